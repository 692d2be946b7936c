# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Health over the real middleware: gathered, published, a baseline that no kill takes."""

import contextlib
import math
import signal

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.baseline import LEARNED
from ballscrew_monitor.health.records import Stretch
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import FILE, HealthStore, read_health
from ballscrew_monitor.health.summary import add
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_msgs.msg import AxisHealth, BallScrewState
from ballscrew_msgs.srv import SetBaseline
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from rclpy.serialization import deserialize_message

KILLS = 2
DAYS = 54
WARM = 313.15  # [K]
SPEEDS = 3.0, 12.0, 40.0, 100.0
TORQUE = {'x__health__baseline_days': 25.0}
TORQUE |= {'x__torque__topic': 'axial_load', 'x__torque__field': 'wrench.torque.x'}
TORQUE |= {'x__torque__type': 'geometry_msgs/msg/WrenchStamped'}


@pytest.fixture(name='axis')
def make_axis(node, tmp_path, bin_of_day):
    """Return an axis whose node keeps in a folder, and is not started yet."""
    return Axis(node, tmp_path / 'state', bin_of_day)


class Axis:
    """A node with a torque, and all that is heard of its health."""

    def __init__(self, node, folder, bin_of_day):
        self.node, self.folder = node, folder
        self.bin_of_day = bin_of_day
        self.states, self.healths = node.states(), node.healths()
        self.publish = None

    def live(self, *, worse=1.0):
        """Let the axis have run for days, the second half with a `worse` friction [-]."""
        today = self.node.now() // DAY
        cells, bins = {}, []
        for day in range(today - DAYS, today, 3):
            factor = worse if day >= today - DAYS // 2 else 1.0
            for number, speed in enumerate((*SPEEDS, *(-one for one in SPEEDS))):
                for second in range(8):
                    torque = math.copysign(0.3, speed)
                    one = Stretch(
                        start=day * DAY + (10 * number + second) * SECOND,
                        duration=600.0,
                        samples=100,
                        speed=speed,
                        axial_load=0.0,
                        temperature=WARM,
                        motor_torque=factor * torque * (1.0 + 0.002 * (second % 3 - 1)),
                    )
                    assert add(cells, one, today=day) == ''
            bins.append(self.bin_of_day(day))
        with contextlib.closing(HealthStore(self.folder)) as store:
            store.load()
            store.add('x', cells.values(), bins)

    def start(self, **parameters):
        self.healths.clear()
        self.node.start(
            **{'state_dir': self.folder, 'x__max_future': 3600.0} | TORQUE | parameters
        )
        self.publish = self.publish or self.node.machine()

    def health(self, condition=lambda one: True, what='the health'):
        """Return the last health, once a `condition` holds for it."""
        return self.node.until(
            lambda: self.healths and condition(self.healths[-1]) and self.healths[-1], what
        )

    def move(self, seconds, speed=40.0, torque=0.3):
        """Move for a time [s] of stamps, and wait until it is judged."""
        for _ in range(round(100 * seconds)):
            self.publish(speed, 0.0, torque=torque)
            self.node.spin()
        last = self.node.stamp

        def judged():
            self.publish(speed, 0.0, torque=torque)  # the last one may be lost
            return self.states and stamp_of(self.states[-1]) >= last

        self.node.until(judged, 'the state')

    def kill(self):
        self.node.process.kill()
        assert self.node.process.wait() == -signal.SIGKILL

    def kept(self):
        return read_health(self.folder)['x']


def stamp_of(message):
    return message.header.stamp.sec * SECOND + message.header.stamp.nanosec


