# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The node at work in a scripted world: all that it can hear, be asked for and lose, in two runs.

The first one is on simulated time and records itself, the second one on the clock of the wall goes
on with what the first one kept. The node is made in `make_node` alone.

"""

import contextlib
import math
import sqlite3
import types

from ballscrew_monitor.node.node import BallscrewMonitor
from ballscrew_msgs.msg import OperatingPoint
from ballscrew_msgs.srv import AcknowledgeAlarm, EvaluateOperatingPoint, SetBaseline, ShelveAlarm
from builtin_interfaces.msg import Time
from geometry_msgs.msg import WrenchStamped
from golden.compare import masked
from golden.doors import fields_of, page_records, plain_lines, SaidByNode
from golden.inputs import FEED, NOMINAL
from golden.world import SECOND, World
from lifecycle_msgs.srv import ChangeState, GetState
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from recording import BEGIN
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import Trigger
from surrogate.surface import FIELDS, Surface
import yaml

PERIOD = 0.05  # [s] of the samples
START = BEGIN + 3600 * SECOND  # [ns] of simulated time
YEAR = 365 * 86_400 * SECOND
SURFACE = 'x.npz'
GOOD, CREEP, FAST = 90.0, 12.0, 300.0  # [rad/s] optimal, outside, beyond the surface


def parameters(folder, *, simulated):
    """Return the parameters of the node."""
    return {
        'axes': ['x', 'p', 's'],
        'use_sim_time': simulated,
        'state_dir': str(folder / 'state'),
        'record': 'always' if simulated else 'never',
        'x': {
            'surface': str(folder / SURFACE),
            'limits': {'raise_delay': 0.3, 'clear_delay': 0.5},
            'temperature': {'topic': 'oil_temperature', 'timeout': 4.0 if simulated else 0.8},
            'torque': {'topic': 'x/torque'},
            'plain_topics': True,
            'solve_on_dwell': True,
            'health': {'period': 15.0, 'baseline_days': 2.0},
        },
        'p': {
            'surface': str(FEED),
            'screw': 'iso3408_40x10',
            'publish_period': 0.2,
            'inertia': 0.001,
            'speed': {
                'topic': 'drive',
                'field': 'position[p_axis]',
                'unit': 'deg',
                'wrap': 360.0,
                'window': 0.15,
            },
            'load': {'source': 'motor_torque'},
            'torque': {'topic': 'p/current', 'unit': 'A', 'constant': 0.8, 'uncertainty': 0.05},
        },
        's': {
            'surface': str(NOMINAL),
            'handedness': 'left',
            'max_lag': 0.05,
            'speed': {'topic': 's/rpm', 'type': '', 'field': 'data', 'unit': 'rev/min'},
            'load': {
                'topic': 's/forces',
                'type': 'std_msgs/msg/Float64MultiArray',
                'field': 'data[1]',
                'unit': 'kN',
            },
            'health': {'enabled': False},
        },
    }


def make_node(context, path):
    """Return the node with the parameters of a file, which is not started yet."""
    node = BallscrewMonitor(context=context, cli_args=['--ros-args', '--params-file', str(path)])
    # By which nodes of one name hear of each other: it is another one in every run.
    node._heartbeat._instances = types.SimpleNamespace(publish=lambda instance: None)
    return node


class Run:
    """A run of the node, and the machine around it."""

    def __init__(self, folder, world, *, simulated):
        """Begin without a message; `simulated` tells by which clock."""
        self.world, self.simulated, self.answers = world, simulated, []
        self.path, self.surface = folder / 'node.yaml', folder / SURFACE
        self.surface.write_bytes(NOMINAL.read_bytes())
        values = {'/**': {'ros__parameters': parameters(folder, simulated=simulated)}}
        self.path.write_text(yaml.safe_dump(values, sort_keys=False))
        self.clock = world.publisher('/clock', Clock) if simulated else None
        self.joints = world.publisher('/joint_states', JointState)
        self.load = world.publisher('/axial_load', WrenchStamped)
        self.oil = world.publisher('/oil_temperature', Temperature)
        self.torque = world.publisher('/x/torque', Float64)
        self.drive = world.publisher('/drive', JointState)
        self.current = world.publisher('/p/current', Float64)
        self.forces = world.publisher('/s/forces', Float64MultiArray)
        self.rpm = None  # comes late
        self.time, self.ahead, self.angle, self.count = START, 0, 350.0, 0
        self.stands = False  # simulated time

    @property
    def stamp(self):
        """Return the stamp of what is measured now [ns]."""
        return (self.time if self.simulated else self.world.wall) + self.ahead

    def stamped(self, message, stamp=None):
        """Return a message with a stamp [ns], that of now unless stated."""
        stamp = self.stamp if stamp is None else stamp
        message.header.stamp = Time(sec=stamp // SECOND, nanosec=stamp % SECOND)
        return message

    def go(self, duration, x=(GOOD, -1000.0), p=40.0, s=(700.0, -0.8), **changes):
        """Let the machine run for a duration [s] at speeds and loads of its axes."""
        for _ in range(round(duration / PERIOD)):
            self.world.wait(PERIOD)
            if self.simulated and not self.stands:
                self.time += round(PERIOD * SECOND)
                self.clock.publish(
                    Clock(clock=Time(sec=self.time // SECOND, nanosec=self.time % SECOND))
                )
            self.count += 1
            self.send(x, p, s, **changes)
            self.world.spin()

    def send(self, x, p, s, *, joint='x_axis', value=None):
        """Send what an instant gives; None: the axis is silent."""
        if x is not None:
            speed, load = x
            force = WrenchStamped()
            force.wrench.force.x = load
            self.load.publish(self.stamped(force))
            torque = 0.15 * math.tanh(speed) - load * 0.01 / 2.0 / math.pi
            self.torque.publish(Float64(data=torque + 0.01 * (self.count % 3)))
            self.joints.publish(self.stamped(JointState(name=[joint], velocity=[speed])))
            if self.count % 20 == 1:
                oil = Temperature(temperature=42.0 + 0.03 * (self.count % 7))
                self.oil.publish(self.stamped(oil))
        if p is not None:
            self.angle = (self.angle + math.degrees(p) * PERIOD) % 360.0
            self.drive.publish(self.stamped(JointState(name=['p_axis'], position=[self.angle])))
            self.current.publish(Float64(data=1.2 * math.tanh(p) if value is None else value))
        if s is not None:
            self.forces.publish(Float64MultiArray(data=[0.0, s[1]]))
            if self.rpm is not None:
                self.rpm.publish(Float64(data=s[0]))

    def only(self, publisher, message):
        """Send a message between two samples, and let the node take it."""
        self.world.wait(PERIOD / 2)
        publisher.publish(message)
        self.world.spin()

    def ask(self, service, kind, **request):
        """Ask the node for a service, and keep its answer."""
        answer = self.world.call(self.node, service, kind, **request)
        self.answers.append((self.world.now, service, kind.Request(**request), answer))

    def set_parameters(self, **values):
        """Set parameters, with `__` for a dot."""
        named = [Parameter(name.replace('__', '.'), value=one) for name, one in values.items()]
        given = [one.to_parameter_msg() for one in named]
        self.ask('~/set_parameters_atomically', SetParametersAtomically, parameters=given)

    def change(self, label):
        """Ask for a transition of the lifecycle."""
        request = ChangeState.Request()
        request.transition.label = label
        self.ask('~/change_state', ChangeState, transition=request.transition)
        self.ask('~/get_state', GetState)

    def text(self, folder):
        """Return what was said, asked and logged in the run, and the page's records of it."""
        said, page, counts = SaidByNode(folder), [], {}
        for time, topic, kind, data in self.world.said:
            if not topic.startswith(('/ballscrew_monitor/', '/diagnostics')):
                continue
            message = deserialize_message(data, kind)
            said.take(topic, time, message)
            counts[topic] = counts.get(topic, -1) + 1
            if counts[topic] % 100 == 0:
                for name, record in page_records(message):
                    page.append(f'{time} {topic} {name}\n{plain_lines(record)}')
        answers = ''.join(
            f'{time} {service} {_shown(request)}\n{_lines(answer)}'
            for time, service, request, answer in self.answers
        )
        log = ''.join(f'{time} {level} {text}\n' for time, level, text in self.world.logged)
        return {
            'said': said.text(),
            'page': masked(''.join(page), folder),
            'answers': masked(answers, folder),
            'log': masked(log, folder),
        }


