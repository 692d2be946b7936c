# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Picture of the onset of contact over the pressure at which summits are cut."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
import numpy as np
from surrogate.parameters import Lubricant, Screw
from surrogate.plotting.style import BLUE, draw_picture, new_figure, ORANGE, VERMILION
from surrogate.screw.screw_onset import ABOVE, onset_over_pressure
from surrogate.units import GIGA, RPM, ZERO_CELSIUS

PRESSURES = 0.5e9, 20e9
"""Cutting pressures that a sheet may state [Pa]."""
STEPS = 8
"""Cutting pressures along the curve [-]."""


def draw_onset(
    folder: Path, screw: Screw, lubricant: Lubricant, record: Mapping[str, Any]
) -> Path:
    """Draw the onset of a screw and oil into a folder and return the path of the picture."""
    name = f'onset_{record["screw"]}_{record["oil"]}.png'
    return draw_picture(folder / name, lambda: figure_onset(screw, lubricant, record))


def figure_onset(screw: Screw, lubricant: Lubricant, record: Mapping[str, Any]) -> Figure:
    """Return the onset speed over the cutting pressure, with hardness and running-in marked."""
    low, high = next(iter(record['states'].values()))['band']
    sheet = screw.roughness
    screw = replace(screw, working_load=record['working_load_N'])
    least = max(ABOVE * record['working_pressure_Pa'], 0.8 * sheet.run_in_low)
    least, most = np.clip([least, 1.2 * sheet.hardness], *PRESSURES)
    pressures = np.geomspace(least, most, STEPS)
    place = record['load_N'], record['temperature_K']
    speed = np.array(onset_over_pressure(screw, lubricant, *place, pressures.tolist())) / RPM
    figure = new_figure(6.4, 4.0)
    axes, giga = figure.subplots(), GIGA * pressures
    axes.fill_between(
        giga, speed * low, speed * high, color=BLUE, alpha=0.2, label=f'within {high:g}'
    )
    axes.plot(giga, speed, color=BLUE, label='onset, RCS 0.01')
    axes.axvspan(
        GIGA * sheet.run_in_low,
        GIGA * sheet.run_in_high,
        color=ORANGE,
        alpha=0.2,
        label='run in, its range',
    )
    axes.axvline(GIGA * sheet.run_in_pressure, color=ORANGE, linestyle='--', label='run in')
    axes.axvline(GIGA * sheet.hardness, color=VERMILION, linestyle=':', label='hardness: new')
    axes.set(
        xscale='log',
        yscale='log',
        xlabel='pressure at which summits are cut [GPa]',
        ylabel='speed at which contact begins [rev/min]',
        title=f'{record["screw"]}, {record["oil"]}, {record["load_N"]:g} N, '
        f'{record["temperature_K"] - ZERO_CELSIUS:g} °C',
    )
    ticks = [one for one in (1, 1.5, 2, 3, 5, 7, 10) if giga[0] <= one <= giga[-1]]
    axes.set_xticks(ticks, [f'{one:g}' for one in ticks])
    axes.minorticks_off()
    axes.legend(loc='lower right')
    return figure
