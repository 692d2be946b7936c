# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Progress of judging a recording or reading a table, for people: rate and time left."""

from collections.abc import Callable, Iterator
import contextlib
import time

from surrogate.progress import Progress

PATIENCE = 2.0  # [s] of work before anything is said
Shown = Callable[[float, str], contextlib.AbstractContextManager[Callable[[float], None]]]
"""Shows how far a total of some unit is done: `shown_progress`, or `silent` in its place."""


@contextlib.contextmanager
def shown_progress(
    total: float,
    unit: str = 's of the recording',
    *,
    progress: Progress | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[Callable[[float], None]]:
    """Give what shows the share [-] done of a total of some unit, if it takes long."""
    whole, begin = max(round(total), 1), clock()
    bar = progress or Progress(whole, unit)
    bar.show(0, whole)

    def show(share: float) -> None:
        if clock() - begin >= PATIENCE:
            bar.show(min(max(round(share * whole), 1), whole), whole)

    try:
        yield show
    finally:
        bar.close()


@contextlib.contextmanager
def silent(total: float, unit: str) -> Iterator[Callable[[float], None]]:
    """Give what shows nothing of a total of some unit."""
    yield lambda share: None