def _shown(message):
    return ', '.join(f'{place}={value!r}' for place, value in fields_of(message))


def _lines(message):
    return ''.join(f'    {place} = {value!r}\n' for place, value in fields_of(message))


def solved(asked):
    """Return the frames of the process that solves: what the surface says, a little worse."""
    if 'task' not in asked:
        return []
    place = asked['inputs']['point']
    found = Surface.load(NOMINAL).lookup(
        place['speed'], place['opposing_load'], place['temperature']
    )
    means = {name: float(getattr(found, name)) for name in FIELDS}
    means |= {'friction_torque': 1.04 * means['friction_torque'], 'rcs': 1.1 * means['rcs']}
    step = {'stage': 'solving', 'nut': 1, 'side': 1, 'iteration': 3, 'fraction': 0.5}
    result = {
        'converged': True,
        'status': 'converged',
        'worst_contact': 0,
        'rcs_deviation': 1e-9,
        **means,
    }
    return [{'step': step}, {'result': result, 'sentence': '', 'worker': '', 'seconds': 1.0}]


def first_run(folder):
    """Return what the node says on simulated time."""
    world = World(BEGIN)
    world.worker = solved
    with world.entered():
        run = Run(folder, world, simulated=True)
        with world.node(lambda context: make_node(context, run.path)) as run.node:
            run.node.start()
            for act in SCRIPT:
                act(run)
            run.node.finish()
    return run.text(folder)


