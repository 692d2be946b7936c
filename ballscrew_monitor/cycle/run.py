# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The main job: the real node supervises a recorded cycle, over real DDS, in real time.

The node runs as a child process on simulated time; this process plays the bag into it, records
what goes in and what comes out, shows the state, and checks in the end that every speed message
was judged. All of it happens in a ROS domain of its own that is seen on this machine only.

The main thread spins the recorder and looks after the node; a thread of its own keeps the time of
the player. Readiness is seen, not guessed: the node sends its latched surface_info when it is
active, and announces its subscriptions after that.

"""

from collections.abc import Iterator
import contextlib
import dataclasses
import fcntl
import functools
import os
from pathlib import Path
import sys
import threading
import time
from typing import Any

from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.interrupts import DONE, FAILED, interrupts, SIGNALLED
from ballscrew_monitor.cycle import outcome as outcomes
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import confined, NodeProcess, ros_environment
from ballscrew_monitor.cycle.outcome import LOG, Outcome, Plan, RECORDING, speed_health
from ballscrew_monitor.cycle.status import progress_bar, state_cells, StatusLine
from ballscrew_monitor.messages.diagnostics import code_of
from ballscrew_monitor.recordings.bag_writer import BagWriter
from ballscrew_monitor.recordings.player import Player
from ballscrew_monitor.recordings.recorder import recorded_topics, Recorder
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.logs import remove_report
from ballscrew_monitor.settings.parameters import absolute, input_topics, output
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.msg import BallScrewState
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.serialization import deserialize_message
from surrogate.files import InputError

START_PATIENCE = 30.0  # [s] until the node is active and matched
SETTLE_PATIENCE = 2.0  # [s] for the last messages after the end of the bag
LAST_WORDS = 1.0  # [s] for what the node says while it stops
RUN_ON_PATIENCE = 3.0  # [s] of /clock after that, for a node that publishes now and then
POLL = 0.05  # [s] longest wait for a message


class RunFailure(Exception):
    """Why the run cannot go on, as a sentence."""


class Supervision:
    """The ROS side of a run; once closed it leaves no thread and no context behind."""

    def __init__(self, plan: Plan, process: NodeProcess, writer: BagWriter, domain: int) -> None:
        """Join the domain and subscribe to the outputs before the node can have any."""
        self._plan, self._process, self._writer = plan, process, writer
        self._states: dict[str, bytes] = {}
        self._active: set[str] = set()
        self._reason = ''
        self._settled = threading.Event()
        self._broken: BaseException | None = None
        self._started = contextlib.ExitStack()
        node = self._started.enter_context(started_node('ballscrew_run', domain))
        assert node.executor is not None
        self._executor = node.executor
        topics = list(input_topics(plan.values))
        self._player = Player(node, plan.bag, rate=plan.rate, topics=topics)
        listeners: dict[str, Any] = {'/diagnostics': self._on_diagnostics}
        for axis in plan.values['axes']:
            listeners[output(axis, 'state')] = functools.partial(self._states.__setitem__, axis)
            listeners[output(axis, 'surface_info')] = lambda data, axis=axis: self._active.add(
                axis
            )
        recorded = recorded_topics(plan.values)
        self._recorder = Recorder(node, writer, recorded, lambda: self._player.now, listeners)

    def close(self) -> None:
        """Leave the domain."""
        self._recorder.close()
        self._started.close()

    def carry_out(self, stop: threading.Event) -> Outcome:
        """Play the whole bag, or until `stop` is set; raises Failure when it cannot go on."""
        self._wait_until_ready(stop)
        if stop.is_set():
            return self.outcome()
        thread = threading.Thread(target=self._play, args=(stop,), name='player')
        thread.start()
        try:
            self._watch(thread)
        except BaseException:
            stop.set()
            raise
        finally:
            thread.join()
        if self._broken is not None:
            raise self._broken
        code = self._process.stop()
        deadline = time.monotonic() + LAST_WORDS
        while time.monotonic() < deadline:  # record what it says at last
            before = self._writer.total
            self._executor.spin_once(timeout_sec=POLL)
            if self._writer.total == before:
                break
        if code != 0:
            raise self._failure(f'ended with exit code {code} when it was asked to stop')
        return self.outcome()

    def outcome(self, *failures: str) -> Outcome:
        """Return what the run has come to so far."""
        return Outcome(
            recording=self._writer.path,
            sent=self._player.sent,
            failures=failures,
            recorded=self._writer.total,
            states={axis: self._state(axis) for axis in self._states},
            lateness=self._player.lateness,
            cpu_time=self._process.cpu_time,
        )

    def _on_diagnostics(self, data: bytes) -> None:
        if len(self._active) < len(self._plan.expected):
            for status in deserialize_message(data, DiagnosticArray).status:
                if code_of(status) == Fault.NOT_BUILT:
                    self._reason = status.message

    def _wait_until_ready(self, stop: threading.Event) -> None:
        """
        Wait until the node is active and everybody knows everybody.

        DDS announces the readers, and the writers, of a process in the order in which they were
        made. So a node that sends its latched surface_info here knows the readers of all its other
        topics too; and one that answers to `/clock`, the last writer of the player, with a state
        knows the writers of its inputs.

        """
        deadline = time.monotonic() + START_PATIENCE
        axes = self._plan.expected.keys()
        while not stop.is_set():
            self._executor.spin_once(timeout_sec=POLL)
            self._check_node()
            if self._reason:
                raise RunFailure(f'the node is {self._reason}')
            # Two subscribers of each input: the node and the recorder.
            if self._active == axes and not self._player.unmatched(2):
                if self._states.keys() == axes:
                    return
                self._player.show_begin()
            if time.monotonic() > deadline:
                raise self._failure(f'did not become active within {START_PATIENCE:g} s')

    def _play(self, stop: threading.Event) -> None:
        try:
            if self._player.play(stop) and not self._settled.wait(SETTLE_PATIENCE):
                self._player.run_on(self._settled.is_set, RUN_ON_PATIENCE, stop)
        except BaseException as error:  # handed to the main thread
            self._broken = error

    def _watch(self, thread: threading.Thread) -> None:
        """Record and show until the player has come to its end."""
        with contextlib.closing(StatusLine(sys.stdout)) as status:
            while thread.is_alive():
                self._executor.spin_once(timeout_sec=POLL)
                now = time.monotonic()
                self._check_node()
                if status.due(now) and self._states:
                    self._show(status, now)
                # The states say that every speed message of the bag has been taken.
                if self._player.elapsed >= self._plan.bag.duration and all(
                    axis.name in self._states
                    and speed_health(self._state(axis.name)).received
                    >= self._plan.bag.topics[absolute(axis.inputs[-1].topic)].count
                    for axis in self._plan.axes
                ):
                    self._settled.set()

    def _show(self, status: StatusLine, now: float) -> None:
        duration, elapsed = self._plan.bag.duration, self._player.elapsed
        part = elapsed / duration if duration else 1.0
        bar = progress_bar(part, (duration - elapsed) / self._plan.rate)
        axis = min(self._states)
        name = [] if len(self._plan.expected) == 1 else [axis]
        status.show([bar, *name, *state_cells(self._state(axis))], now)

    def _state(self, axis: str) -> BallScrewState:
        return deserialize_message(self._states[axis], BallScrewState)

    def _check_node(self) -> None:
        code = self._process.returncode
        if code is not None:
            raise self._failure(f'ended with exit code {code}')

    def _failure(self, what: str) -> RunFailure:
        words = self._process.last_words()
        log = f'; {self._process.log} ends with: {words}' if words else ''
        return RunFailure(f'the node {what}{log}')


LOCK = '.lock'


def run(plan: Plan) -> int:
    """Carry out the plan; return the exit code."""
    stop = threading.Event()
    with _exclusive(plan.out), interrupts(stop) as interrupted:
        print(
            f'bag {plan.bag.path}: {plan.bag.duration:.1f} s, at {plan.rate:g}x; '
            f'parameters {plan.params}',
            flush=True,
        )
        say(*plan.bag.notes)
        remove_report(plan.out)  # the recording of this run would belie an earlier one
        with free_domain() as domain, contextlib.ExitStack() as stack:
            os.environ |= confined(domain)
            node = NodeProcess(plan.params, plan.out / LOG, domain=domain)
            stack.callback(node.stop)
            print(
                f'node ballscrew_monitor: process {node.pid}, ROS_DOMAIN_ID={domain} '
                'ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST',
                *(f'full solve  {line}' for line in solve_lines(plan, domain)),
                sep='\n',
                flush=True,
            )
            writer = stack.enter_context(BagWriter(plan.out, RECORDING))
            supervision = Supervision(plan, node, writer, domain)
            stack.callback(supervision.close)
            try:
                outcome = supervision.carry_out(stop)
                if not stop.is_set():
                    outcome = dataclasses.replace(outcome, failures=outcomes.losses(plan, outcome))
            except RunFailure as failure:
                outcome = supervision.outcome(str(failure))
            writer.add_metadata(outcomes.facts(plan, outcome))
    if interrupted:
        say(f'interrupted, recorded so far: {outcome.recording}')
        return SIGNALLED + interrupted[0]
    say(*outcome.failures)
    outcomes.report(plan, outcome)
    return FAILED if outcome.failures else DONE


def solve_lines(plan: Plan, domain: int) -> list[str]:
    """Return what to type in another terminal for a full solve of the current point."""
    variables = ' '.join(f'{name}={value}' for name, value in ros_environment(domain).items())
    return [f'{variables} ballscrew solve --axis {axis.name}' for axis in plan.axes]


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