def test_the_node_gathers_and_says_what_is_normal(axis):
    axis.live()
    axis.start(record='always')
    health = axis.health()
    assert (health.axis, health.condition) == ('x', AxisHealth.CONDITION_NORMAL)
    assert health.baseline_reason == LEARNED
    assert 0 < health.baseline_begin.sec < health.baseline_end.sec
    assert health.verdict.startswith('Axis x is normal')
    level, message = axis.node.until(lambda: axis.node.levels('x: Health')[-1:], 'the status')[0]
    assert (level, message) in {
        (DiagnosticStatus.OK, health.verdict),
        (DiagnosticStatus.OK, 'not known: nothing has been assessed yet'),
    }
    axis.move(3.0)
    before = axis.states[-1].totals.running_time
    assert axis.node.stop() == 0
    kept = axis.kept()
    today = [one for one in kept.cells if one.first_day >= axis.node.now() // DAY]
    today = [one for one in today if one.direction]
    assert sum(one.stretches for one in today) >= 1
    assert today[0].motor_torque == pytest.approx(0.3)
    moved = sum(one.time for one in kept.spectrum if one.first_day >= today[0].first_day)
    assert moved == pytest.approx(before, abs=0.5)
    assert kept.baselines == ()
    made = axis.folder / 'recordings'
    (path,) = axis.node.until(lambda: [*made.glob('*/metadata.yaml')], 'the recording')
    *_, last = Bag(path.parent).messages([f'{axis.node.name}/x/health'])
    assert str(deserialize_message(last.data, AxisHealth)) == str(health)


def test_a_change_warns_by_the_policy_alone(axis):
    axis.live(worse=1.4)
    axis.start(x__warning__policy='change')
    health = axis.health()
    assert (health.condition, health.warning) == (AxisHealth.CONDITION_WORSE, True)
    axis.node.until(
        lambda: (DiagnosticStatus.WARN, health.verdict) in axis.node.levels('x: Health'), 'WARN'
    )
    axis.node.set_parameters(x__warning__policy='zone')
    axis.node.until(
        lambda: axis.node.levels('x: Health')[-1] == (DiagnosticStatus.OK, health.verdict), 'OK'
    )


def test_a_named_baseline_outlives_the_node(axis, says):
    axis.live(worse=1.4)
    axis.start()
    axis.health(lambda one: one.condition == AxisHealth.CONDITION_WORSE, 'the change')
    refusal = axis.node.call(SetBaseline, 'x/set_baseline', reason=' ')
    assert (refusal.success, refusal.message) == (False, says('no_reason'))
    done = axis.node.call(SetBaseline, 'x/set_baseline', reason='new screw', running_in=7200.0)
    assert (done.success, done.message) == (True, says('learned_from_now'))
    axis.health(lambda one: one.condition == AxisHealth.CONDITION_UNKNOWN, 'no baseline')
    axis.kill()
    axis.start()
    again = axis.health()
    assert (again.condition, again.baseline_end.sec) == (AxisHealth.CONDITION_UNKNOWN, 0)
    assert 'no log since the baseline was named' in again.verdict
    last = axis.kept().baselines[-1]
    assert (last.reason, last.end, last.left_out) == ('new screw', 0, 7200.0)
    today = axis.node.now() // DAY
    begin, end = (Time(sec=(today - days) * DAY // SECOND) for days in (DAYS // 2, 1))
    named = axis.node.call(SetBaseline, 'x/set_baseline', reason='oil', begin=begin, end=end)
    assert (named.success, named.message) == (True, says('named'))
    found = axis.health(lambda one: one.baseline_reason == 'oil', 'the baseline')
    assert found.condition == AxisHealth.CONDITION_NORMAL
    assert axis.node.stop() == 0


def test_a_node_that_is_killed_keeps_its_baseline(axis):
    axis.live()
    baselines = []
    for number in range(KILLS):
        axis.start()
        axis.health()
        if not number:
            axis.node.call(SetBaseline, 'x/set_baseline', reason='oil')
        axis.move(1.0)
        axis.kill()
        baselines.append(axis.kept().baselines)
    assert [len(one) for one in baselines] == [1] * KILLS
    assert len(set(baselines)) == 1
    assert not (axis.folder / f'{FILE}.aside').exists()


def test_a_damaged_store_is_a_sentence_and_disturbs_nothing(axis):
    axis.folder.mkdir()
    (axis.folder / FILE).write_bytes(b'no database' * 1000)
    axis.start()
    health = axis.health()
    assert health.condition == AxisHealth.CONDITION_UNKNOWN
    assert 'not known' in health.verdict
    assert math.isnan(health.quantities[0].value)
    said = axis.node.until(
        lambda: [
            text
            for level, text in axis.node.levels('State directory')
            if level == DiagnosticStatus.WARN
        ],
        'the sentence',
    )[0]
    assert f'{axis.folder / FILE} is damaged (' in said
    assert (axis.folder / f'{FILE}.aside').exists()
    axis.move(0.5)
    assert axis.states[-1].result.validity == 1
    assert axis.states[-1].level != BallScrewState.LEVEL_WARN
    assert all(level == DiagnosticStatus.OK for level, _ in axis.node.levels('x: Health'))
    assert axis.node.stop() == 0