def second_run(folder):
    """Return what the node says on the clock of the wall, after a start again."""
    world = World(BEGIN + 7200 * SECOND)
    with world.entered():
        run = Run(folder, world, simulated=False)
        with world.node(lambda context: make_node(context, run.path)) as run.node:
            for act in AGAIN:
                act(run)
            run.node.finish()
    return run.text(folder)


def before_the_clock(run):
    """Send samples while simulated time has not begun."""
    run.world.wait(1.5)
    run.stands = True
    run.go(0.2)
    run.stands = False


def normal(run):
    """Run as all do that are well; the speed of one axis comes late."""
    run.go(2.0)
    run.rpm = run.world.publisher('/s/rpm', Float64)
    run.go(4.0)
    run.go(1.0, p=-40.0, s=(-700.0, -0.8))


def a_warning(run):
    """Creep until there is a warning, which people see, shelve and acknowledge."""
    run.go(1.2, x=(CREEP, -1000.0))
    run.ask('~/shelve', ShelveAlarm, axis='x', duration=4.0, reason='the tool is changed')
    run.go(1.0, x=(CREEP, -1200.0))
    run.ask('~/acknowledge_as', AcknowledgeAlarm, axis='x', name='Ada', reason='seen it')
    run.go(1.5, x=(CREEP, -1000.0))
    run.go(2.5)
    run.ask('~/shelve', ShelveAlarm, axis='', duration=60.0, reason='maintenance')
    run.ask('~/shelve', ShelveAlarm, axis='x', duration=0.0, reason='')
    run.ask('~/shelve', ShelveAlarm, axis='w', duration=60.0, reason='no such axis')
    run.ask('~/shelve', ShelveAlarm, axis='x', duration=1e9, reason='too long')
    run.ask('~/shelve', ShelveAlarm, axis='x', duration=60.0, reason='')
    run.ask('~/acknowledge_as', AcknowledgeAlarm, axis='x', name='', reason='nobody')
    run.go(0.5, x=(GOOD, -100.0))
    run.go(1.5, x=(GOOD, -300.0))
    run.ask('~/x/acknowledge', Trigger)
    run.go(0.5)


def refusals(run):
    """Send what gives no sample, for every reason that there is."""
    run.go(1.0, joint='y_axis')
    run.go(0.5)
    run.go(0.2, x=(math.nan, -1000.0))
    run.only(run.load, b'\0\1\0\0\7')
    run.only(run.joints, run.stamped(JointState(name=['x_axis'], velocity=[GOOD]), -5 * SECOND))
    run.only(run.joints, run.stamped(JointState(name=['x_axis'])))
    run.only(run.joints, run.stamped(JointState(name=['x_axis'], velocity=[GOOD]), 0))
    run.go(0.5)
    run.ahead = 5 * SECOND
    run.go(1.0)
    run.ahead = 2 * YEAR
    run.go(1.0)
    run.ahead = -SECOND
    run.go(1.0)
    run.ahead = -run.time - SECOND
    run.go(1.0)
    run.ahead = 0
    run.go(0.5)
    run.only(run.joints, run.stamped(JointState(name=['x_axis'], velocity=[1e7])))
    run.go(0.5, x=(GOOD, 1e7))
    run.go(2.0, x=(FAST, -1000.0))
    run.go(0.5, x=(GOOD, -9000.0))
    run.go(0.5)


