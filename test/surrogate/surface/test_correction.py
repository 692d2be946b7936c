# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A corrected surface: the full solve at its point, the same surface everywhere else, smooth."""

from dataclasses import replace
import math
from types import SimpleNamespace

from hypothesis import assume, given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.parameters import OperatingPoint
from surrogate.surface import FIELDS, shipped_surface, Surface, Validity
from surrogate.surface.correction import (
    make_correction,
    NEAREST,
    places_of,
    solved_values,
    TRUST_RADIUS,
)
from surrogate.surface.file import read, SurfaceError

DATA, FULL_DATA = (read(shipped_surface(tier=tier)) for tier in ('closed_form', 'full'))
SHIPPED, FULL = Surface(DATA), Surface(FULL_DATA)
AXES = {
    data.header['tier']: (data.speed_coordinate, data.load, data.temperature)
    for data in (DATA, FULL_DATA)
}
both = pytest.mark.parametrize('shipped', [SHIPPED, FULL], ids=['closed_form', 'full'])
SHARES = ('rcs', 'asperity_share')
CELLS = st.tuples(*3 * [st.integers(0, 1000)])
"""Cells of any surface, counted round."""
FRACTIONS = st.tuples(*3 * [st.floats(0.02, 0.98)])
FACTORS = st.floats(0.05, 20.0)
ONE = st.floats(0.0, 1.0)
SOLUTIONS = st.builds(
    lambda factors, rcs, share: (factors, {'rcs': rcs, 'asperity_share': share}),
    st.tuples(*len(FIELDS) * [FACTORS]),
    ONE,
    ONE,
)


def turn(surface, cell):
    return tuple(number % count for number, count in zip(cell, surface.cells))


def place(surface, cell, fractions):
    """Return speed, load and temperature at fractions of a cell; passes over those outside."""
    s, load, heat = (
        float(axis[i] + (axis[i + 1] - axis[i]) * fraction)
        for axis, i, fraction in zip(AXES[surface.tier], turn(surface, cell), fractions)
    )
    speed = surface.onset_speed(load, heat) * math.exp(s)
    assume(surface.lookup(speed, load, heat).validity is Validity.VALID)
    return speed, load, heat


def at(where, speed_sign=1.0):
    return SimpleNamespace(
        speed=speed_sign * where[0], opposing_load=where[1], temperature=where[2]
    )


def solution(surface, where, drawn):
    """Return a solution that differs from the surface by factors, and with other shares."""
    found, (factors, shares) = surface.lookup(*where), drawn
    values = {name: factor * getattr(found, name) for name, factor in zip(FIELDS, factors)}
    return SimpleNamespace(**{**values, **shares})


CELLS_OF_ONE = (5, 6, 7)


@pytest.mark.parametrize(
    ('heat_cell', 'heat', 'places'),
    [
        (3, 0.5, [(3, 0.5)]),
        (3, 0.01, [(3, 0.01)]),  # as near to a node as is still within
        (3, 0.99, [(3, 0.99)]),
        (3, 0.009, [(2, 1.0), (3, 0.0)]),
        (3, 0.991, [(3, 1.0), (4, 0.0)]),
        (1, 0.0, [(0, 1.0), (1, 0.0)]),
        (0, 0.0, [(0, 0.0)]),  # nothing lies below the first node or above the last
        (6, 1.0, [(6, 1.0)]),
        (5, 1.0, [(5, 1.0), (6, 0.0)]),
    ],
)
def test_a_point_on_a_node_of_temperature_lies_in_both_cells(heat_cell, heat, places):
    found = places_of((1, 2, heat_cell), (0.25, 0.75, heat), CELLS_OF_ONE)
    assert found == [((1, 2, k), (0.25, 0.75, at)) for k, at in places]


@pytest.mark.parametrize('fractions', [(0.01, 0.5, 0.0), (0.5, 0.99, 1.0), (0.99, 0.01, 0.5)])
def test_a_point_as_near_to_a_face_as_is_allowed_corrects(fractions):
    values = [2.0, 0.25, 0.0, -1.0, 1.0, 0.0, 4.0, 8.0]
    solved = {'friction_torque': 3.0, 'rcs': 0.5, 'asperity_share': 0.5, 'film_ratio': math.e}
    solved |= {'friction_coefficient': 1.0, 'max_pressure': 8.0}
    point = at((62.8, 1000.0, 313.0), -1.0)
    made = make_correction(point, (1, 2, 3), fractions, values, solved)
    assert (made.speed, made.opposing_load, made.temperature) == (62.8, 1000.0, 313.0)
    assert (made.cell, made.fractions, made.solved) == ((1, 2, 3), fractions, solved)
    # A rising share scales what it lacks of 1; a film is shifted; what was not solved stays.
    assert made.gains == pytest.approx((0.5, -1 / 3, -0.5, 0.0, 0.0, 0.0, -0.75, 0.0))
    assert made.shifts == pytest.approx((0.0, 1 / 3, 0.5, 2.0, 0.0, 0.0, 0.0, 0.0))
    nearer = tuple(math.nextafter(one, round(one)) for one in fractions)
    with pytest.raises(SurfaceError, match='of the width of its cell'):
        make_correction(point, (1, 2, 3), nearer, values, solved)


