# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Build a surface: choose the nodes, solve them, and measure the interpolation error in every cell.

The error of a cell is the difference between the lookup and a solve at the cell's centre, a point
that is no node.

"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
import math
import platform
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray
import scipy
from surrogate.files import InputError
from surrogate.formulas.load_sharing import UNLOADING_RATIO
from surrogate.formulas.lubricant import lubricant_state
from surrogate.formulas.shaft import service_of
from surrogate.formulas.sliding import largest_sliding
from surrogate.parameters import Lubricant, Screw, screw_and_oil
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.screw.point import kept_point
from surrogate.screw.screw_onset import onset_speeds
from surrogate.surface import FIELDS, SolvedPoint, Surface
from surrogate.surface.file import FORMAT, FORMAT_VERSION, SurfaceData
from surrogate.tasks.progress import OnProgress
from surrogate.units import ZERO_CELSIUS

Array = NDArray[np.float64]

SLOWEST_SPEED = 0.05
"""Default lower end of the speed range [rad/s], well below any standstill gate."""
LOADS_IN_PRELOADS = 4.0
LOADS_IN_RATINGS = 0.1


@dataclass(frozen=True, kw_only=True, slots=True)
class SurfaceSettings:
    """
    Ranges and nodes of a surface.

    Speeds [rad/s] and loads [N] and temperatures [K] as (low, high), covered everywhere. Numbers
    of nodes: along speed, along load per side below and above unloading, along temperature.

    """

    speed_range: tuple[float, float]
    load_range: tuple[float, float]
    temperature_range: tuple[float, float]
    speed_nodes: int = 40
    load_cells: int = 13
    unloaded_cells: int = 3
    temperature_nodes: int = 9


def default_settings(screw: Screw) -> SurfaceSettings:
    """Return 0.05 rad/s to the screw's speed limit, four preloads either way, 10 to 80 degC."""
    reach = LOADS_IN_PRELOADS * screw.preload or LOADS_IN_RATINGS * screw.static_rating
    return SurfaceSettings(
        speed_range=(SLOWEST_SPEED, screw.fastest_speed),
        load_range=(-reach, reach),
        temperature_range=(10 + ZERO_CELSIUS, 80 + ZERO_CELSIUS),
    )


def build_closed_form(
    screw: Screw,
    lubricant: Lubricant,
    settings: SurfaceSettings,
    *,
    progress: OnProgress = lambda done, total: None,
) -> SurfaceData:
    """
    Build the surface of the closed-form tier; `progress(done, total)` counts solved slices.

    Raises InputError for a range that is reversed, empty or leaves the oil's datasheet.

    """
    check_rough(screw)
    check_ranges(settings, lubricant)
    started, opened = time.perf_counter(), Contacts.of(screw)
    load, breaks = load_nodes(screw, settings)
    temperature = temperature_nodes(
        lubricant, settings.temperature_range, settings.temperature_nodes
    )
    log_onset = np.log(onset_speeds(opened, lubricant, load, temperature))
    s = speed_coordinates(settings, log_onset)
    total = 2 * len(temperature) - 1
    nodes = solve_grid(
        opened, lubricant, s, load, temperature, log_onset, lambda done: progress(done, total)
    )
    axes = (s, load, temperature)
    data = SurfaceData(
        header=surface_header(screw, lubricant, settings, breaks, closed_form.TIER),
        speed_coordinate=s,
        load=load,
        temperature=temperature,
        log_onset=log_onset,
        fields={name: nodes[name] for name in FIELDS},
        errors={name: np.full([len(axis) - 1 for axis in axes], np.nan) for name in FIELDS},
        worst_contact=nodes['worst_contact'].astype(np.uint8),
        mask=~np.all([np.isfinite(nodes[name]) for name in FIELDS], axis=0),
    )
    errors = measure_errors(
        opened, lubricant, data, lambda done: progress(len(temperature) + done, total)
    )
    return replace(data, errors=errors, provenance=provenance(time.perf_counter() - started))


def solve_closed_form(
    header: Mapping[str, Any], speed: float, load: float, temperature: float
) -> SolvedPoint:
    """Solve a point [rad/s, N, K] as the closed-form surface of this header was solved."""
    screw, lubricant = screw_and_oil(header['inputs'])
    opened = Contacts.of(screw)
    return kept_point(closed_form.solve(opened, lubricant, speed, load, temperature))


def load_nodes(screw: Screw, settings: SurfaceSettings) -> tuple[Array, list[float]]:
    """
    Return load nodes [N] and, among them, the break nodes: zero and the unloading load.

    Nodes crowd towards the unloading load, where what the relieved nut carries runs out as a
    power.

    """
    low, high = settings.load_range
    unloading = UNLOADING_RATIO * screw.preload
    steps = np.linspace(0.0, 1.0, settings.load_cells + 1)
    if unloading > 0:
        inner = unloading * (1 - (1 - steps) ** 3)
        reach = max(abs(low), abs(high))
        outer = np.linspace(unloading, max(reach, unloading), settings.unloaded_cells + 1)[1:]
        side = np.concatenate([inner, outer])
    else:
        side = max(abs(low), abs(high)) * steps
    nodes = np.unique(np.concatenate([-side, side, [low, high]]))
    nodes = nodes[(nodes >= low) & (nodes <= high)]
    breaks = [load for load in (-unloading, 0.0, unloading) if load in nodes]
    return nodes, sorted(set(breaks))


