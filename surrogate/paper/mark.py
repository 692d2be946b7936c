# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A number of the comparison with the published study, beside what the study reports."""

from collections.abc import Iterable
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from surrogate.paper.cases import PRELOAD
from surrogate.paper.curves import pick
from surrogate.paper.rows import StudyRow

REPORTED_FILM = 153.0
"""Central film at 502.65 mm/s and preload only, published for the rough surface [nm]."""
FILM_SAID = f'{REPORTED_FILM:.0f} nm, rough'


@dataclass(frozen=True, kw_only=True, slots=True)
class Mark:
    """
    A number of ours: what it is, value, standard error (NaN: none), unit, what is reported.

    `trend` in what is reported means that only the direction is known.

    """

    name: str
    value: float
    unit: str = '-'
    reported: str = ''
    error: float = math.nan

    @property
    def shown(self) -> str:
        """Return value, error and unit as text."""
        more = '' if math.isnan(self.error) else f' ± {self.error:.2g}'
        unit = '' if self.unit == '-' else f' {self.unit}'
        return f'{self.value:.4g}{more}{unit}'


def table(found: Iterable[Mark]) -> str:
    """Return marks as a table in Markdown."""
    lines = ['| number | ours | reported |', '|---|---|---|']
    return '\n'.join(lines + [f'| {m.name} | {m.shown} | {m.reported} |' for m in found])


def counted(draws: int) -> str:
    """Return a number of draws in words."""
    return 'one draw' if draws == 1 else f'{draws} draws'


def mean_of(rows: Iterable[StudyRow], name: str, **wanted: Any) -> float:
    """Return the mean of a column over the rows with the wanted values; NaN without any."""
    values = [getattr(row, name) for row in pick(rows, **wanted)]
    return float(np.mean(values)) if values else math.nan


def over_preload(rows: Iterable[StudyRow], name: str, load: float, **wanted: Any) -> float:
    """Return a column at a `load` [N] over that at preload [-]."""
    rows = list(rows)
    last = mean_of(rows, name, load=load, **wanted)
    return last / mean_of(rows, name, load=PRELOAD, **wanted)
