# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of the database of health, and what they say; numbers that are not known are NULL."""

from collections.abc import Mapping
import dataclasses
import math
from typing import Any, NamedTuple

from ballscrew_monitor.health.records import (
    Baseline,
    ComparablePoint,
    LoadSource,
    Place,
    SpectrumBin,
)
import numpy as np

NAN = math.nan
SQL = {int: 'INTEGER', bool: 'INTEGER', float: 'REAL', str: 'TEXT', bytes: 'BLOB'}
BANDS = {name: f'{name}_band' for name in Place._fields}
"""Columns of the bands of a place; the means have the names without the ending."""
POINT: dict[str, Any] = {
    **dict.fromkeys(BANDS.values(), int),
    **{
        field.name: int if field.type is LoadSource else field.type
        for field in dataclasses.fields(ComparablePoint)
        if field.name != 'place'
    },
}
SPECTRUM: dict[str, Any] = {
    field.name: bytes if field.name == 'wear_time' else field.type
    for field in dataclasses.fields(SpectrumBin)
}
BASELINE: dict[str, Any] = {
    field.name: field.type for field in dataclasses.fields(Baseline) if field.name != 'points'
}
POINT_UNKNOWN = {'residual'}
BIN_UNKNOWN = {'axial_load', 'energy_measured', 'energy_expected'}
"""Numbers of a point and of a bin that may not be known."""


def _columns(types: Mapping[str, Any]) -> str:
    return ', '.join(f'"{name}" {SQL[kind]}' for name, kind in types.items())


POINT_COLUMNS, SPECTRUM_COLUMNS = _columns(POINT), _columns(SPECTRUM)
BASELINE_COLUMNS = _columns(BASELINE)


class KeptHealth(NamedTuple):
    """
    What is kept of one axis.

    The baseline in force is the last one; `notes` say what could not be read.

    """

    points: tuple[ComparablePoint, ...] = ()
    spectrum: tuple[SpectrumBin, ...] = ()
    baselines: tuple[Baseline, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def baseline(self) -> Baseline | None:
        """Return the baseline in force."""
        return self.baselines[-1] if self.baselines else None


def point_row(point: ComparablePoint) -> dict[str, Any]:
    """Return a point as a row."""
    bands = {BANDS[name]: band for name, band in point.place._asdict().items()}
    return _row(POINT, point, bands)


def point_of(row: Any) -> ComparablePoint:
    """Return the point of a row; raises ValueError or TypeError for what nobody has written."""
    values = _values(POINT, row, POINT_UNKNOWN)
    place = Place(**{name: values.pop(column) for name, column in BANDS.items()})
    values['load_source'] = LoadSource(values['load_source'])
    if min(values['stretches'], values['days']) < 1 or abs(place.direction) != 1:
        raise ValueError(f'a point of {values["stretches"]} stretches')
    return ComparablePoint(place=place, **values)


def bin_row(one: SpectrumBin) -> dict[str, Any]:
    """Return a bin of the spectrum as a row."""
    return _row(SPECTRUM, one, {'wear_time': np.array(one.wear_time, dtype='<f8').tobytes()})


def bin_of(row: Any) -> SpectrumBin:
    """Return the bin of a row; raises as `point_of` does."""
    values = _values(SPECTRUM, row, BIN_UNKNOWN)
    times = np.frombuffer(values.pop('wear_time'), dtype='<f8').tolist()
    if values['time'] <= 0.0 or not all(time >= 0.0 for time in times):
        raise ValueError(f'a bin of {values["time"]} s')
    return SpectrumBin(wear_time=tuple(times), **values)


def baseline_row(baseline: Baseline) -> dict[str, Any]:
    """Return a baseline as a row, without its points."""
    return _row(BASELINE, baseline, {})


def baseline_of(row: Any) -> Baseline:
    """Return the baseline of a row, without its points; raises as `point_of` does."""
    return Baseline(**_values(BASELINE, row, set()))


def _row(types: Mapping[str, Any], record: Any, more: Mapping[str, Any]) -> dict[str, Any]:
    values = {name: more.get(name, getattr(record, name, None)) for name in types}
    return {name: None if value != value else value for name, value in values.items()}


def _values(types: Mapping[str, Any], row: Any, unknown: set[str]) -> dict[str, Any]:
    columns = dict(
        zip(row.keys(), row, strict=True)
    )  # a row looks for a name from column to column
    return {
        name: _value(name, kind, columns[name], name in unknown) for name, kind in types.items()
    }


def _value(name: str, kind: Any, value: Any, may_be_unknown: bool) -> Any:
    if kind is float:
        if value is None and may_be_unknown:
            return NAN
        if type(value) is float and math.isfinite(value):
            return value
    elif type(value) is kind:
        return value
    elif kind is bool and value in (0, 1):
        return bool(value)
    raise ValueError(f'{name} is {value!r}')
