# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records as strict JSON."""

from collections.abc import Mapping
import math
from typing import Any


def to_json(record: Any) -> Any:
    """Return `record` with every number that is not finite as None, which JSON calls null."""
    if isinstance(record, Mapping):
        return {key: to_json(value) for key, value in record.items()}
    if isinstance(record, list):
        return [to_json(value) for value in record]
    return None if isinstance(record, float) and not math.isfinite(record) else record