@pytest.mark.parametrize('value', [0.0, 0.25, 1.0])
@pytest.mark.parametrize('target', [0.0, 0.25, 0.5, 1.0])
def test_a_share_reaches_any_other(value, target):
    values = [value] * len(FIELDS)
    made = make_correction(at((1.0, 2.0, 3.0)), (0, 0, 0), (0.5,) * 3, values, {'rcs': target})
    assert value + made.gains[1] * value + made.shifts[1] == pytest.approx(target)
    # In between it stays a share, for any share that the surface has beside.
    for weight in (0.25, 0.75):
        for beside in (0.0, 0.5, 1.0):
            there = beside + weight * (made.gains[1] * beside + made.shifts[1])
            assert value == 0.0 or -1e-12 <= there <= 1.0 + 1e-12


@pytest.mark.parametrize(
    ('name', 'value', 'sound'),
    [
        ('rcs', 0.0, True),
        ('rcs', 1.0, True),
        ('rcs', math.nextafter(1.0, 2.0), False),
        ('rcs', -5e-324, False),
        ('film_ratio', 5e-324, True),
        ('film_ratio', 0.0, False),
        ('film_ratio', 1.7e308, True),
        ('film_ratio', math.inf, False),
    ],
)
def test_limits_of_what_is_solved_are_allowed(name, value, sound):
    solution = SimpleNamespace(**{name: value}, max_pressure=math.nan)
    if sound:
        assert solved_values(solution) == {name: value}
    else:
        with pytest.raises(SurfaceError):
            solved_values(solution)


@both
@given(CELLS, FRACTIONS, SOLUTIONS)
def test_the_corrected_point_is_the_solve(shipped, cell, fractions, drawn):
    """Every field, to rounding; what follows from the torque too; the flag tells."""
    where = place(shipped, cell, fractions)
    solved = solution(shipped, where, drawn)
    found = shipped.with_correction(at(where), solved).lookup(*where)
    assert found.corrected
    for name in FIELDS:
        assert getattr(found, name) == pytest.approx(getattr(solved, name), rel=1e-9, abs=1e-12)
    for name in ('friction_torque_error', 'rcs_error'):
        stated = getattr(shipped.lookup(*where), name)
        assert getattr(found, name) == pytest.approx(stated, rel=0, nan_ok=True)


@both
@given(CELLS, FRACTIONS, SOLUTIONS, CELLS, FRACTIONS)
def test_elsewhere_nothing_changes_by_a_bit(shipped, cell, fractions, drawn, other, others):
    """In any other cell, and in the same cell beyond the trust region, bit for bit."""
    where, elsewhere = place(shipped, cell, fractions), place(shipped, other, others)
    beyond = any(abs(a - b) > TRUST_RADIUS + 1e-9 for a, b in zip(fractions, others))
    assume(turn(shipped, other) != turn(shipped, cell) or beyond)
    corrected = shipped.with_correction(at(where), solution(shipped, where, drawn))
    before, after = shipped.lookup(*elsewhere), corrected.lookup(*elsewhere)
    # By their texts, which tell every bit and let NaN be equal to itself.
    assert str(after) == str(before)
    assert not after.corrected


@both
@given(CELLS, FRACTIONS, SOLUTIONS, FRACTIONS)
def test_signs_and_ranges_hold(shipped, cell, fractions, drawn, others):
    """Anywhere in the cell: positive stays positive, shares stay shares, and no overshoot."""
    where, near = place(shipped, cell, fractions), place(shipped, cell, others)
    solved = solution(shipped, where, drawn)
    corrected = shipped.with_correction(at(where), solved)
    before, after, here = shipped.lookup(*near), corrected.lookup(*near), shipped.lookup(*where)
    for name in FIELDS:
        old, new = getattr(before, name), getattr(after, name)
        if name in SHARES:
            assert 0.0 <= new <= 1.0
            assert abs(new - old) <= 1.0
        else:
            assert new > 0.0
            factor = getattr(solved, name) / getattr(here, name)
            assert min(1.0, factor) - 1e-9 <= new / old <= max(1.0, factor) + 1e-9