def temperature_nodes(lubricant: Lubricant, ends: tuple[float, float], number: int) -> Array:
    """Return temperatures [K] between the ends, even in the logarithm of the viscosity."""
    fine = np.linspace(*ends, 400)
    logs = np.log(lubricant_state(lubricant, fine).viscosity)
    nodes = np.interp(-np.linspace(logs[0], logs[-1], number), -logs, fine)
    nodes[[0, -1]] = ends
    return np.asarray(nodes)


def speed_coordinates(settings: SurfaceSettings, log_onset: Array) -> Array:
    """Return nodes of s that cover the speed range everywhere and crowd the onset at s = 0."""
    low, high = settings.speed_range
    ends = np.arcsinh([math.log(low) - log_onset.max(), math.log(high) - log_onset.min()])
    return np.sinh(np.linspace(ends[0], ends[1], settings.speed_nodes))


def measure_errors(
    opened: Contacts, lubricant: Lubricant, data: SurfaceData, step: Callable[[int], None]
) -> dict[str, Array]:
    """
    Return, per field and cell, |lookup - solve| at the centre of the cell.

    NaN where the cell is masked or its centre lies outside the speed range.

    """
    surface = Surface(data)
    s, load, temperature = (
        0.5 * (axis[1:] + axis[:-1])
        for axis in (data.speed_coordinate, data.load, data.temperature)
    )
    log_onset = np.log(
        [[surface.onset_speed(force, heat) for heat in temperature] for force in load]
    )
    solved = solve_grid(opened, lubricant, s, load, temperature, log_onset, step)
    points = [
        surface.lookup(math.exp(s[i] + log_onset[j, k]), float(load[j]), float(temperature[k]))
        for i, j, k in np.ndindex(len(s), len(load), len(temperature))
    ]
    return {
        name: np.abs(
            np.reshape([getattr(point, name) for point in points], solved[name].shape)
            - solved[name]
        )
        for name in FIELDS
    }


def solve_grid(
    opened: Contacts,
    lubricant: Lubricant,
    s: Array,
    load: Array,
    temperature: Array,
    log_onset: Array,
    step: Callable[[int], None] = lambda done: None,
) -> dict[str, Array]:
    """
    Return fields and worst contacts at mapped speeds [-], loads [N] and temperatures [K].

    Slice by slice of temperature, which bounds the memory; `step` counts them.

    """
    slices: dict[str, list[Array]] = {name: [] for name in (*FIELDS, 'worst_contact')}
    for k, heat in enumerate(temperature):
        speed = np.exp(s[:, None] + log_onset[None, :, k])
        result = closed_form.solve(opened, lubricant, speed, load, heat)
        for name, values in slices.items():
            values.append(getattr(result, name))
        step(k + 1)
    return {name: np.stack(values, axis=-1) for name, values in slices.items()}


def check_rough(screw: Screw) -> None:
    """Refuse a screw whose film ratio is infinite: InputError."""
    if not screw.composite_rms:
        raise InputError(
            f'screw {screw.name}: rms_um of roughness is 0 um and the ball is smooth, allowed is '
            'above 0 for a surface: its film ratio would be infinite'
        )


def check_ranges(settings: SurfaceSettings, lubricant: Lubricant) -> None:
    """Raise InputError for a range that is reversed, empty or leaves the oil's datasheet."""
    for name, unit, (low, high) in (
        ('speed range', 'rad/s', settings.speed_range),
        ('load range', 'N', settings.load_range),
        ('temperature range', 'K', settings.temperature_range),
    ):
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise InputError(
                f'{name} is {low:g} to {high:g} {unit}, allowed is a low end below a high end'
            )
    if settings.speed_range[0] <= 0:
        raise InputError(
            f'speed range begins at {settings.speed_range[0]:g} rad/s, allowed is above 0'
        )
    low, high = settings.temperature_range
    if low < lubricant.minimum_temperature or high > lubricant.maximum_temperature:
        raise InputError(
            f'temperature range is {low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC, '
            f'oil {lubricant.name} allows {lubricant.minimum_temperature - ZERO_CELSIUS:g} to '
            f'{lubricant.maximum_temperature - ZERO_CELSIUS:g} degC'
        )


def surface_header(
    screw: Screw, lubricant: Lubricant, settings: SurfaceSettings, breaks: list[float], tier: str
) -> dict[str, Any]:
    """Return the hashed part of the header, in plain JSON types."""
    return {
        'format': FORMAT,
        'format_version': FORMAT_VERSION,
        'tier': tier,
        'inputs': {'screw': screw.stated(), 'lubricant': lubricant.stated()},
        'service': service_of(screw),
        'sliding_m_per_rad': largest_sliding(screw),
        'settings': {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in asdict(settings).items()
        },
        'load_breaks': breaks,
    }


def provenance(seconds: float) -> dict[str, Any]:
    """Return when, in how many seconds and by what a surface was built."""
    return {
        'built': time.strftime('%Y-%m-%dT%H:%M:%SZ', time.gmtime()),
        'build_seconds': round(seconds, 3),
        'machine': platform.machine(),
        'python': platform.python_version(),
        'numpy': np.__version__,
        'scipy': scipy.__version__,
    }
