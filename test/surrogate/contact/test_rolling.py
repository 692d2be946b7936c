# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Marching a case: what it states reaches the march, whole contact or strip."""

from dataclasses import replace
import logging

import numpy as np
import pytest
from surrogate.contact.case import CaseDomain, CaseGrid, CaseRoughness, CaseStrip
from surrogate.contact.rolling import case_strip, march_case, march_settings
from surrogate.ehl.moving import march_contact, StripContact
from surrogate.ehl.scales import scale_contact
from surrogate.ehl.watch import watched
from surrogate.raceway.scaling import draw_raceway, scale_spectrum
from surrogate.raceway.short_waves import without_short_waves
from surrogate.raceway.spectrum import RoughnessSpectrum


def scaled_to_settings(case):
    """Return the settings of a case on a smooth raceway."""
    scaled = scale_contact(case.contact, case.lubricant, case.condition, np.zeros_like)
    scaled = replace(scaled, roughness=lambda x, y: 0.0 * x * y)
    return march_settings(case, scaled)


def test_a_case_is_the_march_of_what_it_states(rolling_case, marched):
    """By hand: the spectrum, its draw without short waves, the march; the same numbers."""
    solution, _ = marched
    spectrum = RoughnessSpectrum(rms=0.1e-6, cutoff_long=0.08e-3, fractal_dimension=2.3)
    waves = without_short_waves(draw_raceway(scale_spectrum(spectrum), 3), 20e-6)
    mean = float(np.sum(waves.amplitude * np.cos(waves.phase)))
    surface = replace(waves, plane=(mean, 0.0, 0.0))
    expected = march_contact(
        rolling_case.contact,
        rolling_case.lubricant,
        rolling_case.condition,
        surface.heights,
        transits=2.0,
        settings=solution.settings,
    )
    assert solution.converged
    assert solution.rcs.value > 0
    assert solution.rcs.value == pytest.approx(expected.rcs.value, rel=1e-9)
    assert solution.mean_film.value == pytest.approx(expected.mean_film.value, rel=1e-9)


def test_settings_of_a_case(rolling_case):
    """Nodes, places, floor, domain and slip; what is not stated is the documented default."""
    bare = replace(rolling_case, grid=None, places=None, transits=None)
    found = scaled_to_settings(bare)
    assert (found.nx, found.ny, found.places) == (129, 257, 4)
    assert found.film_floor == rolling_case.film_floor
    stated = replace(
        rolling_case,
        domain=CaseDomain(inlet=-3.0, outlet=1.6, side=1.7),
        slide_roll_ratio=(0.05,),
        places=3,
        film_floor=1e-9,
    )
    found = scaled_to_settings(stated)
    assert (found.nx, found.ny, found.places) == (65, 33, 3)
    assert found.domain == (-3.0, 1.6, 1.7)
    assert found.slide_roll_ratio == 0.05
    assert found.film_floor == 1e-9


def test_every_step_is_told(rolling_case):
    seen = []
    short = replace(rolling_case, places=1, transits=1.0)
    with watched(lambda now: seen.append((now.step, now.steps)) if now.steps else None):
        solution, _ = march_case(short)
    assert seen == [(step, solution.steps) for step in range(solution.steps + 1)]


def test_a_strip_of_the_contact(rolling_case, caplog, says):
    """Its columns take the place of ny, its raceway repeats, and what that costs is said."""
    strip = CaseStrip(place=0.6, width=60e-6, columns=12)
    rough = replace(rolling_case.roughness, rms=0.02e-6)
    case = replace(rolling_case, strip=strip, roughness=rough, places=1, transits=1.0)
    with caplog.at_level(logging.INFO, 'surrogate.contact.rolling'):
        solution, _ = march_case(case)
    assert says('strip_repeat_across') in caplog.text
    assert isinstance(solution.contact, StripContact)
    assert solution.contact == case_strip(case, strip)
    assert solution.contact.columns == 12
    assert solution.film.shape == (65, solution.y_nodes.size)
    assert solution.converged


def test_a_rescaled_patch_rolls_on_the_level(rolling_case):
    rough = CaseRoughness(rms=0.02e-6, shortest_wavelength=40e-6, sample_length=0.1e-3, seed=1)
    case = replace(rolling_case, roughness=rough, places=1, transits=1.0)
    solution, surface = march_case(case)
    assert surface.plane[1:] == (0.0, 0.0)
    assert surface.scale != 1.0
    far = surface.heights(np.linspace(0.0, 1.0, 4000), [0.0])
    assert abs(far.mean()) < 0.1e-6
    assert solution.converged


def test_nodes_too_far_apart_are_said_and_too_few_transits_refused(rolling_case, caplog, refused):
    grid = CaseGrid(nx=17, ny=17)
    case = replace(rolling_case, grid=grid, places=1, transits=1.0)
    with caplog.at_level(logging.WARNING):
        march_case(case)
    assert 'um apart along x, the shortest wavelength is' in caplog.text
    refused('transits_1_0', march_case, replace(rolling_case, transits=1.0))
