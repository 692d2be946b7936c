# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Marches against what is known: rest, the smooth contact, one wave, energy, and bad input."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.ehl import Settings, solve_contact, Status
from surrogate.ehl.interface import NO_FADING
from surrogate.ehl.moving import march_contact, MarchSettings, MarchStatus, step
from surrogate.ehl.newton import solve_grid


def flat(x, y):
    return 0.0 * x * y


def wave_amplitude(march, length):
    """Return the amplitude of a wave, `length` over the semi-axis, in the film at the centre."""
    films = march.centre_films
    steps = np.arange(films.size) - films.size / 2
    turn = 2 * np.pi * (march.x[1] - march.x[0]) * march.settings.stride / length
    waves = np.stack([1 + 0 * steps, steps, np.cos(turn * steps), np.sin(turn * steps)], axis=1)
    _, _, along, across = np.linalg.lstsq(waves, films, rcond=None)[0]
    return math.hypot(along, across)


def test_a_flat_raceway_leaves_the_steady_contact_alone(smooth_march):
    """Nothing moves: no Newton step, no contact, the loss of the smooth contact at every step."""
    march = smooth_march
    assert march.status is MarchStatus.CONVERGED
    steady = solve_contact(
        march.contact,
        march.lubricant,
        march.condition,
        roughness=flat,
        settings=march.settings.steady((-2.6, 1.5, 1.5)),
    )
    assert march.rcs.value == 0.0
    assert march.asperity_share.value == 0.0
    assert march.rolling_loss.value == pytest.approx(march.smooth_rolling_loss, rel=1e-12)
    assert march.centre_films == pytest.approx(march.central_film, rel=1e-6)
    assert march.central_film == pytest.approx(steady.central_film, rel=0.02)


def test_a_standing_raceway_comes_to_the_steady_solution(circular, semi_axis, transverse):
    """Marched to rest with the roughness held, the gap is that of the steady solver."""
    rough = transverse(20e-9, semi_axis)
    march = circular(rough, transits=3.0, moving=False, flux_tolerance=1e-5, load_tolerance=1e-6)
    domain = (march.x[0], march.x[-1], march.y_nodes[-1] / semi_axis)
    settings = Settings(
        nx=65,
        ny=33,
        domain=tuple(map(float, domain)),
        open_inlet=True,
        film_floor=1e-10,
        flux_tolerance=1e-5,
        error_estimate=False,
        wedge_fading=NO_FADING,
    )
    steady = solve_contact(
        march.contact, march.lubricant, march.condition, roughness=rough, settings=settings
    )
    assert steady.status is Status.CONVERGED
    inside = steady.distance < 1
    assert np.abs(march.film - steady.film)[inside].max() < 0.1e-9
    assert march.film[inside].std() > 5e-9


@pytest.mark.parametrize('length', [1.0, 2.0])
def test_a_wave_keeps_its_published_amplitude(
    circular, smooth_march, semi_axis, transverse, length
):
    """Ad/Ai = 1/(1 + 0.15 n + 0.015 n^2), n = (lambda/a) sqrt(M/L): Venner, Lubrecht."""
    flat_film = smooth_march.central_film
    march = circular(transverse(0.1 * flat_film, length * semi_axis), transits=2.0)
    n = length * math.sqrt(100 / 10)
    found = wave_amplitude(march, length) / (0.1 * flat_film)
    assert found == pytest.approx(1 / (1 + 0.15 * n + 0.015 * n**2), rel=0.1)


def test_losses_by_dissipation_and_by_moment_agree(circular, smooth_march, semi_axis, transverse):
    """They differ as for the smooth contact, whose inlet is cut: one wave, then roughness."""
    left_out = smooth_march.moment_loss.value - smooth_march.rolling_loss.value
    wave = transverse(80e-9, semi_axis)

    def rough(x, y):
        return wave(x, y) + 60e-9 * np.cos(2 * np.pi * (1.7 * x + 2.3 * y) / semi_axis)

    for raceway in (wave, rough):
        march = circular(raceway, transits=2.0)
        moment = march.moment_loss.value - left_out
        assert moment == pytest.approx(march.rolling_loss.value, rel=0.01)
        assert march.rolling_loss.value > 1.01 * smooth_march.rolling_loss.value


def test_a_column_is_carried_through_a_stiff_oil(circular, semi_axis, transverse):
    """Waves too short to be flattened pass the contact nearly as high as they came in."""
    march = circular(transverse(2e-9, 0.25 * semi_axis), nx=129, transits=1.0)
    assert 0.94 < wave_amplitude(march, 0.25) / 2e-9 < 1.0


def test_longer_steps_find_the_same_wave(circular, semi_axis, transverse):
    """Steps over two nodes of half the distance: the same steps in time, other nodes."""
    rough = transverse(20e-9, semi_axis)
    films = [
        wave_amplitude(circular(rough, transits=2.0, **grid), 1.0)
        for grid in ({}, {'nx': 129, 'stride': 2}, {'nx': 129})
    ]
    assert films[1] == pytest.approx(films[0], rel=0.02)
    assert films[2] == pytest.approx(films[0], rel=0.03)


