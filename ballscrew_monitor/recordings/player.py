# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Plays a bag over DDS: the serialised messages as they are, and `/clock` from their log times.

`/clock` ticks at 100 Hz and before each message, so that a subscriber on simulated time never
sees a message from its future. In a loop each pass goes on from the end of the one before:
`/clock` and every stamp in the messages are shifted by whole passes. The messages are offered
reliably and to latecomers: a subscriber that asks for less gets them as such, and none is refused.
`playback` does that alone, in the domain of the environment, for whoever listens. It compares what
is played with what the monitors take by their own diagnostics: their inputs are best effort, so
the middleware does not hold the player back for them.

"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
import dataclasses
import itertools
from pathlib import Path
import threading
import time
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.interrupts import DONE, FAILED, interrupts, SIGNALLED
from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.parameters import absolute, input_topics
from ballscrew_monitor.settings.qos import started_node
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.duration import Duration
from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.time import Time as RclTime
from rclpy.validate_full_topic_name import validate_full_topic_name
from rosgraph_msgs.msg import Clock
from surrogate.files import InputError, printable

CLOCK = '/clock'
LAST = 2**31 * SECOND  # [ns] first stamp that a message cannot hold
CLOCK_PERIOD = 0.01  # [s] of wall time
MATCH_POLL = 0.02  # [s] between two looks at who has matched
PAUSE = SECOND // 10  # [ns] of bag time from the last message of a pass to the first of the next
UNTIMED = (
    'nobody takes the time from /clock, and for the clock of the wall the stamps of the bag are '
    'old: start the node with use_sim_time:=true'
)
DELIVERY = 5.0  # [s] that the last messages may take
CLOCK_QOS = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)
DATA_QOS = QoSProfile(
    depth=1000,
    reliability=QoSReliabilityPolicy.RELIABLE,
    durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
)
DIAGNOSTICS, PART = '/diagnostics', ': Inputs'
TAKEN, LOST, MATCHED = ' received [-]', ' lost [-]', ' publishers [-]'
FRESH = ('Speed state', 'OK')
DISCOVERY = 0.5  # [s] from one end of a node that is known to the others
FIRST_WORD, LAST_WORD = 2.0, 5.0  # [s] that a monitor may take to tell what it has taken
POLL = 0.05  # [s]
DEPTH = 1000  # messages of monitors that may wait
Counts = Mapping[str, int]
"""Messages by the input of an axis and whether they are taken or lost."""


