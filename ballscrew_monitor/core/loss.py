# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""How many messages of a topic were lost, by the numbers that their publisher gives them."""

NO_NUMBER = 0
"""What a middleware without publication numbers says; the first real one is 1."""


class LossCounter:
    """Counts the gaps in the publication numbers of one topic with one publisher."""

    def __init__(self) -> None:
        """Begin before the first message."""
        self._last: int | None = None
        self.publishers = 1

    def match(self, publishers: int) -> None:
        """Note how many publishers there are now; the count of each of them begins anew."""
        self.publishers = publishers
        self._last = None

    def take(self, number: int) -> int | None:
        """
        Return how many messages were lost just before the one of this publication number.

        None when that cannot be known: the numbers of several publishers are mixed, or there are
        none. A number that falls back belongs to a publisher that has begun anew.

        """
        if self.publishers > 1 or number == NO_NUMBER:
            self._last = None
            return None
        last, self._last = self._last, number
        return 0 if last is None or number <= last else number - last - 1
