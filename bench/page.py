# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Measure the page beside a bare rclpy subscriber of the same states, in the same run.

Usage: python bench/page.py [--axes 4] [--rate 50] [--browsers 1,20] [--seconds 10]
[--pairs 3] [--minutes 0.5]. This process publishes states of a node that is not there, and reads
as many browsers. Page and subscriber are one process each and hear the same messages, so that a
busy machine harms both: the ratio of their shares of a core is what the page costs. The latency is
from the publication of a state to the frame with its row at a browser.

A real node that sends a state for each sample then takes turns without a page and with one, which
a browser reads in a process of its own.

Then Chromium shows the page, which has no map here, for some minutes: how long a frame of the
screen keeps its main thread, and how much memory its scripts hold before and after.

"""

import argparse
import asyncio
from collections.abc import Iterator
import contextlib
import json
import os
from pathlib import Path
import struct
import subprocess
import sys
import threading
import time
from typing import Any

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment, ros_environment
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.msg import BallScrewState, InputHealth
from node import peers
from node_parts.peer import Turn
from node_parts.results import HEAD, line_of
import numpy as np
from page_parts import screen
from websockets.asyncio.client import connect

NODE = '/bench'
READER = """
import asyncio, sys
sys.path.insert(0, sys.argv[1])
import page
print(flush=True)
asyncio.run(page.browse(sys.argv[2], 1e9, []))
"""
BARE = """
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.msg import BallScrewState
import sys
with started_node('bare') as node:
    for axis in range(int(sys.argv[1])):
        topic = f'{sys.argv[2]}/a{axis}/state'
        node.create_subscription(BallScrewState, topic, lambda state: None, 50)
    print('ready', flush=True)
    while True:
        node.executor.spin_once()
