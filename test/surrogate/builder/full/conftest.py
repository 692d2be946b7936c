# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A pool of workers that is this process."""

import math

import pytest
from surrogate.tasks.worker import run_task


@pytest.fixture
def here():
    """Return the pool, to be made with the number of tasks after which it is interrupted."""
    return Here


class Here:
    """A pool that solves in this process, and may be interrupted after some tasks."""

    def __init__(self, most=math.inf):
        self.most, self.solved = most, 0
        self.heard = []

    def __enter__(self):
        return self

    def __exit__(self, *error):
        pass

    def submit(self, name, task, inputs):
        """Solve at once."""
        if self.solved == self.most:
            raise KeyboardInterrupt
        self.solved += 1
        self.heard.append((name, run_task(task, inputs)))

    def wait(self, seconds):
        """Tell of what is solved."""
        heard, self.heard = self.heard, []
        return heard
