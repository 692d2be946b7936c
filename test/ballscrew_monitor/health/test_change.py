# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Changes between a baseline and now, their causes, and the preload: planted and found again."""

import dataclasses
import math
from types import SimpleNamespace

from ballscrew_monitor.health import causes
from ballscrew_monitor.health.calibration import calibrated, Calibration, EXPECTED
from ballscrew_monitor.health.causes import birge, CANDIDATES, causes_of, fits_of
from ballscrew_monitor.health.change import change_between, parts_of, select
from ballscrew_monitor.health.companions import Companions, companions_beside, NONE_BUILT
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.preload import preload_of
from ballscrew_monitor.health.records import CauseCode, LoadSource, Place
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface import companion_path, PRELOAD_SHARES
from surrogate.surface.file import read, write
from surrogate.units import TURN

SPEEDS, LOADS = (2.0, 8.0, 30.0, 100.0), (0.0, 800.0)
POWER = 0.7
"""Friction over preload, as an exponent, of the companions of these tests."""


class OfShare:
    """A surface whose friction follows its preload by a power."""

    def __init__(self, share):
        self.share = share

    def lookup(self, speed, load, temperature):
        return SimpleNamespace(friction_torque=self.share ** (POWER / (1.0 + speed / 30.0)))


@pytest.fixture(scope='module')
def companions():
    return Companions({share: OfShare(share) for share in PRELOAD_SHARES})


@pytest.fixture
def model(surface, companions):
    return Model(surface, companions)


@pytest.fixture
def points(motion, model):
    """Return what makes the points of some days, with a torque added against the motion."""

    def make(added=lambda point: 0.0, *, days=5, temperature=313.0, first=0, stretches=4):
        found = []
        for day in range(days):
            for band, speed in enumerate(SPEEDS):
                for load_band, load in enumerate(LOADS):
                    for sign in (1, -1):
                        place = Place(band, load_band, 0, sign)
                        point = motion.point(
                            first_day=motion.today + first + day,
                            place=place,
                            speed=sign * speed,
                            axial_load=load,
                            temperature=temperature,
                            stretches=stretches,
                            torque_squares=1e-6 * stretches,
                            residual=math.nan,
                        )
                        drag = model.friction([point])[0] + added(point)
                        torque = sign * (drag + model.ideal(point))
                        found.append(dataclasses.replace(point, motor_torque=torque))
        return found

    return make


def test_a_measured_torque_without_its_load_is_the_friction(points, model):
    """Torque = friction + load lead / 2 pi, each against the motion."""
    for point in points(lambda _: 0.03):
        assert model.residuals([point])[0] == pytest.approx(0.03, abs=1e-12)
        ideal = model.ideal(point)
        assert abs(ideal) == pytest.approx(
            abs(point.axial_load) * model.surface.lead / TURN, rel=1e-12
        )


def test_a_residual_is_that_of_the_surface_in_use_whatever_was_kept(points, model):
    kept = dataclasses.replace(points()[0], residual=0.5, surface='another')
    assert model.residuals([kept])[0] == pytest.approx(0.0, abs=1e-12)


def test_a_calibration_finds_factor_warmth_and_wiper_of_an_axis(surface, points):
    """The friction of known values is fitted again, within the doubt that the fit states."""
    true = Calibration((1.1, 0.05, 0.0, 3.0))
    of_axis = Model(surface, None, true)
    made = [
        dataclasses.replace(
            one, motor_torque=math.copysign(1.0, one.speed) * float(drag + of_axis.ideal(one))
        )
        for heat in (303.0, 313.0, 323.0)
        for one, drag in zip(
            points(days=1, temperature=heat), of_axis.friction(points(days=1, temperature=heat))
        )
    ]
    found = calibrated(made, surface)
    apart = np.array(found.values) - true.values
    assert (np.abs(apart) < 3.0 * np.sqrt(np.diag(found.covariance))).all()
    assert Model(surface, None, found).residuals(made) == pytest.approx(0.0, abs=0.01)
    assert calibrated([], surface).values == tuple(EXPECTED)


