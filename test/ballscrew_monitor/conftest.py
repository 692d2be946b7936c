# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A surface of constants for exact tests of the core, and the node in a process of its own."""

import contextlib
import copy
import dataclasses
import ipaddress
import itertools
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import types
import warnings

from ballscrew_monitor.core import advice
from ballscrew_monitor.core.conversions import direction_of, SECOND
from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.core.judgement import Limits, PointSource, PointValidity
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment
from ballscrew_monitor.health.records import SpectrumBin
from ballscrew_monitor.judge import derived_load, full_point, point, step
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.judge.views import total_times
from ballscrew_monitor.messages.state_messages import empty_state, fill_state
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.msg import AxisHealth, BallScrewState, OutOfZone, SurfaceInfo
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from lifecycle_msgs.srv import ChangeState, GetState
import numpy as np
import pytest
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from rosgraph_msgs.msg import Clock
from rosidl_parser import definition
from sensor_msgs.msg import JointState
from surrogate.surface import file as surface_file
from surrogate.surface import Found, shipped_surface
from surrogate.tasks.child import path_to_this_code, WORKER
from surrogate.units import TURN
import yaml

with warnings.catch_warnings():
    # A parser that the wheels bring along uses a deprecated module of Python.
    warnings.simplefilter('ignore', DeprecationWarning)
    import rosidl_generator_py  # noqa: F401

