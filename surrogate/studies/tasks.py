# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tasks that the comparison with the published study solves, by the figure that needs them.

A task is one solve: a contact, smooth or with one draw of the study's roughness, which stands
still, or the whole screw in the full tier, whose roughness rolls. Speeds are those of the screw;
contacts take the study's own entrainment, w r_m / 2.

"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

from surrogate.files import InputError

SCREW, OIL = 'nominal', 'iso_vg_68'
"""Datasheets of the published screw."""
SMOOTH = -1
"""Draw of a task without roughness [-]."""
LOADED, RELIEVED = 'loaded', 'relieved'
"""Nuts of a contact; under preload both are alike."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StudyTask:
    """
    One solve: kind, screw speed [rev/min], axial load [N], draw of the roughness, nut.

    The kind is `contact` or `screw`.

    """

    kind: str
    rpm: float
    load: float
    draw: int = SMOOTH
    nut: str = LOADED

    @property
    def key(self) -> str:
        """Name of the task."""
        return f'{self.kind}_{self.nut}_{self.rpm:g}rpm_{self.load:g}N_draw{self.draw}'


PRELOAD = 0.0
"""Axial load of a screw under preload alone [N]."""
MARK_RPM = 600.0
"""Screw speed of the published central film [rev/min]: 502.65 mm/s by w r_m / 2."""
REPORTED_FILM = 153.0
"""Central film at that speed and preload only, published for the rough surface [nm]."""
LOADS = (0.0, 500.0, 1000.0, 1500.0, 2000.0, 2400.0)
RELIEVED_LOADS = LOADS[:-1]
"""Less the largest: there the ball of the relieved nut hardly deforms."""
ROUGH_SPEEDS = (5.0, 10.0, 15.0, 20.0, 40.0)
ROUGH_LOADS = (0.0, 1000.0, 2000.0)
SLOW = 5.0
"""Screw speed inside asperity contact that stands still [rev/min]."""
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
    speeds, maps = (points('screw', SPEEDS, loads) for loads in (preload, MAP_LOADS))
    contacts = points('contact', ROUGH_SPEEDS, preload, every)
    smooth_load = points('contact', [MARK_RPM], LOADS)
    smooth_load += points('contact', [MARK_RPM], RELIEVED_LOADS, nut=RELIEVED)
    rough_load = points('contact', (SLOW, MARK_RPM), ROUGH_LOADS, every)
    rough_load += points('contact', [SLOW], ROUGH_LOADS[1:], every, nut=RELIEVED)
    return {
        '6b': speeds,
        '11': speeds + contacts,
        '12': maps,
        '13': maps,
        'trends': speeds + maps + contacts + smooth_load + rough_load,
    }


FIGURES = tuple(solves(1))
"""Figures by the study's numbers, and the trends, which are a table."""


def tasks(figures: Iterable[str], draws: int) -> list[StudyTask]:
    """
    Return every task of some figures once, in order.

    Raises InputError for a figure that is not made, or less than one draw.

    """
    if draws < 1:
        raise InputError(f'draws is {draws}, allowed is 1 or more')
    needed: dict[str, StudyTask] = {}
    for figure in figures:
        if figure not in FIGURES:
            raise InputError(f'figure is {figure!r}, allowed are {", ".join(FIGURES)}')
        needed |= {task.key: task for task in solves(draws)[figure]}
    return list(needed.values())
