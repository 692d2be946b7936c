# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tasks that the comparison with the published study solves, by the figure that needs them.

A task is one solve: a contact, smooth or with one draw of the study's roughness, which stands
still; the whole screw in the full tier, whose roughness rolls, or stands still for comparison; or
the screw by published formulas. Speeds are those of the screw; contacts take the study's own
entrainment, w r_m / 2.

"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from surrogate.files import InputError

Kind = Literal['contact', 'screw', 'formulas']
SMOOTH = -1
"""Draw of a task without roughness [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Assumptions:
    """Nut of a contact, closed inlet in half-widths [-] and viscosity [Pa s]; None leaves ours."""

    nut: Literal['loaded', 'relieved'] = 'loaded'
    inlet: float | None = None
    viscosity: float | None = None


OURS, RELIEVED, SHORT, STANDING = 'ours', 'relieved nut', 'short inlet', 'standing'
CASES = {
    OURS: Assumptions(),
    RELIEVED: Assumptions(nut='relieved'),
    # With so little inlet the viscosity is what makes the published film of 153 nm.
    SHORT: Assumptions(inlet=1.5, viscosity=0.113),
}
"""Cases of a contact by name; the roughness of a screw rolls unless its case is `STANDING`."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StudyTask:
    """
    One solve.

    Kind, case, screw speed [rev/min], axial load [N], draw of the roughness (`SMOOTH` without);
    `fields` keeps what a picture of the contact needs: nothing, the centre line, or all nodes.

    """

    kind: Kind
    rpm: float
    load: float
    draw: int = SMOOTH
    case: str = OURS
    fields: Literal['', 'line', 'map'] = ''

    @property
    def key(self) -> str:
        """Name of the task, also that of its file of fields."""
        name = f'{self.kind}_{self.case}_{self.rpm:g}rpm_{self.load:g}N_draw{self.draw}'
        return name.replace(' ', '-')

    @property
    def rolls(self) -> bool:
        """Whether the asperity law decides what touches."""
        return self.kind == 'screw' and self.case == OURS

    @property
    def cost(self) -> float:
        """Rough share of the time [-], for the time left."""
        if self.kind == 'formulas':
            return 0.01
        stands = self.draw != SMOOTH
        return (1.0 if stands else 0.2) * (2.5 if self.kind == 'screw' else 1.0)


PRELOAD = 0.0
"""Axial load of a screw under preload alone [N]."""
MARK_RPM = 600.0
"""Screw speed of the published central film [rev/min]: 502.65 mm/s by w r_m / 2."""
SMOOTH_SPEEDS = (50.0, 200.0, 600.0, 1000.0)
LOADS = (0.0, 500.0, 1000.0, 1500.0, 2000.0, 2400.0)
RELIEVED_LOADS = LOADS[:-1]
"""Less the largest: there the ball of the relieved nut hardly deforms."""
SHOWN_SPEEDS = (5.0, 20.0, 600.0)
ROUGH_SPEEDS = (5.0, 10.0, 15.0, 20.0, 40.0)
ROUGH_LOADS = (0.0, 1000.0, 2000.0)
SLOW, ONSET = 5.0, 10.0
"""Screw speeds inside and near the edge of asperity contact that stands still [rev/min]."""
SPEEDS = (2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 1000.0)
"""Speeds of the whole screw [rev/min]."""
MAP_LOADS = (50.0, 150.0, 400.0, 1000.0, 1700.0, 2400.0)
EFFICIENCY_LOAD = 1000.0
"""Axial load at which efficiencies are compared over speed [N], about the preload."""
ROLLING_RPM = 200.0
"""Speed inside asperity contact that rolls [rev/min]."""


def _fractal(draws: int) -> Iterator[StudyTask]:
    yield StudyTask(kind='contact', rpm=SLOW, load=PRELOAD, draw=0, fields='map')


