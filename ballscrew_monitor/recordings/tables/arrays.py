# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Arrays of files of MATLAB and HDF5 as signals: those of one length and columns of a matrix."""

from collections.abc import Iterable, Mapping, Sequence
import math
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.recordings.tables.apart import check_room, library_of
from ballscrew_monitor.recordings.tables.heads import with_unit
from ballscrew_monitor.recordings.tables.layouts import LONGEST_PERIOD
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.signals import (
    behind_times,
    DOUBTFUL,
    NUMBERS,
    periods_of,
    Signals,
    signals_of,
    stated_factors,
)
import numpy as np
from surrogate.files import limits

SCALE_FACTOR, ADD_OFFSET, MISSING = 'scale_factor', 'add_offset', ('_FillValue', 'missing_value')
"""Attributes of the CF conventions: a value is the number times the factor plus the offset."""
BEGIN = re.compile(r'start|begin|offset|delay|^t_?0$', re.I)
"""Names of attributes that may shift the time of a dataset."""
NUMERIC = 'double single logical int8 int16 int32 int64 uint8 uint16 uint32 uint64'.split()
"""Classes of arrays of numbers in files of MATLAB."""


def read_mat(path: Path) -> Signals:
    """Return the arrays of a file of MATLAB; its structures are parts of their names."""
    from scipy.io import loadmat, whosmat

    _check_arrays(shape for _, shape, kind in whosmat(path) if kind in NUMERIC)
    content = loadmat(path, squeeze_me=True, struct_as_record=False)
    held = {key: value for key, value in content.items() if not key.startswith('__')}
    return _signals(dict(_flattened(held)))


def _flattened(content: Mapping[str, Any], before: str = '') -> Iterable[tuple[str, Any]]:
    """Yield the arrays of structures with their names, as `log.x.position`."""
    for key, value in content.items():
        name = f'{before}{key}'
        if hasattr(value, '_fieldnames'):
            fields = {field: getattr(value, field) for field in value._fieldnames}
            yield from _flattened(fields, f'{name}.')
        else:
            yield name, value


def read_hdf(path: Path) -> Signals:
    """Return the datasets of a file of HDF5, in the unit that their attributes state."""
    h5py = library_of('h5py', path, 'HDF5 and MATLAB 7.3')
    held: dict[str, Any] = {}
    factors: list[str] = []
    datasets: dict[str, Any] = {}
    periods: dict[str, float] = {}

    def visit(name: str, item: Any) -> None:
        called = name.replace('/', '.')
        if isinstance(item, h5py.Dataset):
            datasets[called] = item
        else:
            factors.extend(_unclear_factors(called, item.attrs))

    with h5py.File(path, 'r') as file:
        factors.extend(_unclear_factors('', file.attrs))
        file.visititems(visit)
        numeric = {
            called: item
            for called, item in datasets.items()
            if item.dtype.kind in 'iufb' or item.dtype.names
        }
        _check_arrays(one.shape or () for one in numeric.values() for _ in one.dtype.names or '-')
        for called, item in datasets.items():
            shape, is_numeric = item.shape or (), called in numeric
            if not is_numeric or not _columns_of(shape):  # it is not read
                held[called] = np.broadcast_to(0.0 if is_numeric else np.void(b' '), shape)
                continue
            for field in item.dtype.names or ():
                held[f'{called}.{field}'] = np.squeeze(item[field])
            if not item.dtype.names:
                units = np.ravel(item.attrs.get('unit', item.attrs.get('units', b'')))
                unit = units[0] if units.size else ''
                text = unit.decode() if isinstance(unit, bytes) else str(unit)
                held[with_unit(called, text)] = _scaled(item)
                if period := _period_of(item.attrs):
                    periods[with_unit(called, text)] = period
                factors.extend(_unclear_factors(called, item.attrs))
        return _signals(_behind_periods(held, periods), factors)