"""
PAGE = ('-m', 'ballscrew_monitor', 'page', '--port', '0')
TICK = os.sysconf('SC_CLK_TCK')


def cpu_time(pid: int) -> float:
    """Return the processor time of a process [s]."""
    with open(f'/proc/{pid}/stat') as stat:
        fields = stat.read().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / TICK


@contextlib.contextmanager
def child(domain: int, *command: str) -> Iterator[tuple[int, str]]:
    """Start a process; give its number and its first line."""
    process = subprocess.Popen(
        [sys.executable, *command],
        env=child_environment(domain),
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    try:
        yield process.pid, process.stdout.readline()
    finally:
        process.kill()
        process.wait()


class Machine:
    """Publishes states of all axes at a rate [Hz] until stopped."""

    def __init__(self, node: Any, axes: int, rate: float) -> None:
        """Make publishers and messages."""
        self._publishers = [
            node.create_publisher(BallScrewState, f'{NODE}/a{axis}/state', 10)
            for axis in range(axes)
        ]
        inputs = [InputHealth(name=name) for name in ('speed', 'load', 'temperature', 'torque')]
        self._states = [BallScrewState(axis=f'a{at}', inputs=inputs) for at in range(axes)]
        self._rate, self._stopped = rate, threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        due = time.time()
        while not self._stopped.wait(max(0.0, due - time.time())):
            due += 1.0 / self._rate
            for state, publisher in zip(self._states, self._publishers, strict=True):
                stamp = time.time_ns()
                state.header.stamp.sec, state.header.stamp.nanosec = divmod(stamp, 10**9)
                state.point.speed = 100.0
                publisher.publish(state)

    def close(self) -> None:
        """Stop."""
        self._stopped.set()
        self._thread.join()


async def browse(url: str, seconds: float, latencies: list[float]) -> int:
    """Read for some `seconds` [s]; note latencies [s] of rows and return the frames of states."""
    frames = 0
    origin, address = url.rstrip('/'), f'{url.replace("http", "ws")}live'
    options = {'max_size': None, 'compression': None, 'open_timeout': None}
    async with connect(address, origin=origin, **options) as live:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            made = await live.recv()
            (size,) = struct.unpack_from('<I', made)
            at = 4 + size
            record = json.loads(made[4:at])
            if record['kind'] == 'state' and record['arrays'][0][1]:
                frames += 1
                stamps = np.frombuffer(made, '<f8', record['arrays'][0][1], at)
                latencies.append(time.time() - float(stamps[-1]))
    return frames


async def browse_all(url: str, count: int, seconds: float) -> tuple[list[float], int]:
    """Read with some browsers; return the latencies [s] of the first, and frames of all."""
    latencies: list[float] = []
    others = [browse(url, seconds, []) for _ in range(count - 1)]
    frames = await asyncio.gather(browse(url, seconds, latencies), *others)
    return latencies, sum(frames)


@contextlib.contextmanager
def served(axes: int, rate: float) -> Iterator[tuple[str, int, int]]:
    """Serve the page; give its address, and the numbers of the bare process and of the page."""
    with contextlib.ExitStack() as stack:
        domain = stack.enter_context(free_domain())
        node = stack.enter_context(started_node('bench', domain))
        stack.enter_context(contextlib.closing(Machine(node, axes, rate)))
        bare, _ = stack.enter_context(child(domain, '-c', BARE, str(axes), NODE))
        page, line = stack.enter_context(child(domain, *PAGE))
        yield line.split()[1], bare, page


def measure(axes: int, rate: float, browsers: int, seconds: float) -> None:
    """Print a line of the page with some browsers."""
    with served(axes, rate) as (url, bare, page):
        asyncio.run(browse_all(url, 1, 3.0))  # all have found each other
        before = cpu_time(bare), cpu_time(page)
        latencies, frames = asyncio.run(browse_all(url, browsers, seconds))
        used = cpu_time(bare) - before[0], cpu_time(page) - before[1]
        middle, most, last = 1e3 * np.percentile(latencies, (50, 95, 99))
        print(
            f'{axes} axes, {rate:g} Hz, {browsers:2} browsers: '
            f'page {100 * used[1] / seconds:.1f} % of a core, '
            f'{used[1] / max(used[0], 0.01):.2f} times a bare subscriber; '
            f'{frames / seconds / browsers:.0f} frames a second each; latency '
            f'{middle:.0f} ms, p95 {most:.0f} ms, p99 {last:.0f} ms',
            flush=True,
        )


@contextlib.contextmanager
def watched(domain: int) -> Iterator[None]:
    """Let a browser read a page of the nodes of a domain."""
    with child(domain, *PAGE) as (_, line):
        url, folder = line.split()[1], str(Path(__file__).parent)
        with child(domain, '-c', READER, folder, url):
            asyncio.run(browse_all(url, 1, 3.0))  # page and node have found each other
            yield


def measure_node(axes: int, rate: float, pairs: int, seconds: float) -> None:
    """Print a line of the node without a page and with one, in turns."""
    alone: list[Turn] = []
    beside: list[Turn] = []
    with free_domain() as domain:
        os.environ.update(ros_environment(domain))
        with peers(domain, axes, 0.0, 'never') as (_, node, _):
            for _ in range(pairs):
                alone.append(node.take_turn(rate, seconds))
                with watched(domain):
                    beside.append(node.take_turn(rate, seconds))
    print(f'the node without a page and with one\n{HEAD}')
    print(line_of(alone), line_of(beside), sep='\n', flush=True)


def measure_screen(axes: int, rate: float, browser: str, minutes: float) -> None:
    """Print a line of a browser that shows the page."""
    with screen.opened(browser) as tab, served(axes, rate) as (url, _, _):
        shown = screen.watch(tab, url, 60.0 * minutes)
    middle, most = np.percentile(shown.frames, (50, 95))
    print(
        f'{axes} axes, {rate:g} Hz, on the screen: {len(shown.frames)} frames in {minutes:g} min, '
        f'each {middle:.1f} ms of the main thread, p95 {most:.1f} ms; busy for '
        f'{100 * shown.busy:.0f} % of the time; heap {shown.heap[0]:.1f} MB before and '
        f'{shown.heap[1]:.1f} MB after',
        flush=True,
    )


def main() -> int:
    """Measure as the arguments say."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').splitlines()[1])
    parser.add_argument('--axes', type=int, default=4)
    parser.add_argument('--rate', type=float, default=50.0)
    parser.add_argument('--browsers', default='1,20')
    parser.add_argument('--seconds', type=float, default=10.0)
    parser.add_argument('--pairs', type=int, default=3, help='turns of the node, each way')
    parser.add_argument('--minutes', type=float, default=0.5)
    args = parser.parse_args()
    for count in map(int, args.browsers.split(',')):
        measure(args.axes, args.rate, count, args.seconds)
    measure_node(args.axes, args.rate, args.pairs, args.seconds)
    if browser := screen.found_browser():
        measure_screen(args.axes, args.rate, browser, args.minutes)
    else:
        print('no Chromium is installed: the screen is not measured')
    return 0


if __name__ == '__main__':
    sys.exit(main())
