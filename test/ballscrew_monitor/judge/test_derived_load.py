# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Load from a motor torque: that of its plain twin, interpreted and compiled."""

import dataclasses
import math
from types import SimpleNamespace

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.state import LoadDerivation
from ballscrew_monitor.judge.derived_load import (
    derive_load,
    Derived,
    DERIVED_OK,
    NO_ACCELERATION,
    NO_NUMBER,
    OUTSIDE,
    SEVERAL_LOADS,
    TOO_MUCH_INERTIA,
)
from ballscrew_monitor.judge.records import Settings
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import plain_load as twin
import pytest
from surrogate.surface import Found, shipped_surface, Surface, Validity
from surrogate.surface.compiled import compiled
from surrogate.surface.file import read
from surrogate.surface.records import as_array

PARTS = ('inertia', 'torque_uncertainty', 'parts_uncertainty', 'largest_share')
USUAL = Settings(inertia=1e-3, torque_uncertainty=0.05, parts_uncertainty=0.1, largest_share=0.8)


def masked():
    """Return a surface without the middle of its loads."""
    data = read(shipped_surface())
    mask = data.mask.copy()
    mask[:, 12:20, :] = True
    return Surface(dataclasses.replace(data, mask=mask))


def surfaces():
    shipped = [Surface.load(shipped_surface(tier=tier)) for tier in ('closed_form', 'full')]
    point = SimpleNamespace(speed=62.8, opposing_load=1020.0, temperature=313.15)
    pulled = shipped[1].with_correction(point, SimpleNamespace(friction_torque=0.5))
    return [*shipped, pulled, masked()]


SURFACES = surfaces()
NUMBERS = st.floats(-4.0, 8.0)
COURSES = st.tuples(
    st.floats(-235.0, 235.0).filter(lambda speed: abs(speed) > 0.04),
    st.floats(-300.0, 300.0) | st.just(math.nan),
    st.floats(0.0, 50.0),
    NUMBERS | st.floats(-0.3, 0.3),
    st.floats(282.0, 354.0),
)
DERIVATIONS = st.builds(
    Settings,
    inertia=st.sampled_from([0.0, 1e-3]),
    torque_uncertainty=st.sampled_from([0.0, 1e-6, 0.05, 1.0]),
    parts_uncertainty=st.sampled_from([0.0, 0.2]),
    largest_share=st.sampled_from([0.5, 100.0]),
)


def expected(surface, derivation, course):
    """Return what the twin says."""
    names = ('speed', 'acceleration', 'acceleration_change', 'motor_torque', 'temperature')
    running = twin.Running(
        **dict(zip(names, course, strict=True)), direction=direction_of(course[0])
    )
    how = LoadDerivation(window=1, **{name: getattr(derivation, name) for name in PARTS})
    return twin.derive_load(running, surface, how)


def direction_of(speed):
    return Direction.POSITIVE if speed > 0 else Direction.NEGATIVE


def derived(surface, derivation, course):
    found = Derived()
    derive_load(surface.tables, derivation, *course, int(direction_of(course[0])), Found(), found)
    return found


def sentence(found, derivation):
    """Return the sentence that a code and its numbers make."""
    first, second, third = found.first, found.second, found.third
    return {
        NO_ACCELERATION: twin.NO_ACCELERATION,
        TOO_MUCH_INERTIA: f'inertia and drag take {first:.3g} N m and the torque is '
        f'{second:.3g} N m, allowed is a share of {derivation.largest_share:g}: too little is '
        'left for the load',
        SEVERAL_LOADS: f'the torque is that of several loads, from {first:.4g} to '
        f'{second:.4g} N that oppose the motion',
        OUTSIDE: f'the torque along the motion, {first:.3g} N m, asks for a load outside the '
        f'surface, {second:.4g} to {third:.4g} N that oppose the motion',
    }.get(found.code, '')