class Player:
    """
    Publishes the messages of a bag on a node, which need not be spun.

    `now` is the time that `/clock` shows [ns]; so far, `sent` counts messages by topic, and
    `lateness` is the longest time by which one was late [s].

    """

    def __init__(
        self, node: Node, bag: Bag, *, rate: float = 1.0, topics: Sequence[str] | None = None
    ) -> None:
        """Make the publishers; `rate` is bag time over wall time, above 0; topics None: all."""
        if not 0.0 < rate < float('inf'):
            raise InputError(f'rate is {rate:g}, it must be above 0')
        self._bag, self.rate = bag, rate
        self.sent: Counter[str] = Counter()
        self.lateness = 0.0
        self.now = bag.start_time
        self._publishers = {
            topic: node.create_publisher(
                message_class(bag.topics[topic].type_name), topic, DATA_QOS
            )
            for topic in (bag.topics if topics is None else topics)
            if topic != CLOCK
        }
        # Made last: who hears it has heard of the others.
        self._clock = node.create_publisher(Clock, CLOCK, CLOCK_QOS)

    @property
    def elapsed(self) -> float:
        """Return the bag time played so far [s]."""
        return (self.now - self._bag.start_time) / SECOND

    def unmatched(self, wanted: int = 1) -> list[str]:
        """Return the topics with fewer than `wanted` subscribers, and /clock if it has none."""
        missing = [
            topic
            for topic, publisher in self._publishers.items()
            if publisher.get_subscription_count() < wanted
        ]
        return missing + ([CLOCK] if self._clock.get_subscription_count() == 0 else [])

    def wait_for_subscribers(self, timeout: float, stop: threading.Event) -> list[str]:
        """Wait until every topic has a subscriber, at most `timeout` [s]; return those without."""
        deadline = time.monotonic() + timeout
        while (missing := self.unmatched()) and time.monotonic() < deadline:
            if stop.wait(MATCH_POLL):
                break
        return missing

    def show_begin(self) -> None:
        """Publish the time at which the bag begins, so that a listener may answer to it."""
        self._tick(self._bag.start_time)

    def play(self, stop: threading.Event, *, loop: bool = False) -> bool:
        """
        Publish the bag, again and again in a `loop`; tell whether its end came before `stop`.

        Raises InputError on damage.

        """
        begin = time.monotonic()
        for message in self._messages(loop):
            due = begin + (message.log_time - self._bag.start_time) / SECOND / self.rate
            if not self._wait(due, stop, begin):
                return False
            self._tick(message.log_time)
            self._publishers[message.topic].publish(message.data)
            self.sent[message.topic] += 1
            self.lateness = max(self.lateness, time.monotonic() - due)
        # Reliable subscribers are to have all: what is under way dies with its publisher.
        deadline = time.monotonic() + DELIVERY
        for publisher in self._publishers.values():
            publisher.wait_for_all_acked(Duration(seconds=max(0.0, deadline - time.monotonic())))
        return True

    def _messages(self, loop: bool) -> Iterator[Message]:
        """Yield the messages of the bag, those of a further pass later by whole passes."""
        yield from self._bag.messages(self._publishers)
        length = self._bag.end_time - self._bag.start_time + PAUSE
        kinds = {name: message_class(self._bag.types[name]) for name in self._publishers}
        for number in itertools.count(1) if loop else ():
            for message in self._bag.messages(self._publishers):
                yield dataclasses.replace(
                    message,
                    log_time=message.log_time + number * length,
                    data=shifted(message.data, kinds[message.topic], number * length),
                )

    def run_on(self, finished: Callable[[], bool], timeout: float, stop: threading.Event) -> bool:
        """
        Let `/clock` go on after the end until `finished`, at most `timeout` [s] of wall time.

        Returns what `finished` says at last. A subscriber with a timer on simulated time can so
        notice that the data have ended.

        """
        begin, base = time.monotonic(), self.now
        while not finished() and time.monotonic() < begin + timeout:
            if stop.wait(CLOCK_PERIOD):
                break
            self._tick(base + round((time.monotonic() - begin) * self.rate * SECOND))
        return finished()

    def _wait(self, due: float, stop: threading.Event, begin: float) -> bool:
        """Tick the clock until `due` [s] of the steady clock; False when stopped."""
        while (left := due - time.monotonic()) > 0.0:
            if stop.wait(min(left, CLOCK_PERIOD)):
                return False
            at = self._bag.start_time + round((time.monotonic() - begin) * self.rate * SECOND)
            if time.monotonic() < due:
                self._tick(at)
        return not stop.is_set()

    def _tick(self, now: int) -> None:
        """Publish the time `now` [ns], which never goes back."""
        self.now = max(now, self.now)
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(self.now, SECOND)
        self._clock.publish(message)


def shifted(data: bytes, message_type: Any, by: int) -> bytes:
    """Return a serialised message with stamps later `by` [ns]; a stamp of 0 stays."""
    message = deserialize_message(data, message_type)
    for stamp in _times(message):
        before = stamp.sec * SECOND + stamp.nanosec
        if before and before + by < LAST:
            stamp.sec, stamp.nanosec = divmod(before + by, SECOND)
    return bytes(serialize_message(message))


def _times(part: Any) -> Iterator[Time]:
    """Yield every time in a message, in a list of them, or in anything else, which holds none."""
    if isinstance(part, Time):
        yield part
    elif isinstance(part, list):
        for message in part:
            yield from _times(message)
    elif hasattr(part, 'get_fields_and_field_types'):
        for name in part.get_fields_and_field_types():
            yield from _times(getattr(part, name))


