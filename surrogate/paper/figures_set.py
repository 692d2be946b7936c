# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The set of pictures beside the published study: which rows each one draws, and its file."""

from collections.abc import Callable, Iterator
from pathlib import Path

from matplotlib.figure import Figure
from surrogate.paper.cases import (
    LOADS,
    MARK_RPM,
    PRELOAD,
    ROUGH_LOADS,
    SHOWN_SPEEDS,
    SLOW,
    SMOOTH,
    SMOOTH_SPEEDS,
    StudyTask,
)
from surrogate.paper.figures_contact import (
    Drawn,
    figure_fractal,
    figure_rough,
    figure_smooth_load,
    figure_smooth_speed,
)
from surrogate.paper.figures_map import figure_maps, figure_zone
from surrogate.paper.figures_screw import figure_stribeck, figure_torque, MeasuredTorque
from surrogate.paper.figures_trends import figure_trends
from surrogate.paper.raceway import published_patch
from surrogate.paper.solve import SHORTEST_ON_GRID
from surrogate.paper.study import SCREW, Study
from surrogate.parameters import load_screw
from surrogate.plotting.style import draw_picture
from surrogate.raceway.short_waves import without_short_waves
from surrogate.screw.opened import Contacts

SHOWN_LOADS = tuple(LOADS[i] for i in (0, 2, 4, 5))
"""Axial loads whose profiles are drawn [N]."""


def draw_figures(
    study: Study, figures: tuple[str, ...], measured: MeasuredTorque | None = None
) -> Iterator[Path]:
    """Draw some figures of a study into its folder; yield the paths."""
    for figure in figures:
        for name, draw in _pictures(study, figure, measured).items():
            yield draw_picture(study.folder / f'paper_{name}.png', draw)


def _pictures(
    study: Study, figure: str, measured: MeasuredTorque | None
) -> dict[str, Callable[[], Figure]]:
    """Return the pictures of one figure of the study by file name."""
    rows, screw = study.rows, load_screw(SCREW)
    law = Contacts.of(screw).law
    every = list(rows.values())
    pictures: dict[str, dict[str, Callable[[], Figure]]] = {
        '4': {'04_surface': lambda: _fractal(study)},
        '6b': {'06b_torque': lambda: figure_torque(every, measured)},
        '7': {
            '07_smooth_speed': lambda: figure_smooth_speed(
                _drawn(study, SMOOTH, [(rpm, PRELOAD) for rpm in SMOOTH_SPEEDS])
            )
        },
        '8': {
            '08_smooth_load': lambda: figure_smooth_load(
                _drawn(study, SMOOTH, [(MARK_RPM, load) for load in SHOWN_LOADS]), every
            )
        },
        '9': {
            '09_rough_speed': lambda: figure_rough(
                _drawn(study, 0, [(rpm, PRELOAD) for rpm in SHOWN_SPEEDS])
            )
        },
        '10': {
            '10_rough_load': lambda: figure_rough(
                _drawn(study, 0, [(SLOW, load) for load in ROUGH_LOADS])
            )
        },
        '11': {'11_stribeck': lambda: figure_stribeck(law, every)},
        '12': {'12_maps': lambda: figure_maps(screw, every)},
        '13': {'13_zone': lambda: figure_zone(screw, law, every)},
        'trends': {'trends': lambda: figure_trends(screw, every)},
    }
    return pictures[figure]


def _drawn(study: Study, draw: int, points: list[tuple[float, float]]) -> list[Drawn]:
    """Return row and fields of converged contacts at speeds [rev/min] and axial loads [N]."""
    keys = [StudyTask(kind='contact', rpm=rpm, load=load, draw=draw).key for rpm, load in points]
    solved = [key for key in keys if study.rows[key].status == 'CONVERGED']
    return [(study.rows[key], study.fields(key)) for key in solved]


def _fractal(study: Study) -> Figure:
    screw = load_screw(SCREW)
    raceway = without_short_waves(published_patch(screw, 0), SHORTEST_ON_GRID)
    return figure_fractal(_drawn(study, 0, [(SLOW, PRELOAD)])[0], raceway)
