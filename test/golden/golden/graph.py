# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Findings of `ballscrew doctor` in a scripted graph, with parameters that are right and wrong."""

from builtin_interfaces.msg import Time
from geometry_msgs.msg import WrenchStamped
from golden import doors
from golden.inputs import NOMINAL
from golden.world import SECOND, World
from recording import BEGIN
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Float64
import yaml

GOOD = {
    'axes': ['x'],
    'x': {
        'surface': str(NOMINAL),
        'speed': {'topic': 'joint_states'},
        'load': {'topic': 'axial_load'},
        'temperature': {'topic': 'oil_temperature'},
        'torque': {'topic': 'spindle'},
    },
}
WRONG = {
    'good': {},
    'topic': {'load': {'topic': 'axial_laod'}},
    'type': {'speed': {'type': 'std_msgs/msg/Float64', 'field': 'data'}},
    'field': {'load': {'field': 'wrench.force'}},
    'joint': {'speed': {'field': 'velocity[y_axis]'}},
    'open_type': {'speed': {'topic': 'spindle', 'type': '', 'field': 'data'}},
    'speed_unit': {'speed': {'topic': 'turns', 'type': '', 'field': 'data'}},
    'load_unit': {'load': {'unit': 'kN'}},
    'temperature_unit': {'temperature': {'unit': 'K'}},
    'torque_unit': {'torque': {'unit': 'A'}},
    'derived': {'load': {'source': 'motor_torque'}, 'torque': {'uncertainty': 0.1}},
    'no_uncertainty': {'load': {'source': 'motor_torque'}},
    'timeout': {'load': {'topic': 'slow_load', 'timeout': 0.1}},
    'silent': {'load': {'topic': 'silent_load'}},
    'ahead': {'load': {'topic': 'future_load'}},
    'behind': {'load': {'topic': 'late_load'}},
    'positions': {'speed': {'topic': 'positions'}},
    'short_array': {'speed': {'field': 'velocity[7]'}},
    'two_types': {'speed': {'topic': 'mixed', 'type': '', 'field': 'data'}},
    'surface': {'surface': 'none.npz'},
    'unknown': {'sped': {'topic': 'joint_states'}},
}
"""Changes of the parameters of the axis by what is wrong with them."""
WHOLE = {
    'simulated': {'use_sim_time': True},
    'qos': {'qos_overrides': {'/joint_states': {'subscription': {'reliability': 'reliable'}}}},
    'override': {'qos_overrides': {'/joint': {'subscription': {'depth': 5}}}},
}
"""Changes of the parameters of the node."""


class Graph:
    """The topics of a machine, each with a publisher of its own."""

    def __init__(self, world):
        """Begin to publish in a world."""
        self._world, self._count = world, 0
        make = world.publisher
        self.joints = make('/joint_states', JointState)
        self.positions = make('/positions', JointState)
        self.spindle, self.turns = make('/spindle', Float64), make('/turns', Float64)
        self.oil = make('/oil_temperature', Temperature)
        names = ('axial', 'slow', 'future', 'late', 'silent')
        self.loads = {name: make(f'/{name}_load', WrenchStamped) for name in names}
        for kind in (Float64, JointState):
            make('/mixed', kind, node=f'one of {kind.__name__}')
        make('/clock_of_others', Clock)
        world.others = ['machine', 'recorder']
        world.every(0.02, self.publish)

    def publish(self):
        """Send what is due."""
        self._count += 1
        speed = 90.0 if self._count % 2 else 91.0
        joints = JointState(name=['arm', 'x_axis'], velocity=[0.0, speed])
        self.joints.publish(self.stamped(joints, -0.001))
        self.positions.publish(self.stamped(JointState(name=['x_axis'], position=[1.0])))
        self.spindle.publish(Float64(data=1.5))
        self.turns.publish(Float64(data=9000.0))
        if self._count % 25 == 0:
            self.oil.publish(self.stamped(Temperature(temperature=40.0)))
            self.loads['slow'].publish(self.load(0.0))
        for name, lead in {'axial': -0.002, 'future': 5.0, 'late': -2.0}.items():
            self.loads[name].publish(self.load(lead))

    def stamped(self, message, lead=0.0):
        """Return a message whose stamp leads by a time [s]."""
        stamp = self._world.wall + round(lead * SECOND)
        message.header.stamp = Time(sec=stamp // SECOND, nanosec=stamp % SECOND)
        return message

    def load(self, lead):
        """Return a load."""
        message = WrenchStamped()
        message.wrench.force.x = -1000.0 - self._count % 5
        return self.stamped(message, lead)


def examined(folder, name, values, *options):
    """Return what the doctor says of parameters."""
    path = folder / f'{name}.yaml'
    content = {'/**/ballscrew_monitor': {'ros__parameters': values}}
    path.write_text(yaml.safe_dump(content, sort_keys=False))
    world = World(BEGIN)
    with world.entered():
        Graph(world)
        return doors.command(folder, 'doctor', '--params', path, *options)


def doctor(folder):
    """Return what the doctor says of all parameters."""
    axis = GOOD['x']
    cases = {
        name: GOOD
        | {
            'x': axis
            | {
                key: axis.get(key, {}) | one if isinstance(one, dict) else one
                for key, one in changes.items()
            }
        }
        for name, changes in WRONG.items()
    }
    cases |= {name: GOOD | changes for name, changes in WHOLE.items()}
    said = [examined(folder, name, values) for name, values in cases.items()]
    as_json = [
        examined(folder, name, cases[name], '--json', '--seconds', '1.5')
        for name in ('good', 'timeout', 'ahead')
    ]
    return {'words': ''.join(said), 'json': ''.join(as_json)}
