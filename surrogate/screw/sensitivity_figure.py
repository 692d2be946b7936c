# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tornado picture of the sensitivity of a point to its inputs."""

from collections.abc import Mapping
import math
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.patches import Patch
from surrogate.plotting.style import BLUE, draw_picture, GREY, new_figure, ORANGE, SKY
from surrogate.screw.sensitivity import EFFICIENCY_SPEED, ONSET, shown, TORQUE
from surrogate.units import RPM, ZERO_CELSIUS

PANELS = {
    ONSET: ('Contact begins', 'speed [rev/min]', RPM),
    TORQUE: ('Friction torque', 'torque [N m]', 1.0),
    EFFICIENCY_SPEED: ('Efficiency falls to 0.85', 'speed [rev/min]', RPM),
}
"""Title, label and unit [SI] of the quantities that are drawn."""
BANDS = {'unknown_band': ('not known', GREY), 'numerical_band': ('numerics', SKY)}
"""Words and colours of the bands of the onset."""
COLOURS = {'low': BLUE, 'high': ORANGE}
"""Colours of the ends of an input."""


def draw_sensitivity(folder: Path, record: Mapping[str, Any]) -> Path:
    """Draw a record of `sensitivity_record` into a folder and return the path of the picture."""
    name = f'sensitivity_{record["screw"]}_{record["oil"]}.png'
    return draw_picture(folder / name, lambda: figure_sensitivity(record))


def figure_sensitivity(record: Mapping[str, Any]) -> Figure:
    """Return bars of what each input changes, the largest on top, and the bands of the onset."""
    panels = [name for name in PANELS if math.isfinite(record['stated'][name])]
    rows = [*record['inputs'][::-1]]
    figure = new_figure(2.2 + 2.4 * len(panels), 1.6 + 0.28 * (len(rows) + len(BANDS)))
    every = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axes, name in zip(every, panels, strict=True):
        title, label, unit = PANELS[name]
        axes.set(title=title, xlabel=label)
        stated = record['stated'][name] / unit
        for place, row in enumerate(rows):
            ends = [(row[f'at_{end}'][name] / unit - stated, end) for end in COLOURS]
            # The longer bar first, so that it does not hide another on its side.
            for reached, end in sorted(ends, key=lambda one: -abs(one[0])):
                axes.barh(place, reached, left=stated, color=COLOURS[end], height=0.7)
        axes.axvline(stated, color='black', linewidth=0.8)
        axes.grid(axis='x')
    every[0].use_sticky_edges = False
    # Below the bars of the onset, its bands.
    onset = record['stated'][ONSET] / RPM
    every[0].axhline(-0.5, color='black', linewidth=0.8)
    for place, (name, (_, shade)) in enumerate(BANDS.items()):
        low, high = (factor * onset for factor in record[name])
        every[0].barh(-1 - place, high - low, left=low, color=shade, height=0.7)
    every[0].set_yticks(
        range(-len(BANDS), len(rows)),
        [words for words, _ in BANDS.values()][::-1] + [_label(row) for row in rows],
    )
    marks = [Patch(color=colour, label=f'input is {end}') for end, colour in COLOURS.items()]
    every[-1].legend(handles=marks, loc='lower right')
    figure.suptitle(
        f'{record["screw"]}, {record["oil"]}: {record["speed_rad_s"] / RPM:g} rev/min, '
        f'{record["load_N"]:g} N, {record["temperature_K"] - ZERO_CELSIUS:g} °C'
    )
    return figure


def _label(row: Mapping[str, Any]) -> str:
    return f'{row["key"]}  {shown(row["low"])} to {shown(row["high"])}'
