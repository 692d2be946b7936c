# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Just the player: a bag over DDS in the domain of the environment, for whoever listens."""

from pathlib import Path
import sys
import threading

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.interrupts import DONE, FAILED, interrupts, SIGNALLED
from ballscrew_monitor.recordings.player import Player
import rclpy
from rclpy.signals import SignalHandlerOptions


def playback(path: Path, *, rate: float, patience: float) -> int:
    """Play the bag at `path` to whom listens within `patience` [s]; return the exit code."""
    bag = Bag(path)
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node('ballscrew_player', start_parameter_services=False)
    stop = threading.Event()
    try:
        player = Player(node, bag, rate=rate)
        with interrupts(stop) as interrupted:
            code = _play(player, bag, patience, stop)
        return SIGNALLED + interrupted[0] if interrupted else code
    finally:
        node.destroy_node()
        rclpy.shutdown()


def _play(player: Player, bag: Bag, patience: float, stop: threading.Event) -> int:
    missing = player.wait_for_subscribers(patience, stop)
    if stop.is_set():
        return FAILED
    if set(bag.topics) <= set(missing):
        print(
            f'ballscrew: nobody subscribed to {", ".join(bag.topics)} within {patience:g} s',
            file=sys.stderr,
        )
        return FAILED
    if missing:
        print(f'nobody listens to {", ".join(missing)}', flush=True)
    played = player.play(stop)
    print(
        f'{sum(played.sent.values())} messages in {player.elapsed:.1f} s of bag time, '
        f'at most {1e3 * played.lateness:.1f} ms late'
    )
    return DONE
