# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Mends of inputs whose sign or size contradicts the others."""

import dataclasses
import math

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.report.balance import Balance
from ballscrew_monitor.report.inputs_seen import hints_on, inputs_seen
import pytest

TORQUE = {'x.torque.topic': 'torque', 'x.torque.field': 'data'}


@pytest.mark.parametrize(
    ('source', 'known', 'key'),
    [
        (Source.LOAD, {}, 'turned_load'),
        (Source.SPEED, {}, 'turned_speed'),
        (Source.TORQUE, {}, 'turned_torque'),
        (Source.LOAD, {'stated': frozenset({'lead_mm'})}, 'turned_load_of_map'),
        (
            Source.LOAD,
            {'stated': frozenset({'lead_mm', 'current.column'}), 'load_from': 'current'},
            'turned_current',
        ),
        (
            Source.SPEED,
            {'stated': frozenset({'lead_mm'}), 'assumed': {'speed': {}}},
            'turned_position',
        ),
        (
            Source.TORQUE,
            {'stated': frozenset({'lead_mm', 'current.column'})},
            'turned_torque_of_current',
        ),
    ],
)
def test_a_turned_sign_is_told_with_what_mends_it(judged, source, known, key, says):
    case = judged.case([judged.rows()], values=judged.values(**TORQUE), known=known)
    case = dataclasses.replace(case, balance=Balance(turned=source))
    assert says(key) in hints_on([case])
    others = [one for one in inputs_seen(case) if one.source is not source]
    assert not any('turned' in hint for one in others for hint in one.hints)


@pytest.mark.parametrize(
    ('factor', 'friction', 'key'),
    [
        (1100.0, 0.9, 'looks_like_kn'),
        (0.0009, 1.2, 'looks_like_n'),
        (0.0009, math.nan, 'looks_like_n'),  # a load beyond the surface: no friction of the model
        (1100.0, math.nan, 'size_of_either'),
        (980.0, 1500.0, 'looks_like_n_mm'),
        (5.0, 1.0, 'check_both'),
    ],
)
def test_a_wrong_size_is_told_with_the_unit_that_fits(judged, factor, friction, key, says):
    known = {'stated': frozenset({'lead_mm'})}
    case = judged.case([judged.rows()], values=judged.values(**TORQUE), known=known)
    case = dataclasses.replace(case, balance=Balance(factor=factor, friction=friction))
    assert says(key) in hints_on([case])
