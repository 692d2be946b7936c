# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The acting roughness: one wave by hand, the inverse of the ratio, smooth raceways."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.asperities.acting import (
    acting_rms,
    film_over_acting,
    speed_at_ratio,
    stated_waves,
    Waves,
    waves_of,
)
from surrogate.ehl import ContactLubricant
from surrogate.formulas.line import (
    amplitude_reduction_venner_1997,
    central_film_line,
    Line,
    moes_line,
)
from surrogate.parameters import BallRoughness, load_screw
from surrogate.raceway.scaling import scale_spectrum
from surrogate.raceway.stated import spectrum_of

SCREW = load_screw('nominal')
OIL = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)
LINE = Line(radius=2.5e-3, reduced_modulus=226.4e9, max_pressure=np.array(0.9e9))
ROUGH = stated_waves(SCREW.roughness, None)
SPEED = np.array(0.1)
RATIOS = st.floats(0.2, 5.0)


def one_wave(amplitude, length):
    """Return the waves of a single sine [m]."""
    return Waves(length=np.array([length]), mean_square=np.array([0.5 * amplitude**2]))


@given(amplitude=st.floats(1e-9, 1e-6), length=st.floats(1e-6, 1e-3))
def test_one_wave_acts_with_what_is_left_of_it(amplitude, length):
    """Rms A/sqrt(2) times the amplitude reduction."""
    M1, L = moes_line(LINE, SPEED, OIL.viscosity, OIL.pressure_viscosity)
    left = float(amplitude_reduction_venner_1997(length, LINE.semi_axis, M1, L))
    found = float(acting_rms(one_wave(amplitude, length), LINE, SPEED, OIL))
    assert found == pytest.approx(amplitude / math.sqrt(2) * left, rel=1e-12)


def test_waves_add_their_squares():
    """Two fields are independent."""
    both = Waves(length=np.array([5e-6, 4e-5]), mean_square=np.array([1e-16, 4e-16]))
    parts = [
        Waves(length=both.length[place:][:1], mean_square=both.mean_square[place:][:1])
        for place in (0, 1)
    ]
    whole, first, second = (float(acting_rms(one, LINE, SPEED, OIL)) for one in (both, *parts))
    assert whole == pytest.approx(math.hypot(first, second), rel=1e-12)


def test_all_waves_together_are_the_height_of_the_sheet():
    """The variance of the field; shorter waves can be left out; a ball adds its own."""
    field = scale_spectrum(spectrum_of(SCREW.roughness))
    whole = ROUGH.mean_square.sum()
    assert whole == pytest.approx(waves_of(field).mean_square.sum())
    assert math.sqrt(whole) == pytest.approx(SCREW.roughness.rms, rel=0.5)
    long = ROUGH.longer_than(10e-6)
    assert 0 < long.mean_square.sum() < whole
    assert long.length.min() >= 10e-6
    ball = stated_waves(SCREW.roughness, BallRoughness(grade='G10'))
    assert ball.mean_square.sum() > whole


def test_ratio_is_the_film_over_the_acting_roughness():
    """At many speeds and pressures at once as at each."""
    speeds = np.array([0.01, 0.1, 1.0])
    pressed = replace(LINE, max_pressure=np.array([[0.6e9], [1.2e9]]))
    film = central_film_line(pressed, speeds, OIL.viscosity, OIL.pressure_viscosity)
    found = film_over_acting(ROUGH, pressed, speeds, OIL)
    assert found.shape == (2, 3)
    assert found == pytest.approx(film / acting_rms(ROUGH, pressed, speeds, OIL))
    alone = replace(LINE, max_pressure=np.array(1.2e9))
    assert found[1, 2] == pytest.approx(float(film_over_acting(ROUGH, alone, speeds[2], OIL)))


@given(ratio=RATIOS)
def test_the_speed_of_a_ratio_has_that_ratio(ratio):
    """For pressures side by side, to the grid of speeds."""
    lines = replace(LINE, max_pressure=np.array([0.4e9, 0.9e9, 1.5e9]))
    speed = speed_at_ratio(ROUGH, lines, OIL, np.array(ratio))
    assert speed.shape == (3,)
    assert film_over_acting(ROUGH, lines, speed, OIL) == pytest.approx(ratio, rel=1e-3)


@given(ratio=RATIOS, more=st.floats(1.01, 3.0))
def test_a_thicker_film_asks_for_more_speed(ratio, more):
    """As does a rougher raceway."""
    slow, fast = speed_at_ratio(ROUGH, LINE, OIL, np.array([ratio, more * ratio]))
    rougher = Waves(length=ROUGH.length, mean_square=more**2 * ROUGH.mean_square)
    assert 0 < slow < fast
    assert fast == pytest.approx(float(speed_at_ratio(rougher, LINE, OIL, np.array(ratio))))


def test_a_smooth_raceway_has_no_onset():
    """No speed has the ratio, whatever the pressures; nor has one so fine that all is film."""
    smooth = stated_waves(replace(SCREW.roughness, rms=0.0), None)
    lines = replace(LINE, max_pressure=np.array([0.4e9, 0.9e9]))
    assert speed_at_ratio(smooth, lines, OIL, np.array(1.0)).tolist() == [0.0, 0.0]
    fine = one_wave(1e-14, 1e-5)
    assert float(speed_at_ratio(fine, LINE, OIL, np.array(1.0))) == 0.0