class Following:
    """What the monitors have taken and lost since the first that was heard of them."""

    def __init__(self, node: Node, topics: Mapping[tuple[str, str], str]) -> None:
        """Listen on a node, which is spun here alone; `topics` by axis and input, if known."""
        self._node, self._topics = node, topics
        self._first: dict[str, Counts] = {}
        self._last: dict[str, Counts] = {}
        self._resting: set[str] = set()  # monitors whose counts do after the end
        self._unmatched: set[str] = set()  # those that miss the publisher of an input
        self._end = 2**63
        node.create_subscription(DiagnosticArray, DIAGNOSTICS, self._hear, DEPTH)

    def begin(self) -> None:
        """
        Wait a little for what the monitors have taken before, and until they know the player.

        A subscriber may be known before what its node publishes: only where no monitor is known
        after a moment there is none.

        """
        begin = time.monotonic()
        deadline = begin + FIRST_WORD
        while (not self._first or self._unmatched) and (now := time.monotonic()) < deadline:
            if now > begin + DISCOVERY and not self._node.count_publishers(DIAGNOSTICS):
                break
            self._take(POLL)

    def settle(self, end: int, run_on: Callable[[Callable[[], bool], float], object]) -> None:
        """
        Let the clock run on until the counts of all monitors rest after the `end` [ns].

        Their speeds are stale then: a tick comes after all that waits.

        """
        self._end = end

        def rest() -> bool:
            self._take()
            return self._resting == self._last.keys()

        if self._first:
            run_on(rest, LAST_WORD)

    def complaint(self, rate: float, sent: Mapping[str, int]) -> str:
        """
        Return which input has lost most at a `rate` [-], of how many; empty if none has.

        Of an input whose topic is known all that was `sent` on it counts, of another one what the
        monitor knows to be lost: it cannot know that of the last messages.

        """
        complaints = []
        for name, counts in self._last.items():
            where = name.removesuffix(PART)
            for source in (topic.removesuffix(TAKEN) for topic in counts if topic.endswith(TAKEN)):
                taken = self._gained(name, source + TAKEN)
                if not taken:  # it listens to something else
                    continue
                key = where.rpartition(': ')[2], source.lower()
                count = sent.get(self._topics.get(key, ''), 0) or taken + self._gained(
                    name, source + LOST
                )
                complaints.append((count - taken, taken, count, where, source.lower()))
        lost, taken, count, where, source = max(complaints, default=(0, 0, 0, '', ''))
        if lost <= 0:
            return ''
        return (
            f'{where} did not follow at {rate:g}x: it took {taken} of {count} messages of its '
            f'{source}; lower --rate'
        )

    def _gained(self, name: str, key: str) -> int:
        return self._last[name].get(key, 0) - self._first[name].get(key, 0)

    def _hear(self, message: DiagnosticArray) -> None:
        late = RclTime.from_msg(message.header.stamp).nanoseconds > self._end
        for status in message.status:
            if not status.name.endswith(PART):
                continue
            counts = _counts(status)
            fresh = any((pair.key, pair.value) == FRESH for pair in status.values)
            if late and not fresh and counts == self._last.get(status.name):
                self._resting.add(status.name)
            missing = any(
                pair.key.endswith(MATCHED) and pair.value == '0' for pair in status.values
            )
            (self._unmatched.add if missing else self._unmatched.discard)(status.name)
            self._first.setdefault(status.name, counts)
            self._last[status.name] = counts

    def _take(self, patience: float = 0.0) -> None:
        """Take a word of a monitor if one has come within a time [s]."""
        assert self._node.executor is not None
        self._node.executor.spin_once(timeout_sec=patience)


def _counts(status: DiagnosticStatus) -> Counts:
    return {
        pair.key: int(pair.value)
        for pair in status.values
        if pair.key.endswith((TAKEN, LOST)) and pair.value.isdecimal()
    }


