# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Measured torque over speed without load: what an identification starts from, and its CSV.

The first line of a CSV that is no comment (#) names the columns, each with its unit: speed_rpm or
speed_rad_s and torque_Nm or torque_mNm, or current_A with a torque constant; if wanted
torque_std_Nm, load_N and temperature_degC. Any other column is left alone.

"""

from collections.abc import Mapping
from dataclasses import dataclass
import math
from pathlib import Path
import re

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.limits import read_text, TABLE
from surrogate.units import RPM, ZERO_CELSIUS

Array = NDArray[np.float64]

UNITS: dict[str, dict[str, tuple[float, float]]] = {
    'speed': {'rpm': (RPM, 0.0), 'rad_s': (1.0, 0.0)},
    'torque': {'Nm': (1.0, 0.0), 'mNm': (1e-3, 0.0)},
    'current': {'A': (1.0, 0.0), 'mA': (1e-3, 0.0)},
    'torque_std': {'Nm': (1.0, 0.0), 'mNm': (1e-3, 0.0)},
    'load': {'N': (1.0, 0.0), 'kN': (1e3, 0.0)},
    'temperature': {'degC': (1.0, ZERO_CELSIUS), 'K': (1.0, 0.0)},
}
"""Factor and shift to SI of each unit of each quantity."""
MEASURED = ('torque', 'current')
STANDSTILL = 0.01
"""Screw speed below which friction has no sure direction [rad/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class NoLoadRun:
    """
    Torque measured at steady speeds, one entry per point; arrays of one length.

    Screw speed [rad/s] and torque on the screw [N m], the sign of both is the direction; standard
    deviation of the torque [N m], None where it is not known; axial load [N], positive when it
    opposes positive motion; oil temperature [K]. `source` names the data, `notes` say what was
    left out.

    """

    speed: Array
    torque: Array
    torque_std: Array | None
    load: Array
    temperature: Array
    source: str
    notes: tuple[str, ...] = ()

    @property
    def direction(self) -> Array:
        """Sign of the motion [-]."""
        return np.sign(self.speed)

    @property
    def both_directions(self) -> bool:
        """Tell whether there is a point in either direction."""
        return bool((self.speed > 0).any() and (self.speed < 0).any())

    @property
    def mean_temperature(self) -> float:
        """Mean temperature of the oil [K]."""
        return float(self.temperature.mean())


def no_load_run(
    columns: Mapping[str, Array], *, source: str, temperature: float, notes: tuple[str, ...] = ()
) -> NoLoadRun:
    """
    Return a run made of `columns` in SI units by quantity, without the points at standstill.

    `temperature` [K] holds where there is no such column. Raises InputError for a number that is
    not finite and for a standard deviation that is not positive.

    """
    for name, values in columns.items():
        bad = ~np.isfinite(values) | ((values <= 0) & (name == 'torque_std'))
        if bad.any():
            allowed = 'a finite number' + (' above 0' if name == 'torque_std' else '')
            raise InputError(
                f'{source}: {name} of point {int(np.argmax(bad)) + 1} is '
                f'{values[bad][0]:g}, allowed is {allowed}'
            )
    moving = np.abs(columns['speed']) >= STANDSTILL
    left = int((~moving).sum())
    kept = {name: np.asarray(values, dtype=float)[moving] for name, values in columns.items()}
    zero = np.zeros(int(moving.sum()))
    return NoLoadRun(
        speed=kept['speed'],
        torque=kept['torque'],
        torque_std=kept.get('torque_std'),
        load=kept.get('load', zero),
        temperature=kept.get('temperature', zero + temperature),
        source=source,
        notes=notes + ((f'{left} points at standstill are left out',) if left else ()),
    )


def read_drag_csv(
    path: str | Path,
    *,
    speed_column: str | None = None,
    torque_column: str | None = None,
    torque_constant: float | None = None,
) -> dict[str, Array]:
    """
    Read the columns of a CSV in SI units; raises InputError with file, line and cell.

    `speed_column` and `torque_column` name columns with a unit at their end, such as
    motor_speed_rpm, in place of speed_rpm and torque_Nm. With a `torque_constant` [N m/A] a
    current stands for the torque.

    """
    path = Path(path)
    lines = _lines(path)
    number, header = lines[0]
    names = _cells(header)
    measured = 'torque' if torque_constant is None else 'current'
    chosen = {'speed': speed_column, measured: torque_column}
    _refuse_bare_current(path, names, torque_column, torque_constant)
    found = {name: _find(path, names, name, chosen.get(name), measured) for name in UNITS}
    columns = {name: place for name, place in found.items() if place is not None}
    rows = [_row(path, line, text, len(names), columns) for line, text in lines[1:]]
    if not rows:
        raise InputError(f'{path}: has no numbers below line {number}, which names the columns')
    table = np.array(rows)
    read = {name: table[:, column] for column, name in enumerate(columns)}
    if torque_constant is not None:
        read['torque'] = torque_constant * read.pop('current')
    return read


def _lines(path: Path) -> list[tuple[int, str]]:
    """Return the lines that say something, with their numbers."""
    try:
        text = read_text(path, encoding='utf-8-sig', most=TABLE)
    except OSError as error:
        raise InputError(f'{path}: cannot be read, {error.strerror}') from None
    except InputError as error:
        raise InputError(f'{path}: cannot be read, {error}') from None
    except UnicodeDecodeError:
        raise InputError(f'{path}: cannot be read as text, a CSV is wanted') from None
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip(' ,;\t') and not line.lstrip().startswith('#')
    ]
    if not lines:
        raise InputError(f'{path}: is empty, a line that names the columns comes first')
    return lines


def _cells(line: str) -> list[str]:
    return [cell.strip().strip('"') for cell in re.split(r'[,;\t]', line.strip())]


def _refuse_bare_current(
    path: Path, names: list[str], torque_column: str | None, constant: float | None
) -> None:
    """Refuse a current without its constant [N m/A], and a constant that is no number."""
    known = [f'torque_{unit}' for unit in UNITS['torque']]
    currents = [name for name in names if name in [f'current_{one}' for one in UNITS['current']]]
    if constant is None and currents and not torque_column and not set(known) & set(names):
        raise InputError(
            f'{path}: has {currents[0]} and no torque, allowed is a current with '
            '--torque-constant K, torque on the screw over current [N m/A]'
        )
    if constant is not None and not (math.isfinite(constant) and constant):
        raise InputError(
            f'--torque-constant is {constant:g} N m/A, allowed is a finite number other than 0'
        )


def _find(
    path: Path, names: list[str], quantity: str, chosen: str | None, measured: str
) -> tuple[int, float, float] | None:
    """
    Return place, factor and shift of the column of a quantity, None where it may be absent.

    `measured` is what gives the torque, torque or current; the other one is left alone.

    """
    if quantity in MEASURED and quantity != measured:
        return None
    units = UNITS[quantity]
    allowed = ', '.join(f'{quantity}_{unit}' for unit in units)
    if chosen is None:
        known = [f'{quantity}_{unit}' for unit in units]
        hits = [name for name in names if name in known]
        if not hits:
            _refuse_wrong_unit(path, names, quantity, allowed)
    else:
        hits = [name for name in names if name == chosen]
    if len(hits) > 1:
        raise InputError(f'{path}: {" and ".join(hits)} both stand for the {quantity}, keep one')
    if not hits:
        if chosen is None and quantity not in ('speed', measured):
            return None
        raise InputError(
            f'{path}: column {chosen or allowed.replace(", ", " or ")} is missing, the file has '
            f'{", ".join(names)}; --speed-column and --torque-column name others'
        )
    unit = next((unit for unit in units if hits[0].endswith(f'_{unit}')), None)
    if unit is None:
        raise InputError(
            f'{path}: column {hits[0]} has no unit of a {quantity} at its end, allowed are '
            f'{", ".join(f"_{unit}" for unit in units)}'
        )
    return names.index(hits[0]), *units[unit]


def _refuse_wrong_unit(path: Path, names: list[str], quantity: str, allowed: str) -> None:
    """Refuse a column whose name is that of the quantity and whose unit is not."""
    others = tuple(f'{other}_' for other in UNITS if other.startswith(f'{quantity}_'))
    for name in names:
        if re.match(rf'{quantity}(_|$)', name) and not (others and name.startswith(others)):
            raise InputError(f'{path}: column {name} has a wrong unit, allowed are {allowed}')


def _row(
    path: Path, line: int, text: str, width: int, columns: dict[str, tuple[int, float, float]]
) -> list[float]:
    cells = _cells(text)
    if len(cells) != width:
        raise InputError(f'{path}: line {line} has {len(cells)} cells, the header has {width}')
    row = []
    for name, (place, factor, shift) in columns.items():
        try:
            value = float(cells[place])
        except ValueError:
            value = math.nan
        positive = name == 'torque_std'
        if not math.isfinite(value) or (positive and value <= 0):
            raise InputError(
                f'{path}: line {line} has {cells[place]!r} as {name}, allowed is a finite number'
                + (' above 0' if positive else '')
            )
        row.append(value * factor + shift)
    return row