def _period_of(attributes: Mapping[str, Any]) -> float:
    """Return the period [s] that an attribute of a dataset states plainly, 0 if not one does."""
    plain = {name: value for name, value in attributes.items() if name.lower() not in DOUBTFUL}
    numbers = {
        name: float(np.ravel(one)[0])
        for name, one in plain.items()
        if np.size(one) == 1 and np.asarray(one).dtype.kind in NUMBERS
    }
    periods = {round(period, 15) for period in periods_of(numbers).values()}
    begins = any(BEGIN.search(name) for name in attributes)
    plainly = len(periods) == 1 and not begins and max(periods) <= LONGEST_PERIOD
    return periods.pop() if plainly else 0.0


def _behind_periods(found: dict[str, Any], periods: Mapping[str, float]) -> dict[str, Any]:
    """Return signals behind times that their own periods [s] tell, if all have one."""
    arrays = {name: np.asarray(one) for name, one in found.items() if np.size(one) > 1}
    if {*arrays} != {*periods} or any(
        one.ndim != 1 or read_name(name).kind == 'time' for name, one in arrays.items()
    ):
        return found
    groups: dict[tuple[float, int], dict[str, Any]] = {}
    for name, one in arrays.items():
        groups.setdefault((periods[name], len(one)), {})[name] = one
    rows = [(period * np.arange(count), held) for (period, count), held in groups.items()]
    beside = {name: one for name, one in found.items() if name not in arrays}
    return {**beside, **behind_times(rows)} if rows else found


def _scaled(dataset: Any) -> Any:
    """Return the values of a dataset, by the attributes that the CF conventions define."""
    values, attributes = np.squeeze(dataset[()]), dataset.attrs
    missing = [attributes[name] for name in MISSING if name in attributes]
    if not missing and not {SCALE_FACTOR, ADD_OFFSET} & set(attributes):
        return values
    known = np.where(np.isin(values, missing), math.nan, values)
    return known * attributes.get(SCALE_FACTOR, 1.0) + attributes.get(ADD_OFFSET, 0.0)


def _unclear_factors(name: str, attributes: Mapping[str, Any]) -> Iterable[str]:
    """Return attributes of a dataset that may scale it, which no convention defines."""
    known = (SCALE_FACTOR, ADD_OFFSET)
    numbers = {key: value for key, value in attributes.items() if key not in known}
    of = f'{name}: ' if name else ''
    return (f'{of}{factor}' for factor in stated_factors(numbers))


def _columns_of(shape: Sequence[int]) -> int:
    """Return how many columns an array makes, 0 for one that is no table."""
    plain = [count for count in shape if count != 1]
    columns = min(plain) if len(plain) == 2 else 1
    return columns if len(plain) < 3 and columns <= limits.COLUMNS else 0


def _check_arrays(shapes: Iterable[Sequence[int]]) -> None:
    """Raise Unreadable if arrays of some shapes come to more than is allowed side by side."""
    tables = [shape for shape in shapes if math.prod(shape) > 1 and _columns_of(shape)]
    check_room(max(map(max, tables), default=0), sum(map(_columns_of, tables)))


def _signals(content: Mapping[str, Any], factors: Sequence[str] = ()) -> Signals:
    """Return arrays as signals: those of one length, and columns of a matrix, side by side."""
    held: dict[str, Any] = {}
    left_out: dict[str, str] = {}
    for name, value in content.items():
        array = np.asarray(value)
        if array.dtype.kind not in 'iufb':
            left_out |= {name: 'it holds no numbers'} if array.size > 1 else {}
        elif array.ndim == 1 and len(array) > 1:
            held[name] = np.asarray(array, np.float64)
        elif array.ndim == 2 and _columns_of(array.shape):
            tall = np.asarray(array if array.shape[0] >= array.shape[1] else array.T, np.float64)
            held |= {f'{name} {at + 1}': tall[:, at] for at in range(tall.shape[1])}
        elif array.size > 1:
            left_out[name] = f'it is an array of {" x ".join(map(str, array.shape))}'
    scalars = {name: value for name, value in content.items() if np.ndim(value) == 0}
    stated = ', '.join([*factors, *stated_factors(scalars)])
    return signals_of(held, scalars, {}, factors=stated, left_out=left_out)