def _speeds(draws: int) -> Iterator[StudyTask]:
    for rpm in SPEEDS:
        yield StudyTask(kind='screw', rpm=rpm, load=PRELOAD)
        yield StudyTask(kind='screw', rpm=rpm, load=PRELOAD, draw=0, case=STANDING)


def _smooth_speed(draws: int) -> Iterator[StudyTask]:
    for rpm in SMOOTH_SPEEDS:
        yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD, fields='line')


def _smooth_load(draws: int) -> Iterator[StudyTask]:
    for load in LOADS:
        yield StudyTask(kind='contact', rpm=MARK_RPM, load=load, fields='line')
    for load in RELIEVED_LOADS:
        yield StudyTask(kind='contact', rpm=MARK_RPM, load=load, case=RELIEVED)


def _rough_speed(draws: int) -> Iterator[StudyTask]:
    for rpm in SHOWN_SPEEDS:
        yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD, draw=0, fields='line')


def _rough_load(draws: int) -> Iterator[StudyTask]:
    for load in ROUGH_LOADS:
        yield StudyTask(kind='contact', rpm=SLOW, load=load, draw=0, fields='line')
    for draw in range(draws):
        for load in ROUGH_LOADS:
            for rpm in (SLOW, ONSET, MARK_RPM):
                yield StudyTask(kind='contact', rpm=rpm, load=load, draw=draw)
        for load in ROUGH_LOADS[1:]:
            yield StudyTask(kind='contact', rpm=SLOW, load=load, draw=draw, case=RELIEVED)


def _stribeck(draws: int) -> Iterator[StudyTask]:
    yield from _speeds(draws)
    for draw in range(draws):
        for rpm in ROUGH_SPEEDS:
            yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD, draw=draw)


def _maps(draws: int) -> Iterator[StudyTask]:
    for load in MAP_LOADS:
        for rpm in SPEEDS:
            yield StudyTask(kind='screw', rpm=rpm, load=load)


def _trends(draws: int) -> Iterator[StudyTask]:
    for some in (_maps, _smooth_load, _rough_load, _stribeck):
        yield from some(draws)
    standing = [(rpm, EFFICIENCY_LOAD) for rpm in SPEEDS]
    standing += [(MARK_RPM, load) for load in MAP_LOADS]
    for rpm, load in standing:
        yield StudyTask(kind='screw', rpm=rpm, load=load, draw=0, case=STANDING)
    for load in LOADS:
        yield StudyTask(kind='contact', rpm=MARK_RPM, load=load, case=SHORT)
        yield StudyTask(kind='formulas', rpm=MARK_RPM, load=load)
    for rpm in SPEEDS:
        yield StudyTask(kind='formulas', rpm=rpm, load=PRELOAD)
        yield StudyTask(kind='formulas', rpm=rpm, load=EFFICIENCY_LOAD)


NEEDS = {
    '4': _fractal,
    '6b': _speeds,
    '7': _smooth_speed,
    '8': _smooth_load,
    '9': _rough_speed,
    '10': _rough_load,
    '11': _stribeck,
    '12': _maps,
    '13': _maps,
    'trends': _trends,
}
"""What each figure solves, given the draws of the contacts; keys are the study's numbers."""


def tasks(figures: tuple[str, ...], draws: int) -> list[StudyTask]:
    """
    Return every task of some figures once, in order; what keeps most fields is the one kept.

    Raises InputError for a figure that is not made, or less than one draw.

    """
    if draws < 1:
        raise InputError(f'draws is {draws}, allowed is 1 or more')
    found: dict[str, StudyTask] = {}
    for figure in figures:
        if figure not in NEEDS:
            raise InputError(f'figure is {figure!r}, allowed are {", ".join(NEEDS)}')
        for task in NEEDS[figure](draws):
            known = found.get(task.key)
            if known is None or _RICHNESS[task.fields] > _RICHNESS[known.fields]:
                found[task.key] = task
    return list(found.values())


_RICHNESS = {'': 0, 'line': 1, 'map': 2}
