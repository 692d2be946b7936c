# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""All pictures beside the published study, each declared once, and their files."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from matplotlib.figure import Figure
from surrogate.parameters import load_screw
from surrogate.plotting.style import draw_picture
from surrogate.screw.opened import Contacts
from surrogate.studies import contact_figures as contacts
from surrogate.studies import map_figures as maps
from surrogate.studies import screw_figures as screws
from surrogate.studies.drawing import DECLARED
from surrogate.studies.solve import SCREW, Study


def draw_figures(
    study: Study, figures: Iterable[str], folder: Path, measured: screws.Measured | None = None
) -> Iterator[Path]:
    """Draw some figures of a study into a folder; yield the paths."""
    draw = pictures(study, measured)
    for figure in figures:
        yield draw_picture(folder / f'{DECLARED[figure]["file"]}.png', draw[figure])


def pictures(
    study: Study, measured: screws.Measured | None = None
) -> dict[str, Callable[[], Figure]]:
    """Return what draws each figure of the study."""
    screw, rows = load_screw(SCREW), list(study.rows.values())
    law = Contacts.of(screw).law
    return {
        '4': lambda: contacts.figure_fractal(study, screw),
        '6b': lambda: screws.figure_torque(rows, measured),
        '7': lambda: contacts.figure_smooth_speed(study),
        '8': lambda: contacts.figure_smooth_load(study),
        '9': lambda: contacts.figure_rough(study, '9'),
        '10': lambda: contacts.figure_rough(study, '10'),
        '11': lambda: screws.figure_stribeck(law, rows),
        '12': lambda: maps.figure_maps(screw, rows),
        '13': lambda: maps.figure_zone(screw, law, rows),
        'trends': lambda: screws.figure_trends(screw, rows),
    }