@both
@given(CELLS, FRACTIONS, SOLUTIONS, FRACTIONS, st.integers(0, 2), st.sampled_from([0, 1]))
def test_the_pull_vanishes_at_the_faces(shipped, cell, fractions, drawn, others, axis, side):
    """A step h from a face the torque is pulled by no more than a multiple of h squared."""
    where = place(shipped, cell, fractions)
    corrected = shipped.with_correction(at(where), solution(shipped, where, drawn))
    bound = abs(corrected.corrections[0].gains[0]) + 1e-12
    reach = min(fractions[axis], 1 - fractions[axis], TRUST_RADIUS)
    for step in (1e-3, 1e-4, 1e-5):
        near = list(others)
        near[axis] = step if side == 0 else 1 - step
        point = place(shipped, cell, near)
        old, new = (one.lookup(*point).friction_torque for one in (shipped, corrected))
        assert abs(new / old - 1) <= 3.01 * bound * (step / reach) ** 2 + 1e-13


def test_a_solution_pulls_what_it_has():
    """A field that is not there or NaN stays; the others are pulled."""
    where = (62.8, 1000.0, 313.0)
    solved = SimpleNamespace(rcs=0.0, friction_torque=math.nan, film_ratio=3.0)
    before = SHIPPED.lookup(*where)
    after = SHIPPED.with_correction(at(where), solved).lookup(*where)
    assert (after.rcs, after.friction_torque) == (0.0, before.friction_torque)
    assert after.film_ratio == pytest.approx(3.0)
    assert after.minimum_film == before.minimum_film


def test_a_solution_of_the_screw_is_taken():
    """As the full tier gives it, at an operating point in the other direction of motion."""
    from surrogate.screw.solve import ScrewSolution

    point = OperatingPoint(speed=-62.8, load=1000.0, temperature=313.0)
    solved = ScrewSolution(
        status='Solved.',
        converged=True,
        contacts=(),
        entrainment_speed=1.0,
        normal_forces=(27.0, 30.0),
        friction_torque=0.123,
        rcs=0.0,
        asperity_share=0.0,
        film_ratio=2.5,
        central_film=0.3e-6,
    )
    found = SHIPPED.with_correction(point, solved).lookup(62.8, -1000.0, 313.0)
    assert found.friction_torque == pytest.approx(0.123, rel=1e-12)
    assert found.rcs == solved.rcs
    assert found.central_film == pytest.approx(0.3e-6, rel=1e-12)


def test_provenance_and_hash():
    """Each set of corrections has a hash of its own, whatever their order; the old one stays."""
    first, second = (62.8, 1000.0, 313.0), (10.0, -500.0, 330.0)
    solved = SimpleNamespace(rcs=0.2)
    one = SHIPPED.with_correction(at(first), solved)
    two = one.with_correction(at(second), solved)
    other = SHIPPED.with_correction(at(second), solved).with_correction(at(first), solved)
    assert len({SHIPPED.sha256, one.sha256, two.sha256}) == 3
    assert two.sha256 == other.sha256
    assert SHIPPED.corrections == ()
    assert SHIPPED.sha256 == DATA.sha256
    assert len(two.corrections) == 2
    assert {made.solved['rcs'] for made in two.corrections} == {0.2}
    assert (one.corrections[0].speed, one.corrections[0].opposing_load) == first[:2]


def test_the_newest_solve_in_a_cell_or_beside_its_node_replaces_the_older():
    """As if that had never been; else a step would be left on the face between two cells."""
    first, second = (62.8, 1000.0, 313.0), (62.9, 1001.0, 313.01)
    solved, newer = SimpleNamespace(rcs=0.2), SimpleNamespace(rcs=0.3)
    both = SHIPPED.with_correction(at(first), solved).with_correction(at(second), newer)
    alone = SHIPPED.with_correction(at(second), newer)
    assert both.sha256 == alone.sha256
    assert str(both.lookup(*first)) == str(alone.lookup(*first))
    node = float(AXES['full'][2][3])
    speed = amid(node)
    older = FULL.with_correction(at((speed, 1234.0, node)), SimpleNamespace(rcs=0.2))
    newer = older.with_correction(at((speed, 1234.0, node + 2.0)), SimpleNamespace(rcs=0.3))
    alone = FULL.with_correction(at((speed, 1234.0, node + 2.0)), SimpleNamespace(rcs=0.3))
    assert newer.sha256 == alone.sha256
    below = (speed, 1234.0, node - 0.1)
    assert str(newer.lookup(*below)) == str(FULL.lookup(*below))


