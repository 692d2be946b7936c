# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Load sharing of the nuts: table, identities, limits."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas.load_sharing import (
    idle_load,
    IDLE_SHARE,
    normal_force,
    nut_forces,
    UNLOADING_RATIO,
    working_preload,
)


def test_preload_sharing_table(table):
    for row in table('preload_sharing.csv'):
        loaded, relieved = nut_forces(float(row['axial_load_over_preload']) * 990.0, 990.0)
        assert loaded / 990 == pytest.approx(float(row['loaded_nut_over_preload']), abs=5.1e-5)
        assert relieved / 990 == pytest.approx(float(row['relieved_nut_over_preload']), abs=5.1e-5)


@given(st.floats(-UNLOADING_RATIO, UNLOADING_RATIO), st.floats(1.0, 1e5))
def test_both_equations_hold(ratio, preload):
    loaded, relieved = nut_forces(ratio * preload, preload)
    assert loaded - relieved == pytest.approx(abs(ratio) * preload, rel=1e-9, abs=1e-9 * preload)
    expected = 2 * preload ** (2 / 3)
    assert loaded ** (2 / 3) + relieved ** (2 / 3) == pytest.approx(expected, rel=1e-9)


@given(st.floats(1.0, 10.0))
def test_past_unloading_one_nut_carries_everything(factor):
    load = factor * UNLOADING_RATIO * 990.0
    loaded, relieved = nut_forces(load, 990.0)
    assert relieved == 0.0
    assert loaded == load


def test_zero_preload_is_legal_and_a_share_of_the_rating_stands_for_it(screw):
    loaded, relieved = nut_forces([0.0, 100.0], 0.0)
    assert loaded.tolist() == [0.0, 100.0]
    assert relieved.tolist() == [0.0, 0.0]
    free = replace(screw, preload=0.0)
    assert working_preload(screw) == working_preload(screw, 0.02) == screw.preload
    assert working_preload(free) == 0.01 * screw.static_rating
    assert working_preload(free, 0.02) == 0.02 * screw.static_rating


def test_normal_force_at_preload_is_the_published_one(screw):
    """990 N over 51 balls is 27.6 N per ball."""
    assert normal_force(screw, 990.0) == pytest.approx(27.6, abs=0.05)
    back = normal_force(screw, 990.0) * 51 * math.sin(screw.contact_angle)
    assert back == pytest.approx(990.0, rel=0.01)


def test_idle_is_where_load_sharing_says_so(screw):
    """On either side of it the relieved nut has more and less than the least share."""
    idle = idle_load(screw)
    for side, shared in ((-1e-4, True), (1e-4, False)):
        loaded, relieved = nut_forces((1 + side) * idle, screw.preload)
        assert (relieved >= IDLE_SHARE * loaded) == shared
    assert 0.95 * 2**1.5 * screw.preload < idle < 2**1.5 * screw.preload
    assert idle_load(replace(screw, preload=0.0)) == 0.0