def several_and_lost(run):
    """Send one input by two publishers, too short arrays, and lose messages on the way."""
    other = run.world.publisher('/s/rpm', Float64, node='somebody')
    for _ in range(20):
        run.go(PERIOD)
        other.publish(Float64(data=-3.0))
    run.world.leave(other)
    run.go(1.0)
    for _ in range(3):
        run.only(run.forces, Float64MultiArray(data=[1.0]))
    run.only(run.forces, Float64MultiArray())
    for _ in range(20):
        run.go(PERIOD, s=None)
        run.rpm.publish(Float64(data=700.0))
        run.forces.publish(Float64MultiArray(data=[1.0]))
    run.go(0.5)
    for number in range(20):
        message = run.stamped(JointState(name=['x_axis'], velocity=[GOOD]))
        run.joints.publish(message, lost=number % 4 != 0)
        run.go(PERIOD)
    second = run.world.publisher('/joint_states', JointState, node='of another axis')
    for _ in range(10):
        run.go(PERIOD)
        second.publish(run.stamped(JointState(name=['w_axis'], velocity=[1.0])))
    run.world.leave(second)
    run.go(1.0)


def positions(run):
    """Let positions jump and stop, and the motor torque tell no load."""
    run.angle += 170.0
    run.go(1.0)
    run.go(2.0, p=None)
    run.go(1.0)
    run.go(0.5, value=math.nan)
    run.go(1.0, p=0.0)
    run.go(1.0, p=120.0)
    run.go(1.0, p=-120.0, value=0.01)
    run.go(0.5, p=2.0)


def parameters_change(run):
    """Change parameters, those that must not change among them."""
    run.set_parameters(x__limits__efficiency=0.95)
    run.go(1.0)
    run.set_parameters(x__limits__efficiency=0.85, x__limits__rcs=0.02)
    run.set_parameters(p__publish_period=0.0)
    run.go(0.5)
    run.set_parameters(x__limits__rcs=2.0)
    run.set_parameters(x__limits__rcs=1)
    run.set_parameters(x__surface='other.npz')
    run.set_parameters(axes=['x'])
    run.set_parameters(x__publish_period=5.0)
    run.set_parameters(no_such_parameter=1.0)
    run.set_parameters(x__limits__rcs=0.01)
    run.set_parameters(p__publish_period=0.2)
    run.set_parameters(s__one_source=False)
    run.go(0.5)
    other = run.world.publisher('/s/rpm', Float64, node='somebody')
    for _ in range(10):
        run.go(PERIOD)
        other.publish(Float64(data=710.0))
    run.world.leave(other)
    run.set_parameters(x__warning__policy='both')
    run.set_parameters(s__one_source=True)
    run.go(0.5)


def evaluations(run):
    """Ask what the surface says of points."""
    places = [
        (GOOD, -1000.0, 40.0),
        (-GOOD, -1000.0, 25.0),
        (0.0, 0.0, 40.0),
        (CREEP, 500.0, 60.0),
    ]
    places += [(0.01, 0.0, 40.0), (0.8, 3300.0, 10.5), (1.2, 3300.0, 10.5), (2.0, 3300.0, 10.5)]
    places += [(FAST, 0.0, 40.0), (GOOD, 9000.0, 40.0), (GOOD, 0.0, 150.0), (GOOD, -1.0, math.nan)]
    points = [
        OperatingPoint(speed=speed, axial_load=load, temperature=oil)
        for speed, load, oil in places
    ]
    for axis in ('x', 'p', 'w'):
        run.ask('~/evaluate', EvaluateOperatingPoint, axis=axis, points=points)


def dwelling(run):
    """Stay where the surface cannot tell, so that a full solve corrects it."""
    run.go(36.0, x=(DWELL, -1000.0))
    run.set_parameters(x__solve_on_dwell=False)
    run.go(1.0, x=(DWELL, -1000.0))
    run.go(1.0)


