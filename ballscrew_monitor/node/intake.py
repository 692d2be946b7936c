# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Intake of everything that waits at the inputs, whatever woke the node, oldest first.

An executor costs more for each message than its judgement does, looks at every subscription in
every round, and hands the messages of several topics over in an order of its own. So it waits for
all inputs as one, the first message of a burst brings along all the others, and the clock is asked
once for all of them. Simulated time is read in the same order: a message arrived at the last
`/clock` before it.

"""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
import contextlib
import math
import operator
import time
from typing import Any

from ballscrew_monitor.core.conversions import SECOND, seconds
from ballscrew_monitor.core.inputs import (
    Input,
    InputSample,
    of_several,
    OpenInput,
    ordered,
    Refusal,
    Source,
    Why,
)
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.core.tick_grid import ClockSteps, LEAST_STEP
from ballscrew_monitor.node.burst import Burst
from ballscrew_monitor.node.compiled_turns import CompiledTurns
from ballscrew_monitor.node.event_recorder import AxisEvent, EventRecorder, Heard, SILENT
from ballscrew_monitor.node.sources import READING, Reading
from ballscrew_monitor.node.topic import (
    Apart,
    Arrival,
    link_of,
    open_topic,
    RECEIVED,
    Taken,
    Topic,
)
from ballscrew_monitor.node.turn import AxisTurn, TurnReader
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.qos import publishers_on
from rclpy.event_handler import EventHandler
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.waitable import NumberOfEntities, Waitable
from rosgraph_msgs.msg import Clock
from surrogate.files import InputError

CLOCK = '/clock'
PAUSE = 3.5e-4  # [s] between two looks at the inputs while messages come, at least
PAUSE_PER_TOPIC = 4e-5  # [s] the same for each topic, twenty times what a look at it takes
LONGER = 8.0  # times the pause while turns are judged compiled: the larger they are the better
QUIET = 1.5e-3  # [s] without a message after which the executor waits for the next one
STAY = 0.02  # [s] longest turn; what becomes ready in one may wait for the next one too
STEPS = 9  # of `/clock`, of which the middle one counts
MOST_AHEAD = SECOND  # [ns] by which the steps of `/clock` let stamps be ahead
LONG_STEP = 10  # usual steps of `/clock` in one that is a leap
MOST_LOOKS = 10  # at all topics, while messages come faster than they are looked at

Take = Callable[[Axis, InputSample | Refusal], None]


def _forget(*what: Any) -> None:
    """Take no note of work, nor of a step of the clock."""


def _call(axis: Axis, place: str, call: Callable[..., Any], *args: Any, **named: Any) -> Any:
    return call(*args, **named)


def system_step(steps: ClockSteps) -> int:
    """Return by how much [ns] the clock of the machine was set since it was last looked at."""
    before = time.monotonic_ns()
    return steps.take(time.time_ns(), before, time.monotonic_ns())


class Intake(Waitable):
    """The subscriptions of all axes; each sample and refusal is handed to `take`."""

    def __init__(
        self,
        node: Node,
        axes: Iterable[Axis],
        take: Take,
        recorder: EventRecorder = SILENT,
        guard: Callable[..., Any] = _call,
        worked: Callable[[float, int], None] = _forget,
        stepped: Callable[[int, int], None] = _forget,
        steps: ClockSteps | None = None,
        compiled: CompiledTurns | None = None,
        take_many: Callable[[AxisTurn], None] = _forget,
    ) -> None:
        """
        Subscribe once to each topic, however many inputs read it; `recorder` gets all.

        `guard` calls what reads for an axis, and returns None if the program fails in it; `worked`
        takes for how long [s] messages were at work, and how many. `stepped` takes by how much
        [ns] the clock was set, and the time of that; `steps` know the clock of the system from
        before. While turns are due to be `compiled`, `take_many` gets those of each axis instead.

        """
        super().__init__(node.default_callback_group)
        self._node, self._take, self._recorder, self._guard = node, take, recorder, guard
        self._worked, self._apart = worked, Apart()
        self._stepped, self._system_steps = stepped, steps or ClockSteps()
        self._simulated = 0  # the last `/clock` [ns]
        self._steps: deque[int] = deque(maxlen=STEPS)  # of `/clock` [ns]
        self._reading = READING
        self._places: list[int] = []  # of the subscriptions in the wait set
        self._open: list[tuple[Axis, OpenInput]] = []
        self._problems: dict[tuple[str, Source], str] = {}  # of open inputs
        self._changed: list[EventHandler] = []  # that tell of publishers come or gone
        self._waited_for = contextlib.ExitStack()
        self._awaited: list[Topic] = []  # whose messages the executor waits for
        self._handlers: list[EventHandler] = []  # that it waits for
        self._stayed = False  # for all of STAY, the last time
        self._flows = False  # more came until the end of the last turn
        self.topics: dict[str, Topic] = {}
        self._axes = list(axes)
        self._compiled, self._take_many = compiled, take_many
        self._turns = TurnReader(self._axes, self._judged)
        for axis in self._axes:
            for source in axis.inputs:
                self._read(axis, source)
            self._open += [(axis, open_input) for open_input in axis.open_inputs]
        self._clock: Topic | None = None
        if node.get_parameter('use_sim_time').value:
            self._clock = open_topic(node, CLOCK, Clock, self._apart)
            self._simulated = node.get_clock().now().nanoseconds
            self._reading = Reading(MOST_AHEAD)  # until the steps are known
        node.add_waitable(self)
        self.discover()

    @property
    def now(self) -> int:
        """Return the time [ns] by which arrivals are timed, and ticks are to be."""
        if self._clock is not None:
            return self._simulated
        return self._node.get_clock().now().nanoseconds

    @property
    def _all(self) -> list[Topic]:
        clock = [] if self._clock is None else [self._clock]
        return [*clock, *self.topics.values()]

    def _read(self, axis: Axis, source: Input) -> None:
        """Subscribe to the topic of an input, unless another input has done so."""
        name = self._node.resolve_topic_name(source.topic)
        if name not in self.topics:
            self.topics[name] = open_topic(
                self._node, name, source.message_type, self._apart, overridable=True, raw=True
            )
        self.topics[name].readers.append((axis, source))

    def discover(self) -> None:
        """Begin to read each open input whose topic has publishers of one type by now."""
        for axis, open_input in list(self._open):
            name = self._node.resolve_topic_name(open_input.topic)
            known = self.topics.get(name)
            types = {publisher.type_name for publisher in publishers_on(self._node, name)}
            if known is not None:
                types = {known.type_name}
            if len(types) != 1:
                continue
            self._problems.pop((axis.name, open_input.source), None)
            try:
                closed = open_input.close(types.pop())
            except InputError as error:
                self._problems[axis.name, open_input.source] = str(error)
                continue
            self._open.remove((axis, open_input))
            self._read(axis, closed)

    def __enter__(self) -> None:
        """
        Keep what the executor waits for, also when it is closed meanwhile.

        An executor with several threads may find another topic while it makes ready to wait.

        """
        self._awaited, self._handlers = [], []
        with contextlib.ExitStack() as stack:
            topics = self._all
            # rclpy annotates the list as one handler.
            lists: list[Any] = [topic.subscription.event_handlers for topic in topics]
            handlers = [handler for handlers in lists for handler in handlers]
            for entity in (*(topic.subscription.handle for topic in topics), *handlers):
                stack.enter_context(entity)
            self._waited_for = stack.pop_all()
            self._awaited, self._handlers = topics, handlers

    def __exit__(self, *raised: object) -> None:
        """Let go of what the executor has waited for."""
        self._waited_for.close()

    def get_num_entities(self) -> NumberOfEntities:
        """Return how much the executor is to wait for."""
        return NumberOfEntities(num_subs=len(self._awaited), num_events=len(self._handlers))

    def add_to_wait_set(self, wait_set: Any) -> None:
        """Let the executor wait for messages, and for publishers that come or go."""
        self._places = [
            wait_set.add_subscription(topic.subscription.handle) for topic in self._awaited
        ]
        handlers, self._handlers = self._handlers, []
        for handler in handlers:
            with contextlib.suppress(InvalidHandle):  # another thread has destroyed it
                handler.add_to_wait_set(wait_set)
                self._handlers.append(handler)

    def is_ready(self, wait_set: Any) -> bool:
        """Return True if anything has come."""
        self._changed = [handler for handler in self._handlers if handler.is_ready(wait_set)]
        come = any(wait_set.is_ready('subscription', place) for place in self._places)
        return come or bool(self._changed)

    def take_data(self) -> None:
        """Count the publishers again, once what has come by then is taken."""
        if self._changed:
            self.drain()
        for handler in self._changed:
            with contextlib.suppress(InvalidHandle):  # another thread has closed the intake
                if status := handler.take_data():
                    handler.callback(status)

    async def execute(self, taken_data: None) -> None:
        """
        Take what waits, and look again while more comes: cheaper than to be woken for each.

        Not when a timer of the executor is due, nor twice in a row for all of STAY: the executor
        may come back before the others' turn. While messages flow, a turn that is judged compiled
        begins after a pause: it is the cheaper for each message the more there are.

        """
        if not (self._flows and self.is_compiled) or self._time_to_timer() <= 0.0:
            self.drain()
        if self._stayed:
            self._stayed = False
            return
        pause = max(PAUSE, PAUSE_PER_TOPIC * len(self.topics))
        pause *= LONGER if self.is_compiled else 1.0
        stay = min(STAY, self._time_to_timer())
        now = begin = came = time.monotonic()
        while now - came < QUIET and now - begin < stay:
            time.sleep(min(pause, max(begin + stay - now, PAUSE)))
            now = time.monotonic()
            if self.drain():
                came = now
        self._stayed = now - begin >= STAY
        self._flows = begin < came and now - came < QUIET

    def _time_to_timer(self) -> float:
        """
        Return how long [s] until a timer of any node of the executor is due.

        One that waits for longer than its period loses calls.

        """
        executor = self._node.executor
        left = math.inf
        for node in executor.get_nodes() if executor else ():
            for timer in node.timers:
                with contextlib.suppress(InvalidHandle):  # another thread may destroy it
                    wait = timer.time_until_next_call()
                    left = left if wait is None else min(left, seconds(wait))
        return left

    def close(self) -> None:
        """Unsubscribe."""
        closed = self._all
        self.topics, self._clock = {}, None  # first, lest an executor begin to wait for them
        self._node.remove_waitable(self)
        for topic in closed:
            self._node.destroy_subscription(topic.subscription)

    def links(self, axis: Axis) -> dict[Source, Link]:
        """Return how each input of an axis is connected."""
        opened = {open_input.source for reader, open_input in self._open if reader is axis}
        by_source = {}
        for source, topic in axis.topics.items():
            name = self._node.resolve_topic_name(topic)
            read = None if source in opened else self.topics.get(name)
            problem = self._problems.get((axis.name, source), '') if source in opened else ''
            counter = read.sources.get((axis.name, source)) if read else None
            several = counter.several if counter else False
            by_source[source] = link_of(self._node, name, read, several=several, problem=problem)
        return by_source

    def _taken(self) -> list[tuple[Topic, list[Taken]]]:
        """
        Return all that waits, by topics.

        While the topics are looked at one after the other, a message may come to one that has been
        looked at, and a later message to one that has not. So they are looked at again if anything
        has arrived since the look began.

        """
        topics = [(topic, list[Taken]()) for topic in self._all]
        for _ in range(MOST_LOOKS):
            begin, newest = time.time_ns(), 0
            for topic, messages in topics:
                if look := topic.taken():
                    messages += look
                    newest = max(newest, *(info[RECEIVED] for _, info in look))
            if newest <= begin:
                break
        return topics

    def _waiting(self) -> list[Arrival]:
        """Return all that waits in the order of arrival."""
        arrivals = [
            topic.arrival(*taken) for topic, messages in self._taken() for taken in messages
        ]
        return sorted(arrivals, key=operator.attrgetter('received'))

    def drain(self) -> bool:
        """Hand over all that waits, oldest first; return whether that was anything."""
        if self._compiled is None:
            return self._drain() > 0
        self._compiled.at_rest.clear()
        try:
            return self._drain() > 0
        finally:
            self._compiled.at_rest.set()

    def _drain(self) -> int:
        """Hand over all that waits, oldest first; return how many messages that was."""
        begin, step = time.monotonic(), 0
        if self._clock is None:  # by how much [ns] the clock of the system was set
            step = system_step(self._system_steps)
        if self.is_compiled and self._clock is None and not step:  # all of it is one turn
            taken = self._taken()
            messages = sum(len(received) for _, received in taken)
            events = sum(len(topic.readers) * len(received) for topic, received in taken)
            if messages:
                now, wall = self.now, time.time_ns()
                self._learn()
                self._hand_over_burst(Burst.taken(taken, now, wall))
        else:
            messages, events = self._drain_each(step)
        if messages:
            end = time.monotonic()
            self._worked(end - begin, messages)
            if self._compiled is not None:
                self._compiled.count(events, end)
        return messages

    def _drain_each(self, step: int) -> tuple[int, int]:
        """Hand over all that waits; a `step` [ns] of the clock and one of `/clock` end a turn."""
        arrivals = self._waiting()
        if not arrivals:
            self._hand_over([], step)
            return 0, 0
        now, wall = self.now, time.time_ns()
        self._learn()
        heard: list[Heard] = []
        for arrival in arrivals:
            if arrival.topic is self._clock:
                if leap := self._show(arrival.message.clock):
                    self._hand_over(heard, leap)
                continue
            waited = max(wall - arrival.received, 0) if arrival.received else 0
            lost = arrival.topic.loss.take(arrival.number)
            at = max(now - waited, 0) if self._clock is None else self._simulated
            if step and 2 * (now - at) < abs(step):  # the first one that arrived after the step
                self._hand_over(heard, step)
                step = 0
            heard.append((arrival, at, lost))
        self._hand_over(heard, step)
        events = 0
        if self._compiled is not None:
            events = sum(len(arrival.topic.readers) for arrival in arrivals)
        return len(arrivals), events

    def _hand_over(self, heard: list[Heard], step: int) -> None:
        """
        Hand over what was heard as one turn, and after it a step of the clock.

        The next turn begins then.

        """
        if heard:
            if self.is_compiled:
                self._hand_over_burst(Burst.of(heard, self.topics.values()))
            else:
                self._hand_over_each(heard)
            heard.clear()
        if step:
            now = self.now
            self._recorder.set_clock(now - step, now, time.monotonic_ns())
            for axis in self._axes:
                self._guard(axis, 'a step of the clock', axis.monitor.set_clock, now - step, now)
            self._stepped(step, now)

    def _hand_over_each(self, heard: Sequence[Heard]) -> None:
        turn = ordered([event for each in heard for event in self._judged(each)])
        self._recorder.hear(heard)
        self._recorder.take(turn, heard[-1][1], time.monotonic_ns())
        self._recorder.flush()  # whatever becomes of the node with these events
        for axis, event in turn:
            self._take(axis, event)
        self._recorder.flush()

    def _hand_over_burst(self, burst: Burst) -> None:
        try:
            turn = self._turns.turn(burst, self._reading)
        except Exception as error:  # whatever it is: messages are read one by one, each guarded
            assert self._compiled is not None
            self._compiled.give_up(error)
            self._hand_over_each([burst.heard(at) for at in range(len(burst.now))])
            return
        if self._recorder.on:
            if self._recorder.raw:
                self._recorder.hear([burst.heard(at) for at in range(len(burst.now))])
            names = [self._axes[number].name for number in turn.numbers.tolist()]
            now, steady = int(burst.now[-1]), time.monotonic_ns()
            self._recorder.take_many(turn.events, names, turn.joints, now, steady)
            self._recorder.flush()
        for part in turn.by_axis():
            self._take_many(part)
        self._recorder.flush()

    @property
    def is_compiled(self) -> bool:
        """Return True if turns are judged compiled now."""
        return self._compiled is not None and self._compiled.are_due

    def _show(self, shown: Any) -> int:
        """Take a time of `/clock`; return by how much it leaps [ns], 0 if it goes on as before."""
        before, self._simulated = self._simulated, shown.sec * SECOND + shown.nanosec
        step = self._simulated - before
        if before <= 0:
            return 0
        usual = sorted(self._steps)[len(self._steps) // 2] if self._steps else max(step, 0)
        if step < -LEAST_STEP or step - LONG_STEP * usual > LEAST_STEP:
            return step - usual
        if step > 0:
            self._steps.append(step)
        return 0

    def _learn(self) -> None:
        """
        Read from now on as the messages so far suggest, one burst like the other.

        Between two steps of `/clock` stamps run ahead of it by up to one step.

        """
        ahead = self._reading.ahead
        if self._steps:
            wanted = min(2 * sorted(self._steps)[len(self._steps) // 2], MOST_AHEAD)
            ahead = wanted if 4 * abs(wanted - ahead) > ahead else ahead
        several = frozenset(
            key
            for topic in self.topics.values()
            for key, counter in topic.sources.items()
            if counter.several
        )
        self._reading = Reading(ahead, several)

    def _judged(self, heard: Heard) -> list[AxisEvent]:
        """Return what a message says of each axis, and count of which inputs it gives samples."""
        arrival, now, _ = heard
        events = _events(*heard, self._reading, self._guard)
        for axis, event in events:
            if isinstance(event, InputSample) or event.why is Why.SEVERAL:
                arrival.topic.count((axis.name, event.source), arrival.number, now)
        return events


def _events(
    arrival: Arrival,
    now: int,
    lost: int | None,
    reading: Reading = READING,
    guard: Callable[..., Any] = _call,
) -> list[AxisEvent]:
    """Return what a message that arrived at `now` [ns] of the node's clock says of each axis."""
    events: list[AxisEvent] = []
    for reader, (axis, source) in enumerate(arrival.topic.readers):
        limit = axis.max_future + reading.ahead
        options: dict[str, Any] = {'now': now, 'max_future': limit, 'lost': lost}
        try:
            event = arrival.read(reader, **options)
        except Exception:  # whatever it is: the guard takes it for the axis, with its place
            place = f'the {source.source.name.lower()} that arrived at {now} ns'
            event = guard(axis, place, arrival.read, reader, **options)
        several = reading.several and axis.one_source
        if several and (axis.name, source.source) in reading.several:
            if isinstance(event, InputSample):
                event = of_several(source.source, event.arrival, lost)
        if event is not None:
            events.append((axis, event))
    return events
