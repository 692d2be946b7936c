# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What the comparison with the published study solves: tasks, by the figure that needs them.

A task is one solve: a contact of the loaded or the relieved nut, smooth or with one draw of the
roughness, the whole screw in the full tier, or the screw by published formulas. A case names the
assumptions that differ from ours. Speeds are those of the screw; contacts take the study's own
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
    """
    Assumptions of a contact; None leaves ours.

    Nut, closed inlet in half-widths of the contact [-], viscosity [Pa s], film floor [m].

    """

    nut: Literal['loaded', 'relieved'] = 'loaded'
    inlet: float | None = None
    viscosity: float | None = None
    film_floor: float | None = None


OURS, RELIEVED, SHORT, THIN, HIGH = 'ours', 'relieved nut', 'short inlet', 'thin oil', 'high floor'
CASES = {
    OURS: Assumptions(),
    RELIEVED: Assumptions(nut='relieved'),
    # With so little inlet the viscosity is what makes the published film of 153 nm.
    SHORT: Assumptions(inlet=1.5, viscosity=0.113),
    # ISO VG 68 at 80 degC.
    THIN: Assumptions(viscosity=0.0144),
    HIGH: Assumptions(film_floor=10e-9),
}
"""Cases by name; `THIN` is the oil of the nominal screw at 80 degC."""


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
    def cost(self) -> float:
        """Rough share of the time [-], for the time left."""
        if self.kind == 'formulas':
            return 0.01
        if self.draw == SMOOTH:
            return 0.2
        slow = 1.0 + 20.0 / (self.rpm + 5.0)
        return slow * (2.5 if self.kind == 'screw' else 1.0) * (1.0 + self.load / 2500.0)


PRELOAD = 0.0
"""Axial load of a screw under preload alone [N]."""
MARK_RPM = 600.0
"""Screw speed of the published central film [rev/min]: 502.65 mm/s by w r_m / 2."""
SMOOTH_SPEEDS = (50.0, 200.0, 600.0, 1000.0)
LOADS = (0.0, 500.0, 1000.0, 1500.0, 2000.0, 2400.0)
RELIEVED_LOADS = LOADS[:-1]
"""Less the largest: there the ball of the relieved nut hardly deforms."""
ROUGH_SPEEDS = (5.0, 20.0, 600.0)
ROUGH_LOADS = (0.0, 1000.0, 2000.0)
SLOW, ONSET, CLEAR = 5.0, 12.0, 40.0
"""Screw speeds well inside, at the edge and outside of asperity contact [rev/min]."""
STRIBECK_SPEEDS = (2.0, 5.0, 8.0, 12.0, 16.0, 25.0, 50.0, 100.0, 200.0, 600.0, 1000.0)
MAP_SPEEDS = (5.0, 10.0, 15.0, 25.0, 80.0, 300.0, 1000.0)
MAP_LOADS = (50.0, 150.0, 400.0, 1000.0, 1700.0, 2400.0)
OTHER_SPEEDS = (12.0, 25.0, 50.0, 100.0)
EFFICIENCY_LOAD = 1000.0
"""Axial load at which efficiencies are compared over speed [N], about the preload."""


def _fractal(draws: int) -> Iterator[StudyTask]:
    yield StudyTask(kind='contact', rpm=SLOW, load=PRELOAD, draw=0, fields='map')


def _stribeck(draws: int) -> Iterator[StudyTask]:
    for draw in range(screw_draws(draws)):
        for rpm in STRIBECK_SPEEDS:
            yield StudyTask(kind='screw', rpm=rpm, load=PRELOAD, draw=draw)


def _smooth_speed(draws: int) -> Iterator[StudyTask]:
    for rpm in SMOOTH_SPEEDS:
        yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD, fields='line')


def _smooth_load(draws: int) -> Iterator[StudyTask]:
    for load in LOADS:
        yield StudyTask(kind='contact', rpm=MARK_RPM, load=load, fields='line')
    for load in RELIEVED_LOADS:
        yield StudyTask(kind='contact', rpm=MARK_RPM, load=load, case=RELIEVED)


def _rough_speed(draws: int) -> Iterator[StudyTask]:
    for rpm in ROUGH_SPEEDS:
        yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD, draw=0, fields='line')


def _rough_load(draws: int) -> Iterator[StudyTask]:
    for load in ROUGH_LOADS:
        yield StudyTask(kind='contact', rpm=SLOW, load=load, draw=0, fields='line')
    for draw in range(draws):
        for load in ROUGH_LOADS:
            for rpm in (SLOW, ONSET, MARK_RPM):
                yield StudyTask(kind='contact', rpm=rpm, load=load, draw=draw)
        yield StudyTask(kind='contact', rpm=CLEAR, load=PRELOAD, draw=draw)
        for load in ROUGH_LOADS[1:]:
            yield StudyTask(kind='contact', rpm=ONSET, load=load, draw=draw, case=RELIEVED)


def _film_speed(draws: int) -> Iterator[StudyTask]:
    yield from _stribeck(draws)
    for rpm in STRIBECK_SPEEDS:
        yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD)


def _maps(draws: int) -> Iterator[StudyTask]:
    for draw in range(map_draws(draws)):
        for load in MAP_LOADS:
            for rpm in MAP_SPEEDS:
                yield StudyTask(kind='screw', rpm=rpm, load=load, draw=draw)


def _alternatives(draws: int) -> Iterator[StudyTask]:
    yield from _maps(draws)
    yield from _smooth_load(draws)
    yield from _rough_load(draws)
    yield from _stribeck(draws)
    for load in LOADS:
        yield StudyTask(kind='contact', rpm=MARK_RPM, load=load, case=SHORT)
        yield StudyTask(kind='formulas', rpm=MARK_RPM, load=load)
        yield StudyTask(kind='formulas', rpm=SLOW, load=load)
    for rpm in sorted({*STRIBECK_SPEEDS, *MAP_SPEEDS}):
        yield StudyTask(kind='formulas', rpm=rpm, load=PRELOAD)
        yield StudyTask(kind='formulas', rpm=rpm, load=EFFICIENCY_LOAD)
    yield StudyTask(kind='contact', rpm=MARK_RPM, load=PRELOAD, case=THIN)
    for draw in range(screw_draws(draws)):
        for rpm in OTHER_SPEEDS:
            yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD, draw=draw, case=THIN)
            yield StudyTask(kind='contact', rpm=rpm, load=PRELOAD, draw=draw, case=HIGH)


NEEDS = {
    '4': _fractal,
    '6b': _stribeck,
    '7': _smooth_speed,
    '8': _smooth_load,
    '9': _rough_speed,
    '10': _rough_load,
    '11': _film_speed,
    '12': _maps,
    '13': _maps,
    'alternatives': _alternatives,
}
"""What each figure solves, given the draws of the contacts; keys are the study's numbers."""


def screw_draws(draws: int) -> int:
    """Return the draws of the whole screw, which is dear: a third of those of the contacts."""
    return max(1, draws // 3)


def map_draws(draws: int) -> int:
    """Return the draws of each point of the map: a sixth of those of the contacts."""
    return max(1, draws // 6)


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