os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
SCANNED = 81  # loads of a surface of constants
START, STEP = 1000 * SECOND, SECOND // 100  # [ns] of the samples of `core.motion`
DEADLINE = 600.0  # [s] which only ends a hang
LATCHED = QoSProfile(depth=10, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


@dataclasses.dataclass(kw_only=True)
class Numbers:
    validity: PointValidity = PointValidity.VALID
    rcs: float = 0.0
    efficiency: float = 0.9
    film_ratio: float = 3.0
    friction_torque: float = 0.125
    friction_torque_error: float = math.nan
    friction_torque_stderr: float = math.nan
    driving_torque: float = 2.0
    back_driving: bool = False
    worst_nut: int = 1
    worst_side: int = 2
    worst_contact: int = 1
    asperity_share: float = 0.0
    central_film: float = 1e-7
    minimum_film: float = 5e-8
    friction_coefficient: float = 0.02
    max_pressure: float = 1e9
    efficiency_error: float = 1e-4
    rcs_error: float = 1e-5
    efficiency_std: float = math.nan
    rcs_std: float = math.nan
    efficiency_stderr: float = math.nan
    rcs_stderr: float = math.nan
    corrected: bool = False


class ConstantSurface:
    """The same numbers everywhere in its range; each may be a function of speed and load."""

    sha256 = '0123456789abcdef' * 4
    tier = 'closed_form'
    screw_name = 'constant'
    oil_name = 'water'
    preload = 1000.0
    lead = 0.01
    limit_band, numerical_band, onset_band = (0.75, 1.5), (0.8, 1.25), (0.7, 1.6)
    speed_range = (0.1, 100.0)
    load_range = (-4000.0, 4000.0)
    temperature_range = (283.15, 353.15)
    errors = {'rcs': (2e-3, 1e-3)}
    corrections = ()
    parasitic_torque = parasitic_torque_rate = torque_error = 0.0
    torque_low, torque_high = -math.inf, math.inf

    @staticmethod
    def with_typical_drag(friction_torque, opposing_load):
        return {}

    def __init__(self, **numbers):
        self.scan_loads = np.linspace(*self.load_range, SCANNED)
        self.scan_torques = np.zeros(SCANNED)
        self.numbers = numbers
        self.asked = []

    def lookup(self, speed, opposing_load, temperature):
        self.asked.append((speed, opposing_load, temperature))
        if not self.speed_range[0] <= speed:
            return Numbers(validity=PointValidity.SPEED_BELOW_RANGE)
        if not speed <= self.speed_range[1]:
            return Numbers(validity=PointValidity.SPEED_ABOVE_RANGE)
        if not self.load_range[0] <= opposing_load <= self.load_range[1]:
            return Numbers(validity=PointValidity.LOAD_OUT_OF_RANGE)
        if not self.temperature_range[0] <= temperature <= self.temperature_range[1]:
            return Numbers(validity=PointValidity.TEMPERATURE_OUT_OF_RANGE)
        return Numbers(
            **{
                name: value(speed, opposing_load) if callable(value) else value
                for name, value in self.numbers.items()
            }
        )

    @property
    def tables(self):
        return self


def make_limits(**changes):
    """Return limits whose numbers are exact in binary, changed as asked."""
    values = {
        'rcs': 0.25,
        'efficiency': 0.75,
        'light_load': 256.0,
        'standstill_speed': 0.5,
        'raise_delay': SECOND // 2,
        'clear_delay': SECOND,
        'hysteresis': 0.5,
    }
    return Limits(**(values | changes))


@pytest.fixture(scope='session')
def usual_limits():
    """Return the limits of an axis on which nothing is delayed."""
    usual = {'rcs': 0.01, 'efficiency': 0.85, 'light_load': 661.0, 'hysteresis': 0.1}
    return make_limits(raise_delay=0, clear_delay=0, **usual)


def make_point(speed=10.0, axial_load=-1000.0, temperature=313.15, **changes):
    """Return a measured point, moving in the direction of its speed."""
    values = {
        'speed_source': PointSource.MEASURED,
        'axial_load_source': PointSource.MEASURED,
        'temperature_source': PointSource.MEASURED,
        'direction': direction_of(speed),
    }
    return Row(speed=speed, axial_load=axial_load, temperature=temperature, **(values | changes))


def make_monitor(surface=None, limits=None, **changes):
    """Return a monitor of axis x whose speed and load have 0.5 s timeout."""
    values = {
        'axis': 'x',
        'limits': limits or make_limits(),
        'default_temperature': 313.15,
        'timeouts': {Source.SPEED: SECOND // 2, Source.LOAD: SECOND // 2},
    }
    return Monitor(surface or ConstantSurface(), MonitorSettings(**(values | changes)))


def sample(source, value, stamp=START, **changes):
    return InputSample(source=source, value=value, stamp=stamp, **changes)


def motion(value, *, start=START, count=1, force=-1000.0, step=STEP):
    """Return pairs of a load and a speed sample."""
    return [
        sample(source, number, start + i * step)
        for i in range(count)
        for source, number in ((Source.LOAD, force), (Source.SPEED, value))
    ]


def totals_of(memory):
    """Return the totals in a memory, times [ns]."""
    rest = {name: getattr(memory, name) for name in ('angle', 'energy_lost', 'since')}
    return types.SimpleNamespace(**total_times(memory), **rest, revolutions=memory.angle / TURN)


class Published:
    """A row of which a state is published, the message, its totals, and the memory of an edge."""

    def __init__(self, monitor, row):
        self.row, self.totals, self.event = row, totals_of(monitor.memory), None
        self.message = empty_state(monitor.settings.axis)
        self.inputs = fill_state(self.message, row, monitor)
        self.judged, self.window = self.message.judged, self.message.window
        if row.edge:
            self.event = copy.deepcopy(monitor.memory)

    def __getattr__(self, name):
        return getattr(self.row, name)


def feed(monitor, events):
    """Return the states that events give; a number is the stamp of a tick."""
    states = []
    for event in events:
        row = monitor.tick(event) if isinstance(event, int) else monitor.update(event)
        if row is not None:
            states.append(Published(monitor, row))
    return states


def look_up(surface, speed, load, temperature, found):
    numbers = surface.lookup(speed, load, temperature)
    found.validity = int(numbers.validity)
    for name in Found.__dataclass_fields__:
        number = getattr(numbers, name, None)
        if isinstance(number, float) and found.validity != PointValidity.VALID:
            number = math.nan
        if number is not None and name != 'validity':
            setattr(found, name, number)
    return found.validity


def look_up_rest(surface, load, found):
    """Leave what `look_up` has filled in."""


def is_inside(surface, speed, temperature):
    """Let every place of a surface of constants be scanned."""
    return True


def scan_part(surface, speed, temperature, begin, end):
    """Fill in the driving torques of a surface of constants."""
    points = [surface.lookup(speed, float(load), temperature) for load in surface.scan_loads]
    valid = [point.validity is PointValidity.VALID for point in points]
    surface.scan_torques[:] = np.where(valid, [one.driving_torque for one in points], math.nan)
    return np.count_nonzero(np.isfinite(surface.scan_torques[begin:end]))


def scan(surface, speed, temperature):
    return scan_part(surface, speed, temperature, 0, SCANNED)


def constant_or(constant, real):
    """Return a lookup of surfaces of constants that leaves any other to the real one."""
    return lambda tables, *others: (constant if isinstance(tables, ConstantSurface) else real)(
        tables, *others
    )


def take_constants(patch):
    for module in (advice, point, step, derived_load, full_point):
        for constant in (look_up, look_up_rest, is_inside, scan, scan_part):
            name = constant.__name__
            if hasattr(module, name):
                patch.setattr(module, name, constant_or(constant, getattr(module, name)))


@pytest.fixture(scope='module')
def core():
    """Make the parts that tests of the core are built from; nothing compiles meanwhile."""
    with pytest.MonkeyPatch.context() as patch:
        take_constants(patch)
        yield types.SimpleNamespace(
            surface=ConstantSurface,
            numbers=Numbers,
            limits=make_limits,
            point=make_point,
            monitor=make_monitor,
            sample=sample,
            motion=motion,
            feed=feed,
            totals=totals_of,
        )


@pytest.fixture(scope='session')
def filled():
    """Return what makes a message of a type with a value of its own in every field."""
    return _filled


def _filled(message_type, start=1):
    """Return a message with 3 elements in each sequence, numbered from `start`."""
    message, numbers = message_type(), itertools.count(start)
    for name, kind in zip(message.get_fields_and_field_types(), message.SLOT_TYPES):
        setattr(message, name, _value(kind, numbers))
    return message


def _value(kind, numbers):
    number = next(numbers)
    if isinstance(kind, definition.AbstractNestedType):
        size = kind.size if isinstance(kind, definition.Array) else 3
        return [_value(kind.value_type, numbers) for _ in range(size)]
    if isinstance(kind, definition.NamespacedType):
        return _filled(message_class('/'.join(kind.namespaced_name())), number)
    if isinstance(kind, definition.AbstractString):
        return f'text {number} °' + 'x' * (number % 5)
    if kind.typename in ('float', 'double'):
        return math.nan if number % 11 == 0 else number / 8
    if kind.typename == 'octet':
        return bytes([number % 256])
    return bool(number % 2) if kind.typename == 'boolean' else number % 100


def content_of(path):
    """Return what a file holds; nothing if the process that it speaks of is gone."""
    try:
        return path.read_bytes()
    except (FileNotFoundError, ProcessLookupError):
        return b''


class NodeProcess:
    """The node in a process of its own, and a small `node` here that talks to it."""

    name = '/ballscrew_monitor'

    def __init__(self, domain, node, folder, wait_for):
        self.domain, self.node = domain, node
        self.wait_for = wait_for
        self.environment = child_environment(domain) | {'PYTHONPATH': path_to_this_code()}
        self.output = folder / 'node.log'
        self.process = None
        self.clients = {}
        self.stamp = 0
        self.publishers = ()
        self.after_states = []
        self.told = self.listen(DiagnosticArray, '/diagnostics')

    def start(self, *arguments, **parameters):
        """
        Start the node; parameters of axis x are named with `__` for a dot.

        Each sample gives a state and nothing is kept unless told otherwise.

        """
        command = [sys.executable, '-m', 'ballscrew_monitor.node', '--ros-args', *arguments]
        axes = yaml.safe_load(parameters.get('axes', '[x]'))
        defaults = {f'{axis}__publish_period': 0.0 for axis in axes}
        defaults |= {'diagnostics_period': 0.1, 'state_dir': "''"}
        for name, value in (defaults | parameters).items():
            command += ['-p', f'{name.replace("__", ".")}:={value}']
        self.told.clear()
        with open(self.output, 'w') as output:
            self.process = subprocess.Popen(
                command, env=self.environment, stdout=output, stderr=output
            )

    def until(self, condition, what='the condition', **deadline):
        """Spin, a message at a time, until `condition` gives something true; return that."""
        try:
            return self.wait_for(condition, what, meanwhile=self.spin, **deadline)
        except AssertionError as late:
            raise AssertionError(f'{late}, the node said:\n{self.output.read_text()}') from late

    def spin(self):
        self.node.executor.spin_once(timeout_sec=0.02)

    def now(self):
        """Return the time [ns] on the clock of the machine."""
        return self.node.get_clock().now().nanoseconds

    def listen(self, kind, topic, qos=10):
        """Return the list to which messages of `topic` are appended."""
        heard = []
        self.node.create_subscription(kind, topic, heard.append, qos)
        return heard

    def states(self, axis='x'):
        """
        Return the list to which the states of an axis are appended.

        The node learns of subscriptions in their order: once what is latched has come to the
        second one, no state is published without the first.

        """
        qos = QoSProfile(depth=1000, reliability=QoSReliabilityPolicy.RELIABLE)
        heard = self.listen(BallScrewState, f'{self.name}/{axis}/state', qos)
        self.after_states.append(self.infos(axis))
        return heard

    def events(self, axis='x'):
        """Return the list to which the events of an axis are appended, from the last one on."""
        return self.listen(OutOfZone, f'{self.name}/{axis}/out_of_zone', LATCHED)

    def infos(self, axis='x'):
        """Return the list to which what is said of a surface is appended, from the last on."""
        return self.listen(SurfaceInfo, f'{self.name}/{axis}/surface_info', LATCHED)

    def healths(self, axis='x'):
        """Return the list to which the health of an axis is appended, from the last one on."""
        return self.listen(AxisHealth, f'{self.name}/{axis}/health', LATCHED)

    def levels(self, part='x: Inputs'):
        """Return the levels and messages that a diagnostic status went through."""
        found = [
            (status.level, status.message)
            for message in self.told
            for status in message.status
            if status.name == f'ballscrew_monitor: {part}'
        ]
        return [now for now, before in zip(found, [None, *found], strict=False) if now != before]

    def call(self, kind, service, **request):
        """
        Return the answer of a service of the node.

        The first answer to a new client is lost when the node does not know the client yet, so
        the request is repeated; it must do no harm twice.

        """
        if service not in self.clients:
            self.clients[service] = self.node.create_client(kind, f'{self.name}/{service}')
        client = self.clients[service]
        self.until(client.service_is_ready, service)
        futures = []

        def answer():
            return [future.result() for future in futures if future.done()]

        for patience in (2.0, 5.0, DEADLINE):
            futures.append(client.call_async(kind.Request(**request)))
            with contextlib.suppress(AssertionError):
                return self.until(answer, deadline=patience)[0]
        raise AssertionError(f'{service} did not answer')

    def set_parameters(self, **values):
        parameters = [
            Parameter(name.replace('__', '.'), value=value).to_parameter_msg()
            for name, value in values.items()
        ]
        return self.call(
            SetParametersAtomically, 'set_parameters_atomically', parameters=parameters
        ).result

    def transition(self, label):
        """Ask for a lifecycle transition; return whether it succeeded."""
        request = ChangeState.Request()
        # Twice is not once for a transition: a label that does not exist makes us known.
        request.transition.label = 'none'
        self.call(ChangeState, 'change_state', transition=request.transition)
        request.transition.label = label
        return self.call(ChangeState, 'change_state', transition=request.transition).success

    def lifecycle(self):
        return self.call(GetState, 'get_state').current_state.label

    def machine(self, speed_topic='joint_states', load_topic='axial_load'):
        """
        Return a function that publishes speed [rad/s], force [N] and torque, 10 ms later each.

        The stamps run ahead of the clock, so that a slow machine makes no sample stale. What is
        listened to before this call is heard from the first sample on.

        """
        speeds = self.node.create_publisher(JointState, speed_topic, 100)
        loads = self.node.create_publisher(WrenchStamped, load_topic, 100)
        self.publishers = speeds, loads
        self.until_matched(*self.publishers)
        self.stamp = self.now() + 100 * SECOND

        def publish(speed, force=-1000.0, *, torque=0.0, step=SECOND // 100, joint='x_axis'):
            self.stamp += step
            load, joints = WrenchStamped(), JointState(name=[joint], velocity=[speed])
            load.wrench.force.x, load.wrench.torque.x = force, torque
            loads.publish(self.stamped(load, self.stamp))
            speeds.publish(self.stamped(joints, self.stamp))

        return publish

    def watched(self):
        """Return the states of axis x, and what publishes its samples; all of them are heard."""
        states = self.states()
        return states, self.machine()

    def clock(self):
        """Return a function that shows a time [ns] on the simulated clock."""
        publisher = self.node.create_publisher(Clock, '/clock', 10)
        self.until(publisher.get_subscription_count, 'the subscription of the clock')

        def show(stamp):
            message = Clock()
            message.clock.sec, message.clock.nanosec = divmod(stamp, SECOND)
            publisher.publish(message)

        return show

    @staticmethod
    def stamped(message, stamp):
        """Return a message with a stamp [ns]."""
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        return message

    def knows_listeners(self):
        """Return True if the node knows all subscriptions of its states."""
        return all(self.after_states)

    def until_matched(self, *publishers, inputs=('Speed', 'Load')):
        """Wait until the inputs have one publisher each, and these their node."""
        # A best-effort sample is lost unless both sides know of each other.
        self.until(
            lambda: (
                all(publisher.get_subscription_count() for publisher in publishers)
                and self.knows_listeners()
                and self.told
                and {f'{name} publishers [-]' for name in inputs}
                <= {
                    pair.key
                    for status in self.told[-1].status
                    for pair in status.values
                    if pair.value == '1'
                }
            ),
            'the match with the inputs of the node',
        )

    def solvers(self):
        """Return the numbers of the processes that solve for the node."""
        command = f'-m\0{WORKER}\0'.encode()
        return [
            int(path.parent.name)
            for path in pathlib.Path('/proc').glob('[0-9]*/cmdline')
            if command in content_of(path) and parent_of(path.parent) == self.process.pid
        ]

    def stop(self, number=signal.SIGINT):
        self.process.send_signal(number)
        return self.end()

    def end(self):
        return self.process.wait(DEADLINE)

    def close(self):
        """End what is left; a node that is killed leaves its shared memory behind."""
        if self.process is not None and self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(DEADLINE)
            finally:
                self.process.kill()


def parent_of(process):
    """Return the number of the parent of a process, 0 for one that is gone."""
    stat = content_of(process / 'stat').rpartition(b')')[2].split()
    return int(stat[1]) if stat else 0


def day_of_motion(day):
    """Return the load spectrum of hours without load on a day [-] since 1970."""
    return SpectrumBin(
        first_day=day,
        load_band=0,
        axial_load=0.0,
        angle=4e5,
        speed=40.0,
        time=10_000.0,
        wear_time=(10_000.0,),
    )


@pytest.fixture(scope='session')
def bin_of_day():
    return day_of_motion


@pytest.fixture(scope='session')
def is_alive():
    """Return what tells whether a process runs; one that nobody has reaped yet does not."""

    def alive(pid):
        stat = content_of(pathlib.Path('/proc', str(pid), 'stat')).rpartition(b')')[2].split()
        return bool(stat) and stat[0] != b'Z'

    return alive


@pytest.fixture(scope='session')
def bound_addresses():
    """Return a function that gives address and port of every UDP and TCP socket of a process."""

    def find(pid):
        process = pathlib.Path('/proc', str(pid))
        mine = {f'socket:[{line[9]}]': line[1] for line in socket_lines(process)}
        links = {target_of(opened) for opened in (process / 'fd').iterdir()}
        return {address_of(column) for socket, column in mine.items() if socket in links}

    return find


def target_of(link):
    try:
        return os.readlink(link)
    except FileNotFoundError:
        return ''


def socket_lines(process):
    """Yield the columns of every socket in the network of a process."""
    for table in ('udp', 'udp6', 'tcp', 'tcp6'):
        path = process / 'net' / table
        if path.exists():
            yield from (line.split() for line in path.read_text().splitlines()[1:])


def address_of(column):
    """Return address and port out of a table of sockets, whose words are of little endian."""
    address, _, port = column.partition(':')
    words = [bytes.fromhex(word)[::-1] for word in re.findall('.{8}', address)]
    return str(ipaddress.ip_address(b''.join(words))), int(port, 16)


@pytest.fixture(scope='session')
def quick_surface(tmp_path_factory):
    """Return the shipped surface with wide stated errors."""
    data = surface_file.read(shipped_surface())
    errors = {name: np.full_like(values, 0.5) for name, values in data.errors.items()}
    path = tmp_path_factory.mktemp('surface') / 'quick.npz'
    surface_file.write(path, dataclasses.replace(data, errors=errors))
    return path


@pytest.fixture
def node(tmp_path, wait_for):
    """Make a node process that is not started yet, in a DDS domain of its own."""
    with free_domain() as domain, started_node('tester', domain) as tester:
        with contextlib.closing(NodeProcess(domain, tester, tmp_path, wait_for)) as process:
            yield process
