# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""State that outlives the node, over the real middleware: kills, a full disk, shelving, names."""

import contextlib
import json
import math
import resource
import signal
import sqlite3

from ballscrew_monitor import cli
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.state import NOT_ENDED, NOT_SHELVED
from ballscrew_monitor.health.bands import load_band, speed_band
from ballscrew_monitor.health.records import Cell
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import HealthStore
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.messages.diagnostics import USUAL_EVENTS
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_database import FILE, read_entries
from ballscrew_msgs.msg import BallScrewState, OutOfZone
from ballscrew_msgs.srv import AcknowledgeAlarm, ShelveAlarm
from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

FAST, SLOW = 100.0, 0.8  # [rad/s] optimal and outside at 1 kN and 40 degC
KILLS = 2
AT_ONCE = {'x__max_future': 3600.0, 'x__limits__raise_delay': 0.0, 'x__limits__clear_delay': 0.0}


@pytest.fixture(name='axis')
def make_axis(node, tmp_path):
    """Return an axis whose node keeps in a folder, and is not started yet."""
    return Axis(node, tmp_path / 'state')


class Axis:
    """A node, its machine and all that is heard of them."""

    def __init__(self, node, folder):
        self.node, self.folder = node, folder
        self.states = node.states()
        self.events = node.events()
        self.publish = None

    def start(self, **parameters):
        self.states.clear()
        self.events.clear()
        self.node.start(**{'state_dir': self.folder} | AT_ONCE | parameters)
        self.publish = self.publish or self.node.machine()

    def move(self, speed, condition, what):
        def moved():
            self.publish(speed)
            return next((one for one in reversed(self.states) if condition(one)), None)

        return self.node.until(moved, what)

    def kill(self):
        self.node.process.kill()
        assert self.node.process.wait() == -signal.SIGKILL

    def until_level(self, part, level):
        """Wait until a status has a level at last; return its message."""
        last = self.node.until(
            lambda: [one for one in self.node.levels(part)[-1:] if one[0] == level], part
        )
        return last[0][1]

    def kept(self):
        if not (self.folder / FILE).exists():
            return None
        place = f'file:{self.folder / FILE}?mode=ro'
        with contextlib.closing(sqlite3.connect(place, uri=True)) as database:
            database.row_factory = sqlite3.Row
            with contextlib.suppress(sqlite3.OperationalError):  # there is no table yet
                return database.execute('SELECT * FROM axes').fetchone()

    def begin(self, number):
        """Leave the zone until the event of a number is on the disk as active."""
        begun = self.move(SLOW, lambda state: state.event_id == number, 'the event')
        assert begun.level == BallScrewState.LEVEL_WARN

        def active():
            kept = self.kept()
            active = kept and json.loads(kept['memory'])['event_active']
            return active and kept['event'] == number

        self.node.until(active, 'the event on the disk')
        # Nothing that the node has said before it is killed is heard after that.
        self.node.until(lambda: self.events[-1].active, 'the event')

    def log(self):
        return [entry.record() for entry in read_entries(self.folder)]


def test_a_node_that_is_killed_in_an_event_goes_on(axis, says):
    known = 0.0
    for number in range(1, KILLS + 1):
        axis.start()
        last = axis.node.until(lambda: axis.events and axis.events[0], 'the last event')
        assert (last.event_id, last.active) == (number - 1, False)
        assert last.advice == (says('restarted') if number > 1 else '')
        first = axis.move(SLOW, lambda state: state.judged, 'a state')
        assert first.totals.running_time >= known
        axis.begin(number)
        known = json.loads(axis.kept()['memory'])['running_time'] / SECOND
        axis.kill()
    lines = [(line['kind'], line.get('event'), line.get('ending')) for line in axis.log()]
    expected = [('event_begin', number, '') for number in range(1, KILLS + 1)]
    assert [line for line in lines if line[0] == 'event_begin'] == expected
    wanted = [('event_end', number, says('restarted')) for number in range(1, KILLS)]
    assert [line for line in lines if line[0] == 'event_end'] == wanted
    assert [line[0] for line in lines].count('node_start') == KILLS


def test_an_event_is_kept_with_what_came_before_it(axis, capsys):
    axis.start(x__limits__raise_delay=0.2)
    axis.move(FAST, lambda state: state.judged > 40, 'a stay inside')
    axis.begin(1)
    assert cli.main(['events', '--json', str(axis.folder)]) == 0
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    (entry,) = [line for line in lines if line['kind'] == 'event_begin']
    frame = entry['freeze_frame']
    assert {len(values) for values in frame.values()} == {len(frame['time_s'])}
    assert frame['time_s'][-1] == 0.0
    assert set(frame['speed_rad_s']) == {FAST, SLOW}
    assert (frame['speed_rad_s'][-1], frame['axial_load_N'][-1]) == (SLOW, -1000.0)
    assert frame['rcs'][-1] == pytest.approx(entry['value'], rel=1e-5)
    assert entry['code'] == Fault.RCS_HIGH


