# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Compilation of plain Python functions that also run interpreted: one source, the same numbers.

A function and all that it calls are compiled by numba where many rows wait. They keep to a subset:
numbers, records and flat sequences; powers are written out, logarithms, roots and exponentials
are guarded, calls go by the bare names of functions, and nothing is cleverer than the order in
which it is written (no fastmath). They make no array and no list, so they are compiled without
counts of references: those of some twenty tables cost more than what is computed with them.

"""

from collections.abc import Callable
import hashlib
import inspect
from pathlib import Path
import types
from typing import Any

DIGITS = 16
WITHOUT_COUNTS: dict[str, Any] = {'_nrt': False}
"""What tells numba to keep no counts of references."""
_REGISTERED: set[types.FunctionType] = set()


def called_by(function: Callable[..., Any]) -> list[types.FunctionType]:
    """Return a function and all plain functions that it calls, each once."""
    functions: list[types.FunctionType] = []
    waiting: list[Any] = [function]
    while waiting:
        value = waiting.pop()
        if isinstance(value, types.FunctionType) and value not in functions:
            functions.append(value)
            waiting += [value.__globals__.get(name) for name in value.__code__.co_names]
    return functions


def compiled(function: Callable[..., Any]) -> Callable[..., Any]:
    """
    Return a function compiled, on first call or out of numba's cache.

    Raises ImportError without numba.

    """
    from surrogate.compiler import check

    check()
    import numba
    from numba.extending import register_jitable

    parts = called_by(function)
    for part in parts:
        if part not in _REGISTERED:
            register_jitable(**WITHOUT_COUNTS)(part)
            _REGISTERED.add(part)
    digest = _digest(parts)

    def entry(*arguments):  # type: ignore[no-untyped-def]
        return function(*arguments)

    # A file of its own in the cache: other sources are compiled again, and what was compiled from
    # these does not name what is gone.
    entry.__qualname__ = f'{function.__name__}_{digest}'
    dispatcher: Callable[..., Any] = numba.njit(cache=True, **WITHOUT_COUNTS)(entry)
    return dispatcher


def _digest(parts: list[types.FunctionType]) -> str:
    """Return a hash of the modules of functions and of the constants that they name."""
    content = hashlib.sha256()
    for part in parts:
        content.update(f'{part.__module__}.{part.__qualname__}'.encode())
        content.update(Path(inspect.getfile(part)).read_bytes())
        for name in part.__code__.co_names:
            value = part.__globals__.get(name)
            if isinstance(value, (bool, int, float, str, tuple)):
                content.update(f'{name}={value!r}'.encode())
    return content.hexdigest()[:DIGITS]
