# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The player alone: a bag over DDS in the domain of the environment, for whoever listens."""

from collections.abc import Sequence
import dataclasses
from pathlib import Path
import threading

from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.core.interrupts import DONE, FAILED, interrupts, SIGNALLED
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.player import CLOCK, Player
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.middleware import notice
from ballscrew_monitor.settings.topics import absolute, input_topics
import rclpy
from rclpy.signals import SignalHandlerOptions
from surrogate.files import InputError


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Choice:
    """What is to be played: `every` topic, those in `topics`, or the inputs in a file."""

    params: Path
    topics: Sequence[str] | None = None
    every: bool = False


def playback(path: Path, choice: Choice, *, rate: float, patience: float, loop: bool) -> int:
    """
    Play the bag at `path` to whom listens within `patience` [s]; return the exit code.

    Of a damaged bag it plays the intact part, and says how much that is.

    """
    bag = Bag(path, salvage=True)
    topics = playable(bag, chosen(bag, choice))
    stop = threading.Event()
    with interrupts(stop) as interrupted:
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        node = rclpy.create_node('ballscrew_player', start_parameter_services=False)
        try:
            told = list(bag.notes)
            say(*filter(None, (notice(), *told)))
            player = Player(node, bag, rate=rate, topics=topics)
            code = _play(player, topics, patience, stop, loop)
            say(*(note for note in bag.notes if note not in told))
        finally:
            node.destroy_node()
            rclpy.shutdown()
        return SIGNALLED + interrupted[0] if interrupted else code


def chosen(bag: Bag, choice: Choice) -> list[str]:
    """Return the topics of the bag to be played; raises InputError if there is none of them."""
    if choice.every:
        return [topic for topic in bag.topics if topic != CLOCK]
    if choice.topics is not None:
        wanted, whose = list(map(absolute, choice.topics)), 'the topics asked for'
    else:
        wanted = list(input_topics(parameters.read_file(choice.params)))
        whose = f'the inputs in {choice.params}'
    missing = [topic for topic in wanted if topic not in bag.topics]
    if missing and (choice.topics or len(missing) == len(wanted)):
        raise InputError(
            f'bag {bag.path}: of {whose} it holds no {", ".join(missing)}, it holds '
            f'{", ".join(sorted(bag.topics))}: give --topics, --all or another --params'
        )
    if missing:
        print(f'the bag holds no {", ".join(missing)}', flush=True)
    return [topic for topic in dict.fromkeys(wanted) if topic in bag.topics]


def playable(bag: Bag, topics: Sequence[str]) -> list[str]:
    """Return the topics that can be sent, and say which cannot; raises InputError for none."""
    reasons = {topic: _problem(bag, topic) for topic in topics}
    for topic, reason in reasons.items():
        if reason:
            print(f'not played: {topic}, {reason}', flush=True)
    found = [topic for topic, reason in reasons.items() if not reason]
    if not found:
        raise InputError(f'bag {bag.path}: no topic can be played')
    return found


def _problem(bag: Bag, topic: str) -> str:
    """Return why a topic cannot be sent, empty if it can."""
    info = bag.topics[topic]
    if info.encoding != 'cdr':
        return f'encoded as {info.encoding}'
    try:
        message_class(info.type_name)
    except InputError as error:
        return str(error)
    return ''


def _play(
    player: Player, topics: Sequence[str], patience: float, stop: threading.Event, loop: bool
) -> int:
    missing = player.wait_for_subscribers(patience, stop)
    if stop.is_set():
        return FAILED
    if set(topics) <= set(missing):
        say(f'nobody subscribed to {", ".join(topics)} within {patience:g} s')
        return FAILED
    if missing:
        print(f'nobody listens to {", ".join(missing)}', flush=True)
    played = player.play(stop, loop=loop)
    print(
        f'{player.sent.total()} messages in {player.elapsed:.1f} s of bag time, '
        f'at most {1e3 * played.lateness:.1f} ms late'
    )
    return DONE
