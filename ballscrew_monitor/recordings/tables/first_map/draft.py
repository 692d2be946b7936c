# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A first map while it is written: what it says, what it assumes, and what it asks."""

from typing import Any

from ballscrew_monitor.recordings.tables.first_map.columns import Columns


class Draft:
    """
    What a map says of a log so far, and what is to be said about it.

    `used` says of each axis what its columns are, `assumed` has values with their reasons,
    `unstated` what decides each place that is open. `ways` are those of the position of an axis
    for a unit and second of its speed, NaN where both are not alike; `agreeing` are the units in
    which a motion agrees that states none. The log begins as `begin` says in words, of which
    `date_from` and `order` are what the map says.

    """

    def __init__(self, log: Columns) -> None:
        """Begin with what is noted of the columns of a log."""
        self.log = log
        self.used: dict[str, dict[str, Any]] = {}
        self.assumed: dict[str, dict[str, Any]] = {}
        self.notes, self.unstated = [*log.notes], [*log.unclear]
        self.ways: dict[str, float] = {}
        self.agreeing: dict[str, dict[str, str]] = {}
        self.begin, self.date_from, self.order = '', '', ''

    def assume(self, key: str, value: Any, reason: str) -> None:
        """Assume a value for a reason."""
        self.assumed[key] = {'value': value, 'reason': reason}

    def ask(self, place: str, question: str, value: Any = None) -> None:
        """Leave a place of an axis open, such as x.speed.unit, and say what decides it."""
        *parents, key = place.split('.')
        held: dict[str, Any] = self.used
        for parent in parents:
            held = held[parent]
        held[key] = value
        self.unstated.append(f'state axes.{place} in the map{question}')

    def unit(self, name: str, kind: str) -> str:
        """Return the unit of an input as the map says or assumes it, or as it would agree."""
        if unit := self.agreeing.get(name, {}).get(kind):
            return unit
        assumed = self.assumed.get(f'{name}.{kind}.unit', {}).get('value', '')
        return str(self.used[name][kind].get('unit', assumed) or '')