def assert_agrees(surface, derivation, course):
    ours, theirs = derived(surface, derivation, course), expected(surface, derivation, course)
    assert ours.validity == theirs.validity
    assert sentence(ours, derivation) == theirs.reason
    for name in ('axial_load', 'uncertainty'):
        value = getattr(theirs, name)
        assert getattr(ours, name) == pytest.approx(value, rel=1e-12, abs=1e-9, nan_ok=True)
    assert (ours.code == DERIVED_OK) is (ours.validity == Validity.VALID)
    return ours


@settings(max_examples=150)
@given(st.sampled_from(SURFACES), DERIVATIONS, COURSES)
def test_it_is_the_load_of_the_twin(surface, derivation, course):
    assert_agrees(surface, derivation, course)


@pytest.mark.parametrize(
    ('course', 'code', 'validity'),
    [
        ((60.0, 0.0, 0.0, 2.0, 313.15), DERIVED_OK, Validity.VALID),
        ((-60.0, 10.0, 1.0, -2.0, 313.15), DERIVED_OK, Validity.VALID),
        ((60.0, math.nan, 0.0, 2.0, 313.15), NO_ACCELERATION, Validity.UNKNOWN),
        ((60.0, 1e4, 0.0, 2.0, 313.15), TOO_MUCH_INERTIA, Validity.UNKNOWN),
        ((60.0, 0.0, 0.0, 50.0, 313.15), OUTSIDE, Validity.LOAD_OUT_OF_RANGE),
        ((300.0, 0.0, 0.0, 2.0, 313.15), NO_NUMBER, Validity.SPEED_ABOVE_RANGE),
        ((0.01, 0.0, 0.0, 2.0, 313.15), NO_NUMBER, Validity.SPEED_BELOW_RANGE),
        ((60.0, 0.0, 0.0, 2.0, 200.0), NO_NUMBER, Validity.TEMPERATURE_OUT_OF_RANGE),
    ],
)
def test_every_code(course, code, validity):
    found = assert_agrees(SURFACES[1], USUAL, course)
    assert (found.code, found.validity) == (code, validity)
    assert math.isfinite(found.axial_load) is (code == DERIVED_OK)


def test_a_hole_in_the_loads_is_masked():
    surface = SURFACES[3]
    _, torques = surface.driving_torques(60.0, 313.15)
    known = torques[np.isfinite(torques)]
    hole = np.flatnonzero(np.isnan(torques))
    middle = 0.5 * (torques[hole[0] - 1] + torques[hole[-1] + 1])
    assert known[0] < middle < known[-1]
    found = assert_agrees(surface, USUAL, (60.0, 0.0, 0.0, float(middle), 313.15))
    assert (found.code, found.validity) == (NO_NUMBER, Validity.MASKED)


@pytest.fixture(scope='module')
def wavy():
    """Return a surface whose torque falls with the load near idle: several loads for a torque."""
    data = read(shipped_surface(tier='closed_form'))
    torque = data.fields['friction_torque'] + 1.5 * np.exp(-((data.load / 300.0) ** 2))[:, None]
    return Surface(dataclasses.replace(data, fields={**data.fields, 'friction_torque': torque}))


def test_several_loads_are_one_within_the_margin(wavy):
    course = (60.0, 0.0, 0.0, 1.3, 313.15)
    sure, unsure = (dataclasses.replace(USUAL, torque_uncertainty=each) for each in (1e-6, 2.0))
    found = assert_agrees(wavy, sure, course)
    assert found.code == SEVERAL_LOADS
    assert found.first < found.second
    assert assert_agrees(wavy, unsure, course).code == DERIVED_OK


numba_derive = compiled(derive_load)


@settings(max_examples=80)
@given(st.sampled_from(SURFACES), DERIVATIONS, COURSES)
def test_compiled_it_has_the_same_bits(surface, derivation, course):
    pytest.importorskip('numba')
    kept, scratch = as_array(Derived()), as_array(Found())
    direction = int(direction_of(course[0]))
    numba_derive(
        surface.array_tables, as_array(derivation)[0], *course, direction, scratch[0], kept[0]
    )
    plain = derived(surface, derivation, course)
    for name in kept.dtype.names:
        np.testing.assert_array_equal(kept[0][name], getattr(plain, name), err_msg=name)
