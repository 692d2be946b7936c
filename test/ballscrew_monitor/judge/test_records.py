# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fresh records: nothing is known, nothing has begun, no warning is due."""

import dataclasses
import math

from ballscrew_monitor.judge.records import Event, Memory, Row, Settings
import numpy as np
import pytest

LONG_AGO = -10_000_000_000  # [ns] what happened then is no longer shown
ZERO = {
    Settings: 'hysteresis inertia torque_uncertainty parts_uncertainty largest_share wrap',
    Event: '',
    Memory: 'angle energy_lost moment_speed moment_power window_total',
    Row: '',
}
OTHERS = {
    Settings: {'plausible': math.inf},
    Event: {'note': -1},
    Memory: {
        'lost_known': 1,
        'lost_last': LONG_AGO,
        'refused_last': LONG_AGO,
        'refusal': -1,
        'window_low': math.inf,
        'window_high': -math.inf,
    },
    Row: dict.fromkeys(('speed_cell', 'load_cell', 'heat_cell', 'worst_contact'), -1),
}


@pytest.mark.parametrize('kind', ZERO)
def test_a_fresh_record_holds_nothing(kind):
    for field in dataclasses.fields(kind):
        number = np.unique(getattr(kind(), field.name)).item()  # of a list, the one number
        unknown = math.nan if isinstance(number, float) else 0
        zero = 0 if field.name in ZERO[kind].split() else unknown
        expected = OTHERS[kind].get(field.name, zero)
        assert number == pytest.approx(expected, abs=0, nan_ok=True), field.name
