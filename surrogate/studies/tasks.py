# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tasks that the comparison with the published study solves, by the figure that needs them.

A task is one solve: a contact, smooth or with one draw of the study's roughness, which stands
still; the whole screw in the full tier, whose roughness rolls, or stands still for comparison; or
the screw by published formulas. Speeds are those of the screw; contacts take the study's own
entrainment, w r_m / 2.

"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

from surrogate.files import InputError

SCREW, OIL = 'nominal', 'iso_vg_68'
"""Datasheets of the published screw."""
SMOOTH = -1
"""Draw of a task without roughness [-]."""
OURS, RELIEVED, SHORT, STANDING = 'ours', 'relieved nut', 'short inlet', 'standing'
"""Cases: our assumptions and the loaded nut, or with one other: relieved nut, a short inlet,
roughness of the screw that stands still instead of rolling."""
SHORT_INLET, SHORT_VISCOSITY = 1.5, 0.113
"""Closed inlet of the third case in half-widths [-], and its viscosity [Pa s]: with so little
inlet that is what makes the published film of 153 nm."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StudyTask:
    """
    One solve: kind, screw speed [rev/min], axial load [N], draw of the roughness, case.

    The kind is `contact`, `screw` or `formulas`. `fields` keeps what a picture of the contact
    needs: nothing, the centre `line`, or all nodes, `map`.

    """

    kind: str
    rpm: float
    load: float
    draw: int = SMOOTH
    case: str = OURS
    fields: str = ''

    @property
    def key(self) -> str:
        """Name of the task."""
        name = f'{self.kind}_{self.case}_{self.rpm:g}rpm_{self.load:g}N_draw{self.draw}'
        return name.replace(' ', '-')

    @property
    def rolls(self) -> bool:
        """Whether the asperity law decides what touches."""
        return self.kind == 'screw' and self.case == OURS


PRELOAD = 0.0
"""Axial load of a screw under preload alone [N]."""
MARK_RPM = 600.0
"""Screw speed of the published central film [rev/min]: 502.65 mm/s by w r_m / 2."""
REPORTED_FILM = 153.0
"""Central film at that speed and preload only, published for the rough surface [nm]."""
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


def points(
    kind: str,
    speeds: Iterable[float],
    loads: Sequence[float],
    draws: Sequence[int] = (SMOOTH,),
    **more: str,
) -> list[StudyTask]:
    """Return the tasks of a grid of speeds [rev/min], axial loads [N] and draws."""
    return [
        StudyTask(kind=kind, rpm=rpm, load=load, draw=draw, **more)
        for rpm, load, draw in product(speeds, loads, draws)
    ]


def solves(draws: int) -> dict[str, list[StudyTask]]:
    """Return what each figure solves, given the draws of the contacts."""
    preload, every = [PRELOAD], range(draws)
    speeds = points('screw', SPEEDS, preload)
    speeds += points('screw', SPEEDS, preload, [0], case=STANDING)
    smooth_load = points('contact', [MARK_RPM], LOADS, fields='line')
    smooth_load += points('contact', [MARK_RPM], RELIEVED_LOADS, case=RELIEVED)
    rough_load = points('contact', [SLOW], ROUGH_LOADS, [0], fields='line')
    rough_load += points('contact', (SLOW, ONSET, MARK_RPM), ROUGH_LOADS, every)
    rough_load += points('contact', [SLOW], ROUGH_LOADS[1:], every, case=RELIEVED)
    stribeck = speeds + points('contact', ROUGH_SPEEDS, preload, every)
    maps = points('screw', SPEEDS, MAP_LOADS)
    trends = maps + smooth_load + rough_load + stribeck
    trends += points('screw', SPEEDS, [EFFICIENCY_LOAD], [0], case=STANDING)
    trends += points('screw', [MARK_RPM], MAP_LOADS, [0], case=STANDING)
    trends += points('contact', [MARK_RPM], LOADS, case=SHORT)
    trends += points('formulas', [MARK_RPM], LOADS)
    trends += points('formulas', SPEEDS, (PRELOAD, EFFICIENCY_LOAD))
    return {
        '4': points('contact', [SLOW], preload, [0], fields='map'),
        '6b': speeds,
        '7': points('contact', SMOOTH_SPEEDS, preload, fields='line'),
        '8': smooth_load,
        '9': points('contact', SHOWN_SPEEDS, preload, [0], fields='line'),
        '10': rough_load,
        '11': stribeck,
        '12': maps,
        '13': maps,
        'trends': trends,
    }


FIGURES = tuple(solves(1))
"""Figures by the study's numbers."""


def tasks(figures: Iterable[str], draws: int) -> list[StudyTask]:
    """
    Return every task of some figures once, in order; what keeps most fields is the one kept.

    Raises InputError for a figure that is not made, or less than one draw.

    """
    if draws < 1:
        raise InputError(f'draws is {draws}, allowed is 1 or more')
    kept: dict[str, StudyTask] = {}
    needed, richness = solves(draws), ('', 'line', 'map').index
    for figure in figures:
        if figure not in needed:
            raise InputError(f'figure is {figure!r}, allowed are {", ".join(FIGURES)}')
        for task in needed[figure]:
            known = kept.setdefault(task.key, task)
            if richness(task.fields) > richness(known.fields):
                kept[task.key] = task
    return list(kept.values())
