# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Style of all pictures: colours, style sheet, empty figures and their files."""

from collections.abc import Callable
from pathlib import Path

from matplotlib import style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from surrogate.files import new_file

DPI = 120
"""Resolution [1/inch]."""
BLUE, VERMILION, GREEN, PURPLE, GREY = '#0072b2', '#d55e00', '#009e73', '#7b2d8e', '#6f6f6f'
ORANGE, YELLOW, SKY, BROWN = '#e69f00', '#f0e442', '#56b4e9', '#a8433a'
"""Colours that colour-blind readers keep apart, and a print in grey; mostly Okabe and Ito's."""
REGIMES_BY_METAL = '#8f4aa3', '#c9a3d6', '#e9d8ef'
"""Boundary, mixed and hydrodynamic, here and on pages: the more metal touches, the darker."""
MAP = 'cividis'
"""Colour map of a quantity without a sign."""
LESS_IS_GOOD = f'{MAP}_r'
"""Colour map of a quantity that is bad where it is large, beside others: bright is good."""

styled = style.context(str(Path(__file__).with_name('ballscrew.mplstyle')))
"""Decorator of a function that draws: in the style of all pictures."""


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of a `width` and a `height` [inch]."""
    figure = Figure(figsize=(width, height), dpi=DPI, layout='constrained')
    FigureCanvasAgg(figure)
    return figure


def save(figure: Figure, path: Path) -> Path:
    """Write a PNG, which appears only when it is complete, and return its path."""
    with new_file(path) as file:
        figure.savefig(file, format='png')
    return path


@styled
def draw_picture(path: Path, make: Callable[[], Figure]) -> Path:
    """Make a figure in the style of all pictures, write it as PNG and return its path."""
    return save(make(), path)
