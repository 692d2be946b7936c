# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The compiler of the kernels of a solve.

Interpreted, a point of the full tier takes minutes and does not converge within the time cap of a
contact. So without numba a kernel can be imported, along with what needs none, and refuses to be
called.

"""

from collections.abc import Callable
from typing import Any, NoReturn


def _refuse(*arguments: Any) -> NoReturn:
    raise ModuleNotFoundError("No module named 'numba'", name='numba')


def _njit_without_numba(**options: Any) -> Callable[[Any], Callable[..., NoReturn]]:
    return lambda kernel: _refuse


try:
    from numba import njit
except ModuleNotFoundError:
    njit = _njit_without_numba  # type: ignore[assignment]


def check() -> None:
    """Raise ModuleNotFoundError without numba, before much work is done for a kernel."""
    if njit is _njit_without_numba:
        _refuse()