DWELL = 35.5  # [rad/s] where asperities perhaps carry


def upkeep(run):
    """Name a baseline, reload the surface, reset the totals."""
    day = {'sec': START // SECOND - 40_000, 'nanosec': 0}
    end = {'sec': START // SECOND + 40_000, 'nanosec': 0}
    run.ask('~/x/set_baseline', SetBaseline, begin=Time(**day), end=Time(**end), reason='new oil')
    run.ask('~/x/set_baseline', SetBaseline, begin=Time(**end), end=Time(**day), reason='no')
    run.ask('~/s/set_baseline', SetBaseline, begin=Time(**day), end=Time(**end), reason='new')
    run.go(2.0)
    run.ask('~/reload_surface', Trigger)
    run.surface.write_bytes(b'no surface')
    run.ask('~/x/reload_surface', Trigger)
    run.go(1.0)
    run.surface.write_bytes(NOMINAL.read_bytes())
    run.ask('~/x/reload_surface', Trigger)
    run.ask('~/reset_totals', Trigger)
    run.go(1.0)
    run.ask('~/acknowledge', Trigger)
    run.go(1.0)


def silence(run):
    """Let the machine be silent, simulated time stand, and then be set back."""
    run.go(1.0, x=(CREEP, -1000.0))
    run.go(2.0, x=None, p=None, s=None)
    run.go(0.5, x=(CREEP, -1000.0))
    run.stands = True
    run.go(3.0, x=None, p=None, s=None)
    run.stands = False
    run.go(1.0)
    run.time -= 6 * SECOND
    run.go(3.0)
    run.time += 20 * SECOND
    run.go(1.5)


def a_hole(run):
    """Kill the process that records; another one takes its place."""
    recorder = run.world.processes[-1]
    recorder.kill()
    recorder.wait()
    run.go(4.0)


def lifecycle(run):
    """Go through the lifecycle, and end in the middle of a warning."""
    run.change('deactivate')
    run.go(1.0)
    run.change('activate')
    run.go(2.0, x=(CREEP, -1000.0))
    run.set_parameters(use_sim_time=False)


SCRIPT = (
    *(before_the_clock, normal, a_hole, a_warning, refusals, several_and_lost, positions),
    *(parameters_change, evaluations, dwelling, upkeep, silence, lifecycle),
)


def start(run):
    """Start again; what was kept is there."""
    run.node.start()
    run.world.wait(0.5)
    run.go(1.0, x=(0.0, -1000.0))
    run.rpm = run.world.publisher('/s/rpm', Float64, is_numbered=False)
    run.go(2.0)
    run.world.publisher('/s/rpm', Float64, node='somebody', is_numbered=False)
    run.go(2.0)


def lag(run):
    """Let stamps lag, and come from another kind of clock."""
    run.ahead = -30 * SECOND
    run.go(2.0)
    run.go(2.0, x=(CREEP, -1000.0))
    run.ahead = 100 * SECOND - run.world.wall
    run.go(2.0)
    run.ahead = SECOND // 20
    run.go(1.0)
    run.ahead = SECOND // 2
    run.go(1.0)
    run.ahead = 0
    run.go(2.0)


def steps(run):
    """Set the clock of the wall back and forward, in motion and in a warning."""
    run.go(1.0, x=(CREEP, -1000.0))
    run.world.step = -5 * SECOND
    run.go(2.0, x=(CREEP, -1000.0))
    run.world.step = 60 * SECOND
    run.go(2.0, x=(CREEP, -1000.0))
    run.world.step = 0
    run.go(2.0)
    run.ask('~/shelve', ShelveAlarm, axis='x', duration=3.0, reason='short')
    run.world.step = 10 * SECOND
    run.go(2.0, x=(CREEP, -1000.0))


AGAIN = (start, lag, steps)


def kept(folder):
    """Return the tables that outlive the node, as text."""
    lines = []
    with contextlib.closing(sqlite3.connect(folder / 'state' / 'state.sqlite3')) as database:
        database.row_factory = sqlite3.Row
        for table in ('axes', 'corrections'):
            for row in database.execute(f'SELECT * FROM {table} ORDER BY axis'):
                lines.append(f'{table}\n{plain_lines(dict(row))}')
    return masked(''.join(lines), folder)
