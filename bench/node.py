# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Measure the node beside a bare rclpy node of the same subscriptions, in the same run.

Usage: python bench/node.py [--seconds S] [--pairs N] [--minutes M] [--axes 1,4,16]
[--rates 100,1000] [--record always] [--out DIR]. This process publishes speed and load of every
axis and times the states; the node and the bare node are one process each and take turns under
the same load, so that a busy machine harms both. All shares are of one core, all latencies from
the input to the reception of its state, without the time that this process takes to look.

"""

import argparse
from collections.abc import Callable, Iterator
import contextlib
import dataclasses
import json
import os
from pathlib import Path
import sys
import tempfile
import time
from typing import Any

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import ros_environment
from ballscrew_monitor.node.compiled_turns import COMPILED_FROM
from node_parts.peer import axis_names, Peer, topic
from node_parts.results import Findings, HEAD, line_of, report, write
import rclpy

LOADING = 10.0  # [s] in which the node loads what judges fast inputs, a turn of its own
TIMEOUT = 0.3  # [s] after it a tick tells the last counts
BARE = Path(__file__).parent / 'node_parts' / 'bare.py'


def write_parameters(path: Path, axes: int, period: float, record: str) -> None:
    """Write the parameters of the node; JSON is YAML."""
    values: dict[str, object] = {'axes': axis_names(axes), 'state_dir': '', 'record': record}
    values['record_dir'] = str(path.parent / 'recordings')
    for axis in axis_names(axes):
        values[axis] = {
            'publish_period': period,
            'speed': {
                'topic': topic('node', axis, 'speed'),
                'field': f'velocity[{axis}]',
                'timeout': TIMEOUT,
            },
            'load': {'topic': topic('node', axis, 'load'), 'timeout': TIMEOUT},
            'limits': {'raise_delay': 0.0, 'clear_delay': 0.0},
        }
    path.write_text(json.dumps({'/**': {'ros__parameters': values}}))


@contextlib.contextmanager
def peers(
    domain: int, axes: int, period: float, record: str
) -> Iterator[tuple[Peer, Peer, float]]:
    """Give the bare node and the node at work, and how long the node took to start [s]."""
    context = rclpy.Context()
    rclpy.init(context=context)
    bare, node = (Peer(kind, context, axes, period) for kind in ('bare', 'node'))
    try:
        with tempfile.TemporaryDirectory() as folder:
            parameters = Path(folder, 'parameters.yaml')
            write_parameters(parameters, axes, period, record)
            bare.start([sys.executable, str(BARE), str(axes), str(period)], domain)
            module = [sys.executable, '-m', 'ballscrew_monitor.node', '--ros-args']
            quiet = ['--log-level', 'error', '--params-file', str(parameters)]
            yield bare, node, node.start(module + quiet, domain)
    finally:
        bare.stop()
        node.stop()
        rclpy.shutdown(context=context)


def measure(domain: int, asked: argparse.Namespace) -> Findings:
    """Measure all cases, the two nodes in turns."""
    found = Findings()
    for axes, period in ((1, 0.0), *((axes, 0.1) for axes in asked.axes)):
        with peers(domain, axes, period, asked.record) as (bare, node, start):
            found.starts.append((axes, start))
            loaded = False
            for rate in asked.rates:
                if 2 * axes * rate >= COMPILED_FROM and not loaded:
                    loaded = True
                    loading = node.take_turn(rate, LOADING)
                    found.turns.append(dataclasses.replace(loading, kind='loads'))
                    print(line_of(found.turns[-1:]), flush=True)
                for _ in range(asked.pairs):
                    for peer in (bare, node):
                        found.turns.append(peer.take_turn(rate, asked.seconds))
                        print(line_of(found.turns[-1:]), flush=True)
            if period and axes == 1:
                found.memory = watch_memory(node, 60.0 * asked.minutes)
    return found


def watch_memory(node: Peer, duration: float) -> list[tuple[float, float]]:
    """Return the memory [MB] over the time [s] at 1 kHz."""
    begin, found = time.monotonic(), []
    while (now := time.monotonic() - begin) < duration:
        found.append((now, node.memory))
        node.run(1000.0, max(1.0, duration / 100))
    return [*found, (time.monotonic() - begin, node.memory)]


def arguments() -> argparse.Namespace:
    """Return what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0].strip())
    parser.add_argument('--seconds', type=float, default=1.0, help='length of a turn [s]')
    parser.add_argument('--pairs', type=int, default=1, help='turns of each case')
    parser.add_argument('--minutes', type=float, default=0.1, help='watch on the memory [min]')
    parser.add_argument('--axes', type=numbers(int), default=[1, 4, 16], help='such as 1,4,16')
    parser.add_argument('--rates', type=numbers(float), default=[100.0, 1000.0], help='[Hz]')
    parser.add_argument('--record', default='never', help='what the node records of itself')
    parser.add_argument('--out', type=Path, help='folder for node.csv and node.png')
    return parser.parse_args()


def numbers(kind: Callable[[str], Any]) -> Callable[[str], list[Any]]:
    """Return the reader of a list of numbers with commas."""
    return lambda text: [kind(part) for part in text.split(',')]


def main() -> None:
    """Measure, print, and write what is asked for."""
    asked = arguments()
    os.environ.pop('ROS_PYTHON_CHECK_FIELDS', None)  # as a user has it
    with free_domain() as domain:
        os.environ.update(ros_environment(domain))
        print(HEAD)
        found = measure(domain, asked)
    report(found)
    if asked.out:
        write(found, asked.out)


if __name__ == '__main__':
    main()
