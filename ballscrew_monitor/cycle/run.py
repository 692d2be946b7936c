# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The main job: the real node supervises a recorded cycle, over real DDS, in real time.

The node runs as a child process on simulated time; this process plays the bag into it, records
what goes in and what comes out, shows the state, and checks in the end that every speed message
was judged. All of it happens in a ROS domain of its own that is seen on this machine only.

"""

from collections.abc import Iterator, Sequence
import contextlib
import dataclasses
import fcntl
import importlib.util
import os
from pathlib import Path
import signal
import sys
import threading
from typing import Any

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import NodeProcess, ros_environment
from ballscrew_monitor.cycle.outcome import Outcome
from ballscrew_monitor.cycle.report import LOG, losses, picture, report
from ballscrew_monitor.cycle.supervision import Failure, Supervision
from ballscrew_monitor.node import parameters
from ballscrew_monitor.node.axis import Axis, build_axis
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter
from ballscrew_monitor.recordings.replay import input_topics, speed_messages
from surrogate.files import InputError

RECORDING, LOCK = 'cycle', '.lock'
DONE, FAILED, SIGNALLED = 0, 1, 128  # exit codes; a signal adds its number


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """
    A checked run: what is played, with which parameters, and where it is written.

    `expected` counts the speed messages by axis, `rate` is bag time over wall time [-].

    """

    bag: Bag
    params: Path
    values: dict[str, Any]
    axes: Sequence[Axis]
    expected: dict[str, int]
    rate: float
    out: Path


def plan(bag: Path, params: Path, out: Path, rate: float) -> Plan:
    """
    Return a checked plan for bag time over wall time `rate` [-].

    Raises InputError before anything is started or written.

    """
    if importlib.util.find_spec('matplotlib') is None:  # asked early, imported late: it is slow
        raise ModuleNotFoundError('no picture without matplotlib', name='matplotlib')
    if not 0.0 < rate <= 1000.0:
        raise InputError(f'rate is {rate:g}, allowed is above 0 to 1000')
    values = parameters.read_file(params)
    axes = [build_axis(name, values) for name in values['axes']]
    opened = Bag(bag)
    if any(file.resolve() == (out / f'{RECORDING}.mcap').resolve() for file in opened.files):
        raise InputError(
            f'bag {bag} would be overwritten by the recording in {out}, '
            'another output directory must be given'
        )
    opened.require(input_topics(values))
    return Plan(
        bag=opened,
        params=params,
        values=values,
        axes=axes,
        rate=rate,
        out=out,
        expected=speed_messages(opened, axes),
    )


def run(made: Plan) -> int:
    """Carry out the plan; return the exit code."""
    stop = threading.Event()
    with _exclusive(made.out), interrupts(stop) as interrupted:
        print(
            f'bag {made.bag.path}: {made.bag.duration:.1f} s, at {made.rate:g}x; '
            f'parameters {made.params}',
            flush=True,
        )
        _remove_pictures(made)
        outcome = _supervise(made, stop)
    if interrupted:
        print(f'ballscrew: interrupted, recorded so far: {outcome.recording}', file=sys.stderr)
        return SIGNALLED + interrupted[0]
    failures = outcome.failures or losses(made, outcome)
    for sentence in failures:
        print(f'ballscrew: {sentence}', file=sys.stderr)
    report(made, outcome)
    return FAILED if failures else DONE


def _remove_pictures(made: Plan) -> None:
    """Remove the pictures of an earlier run, which the recording of this one would belie."""
    for axis in made.axes:
        picture(made, axis).unlink(missing_ok=True)


def _supervise(made: Plan, stop: threading.Event) -> Outcome:
    with free_domain() as domain, contextlib.ExitStack() as stack:
        os.environ |= ros_environment(domain)
        node = stack.enter_context(NodeProcess(made.params, made.out / LOG, domain=domain))
        print(
            f'node ballscrew_monitor: process {node.pid}, ROS_DOMAIN_ID={domain} '
            'ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST',
            flush=True,
        )
        writer = stack.enter_context(BagWriter(made.out, RECORDING))
        supervision = stack.enter_context(Supervision(made, node, writer, domain))
        try:
            return supervision.carry_out(stop)
        except Failure as failure:
            return supervision.outcome(str(failure))


@contextlib.contextmanager
def interrupts(stop: threading.Event) -> Iterator[list[int]]:
    """Collect SIGINT, SIGTERM and SIGHUP in a list and set `stop`, instead of dying of them."""
    received: list[int] = []

    def take(number: int, frame: Any) -> None:
        received.append(number)
        stop.set()

    before = {
        number: signal.signal(number, take)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    }
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def _exclusive(out: Path) -> Iterator[None]:
    """Make the output directory and keep other runs out of it."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        stream = (out / LOCK).open('w')
    except OSError as error:
        raise InputError(f'output directory {out} cannot be written: {error.strerror}') from None
    with stream:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise InputError(
                f'output directory {out} is in use by another run, another one must be given'
            ) from None
        yield
