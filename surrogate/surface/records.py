# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Records of numbers with one declaration for plain Python and for arrays.

A record is a slotted dataclass whose fields are an int, a float, a bool, or a list of ints or
floats of fixed length, declared by `many`; an int that is small in arrays is declared by `small`.
Plain Python works on the object, compiled code on an
element of a structured array of the same fields: both read and write `record.field` alike.

"""

import dataclasses
import operator
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Record = TypeVar('Record')
_TYPES: dict[Any, np.dtype[Any]] = {}
"""Types of arrays by their records."""
_KINDS = {'int': np.int64, 'float': np.float64, 'bool': np.bool_}


def many(count: int, start: float) -> Any:
    """Return the declaration of a field of `count` numbers that begin as `start`."""
    return dataclasses.field(
        default_factory=lambda: [start] * count, metadata={'count': count, 'start': start}
    )


def small(kind: type[np.integer[Any]], start: int = 0) -> Any:
    """Return the declaration of an int that begins as `start`, and of its `kind` in arrays."""
    return dataclasses.field(default=start, metadata={'kind': kind})


def dtype_of(kind: type[Any]) -> np.dtype[Any]:
    """Return the type of an array of records."""
    if kind in _TYPES:
        return _TYPES[kind]
    parts: list[Any] = []
    for field in dataclasses.fields(kind):
        count = field.metadata.get('count')
        name = str(getattr(field.type, '__name__', field.type))
        if count is None:
            parts.append((field.name, field.metadata.get('kind', _KINDS[name])))
        else:
            parts.append((field.name, _KINDS[type(field.metadata['start']).__name__], (count,)))
    dtype: np.dtype[Any] = np.dtype(parts, align=True)
    _TYPES[kind] = dtype
    return dtype


def as_array(record: object) -> NDArray[Any]:
    """Return an array of one record."""
    array = np.zeros(1, dtype=dtype_of(type(record)))
    array[0] = operator.attrgetter(*array.dtype.names or ())(record)
    return array


def from_array(kind: type[Record], element: Any) -> Record:
    """Return the record that an element of an array holds."""
    values = zip(element.dtype.names, element.item())  # all at once, but for lists
    return kind(
        **{
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in values
        }
    )