def test_places_give_the_standard_error(circular, semi_axis):
    """A raceway of ridges along the track: time averages differ from place to place alone."""

    def ridges(x, y):
        return 20e-9 * np.cos(2 * np.pi * y / (1.37 * semi_axis)) + 0 * x

    march = circular(ridges, transits=3.0, places=3)
    assert march.rcs.value == 0.0
    assert march.least_film.error > 1e-10
    assert math.isnan(circular(ridges).least_film.error)


def test_a_summit_that_fills_the_film_touches(circular, semi_axis, transverse):
    """Waves higher than the film: asperities carry part of the load, and numbers are bounded."""
    march = circular(transverse(400e-9, 0.5 * semi_axis), film_floor=20e-9)
    assert march.converged
    assert 0.0 < march.asperity_share.value < march.rcs.value < 1.0
    assert march.thin_shares[0].value == 0.0
    assert march.max_pressure.value > 1e9
    assert 0.0 <= march.hard_share.value <= march.rcs.value
    assert march.rcs_along.sum() * (march.x[1] - march.x[0]) == pytest.approx(march.rcs.value)
    assert march.least_film.value == pytest.approx(20e-9, rel=1e-3)


@pytest.mark.parametrize(
    ('ny', 'least'), [(33, 2e-4), pytest.param(65, 5e-4, marks=pytest.mark.long)]
)
def test_shear_thinning_flattens_a_wave(circular, semi_axis, transverse, ny, least):
    """Oil that the flow of the ripples thins leaks more, if little: the amplitude falls."""
    rough = transverse(60e-9, 0.5 * semi_axis)
    thick, stiff, thin = (
        wave_amplitude(circular(rough, nx=97, ny=ny, ripple_eyring_stress=stress), 0.5)
        for stress in (math.inf, 1e9, 1e6)
    )
    assert stiff == pytest.approx(thick, rel=1e-5)
    assert thin < (1 - least) * thick


def test_ridges_that_slip_sideways_move_through_the_film(circular, semi_axis):
    """Ridges along the track: the film at the centre stands without slip, and swings with it."""

    def ridges(x, y):
        return 20e-9 * np.cos(2 * np.pi * y / (0.5 * semi_axis)) + 0 * x

    still, one, other = (
        circular(ridges, transits=2.0, ny=65, side_slip=slip).centre_films
        for slip in (0.0, 0.4, -0.4)
    )
    assert np.ptp(still) < 0.5e-9
    assert np.ptp(one) > 5e-9
    assert other == pytest.approx(one, abs=0.3e-9)  # the ridges are even in y


def test_a_stalled_march_says_so(circular, semi_axis, transverse, monkeypatch):
    """Newton that never ends well: given up after three steps in a row, each tried four times."""
    starts = []

    def hopeless(grid, problem, start, limits):
        starts.append(start)
        return replace(solve_grid(grid, problem, start, limits), converged=False)

    monkeypatch.setattr(step, 'solve_grid', hopeless)
    march = circular(transverse(20e-9, semi_axis))
    assert march.status is MarchStatus.STALLED
    assert (march.steps, march.steps_failed, len(starts)) == (3, 3, 12)
    assert not march.converged
    assert march.transits == 0.0
    assert math.isnan(march.rcs.value)


@pytest.mark.parametrize(
    ('change', 'sentence'),
    [
        ({'transits': 0.5}, 'transits_0_5'),
        ({'stride': 0}, 'stride_0_number'),
        ({'places': 0}, 'places_0_number'),
        ({'slide_roll_ratio': -1.0}, 'slide_roll_ratio_1_0'),
        ({'ripple_eyring_stress': 1.0}, 'ripple_eyring_stress_1_0'),
        ({'side_slip': 2.0}, 'side_slip_2_0'),
        ({'nx': 64}, 'nx_64_odd'),
    ],
)
def test_bad_settings_are_one_sentence(circular, change, sentence, refused):
    refused(sentence, circular, flat, **change)


def test_raceways_that_end_and_fewer_transits_than_places_are_refused(
    circular, refused, moes_case
):
    refused('strip_has_end', circular, np.zeros((65, 33)))
    refused('finite', circular, lambda x, y: np.nan * x * y)
    contact, oil, condition, _ = moes_case(100, 10, 'roelands_dh')
    with refused('each_4_places'):
        march_contact(contact, oil, condition, flat, transits=2.0, settings=MarchSettings())


def test_what_arrives_from_outside_continues_the_first_two_rows():
    before = np.array([[10.0, 1.0], [20.0, 1.0], [45.0, 3.0], [7.0, 8.0]])
    after = [[-10.0, 1.0], [0.0, 1.0], [10.0, 1.0], [20.0, 1.0]]
    assert step.arrived(before, 2).tolist() == after
