# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Backlog of a judgement while a thread of its process loads the compiled code.

Run `python bench/node_parts/loading.py SHARE [WAIT]`: the judgement needs that share of a core
[-], and the thread waits for it WAIT [s] at most before each module, 0 for one that does not.
The time is the processor time of the process, so other work on the machine does not count.

"""

import gc
import sys
import time

from ballscrew_monitor.node import compiled_turns
from ballscrew_monitor.node.compiled_turns import COMPILED_FROM, CompiledTurns, SPAN
import ballscrew_monitor.node.node  # noqa: F401 imported by then, as the node runs

PAUSE = 0.0013  # [s] between two looks of a node with 32 topics


def judge(duration: float) -> None:
    """Hold the interpreter for some processor time [s]."""
    end = time.thread_time() + duration
    while time.thread_time() < end:
        sum(range(50))


def longest_backlog(share: float) -> float:
    """Return the longest time [s] whose messages wait for a judgement of a share of a core."""
    turns, longest = CompiledTurns(print), 0.0
    turns.count(0, SPAN)
    turns.count(round(2 * COMPILED_FROM * SPAN), 2 * SPAN)
    done = time.process_time()
    while not turns.are_due:
        waits = time.process_time() - done
        if waits > PAUSE:
            turns.at_rest.clear()
            longest = max(longest, waits)
            judge(share * waits)
            done += waits
        turns.at_rest.set()
        time.sleep(PAUSE)
    return longest


def main() -> None:
    """Load once, and print what waited."""
    share, wait = float(sys.argv[1]), sys.argv[2:]
    compiled_turns.LONGEST_WAIT = float(wait[0]) if wait else compiled_turns.LONGEST_WAIT
    gc.collect()
    gc.freeze()
    print(f'messages of {1e3 * longest_backlog(share):.0f} ms wait at most')


if __name__ == '__main__':
    main()
