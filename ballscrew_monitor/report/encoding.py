# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers and texts as a page carries them: compact columns, and JSON that ends no element."""

import base64
import functools
import json
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from surrogate.files import to_json

LEVELS = 65534  # steps of a packed number between the lowest and the highest
LARGEST = np.finfo(float).max / 2  # number that is packed, of which a span is finite
SELDOM = 4  # numbers to a change from which on runs are the shorter form


def _encoded(kind: str, values: ArrayLike) -> str:
    return base64.b64encode(np.asarray(values, dtype=kind).tobytes()).decode()


floats, doubles, codes = (functools.partial(_encoded, kind) for kind in ('<f4', '<f8', '<u1'))
"""Return numbers as base64 of little-endian float32, of float64, and of bytes."""


def packed(values: ArrayLike) -> dict[str, Any]:
    """
    Return numbers in 65534 steps from the lowest to the highest, two bytes each, 0 for NaN.

    A number beyond half of the largest double counts as NaN: the reader's span would overflow.
    Where the numbers seldom change, `runs` says how often each is repeated.

    """
    numbers = np.asarray(values, dtype=float)
    known = np.abs(numbers) <= LARGEST
    low, high = _span(numbers[known])
    steps = np.zeros(numbers.size, dtype=np.uint16)
    # The span may be subnormal, and its reciprocal infinite: it divides.
    steps[known] = 1 + np.rint((numbers[known] - low) / ((high - low) or 1.0) * LEVELS)
    record = {'low': low, 'high': high}
    starts = np.flatnonzero(np.diff(steps, prepend=steps[:1] + 1))
    if SELDOM * starts.size > steps.size:
        return record | {'data': _encoded('<u2', steps)}
    runs = np.diff(starts, append=steps.size)
    return record | {'data': _encoded('<u2', steps[starts]), 'runs': _encoded('<u4', runs)}


def _span(numbers: Any) -> tuple[float, float]:
    return (float(numbers.min()), float(numbers.max())) if numbers.size else (0.0, 0.0)


def script_json(record: Any) -> str:
    """Return a record as JSON within a script element: no text in it can end the element."""
    text = json.dumps(to_json(record), separators=(',', ':'), allow_nan=False)
    return text.replace('<', '\\u003c').replace('>', '\\u003e').replace('&', '\\u0026')