@given(part=st.floats(-0.4, 0.4))
def test_a_relative_change_is_found_and_lies_in_its_interval(surface, motion, part):
    model = Model(surface)

    def make(factor, first):
        found = []
        for day in range(4):
            for band, speed in enumerate(SPEEDS):
                point = motion.point(
                    first_day=motion.today + first + day,
                    place=Place(band, 0, 0, 1),
                    speed=speed,
                    axial_load=0.0,
                    residual=math.nan,
                )
                torque = factor * model.friction([point])[0]
                found.append(dataclasses.replace(point, motor_torque=torque))
        return found

    change = change_between(make(1.0, 0), make(1.0 + part, 40), model)
    assert change.common == pytest.approx(part, abs=1e-9)
    assert change.relative == pytest.approx(part, abs=1e-9)
    assert 0.0 < change.deviation < 0.05


def test_only_groups_of_both_times_are_compared_and_none_gives_none(points, model, motion):
    before, now = points(), points(first=40)
    assert change_between(before, [], model) is None
    derived = [dataclasses.replace(one, load_source=LoadSource.DERIVED) for one in now]
    assert change_between(before, derived, model) is None
    slow = [one for one in now if one.place.speed == 0]
    change = change_between(before, slow, model)
    assert len(change.groups) == len(LOADS) * 2
    assert parts_of(change) is None
    away = [dataclasses.replace(one, speed=1e6 * one.speed) for one in now]
    assert change_between(before, away, model) is None


def test_more_days_narrow_the_interval(points, model):
    before = points()
    few = change_between(before, points(days=1, first=40), model)
    many = change_between(before, points(days=7, first=40), model)
    assert many.deviation < few.deviation
    assert many.freedom == 4 + 4  # five days, and what is expected counts as four


def test_constant_and_proportional_parts_are_told_apart(points, model):
    change = change_between(
        points(), points(lambda one: 0.02 + 3e-4 * abs(one.speed), first=40), model
    )
    (constant, rate), deviations = parts_of(change)
    assert constant == pytest.approx(0.02, rel=1e-6)
    assert rate == pytest.approx(3e-4, rel=1e-6)
    assert (deviations > 0.0).all()
    forward, _ = select(change, [one.direction == 1 for one in change.groups])
    assert forward > 0.0
    assert math.isnan(select(change, [False] * len(change.groups))[0])


PLANTED = {
    CauseCode.PRELOAD_LOST: (0.6, lambda model, one: model.relieved([one], 0.6)[0]),
    CauseCode.OIL_THINNER: (12.0, lambda model, one: model.warmer([one], 12.0)[0]),
    CauseCode.OIL_THICKER: (12.0, lambda model, one: model.warmer([one], -12.0)[0]),
    CauseCode.WIPER: (0.06, lambda model, one: 0.06),
    CauseCode.CHURNING: (1e-3, lambda model, one: 1e-3 * abs(one.speed)),
    CauseCode.LOAD_SIGN_OR_UNIT: (-0.3, lambda model, one: -0.3 * model.ideal(one)),
    CauseCode.SENSOR_OFFSET: (0.1, lambda model, one: math.copysign(0.1, one.speed)),
}


@pytest.mark.parametrize('code', PLANTED, ids=lambda code: code.name)
def test_a_planted_cause_is_named_first_with_its_size(code, points, model):
    size, added = PLANTED[code]
    change = change_between(points(), points(lambda one: added(model, one), first=40), model)
    first, *others = causes_of(change, fits_of(change, model))
    assert (first.code, first.excluded) == (code, False)
    assert first.size.value == pytest.approx(size, rel=0.05)
    assert first.size.low <= size <= first.size.high
    assert first.weight > 0.5
    assert sum(one.weight for one in (first, *others)) == pytest.approx(1.0)
    assert any(one.excluded for one in others)


@pytest.mark.parametrize('code', ['OIL_THINNER', 'OIL_THICKER', 'PRELOAD_LOST'])
def test_a_pattern_that_is_not_quite_that_of_the_model_names_its_cause(code, points, model):
    """Another oil is not quite the same oil warmer: each speed differs by a tenth, up or down."""
    _, added = PLANTED[CauseCode[code]]

    def nearly(one):
        return added(model, one) * (1.1 if abs(one.speed) in list(SPEEDS)[::2] else 0.9)

    change = change_between(points(), points(nearly, first=40), model)
    first, *_ = causes_of(change, fits_of(change, model))
    assert first.code is CauseCode[code]


