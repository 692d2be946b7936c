# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Columns of a table: quantities that they may be of, their units, and where their names stand."""

from collections.abc import Mapping
import dataclasses

from ballscrew_monitor.core import conversions
from surrogate.files import printable

DAY = 86400.0  # [s]
EPOCHS = {
    'filetime': (1e-7, -11_644_473_600.0),
    'spreadsheet_days': (DAY, -25_569 * DAY),
    'labview_s': (1.0, -2_082_844_800.0),
    'datenum': (DAY, -719_529 * DAY),
    'mjd': (DAY, -40_587 * DAY),
    'dotnet_ticks': (1e-7, -62_135_596_800.0),
    'spreadsheet_microdays': (1e-6 * DAY, -25_569 * DAY),
}
"""
Counts of times since other epochs: a unit of each [s], and their zero [s] since 1970.

They are ticks of 100 ns since 1601, days since 1900, seconds since 1904, days of MATLAB, modified
Julian days, ticks of 100 ns since the year 1, and millionths of days since 1900, as of WinCC.

"""
SINCE_1904 = 1462  # days of a spreadsheet whose days count from 1904
SCALES = {
    unit: (factor, 0.0) for unit, factor in (conversions.TIME_UNITS | {'d': DAY}).items()
} | EPOCHS
"""Units of a time that a map states, each with its factor and shift [s]."""
ORDERS = {'dmy': 'day, month, year', 'mdy': 'month, day, year', 'ymd': 'year, month, day'}
"""Orders of a date in numbers that a map states, in words."""
RATED = '%'  # of the rated torque, or of the current at which the motor gives it
UNITS: dict[str, Mapping[str, float]] = {
    'speed': conversions.LINEAR_SPEED_UNITS | conversions.ROTARY_SPEED_UNITS,
    'position': conversions.LINEAR_POSITION_UNITS | conversions.ROTARY_POSITION_UNITS,
    'table_position': conversions.LINEAR_POSITION_UNITS,
    'load': conversions.LOAD_UNITS,
    'torque': {'N m': 1.0, RATED: 0.01},
    'current': conversions.CURRENT_UNITS | {RATED: 0.01},
    'temperature': conversions.TEMPERATURE_UNITS,
    'time': {unit: factor for unit, (factor, _) in SCALES.items()},
}
"""Units of each kind of column; some need what a map states, as the lead or the rated torque."""
NAMED_BY_MAPS = ('table_position',)
"""Kinds that no name of a column tells, so that maps alone name them."""
MOTION = ('speed', 'position')
OTHER_SIGN = {'.': ',', ',': '.'}
"""Decimal signs, each with the one that then parts thousands."""
INPUTS = tuple(kind for kind in UNITS if kind != 'time')


def column_name(text: str) -> str:
    """Return the name of a column as a map writes it: in one line, without control characters."""
    return printable(' '.join(text.split()))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Layout:
    """Lines before the names of the columns, and rows that these take: names, or units below."""

    skip: int = 0
    header_rows: int = 1