def test_a_full_disk_is_one_sentence_and_nothing_is_lost(axis):
    """The limit on the size of a file stands for the disk: nothing can be written below it."""
    axis.start()
    axis.move(FAST, lambda state: state.judged > 2, 'a state')
    axis.node.until(lambda: axis.kept(), 'the first record')
    process = axis.node.process.pid
    soft, hard = resource.prlimit(process, resource.RLIMIT_FSIZE)
    axis.node.until(lambda: axis.node.levels('State directory'), 'the status')
    resource.prlimit(process, resource.RLIMIT_FSIZE, (0, hard))
    axis.move(SLOW, lambda state: state.event_id == 1, 'the event')
    axis.node.until(lambda: axis.node.levels('State directory')[1:], 'the sentence')
    axis.move(FAST, lambda state: state.level == BallScrewState.LEVEL_OK, 'the end of it')
    reset = axis.node.call(Trigger, 'x/reset_totals')
    assert reset.success
    assert reset.message.endswith('cannot be written, disk I/O error')
    resource.prlimit(process, resource.RLIMIT_FSIZE, (soft, hard))
    axis.node.until(lambda: axis.node.levels('State directory')[2:], 'the disk to work again')
    good = (DiagnosticStatus.OK, 'sums, events and corrections are kept')
    bad = f'{axis.folder} cannot be written, disk I/O error'
    assert axis.node.levels('State directory') == [good, (DiagnosticStatus.WARN, bad), good]
    kinds = [line['kind'] for line in axis.log()]
    expected = ['node_start', 'event_begin', 'event_end']
    assert [kind for kind in kinds if kind != 'reset_totals'] == expected
    assert 'reset_totals' in kinds
    assert axis.kept()['event'] == 1
    assert axis.node.stop() == 0
    assert axis.log()[-1]['kind'] == 'node_stop'


def test_a_directory_that_is_mounted_later_is_taken_up(axis, tmp_path):
    disk = tmp_path / 'disk'
    disk.write_text('not mounted yet')
    axis.folder = disk / 'state'
    axis.start()
    axis.move(SLOW, lambda state: state.event_id == 1, 'the event')
    bad = f'{axis.folder} cannot be written, Not a directory'
    axis.node.until(
        lambda: axis.node.levels('State directory')[-1:] == [(DiagnosticStatus.WARN, bad)]
    )
    memory = Memory(running_time=7 * SECOND, since=1, event_number=41)
    before = AxisRecord.of('x', memory, NOT_ENDED, NOT_SHELVED, 0)
    mounted = RestartState(tmp_path / 'mounted' / 'state')
    mounted.keep(before)
    mounted.close()
    disk.unlink()
    (tmp_path / 'mounted').rename(disk)
    state = axis.move(SLOW, lambda state: state.event_id == 42, 'the number that goes on')
    assert state.totals.running_time > 7.0
    assert state.totals.since.nanosec == 1
    axis.until_level('State directory', DiagnosticStatus.OK)
    assert [line['kind'] for line in axis.log()] == ['node_start', 'event_begin']


def test_a_damaged_file_is_one_sentence_and_begins_anew(axis):
    axis.folder.mkdir()
    path = axis.folder / FILE
    path.write_text('no database' * 1000)
    axis.start()
    state = axis.move(SLOW, lambda state: state.event_id == 1, 'the event')
    assert state.totals.running_time < 7.0
    message = axis.until_level('State directory', DiagnosticStatus.WARN)
    assert len(axis.node.levels('State directory')) == 1
    damaged = f'{path} is damaged (file is not a database), moved to state.sqlite3.aside'
    assert message == damaged
    assert path.with_suffix('.sqlite3.aside').exists()


def test_an_acknowledgement_keeps_who_and_why(axis, capsys, says):
    axis.start(x__limits__raise_delay=0.2, x__advice__speed='true')
    node, ask = axis.node, {'axis': 'x', 'name': ' Ada\n', 'reason': 'nut is  ordered'}
    axis.begin(1)
    for change, key in (
        ({'name': ' '}, 'name_has_0'),
        ({'name': 'A' * 201}, 'name_has_201'),
        ({'reason': 'x' * 501}, 'acknowledged_for_501'),
        ({'axis': 'q'}, 'axis_unknown'),
    ):
        answer = node.call(AcknowledgeAlarm, 'acknowledge_as', **ask | change)
        assert (answer.success, answer.message) == (False, says(key))
    assert axis.events[-1].active
    assert axis.log()[-1]['kind'] == 'event_begin'
    answer = node.call(AcknowledgeAlarm, 'acknowledge_as', **ask)
    assert (answer.success, answer.message) == (True, says('acknowledged'))
    node.until(lambda: not axis.events[-1].active, 'the end of the event')
    ended = axis.events[-1]
    assert (ended.ending, ended.acknowledged_by) == (OutOfZone.ENDING_ACKNOWLEDGED, 'Ada')
    assert ended.acknowledge_reason == 'nut is ordered'
    assert ended.advice == says('acknowledged_by')
    assert math.isfinite(axis.events[-1].cause.target_speed)
    seen = [one for one in axis.log() if one['kind'] == 'acknowledge'][0]
    assert (seen['event'], seen['name'], seen['reason']) == (1, 'Ada', 'nut is ordered')
    assert cli.main(['events', str(axis.folder)]) == 0
    assert says('acknowledged_in_log') in capsys.readouterr().out
    # Of all axes; the plain service carries no name.
    assert node.call(AcknowledgeAlarm, 'acknowledge_as', name='Bo').success
    assert node.call(Trigger, 'acknowledge').message == 'acknowledged of x'
    names = [one['name'] for one in axis.log() if one['kind'] == 'acknowledge']
    assert list(dict.fromkeys(names)) == ['Ada', 'Bo', '']  # a request may be repeated


