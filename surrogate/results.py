# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of results, declared with their units, and the record that follows from that."""

from dataclasses import dataclass, field, fields, MISSING
import math
from typing import Any


@dataclass(frozen=True, kw_only=True, slots=True)
class Mean:
    """
    Average over a march and its standard error, from what the places differ by.

    The error is NaN with one place: columns beside each other hold the same long waves, so that
    parts of one track say nothing of it.

    """

    value: float = math.nan
    error: float = math.nan


def number(unit: str = '', *, default: Any = math.nan) -> Any:
    """Declare a number of a result with its unit in a record; NaN where it is not known."""
    return field(default=default, metadata={'unit': unit})


def required(unit: str = '') -> Any:
    """Declare a number that every result has."""
    return number(unit, default=MISSING)


def declared(result: Any) -> dict[str, Any]:
    """
    Return the declared numbers of a result as plain values, each under its name and unit.

    An average has its standard error beside it.

    """
    record: dict[str, Any] = {}
    for spec in fields(result):
        if 'unit' not in spec.metadata:
            continue
        value, unit = getattr(result, spec.name), f'_{spec.metadata["unit"]}'.rstrip('_')
        if isinstance(value, Mean):
            record[f'{spec.name}{unit}'] = value.value
            record[f'{spec.name}_standard_error{unit}'] = value.error
        else:
            record[f'{spec.name}{unit}'] = value if isinstance(value, int) else float(value)
    return record
