# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A surface as a table for other programs; numbers bit for bit."""

import csv
import io
from typing import Any

import numpy as np
from surrogate.surface.file import SurfaceData
from surrogate.surface_tools.fields import derived_key, FIELD_TEXTS


def to_table(data: SurfaceData) -> str:
    """Return a surface as a table, a line per node, units in the names of the columns."""
    speed = np.exp(data.speed_coordinate[:, None, None] + data.log_onset[None])
    columns: dict[str, Any] = {
        'speed_rad_s': speed,
        'opposing_load_N': np.broadcast_to(data.load[None, :, None], data.mask.shape),
        'temperature_K': np.broadcast_to(data.temperature, data.mask.shape),
        **{FIELD_TEXTS[name].key: values for name, values in data.fields.items()},
        **{derived_key(name, 'std'): values for name, values in data.deviations.items()},
        **{derived_key(name, 'stderr'): values for name, values in data.standard_errors.items()},
        'worst_contact': data.worst_contact,
        'converged': (~data.mask).astype(int),
    }
    out = io.StringIO()
    writer = csv.writer(out, lineterminator='\n')
    writer.writerow(columns)
    writer.writerows(zip(*(np.ravel(values).tolist() for values in columns.values())))
    return out.getvalue()