def playback(
    path: Path,
    params: Path,
    wanted: Sequence[str] | None = None,
    *,
    every: bool,
    rate: float,
    patience: float,
    loop: bool,
) -> int:
    """
    Play the bag at `path` to whom listens within `patience` [s]; return the exit code.

    What is played is `every` topic, the `wanted` ones, or the inputs in the file `params`. A bag
    that has lost its end is played up to there, and said to be so.

    """
    bag = Bag(path, salvage=True)
    topics = playable(bag, chosen(bag, params, wanted, every=every))
    stop = threading.Event()
    with interrupts(stop) as interrupted:
        with started_node('ballscrew_player', enable_rosout=True) as node:
            notes = list(bag.notes)
            say(*notes)
            player = Player(node, bag, rate=rate, topics=topics)
            # What a monitor said when the bag was recorded tells nothing of those of now.
            known: dict[tuple[str, str], str] = {}
            if not every and wanted is None:
                values = parameters.read_file(params)
                known = {
                    (axis, source): absolute(values[f'{axis}.{source}.topic'])
                    for axis in values['axes']
                    for source in (source.name.lower() for source in Source)
                }
            following = None if DIAGNOSTICS in topics else Following(node, known)
            code = _play(player, topics, patience, stop, loop, following)
            say(*(note for note in bag.notes if note not in notes))
        return SIGNALLED + interrupted[0] if interrupted else code


def chosen(
    bag: Bag, params: Path, topics: Sequence[str] | None = None, *, every: bool = False
) -> list[str]:
    """Return the topics of the bag to be played; raises InputError if there is none of them."""
    if every:
        return [topic for topic in bag.topics if topic != CLOCK]
    if topics is not None:
        wanted, whose = list(map(absolute, topics)), 'the topics asked for'
    else:
        wanted = list(input_topics(parameters.read_file(params)))
        whose = f'the inputs in {params}'
    missing = [topic for topic in wanted if topic not in bag.topics]
    if missing and (topics or len(missing) == len(wanted)):
        raise InputError(
            f'bag {bag.path}: of {whose} it holds no {", ".join(missing)}, it holds '
            f'{", ".join(sorted(bag.topics))}: give --topics, --all or another --params'
        )
    if missing:
        print(printable(f'the bag holds no {", ".join(missing)}'), flush=True)
    return [topic for topic in dict.fromkeys(wanted) if topic in bag.topics]


def playable(bag: Bag, topics: Sequence[str]) -> list[str]:
    """Return the topics that can be sent, and say which cannot; raises InputError for none."""
    reasons = {topic: _problem(bag, topic) for topic in topics}
    for topic, reason in reasons.items():
        if reason:
            print(printable(f'not played: {topic}, {reason}'), flush=True)
    sent = [topic for topic, reason in reasons.items() if not reason]
    if not sent:
        raise InputError(f'bag {bag.path}: no topic can be played')
    return sent


def _problem(bag: Bag, topic: str) -> str:
    """Return why a topic cannot be sent, empty if it can."""
    info = bag.topics[topic]
    if info.encoding != 'cdr':
        return f'encoded as {info.encoding}'
    try:
        message_class(info.type_name)
        validate_full_topic_name(absolute(topic))
    except InputError as error:
        return str(error)
    except InvalidTopicNameException:
        return 'which is no topic name of ROS 2'
    return ''


def _play(
    player: Player,
    topics: Sequence[str],
    patience: float,
    stop: threading.Event,
    loop: bool,
    following: Following | None,
) -> int:
    missing = player.wait_for_subscribers(patience, stop)
    if stop.is_set():
        return FAILED
    if set(topics) <= set(missing):
        say(f'nobody subscribed to {", ".join(topics)} within {patience:g} s')
        return FAILED
    unheard = [topic for topic in missing if topic != CLOCK]
    if unheard:
        print(f'nobody listens to {", ".join(unheard)}', flush=True)
    if CLOCK in missing:
        print(UNTIMED, flush=True)
    if following is not None:
        following.begin()
    ended = player.play(stop, loop=loop)
    print(
        f'{player.sent.total()} messages in {player.elapsed:.1f} s of bag time, '
        f'at most {1e3 * player.lateness:.1f} ms late',
        flush=True,
    )
    complaint = ''
    if ended and following is not None:
        following.settle(player.now, lambda rest, most: player.run_on(rest, most, stop))
        complaint = following.complaint(player.rate, player.sent)
    say(*filter(None, [complaint]))
    return FAILED if complaint else DONE
