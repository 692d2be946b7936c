# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The main job: the real node supervises a recorded cycle, over real DDS, in real time.

The node runs as a child process on simulated time; this process plays the bag into it, records
what goes in and what comes out, shows the state, and checks in the end that every speed message
was judged. All of it happens in a ROS domain of its own that is seen on this machine only.

"""

from collections.abc import Iterator
import contextlib
import dataclasses
import fcntl
import os
from pathlib import Path
import threading

from ballscrew_monitor.core.interrupts import DONE, FAILED, interrupts, SIGNALLED
from ballscrew_monitor.cycle import outcome as outcomes
from ballscrew_monitor.cycle.domain import free_domain, is_free, remove_stale
from ballscrew_monitor.cycle.node_process import confined, NodeProcess, ros_environment
from ballscrew_monitor.cycle.outcome import LOG, Outcome, Plan, RECORDING
from ballscrew_monitor.cycle.supervision import RunFailure, Supervision
from ballscrew_monitor.recordings.bag_writer import BagWriter
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.logs import remove_report
from surrogate.files import InputError

LOCK = '.lock'


def run(made: Plan) -> int:
    """Carry out the plan; return the exit code."""
    stop = threading.Event()
    with _exclusive(made.out), interrupts(stop) as interrupted:
        print(
            f'bag {made.bag.path}: {made.bag.duration:.1f} s, at {made.rate:g}x; '
            f'parameters {made.params}',
            flush=True,
        )
        say(*made.bag.notes)
        remove_report(made.out)  # the recording of this run would belie an earlier one
        outcome = _supervise(made, stop)
    if interrupted:
        say(f'interrupted, recorded so far: {outcome.recording}')
        return SIGNALLED + interrupted[0]
    say(*outcome.failures)
    outcomes.report(made, outcome)
    return FAILED if outcome.failures else DONE


def _supervise(made: Plan, stop: threading.Event) -> Outcome:
    with free_domain() as domain, contextlib.ExitStack() as stack:
        os.environ |= confined(domain)
        remove_stale({domain})  # it has just been found free; at the end somebody may be in it
        stack.callback(lambda: remove_stale({domain} if is_free(domain) else ()))
        node = NodeProcess(made.params, made.out / LOG, domain=domain)
        stack.callback(node.stop)
        print(
            f'node ballscrew_monitor: process {node.pid}, ROS_DOMAIN_ID={domain} '
            'ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST',
            *(f'full solve  {line}' for line in solve_lines(made, domain)),
            sep='\n',
            flush=True,
        )
        writer = stack.enter_context(BagWriter(made.out, RECORDING))
        supervision = Supervision(made, node, writer, domain)
        stack.callback(supervision.close)
        try:
            outcome = supervision.carry_out(stop)
            if not stop.is_set():
                outcome = dataclasses.replace(outcome, failures=outcomes.losses(made, outcome))
        except RunFailure as failure:
            outcome = supervision.outcome(str(failure))
        writer.add_metadata(outcomes.facts(made, outcome))
        return outcome


def solve_lines(made: Plan, domain: int) -> list[str]:
    """Return what to type in another terminal for a full solve of the current point."""
    variables = ' '.join(f'{name}={value}' for name, value in ros_environment(domain).items())
    return [f'{variables} ballscrew solve --axis {axis.name}' for axis in made.axes]


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
