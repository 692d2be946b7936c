# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Nothing is said of short work; of long work the rate and the time left."""

import io

from ballscrew_monitor.recordings.progress import shown_progress
from surrogate.progress import Progress


def said(step):
    """Return what is said of 1000 s whose tenths take `step` [s] each."""
    now, stream = [0.0], io.StringIO()
    bar = Progress(1000, 's of the recording', stream=stream, clock=lambda: now[0])
    with shown_progress(1000.0, progress=bar, clock=lambda: now[0]) as show:
        for tenth in range(1, 11):
            now[0] += step
            show(tenth / 10)
    return stream.getvalue()


def test_short_work_is_silent_and_long_work_tells_rate_and_time_left(says):
    assert said(0.1) == ''
    assert says('500_1000_s') in said(1.0)