def test_a_shelved_warning_calls_nobody_and_outlives_the_node(axis, says):
    plain = axis.node.listen(Bool, f'{axis.node.name}/x/plain/out_of_zone')
    axis.start(x__plain_topics='true')
    axis.move(SLOW, lambda state: state.event_id == 1, 'the event')
    axis.until_level('x: Lubrication', DiagnosticStatus.WARN)
    node, ask = axis.node, {'axis': 'x', 'duration': 3600.0, 'reason': 'nut is ordered'}
    refused = node.call(ShelveAlarm, 'shelve', **ask | {'reason': ''})
    assert (refused.success, refused.until.sec) == (False, 0)
    assert refused.message == says('reason_has_0')
    unknown = node.call(ShelveAlarm, 'shelve', **ask | {'axis': 'q'}).message
    assert unknown == "axis 'q' is unknown, known are: x"
    answer = node.call(ShelveAlarm, 'shelve', **ask)
    assert answer.success
    state = axis.move(SLOW, lambda state: state.shelved, 'a state that says so')
    assert (state.level, state.event_id) == (BallScrewState.LEVEL_WARN, 1)
    assert (state.shelved_until, state.shelve_reason) == (answer.until, 'nut is ordered')
    node.until(lambda: plain and not plain[-1].data, 'the plain topic')
    node.until(
        lambda: axis.events[-1].shelved and axis.events[-1].active, 'the event that says so'
    )
    message = axis.until_level('x: Lubrication', DiagnosticStatus.OK)
    assert message.startswith('shelved until 2')
    assert message.endswith(' UTC: nut is ordered')
    axis.kill()
    axis.start()
    state = axis.move(SLOW, lambda state: state.event_id == 2, 'the next event')
    assert state.shelve_reason == 'nut is ordered'
    assert state.shelved_until.sec >= answer.until.sec  # what was left goes on after the restart
    assert not node.call(ShelveAlarm, 'shelve', axis='q').success  # the new node knows us now
    assert node.call(ShelveAlarm, 'shelve', duration=0.0).message == 'no longer shelved: x'
    axis.move(SLOW, lambda state: state.event_id == 2 and not state.shelved, 'the warning')
    assert node.call(ShelveAlarm, 'shelve', duration=0.5, reason='short').success
    node.until(lambda: axis.log()[-1]['kind'] == 'unshelve', 'its end by itself')
    assert axis.log()[-1]['reason'] == 'short'
    node.until(lambda: not axis.events[-1].shelved, 'the event that says so')
    axis.until_level('x: Lubrication', DiagnosticStatus.WARN)


def keep_baseline(folder):
    """Keep days on which the axis went to and fro at SLOW and FAST, against 1 kN at each."""
    first, speeds = 20_000, (SLOW, FAST)  # days since 1970
    cells = [
        Cell(
            start=day * DAY,
            first_day=day,
            speed_band=speed_band(speed),
            load_band=load_band(-1000.0),
            direction=way,
            stretches=20,
            duration=200.0,
            speed=way * speed,
            axial_load=-1000.0,
            temperature=313.15,
            motor_torque=way * 0.9,
        )
        for day in range(first, first + 300, 2)
        for speed in speeds
        for way in (1, -1)
    ]
    store = HealthStore(folder)
    store.load()
    store.add('x', cells)
    store.close()


def test_a_usual_warning_is_known_as_such_over_a_restart(axis):
    """Level, code and number of the warning are those of any other."""
    axis.folder.mkdir()
    keep_baseline(axis.folder)
    healths = axis.node.healths()

    def usual():
        named = [
            pair.value
            for message in axis.node.told
            for status in message.status
            for pair in status.values
            if status.name.endswith(': x: Lubrication') and pair.key == USUAL_EVENTS
        ]
        return named[-1:]

    axis.start(x__health__enabled='true', x__temperature__default=40.0)
    axis.node.until(lambda: healths, 'the health')
    axis.begin(1)
    axis.node.until(lambda: usual() == ['1'], 'the usual warning')
    assert axis.until_level('x: Lubrication', DiagnosticStatus.WARN) == Fault.RCS_HIGH.text
    assert axis.events[-1].advice.endswith('usual for this axis')
    axis.kill()
    axis.start(x__health__enabled='true', x__temperature__default=40.0)
    axis.move(FAST, lambda state: state.level == BallScrewState.LEVEL_OK, 'a stay inside')
    axis.node.until(lambda: usual() == ['1'], 'the usual warning')
    axis.begin(2)
    axis.node.until(lambda: usual() == ['1 2'], 'another one')
