# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The only factors between units: SI inside, others where numbers come in or are shown."""

from decimal import Decimal
import math

TURN = 2 * math.pi
"""One revolution [rad]."""
MINUTE = 60.0
"""One minute [s]."""
RPM = TURN / MINUTE
"""One revolution per minute [rad/s]: `rpm * RPM` comes in, `speed / RPM` is shown."""
ZERO_CELSIUS = 273.15
"""Zero of the Celsius scale [K]."""
MILLI, MICRO, NANO = 1e3, 1e6, 1e9
"""How many of the small unit one SI unit has: a film [m] times NANO is in nm."""
GIGA = 1e-9
"""How many of the large unit one SI unit has: a pressure [Pa] times GIGA is in GPa."""
KILOWATT_HOUR = 3.6e6
"""One kilowatt-hour [J]."""


def digits(value: float, count: int = 3) -> str:
    """Return a number in significant digits as people write it, never by powers of ten."""
    if not math.isfinite(value):
        return f'{value:g}'
    return f'{Decimal(f"{value:.{count}g}"):f}'
