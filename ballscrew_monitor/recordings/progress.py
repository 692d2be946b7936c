# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""How far a recording is judged, for who waits: rate as a multiple of real time, and time left."""

from collections.abc import Callable, Iterator
import contextlib
import time

from surrogate.progress import Progress

PATIENCE = 2.0  # [s] of work before anything is said


@contextlib.contextmanager
def shown_progress(
    duration: float,
    *,
    progress: Progress | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[Callable[[float], None]]:
    """Give what shows the share [-] done of a recording of some duration [s], if it takes long."""
    total, begin = max(round(duration), 1), clock()
    bar = progress or Progress(total, 's of the recording')
    bar.show(0, total)

    def show(share: float) -> None:
        if clock() - begin >= PATIENCE:
            bar.show(max(round(share * total), 1), total)

    try:
        yield show
    finally:
        bar.close()