def amid(kelvin):
    """Return the speed amid two nodes near 62.8 rad/s at 1234 N and a temperature [K]."""
    s, onset = AXES['full'][0], FULL.onset_speed(1234.0, kelvin)
    cell = int(np.searchsorted(s, math.log(62.8 / onset)))
    return onset * math.exp(0.5 * float(s[cell - 1] + s[cell]))


def pull(made, speed, kelvin):
    """Return the torque of a corrected surface over that of the shipped one at 1234 N [-]."""
    corrected, before = (one.lookup(speed, 1234.0, kelvin) for one in (made, FULL))
    return corrected.friction_torque / before.friction_torque


def weight_amid(where):
    """Return the bump of a point [-] amid the cell of speeds, where the node has its middle."""
    s, coordinate = AXES['full'][0], math.log(where[0] / FULL.onset_speed(*where[1:]))
    cell = int(np.searchsorted(s, coordinate))
    centre = (coordinate - float(s[cell - 1])) / float(s[cell] - s[cell - 1])
    t = 1.0 - abs(0.5 - centre) / min(TRUST_RADIUS, max(centre, 1.0 - centre))
    return 3.0 * t**2 - 2.0 * t**3


@pytest.mark.parametrize('beside', [0.0, 0.004, -0.004])
def test_a_point_on_a_node_of_temperature_corrects_both_sides(beside):
    """The default temperature is one: no step there, no slope, and the solve at the point."""
    heats = AXES['full'][2]
    node, width = float(heats[3]), float(heats[4] - heats[3])
    speed = amid(node)
    where = (speed, 1234.0, node + beside * width)
    solved = SimpleNamespace(friction_torque=1.1 * FULL.lookup(*where).friction_torque)
    made = FULL.with_correction(at(where), solved)
    assert len(made.corrections) == 1
    found = made.lookup(*where)
    assert found.corrected
    assert found.friction_torque == pytest.approx(solved.friction_torque, rel=1e-4)
    # The bump stands on the node, at the speed coordinate of the point: the coordinate of a speed
    # moves with temperature, because the onset does.
    coordinate = speed / FULL.onset_speed(*where[1:])
    for step in (-1e-3, -1e-6, 1e-6, 1e-3):
        heat = node + step
        moved = coordinate * FULL.onset_speed(1234.0, heat)
        assert pull(made, moved, heat) == pytest.approx(1.1, abs=1e-6)
    below, here, above = (pull(made, speed, node + step) for step in (-1e-4, 0.0, 1e-4))
    assert here == pytest.approx(1.0 + 0.1 * weight_amid(where), abs=1e-6)
    assert above - here == pytest.approx(here - below, abs=1e-8)
    far = (speed, 1234.0, node + 0.6 * width)
    assert str(made.lookup(*far)) == str(FULL.lookup(*far))


@pytest.mark.parametrize(
    ('where', 'solved', 'sentence'),
    [
        ((62.8, 1000.0, 200.0), {'rcs': 0.1}, 'answer_temperature_out_o'),
        ((math.nan, 1000.0, 313.0), {'rcs': 0.1}, 'answer_speed_below_range'),
        ((62.8, 0.0, 313.0), {'rcs': 0.1}, 'lies_0_width'),
        ((62.8, 1000.0, 313.0), {}, 'converged_has_numbers'),
        ((62.8, 1000.0, 313.0), {'rcs': 1.01}, 'rcs_1_01'),
        ((62.8, -1e-4, 313.0), {'rcs': 0.1}, 'width_cell_1'),
        ((62.8, 1000.0, 313.0), {'friction_torque': 0.0}, 'friction_torque_0_fin'),
        ((62.8, 1000.0, 313.0), {'max_pressure': math.inf}, 'max_pressure_inf'),
        (
            (62.8, 1000.0, 313.0),
            {'rcs': 0.1, 'converged': False, 'status': 'stalled.'},
            'converged_stalled',
        ),
    ],
)
def test_what_cannot_correct_is_one_sentence(where, solved, sentence, refused):
    assert NEAREST == 0.01
    refused(sentence, SHIPPED.with_correction, at(where), SimpleNamespace(**solved))


def test_masked_cells_are_not_corrected(surface_data, refused):
    mask = surface_data.mask.copy()
    mask[:, :, 4] = True
    holed = Surface(replace(surface_data, mask=mask))
    point = (62.8, 1000.0, float(surface_data.temperature[4]) + 1.0)
    assert holed.lookup(*point).validity is Validity.MASKED
    refused('answer_masked', holed.with_correction, at(point), SimpleNamespace(rcs=0.1))
