# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Kill the running node again and again, and compare what it still knows with what it had said.

Usage: python bench/restarts.py [--kills N] [--seconds S] [--turning T] [--seed K]. The axis
leaves its zone and comes back, each kill comes at a random moment. Printed are the running time
that was lost, event numbers that were lost, given twice or left open in the log, and whether the
baseline of the health, which the node writes to and assesses each second, is the same after all.

"""

import argparse
from collections import Counter
import contextlib
import json
import math
import os
from pathlib import Path
import random
import subprocess
import sys
import tempfile
import time
from typing import Any

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment, ros_environment
from ballscrew_monitor.health.records import KeptHealth, Stretch
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import HealthStore, read_health
from ballscrew_monitor.health.summary import add
from ballscrew_monitor.node.state_database import read_entries
from ballscrew_msgs.msg import BallScrewState
from geometry_msgs.msg import WrenchStamped
from node_parts.peer import FAST, LOAD, SLOW, TURNING
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState

STATE = '/ballscrew_monitor/x/state'
RATE = 100.0  # [Hz] of speed and of load
PATIENCE = 60.0  # [s] for a node to judge
DAYS, LONG, WARM = 10, 1000.0, 313.15  # of health; motion of a stretch [s]; its oil [K]
TORQUE = {
    'topic': 'axial_load',
    'field': 'wrench.torque.x',
    'type': 'geometry_msgs/msg/WrenchStamped',
}


class Machine:
    """An axis that turns, and what the node says of it."""

    def __init__(self, turning: float) -> None:
        """Make the topics; `turning` [s] is the time between two changes of the level."""
        self._turning = turning
        self.node = Node('machine')
        self._speeds = self.node.create_publisher(JointState, 'joint_states', 10)
        self._loads = self.node.create_publisher(WrenchStamped, 'axial_load', 10)
        self.node.create_subscription(BallScrewState, STATE, self._take, 100)
        self.heard: list[BallScrewState] = []

    def turn(self, duration: float) -> None:
        """Turn for a `duration` [s]."""
        end = time.monotonic() + duration
        while time.monotonic() < end:
            self._publish(FAST if time.monotonic() % (2 * self._turning) < self._turning else SLOW)
            rclpy.spin_once(self.node, timeout_sec=1.0 / RATE)

    def turn_until_judged(self) -> BallScrewState:
        """Turn until the node has judged a sample; return its first state with one."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.turn(0.05)
            judged = [state for state in self.heard if state.judged]
            if judged:
                return judged[0]
        said = [(one.result.reason, one.inputs[0].received) for one in self.heard[-1:]]
        raise SystemExit(f'the node judges nothing: {len(self.heard)} states, the last {said}')

    def _take(self, state: BallScrewState) -> None:
        self.heard.append(state)

    def _publish(self, speed: float) -> None:
        load, joints = WrenchStamped(), JointState(name=['x_axis'], velocity=[speed])
        load.header.stamp = joints.header.stamp = self.node.get_clock().now().to_msg()
        load.wrench.force.x, load.wrench.torque.x = LOAD, 0.3
        self._loads.publish(load)
        self._speeds.publish(joints)


def live(folder: Path) -> None:
    """Keep some days of health in a `folder`, of which the node makes its baseline."""
    today = time.time_ns() // DAY
    cells: dict[Any, Any] = {}
    for day in range(today - DAYS, today):
        for speed in (FAST, -FAST, 0.3 * FAST, -0.3 * FAST):
            stretch = Stretch(
                start=day * DAY,
                duration=LONG,
                samples=100,
                speed=speed,
                axial_load=LOAD,
                temperature=WARM,
                motor_torque=math.copysign(0.3, speed),
            )
            for _ in range(3):
                add(cells, stretch)
    with contextlib.closing(HealthStore(folder)) as store:
        store.load()
        store.add('x', cells.values())