def test_a_starved_film_raises_the_friction_where_asperities_carry(points, model):
    change = change_between(
        points(), points(lambda one: model.starved([one], 0.5)[0], first=40), model
    )
    assert change.relative.max() > 0.02
    film = next(one for one in fits_of(change, model) if one.candidate.code.name == 'FILM_STARVED')
    assert film.low <= 0.5 <= film.high
    assert model.starved(points(days=1), 1.0) == pytest.approx(0.0, abs=1e-12)


def test_causes_need_three_places_and_every_code_has_one_row(points, model):
    now = [one for one in points(first=40) if one.place.speed == 0 and one.place.load == 0]
    change = change_between(points(), now, model)
    assert causes_of(change, fits_of(change, model)) == []
    codes = [one.code for one in CANDIDATES]
    assert len(set(codes)) == len(codes)
    assert set(CauseCode) - set(codes) == {CauseCode.WARMER_THAN_MEASURED}


@pytest.mark.parametrize(('chi', 'groups', 'expected'), [(3, 4, 1), (9, 4, 3), (5, 1, 5)])
def test_the_birge_ratio_never_narrows(chi, groups, expected):
    assert birge(chi, groups) == expected


def test_without_companions_a_preload_is_not_known_and_says_why(points, surface, companions):
    change = change_between(points(), points(first=40), Model(surface))
    found = preload_of(change, Model(surface), '', NONE_BUILT)
    assert (found.is_known, found.reason) == (False, NONE_BUILT)
    assert preload_of(None, Model(surface), 'no motion', companions).reason == 'no motion'
    fits = fits_of(change, Model(surface))
    assert CauseCode.PRELOAD_LOST not in [one.candidate.code for one in fits]


def test_a_lost_preload_is_found_beside_a_wiper(points, model, companions):
    def added(one):
        return model.relieved([one], 0.7)[0] + 0.01

    change = change_between(points(), points(added, first=40), model)
    found = preload_of(change, model, '', companions)
    assert found.low <= 0.7 <= found.high
    assert found.high - found.low < 0.4


def test_at_one_speed_without_a_temperature_the_preload_is_not_known(points, model, companions):
    def slow(found):
        return [
            dataclasses.replace(one, temperature_measured=False)
            for one in found
            if one.place.speed == 3 and one.place.load == 0
        ]

    change = change_between(slow(points()), slow(points(lambda one: -0.03, first=40)), model)
    found = preload_of(change, model, '', companions)
    assert not found.is_known
    assert 'measure the oil temperature' in found.reason


@pytest.mark.parametrize('share', [0.4, 0.5, 0.8, 1.0, 1.1])
def test_the_ratio_of_companions_is_their_power_of_the_preload(share, companions):
    for speed in SPEEDS:
        power = POWER / (1.0 + speed / 30.0)
        found = companions.friction_ratio(speed, 0.0, 313.0, share)
        assert found == pytest.approx(share**power, rel=1e-9)


def test_companions_are_read_beside_their_surface_and_others_refused(surface, tmp_path):
    from surrogate.surface import shipped_surface

    file = tmp_path / 'one.npz'
    file.write_bytes(shipped_surface().read_bytes())
    assert companions_beside(file, surface) == NONE_BUILT
    for share in PRELOAD_SHARES:
        data = read(file)
        inputs = data.header['inputs']
        screw = {**inputs['screw'], 'preload': share * inputs['screw']['preload']}
        header = {**data.header, 'inputs': {**inputs, 'screw': screw}}
        write(companion_path(file, share), dataclasses.replace(data, header=header))
    found = companions_beside(file, surface)
    assert found.friction_ratio(50.0, 0.0, 313.0, 0.8) == pytest.approx(1.0)
    companion_path(file, 0.4).write_bytes(companion_path(file, 0.6).read_bytes())
    assert 'built for a preload of 594 N' in companions_beside(file, surface)
    companion_path(file, 0.4).write_bytes(b'')
    assert companions_beside(file, surface).startswith('preload not known: ')


def test_patterns_vanish_without_their_cause(points, model):
    """Every signature is zero at the size that means nothing."""
    change = change_between(points(), points(first=40), model)
    nothing = {CauseCode.PRELOAD_LOST: 1.0, CauseCode.FILM_STARVED: 1.0}
    for one in causes.CANDIDATES:
        found = one.pattern(model, change.points, nothing.get(one.code, 0.0))
        assert np.abs(found) == pytest.approx(0.0, abs=1e-12), one.code
