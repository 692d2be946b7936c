# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The compiler of the kernels of a solve.

Interpreted, a point of the full tier takes minutes and does not converge within the time cap of a
contact. So without a numba that runs, a kernel can be imported, along with what needs none, and
refuses to be called.

"""

from collections.abc import Callable
from typing import Any, NoReturn

_problem: ImportError | None = None


def _refuse(*arguments: Any) -> NoReturn:
    raise _problem or ImportError(name='numba')


def _njit_without_numba(**options: Any) -> Callable[[Any], Callable[..., NoReturn]]:
    return lambda kernel: _refuse


try:
    from numba import njit
except ImportError as error:  # numba is not there, or what it needs is not or does not fit
    _problem = error if error.name == 'numba' else ImportError(str(error), name='numba')
    njit = _njit_without_numba  # type: ignore[assignment]


def check() -> None:
    """Raise ImportError without a numba that runs, before much work is done for a kernel."""
    if _problem:
        _refuse()