def start(folder: Path, domain: int) -> subprocess.Popen[bytes]:
    """Start the node, which keeps what it knows in a `folder`."""
    parameters = {'state_dir': str(folder), 'x': {'limits': {'raise_delay': 0.0}}}
    parameters['x']['limits']['clear_delay'] = 0.0  # type: ignore[index]
    parameters['x'] |= {'torque': TORQUE, 'health': {'period': 1.0}}  # type: ignore[operator]
    file = folder.with_suffix('.yaml')
    file.write_text(json.dumps({'/**': {'ros__parameters': parameters}}))
    command = [sys.executable, '-m', 'ballscrew_monitor.node', '--ros-args']
    quiet = ['--log-level', 'error', '--params-file', str(file)]
    return subprocess.Popen([*command, *quiet], env=child_environment(domain))


def kill_one(machine: Machine, folder: Path, domain: int, seconds: float) -> tuple[Any, Any]:
    """Run the node for some `seconds` and kill it; return its first and its last state."""
    machine.heard.clear()
    process = start(folder, domain)
    try:
        first = machine.turn_until_judged()
        machine.turn(random.uniform(0.0, seconds))
    finally:
        process.kill()
        process.wait()
    last = machine.heard[-1]
    print(f'{last.event_id} events, {last.totals.running_time:.1f} s', flush=True)
    return first, last


def report(runs: list[tuple[Any, Any]], entries: list[dict[str, Any]]) -> None:
    """Print what was lost between one run and the next."""
    pairs = [(before, after) for (_, before), (after, _) in zip(runs, runs[1:])]
    lost = [before.totals.running_time - after.totals.running_time for before, after in pairs]
    numbers = [before.event_id - after.event_id for before, after in pairs]
    print(f'kills                   {len(runs)}')
    print(f'running time            {runs[-1][1].totals.running_time:.1f} s')
    print(f'largest loss            {max(lost):.2f} s, mean {sum(lost) / len(lost):.2f} s')
    print(f'numbers fallen back     {sum(number > 0 for number in numbers)}')
    begun, ended = (
        Counter(one['event'] for one in entries if one['kind'] == kind)
        for kind in ('event_begin', 'event_end')
    )
    restarted = sum('restart' in one.get('ending', '') for one in entries)
    twice = [sum(count > 1 for count in counts.values()) for counts in (begun, ended)]
    print(f'events in the log       {len(begun)}, the last is {max(begun)}')
    print(f'begun, ended twice      {twice[0]}, {twice[1]}')
    print(f'never ended             {len(begun.keys() - ended.keys())}')
    print(f'ended by a restart      {restarted}')


def report_health(kept: list[KeptHealth]) -> None:
    """Print whether the baseline is the same after each kill, and how often stretches are lost."""
    counts = [sum(one.stretches for one in each.cells) for each in kept]
    print(f'kills without baseline  {sum(not each.baselines for each in kept)}')
    print(f'different baselines     {len({each.baselines for each in kept})}')
    print(f'stretches kept          {counts[0]} to {counts[-1]}')
    print(f'stretches fallen back   {sum(a > b for a, b in zip(counts, counts[1:]))}')


def main() -> None:
    """Kill, and report."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0].strip())
    parser.add_argument('--kills', type=int, default=100, help='how often')
    parser.add_argument('--seconds', type=float, default=3.0, help='longest life of a node [s]')
    parser.add_argument('--turning', type=float, default=TURNING, help='in and out of zone [s]')
    parser.add_argument('--seed', type=int, default=1, help='of the moments')
    asked = parser.parse_args()
    random.seed(asked.seed)
    with free_domain() as domain, tempfile.TemporaryDirectory() as place:
        os.environ.update(ros_environment(domain))
        rclpy.init()
        folder, machine = Path(place, 'state'), Machine(asked.turning)
        live(folder)
        runs, kept = [], []
        for _ in range(asked.kills):
            runs.append(kill_one(machine, folder, domain, asked.seconds))
            kept.append(read_health(folder)['x'])
        report(runs, [entry.record() for entry in read_entries(folder)])
        report_health(kept)
        rclpy.shutdown()


if __name__ == '__main__':
    main()
