# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Line contacts by formula: closed forms, groups by hand, the published wave curve, the film."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.ehl import ContactLubricant
from surrogate.ehl.moving import march_strip, MarchSettings, StripContact
from surrogate.formulas import line as laws
from surrogate.formulas.geometry import Contact, hertz

CONTACT = Contact(radius_x=2.589e-3, radius_y=77.39e-3, reduced_modulus=226.4e9)
LINE = laws.Line(radius=2.5e-3, reduced_modulus=226.4e9, max_pressure=np.array(0.9e9))


def test_half_width_and_groups_of_moes_by_hand():
    """U = 0.012/(226.4e9 * 2.5e-3) = 2.12e-11, L = 9.72, w/(E' R) = 9.93e-5, M1 = 21.6."""
    load = 0.5 * math.pi * 0.9e9 * LINE.semi_axis
    assert math.sqrt(load * 226.4e9 / (2 * math.pi * 2.5e-3)) == pytest.approx(0.9e9, rel=1e-12)
    M1, L = laws.moes_line(LINE, 0.1, 0.06, 2e-8)
    assert float(L) == pytest.approx(9.716, rel=1e-3)
    assert float(M1) == pytest.approx(21.56, rel=1e-3)


@given(load=st.floats(1.0, 200.0), place=st.floats(0.0, 0.99))
def test_a_strip_has_pressure_and_length_of_its_place(load, place):
    """Both fall with sqrt(1 - place^2); the radius is the same under any load."""
    ellipse, line = hertz(CONTACT, load), laws.line_at(CONTACT, load, place)
    left = math.sqrt(1 - place**2)
    assert float(line.max_pressure) == pytest.approx(float(ellipse.max_pressure) * left)
    assert float(line.semi_axis) == pytest.approx(float(ellipse.semi_axis_x) * left)
    assert line.radius == pytest.approx(laws.line_at(CONTACT, 1.0, 0.0).radius)


def test_strips_carry_the_load_of_the_ellipse():
    """The sum of pi/2 pH b over the width is the load, and the radius is near that along."""
    place, weight = np.polynomial.legendre.leggauss(4)
    line, width = laws.line_at(CONTACT, 27.6, place), float(hertz(CONTACT, 27.6).semi_axis_y)
    per_length = 0.5 * math.pi * line.max_pressure * line.semi_axis
    assert width * weight @ per_length == pytest.approx(27.6, rel=1e-9)
    assert line.radius == pytest.approx(CONTACT.radius_x, rel=0.05)


@pytest.mark.parametrize(
    ('n', 'left'), [(0.0, 1.0), (1.0, 0.8584), (2.5, 0.6400), (5.0, 0.3810), (10.0, 0.1600)]
)
def test_amplitude_curve(n, left):
    """1/(1 + 0.125 n + 0.04 n^2) at values by hand, with n from any of its factors."""
    for length, M1, L in ((n, 1.0, 1.0), (n / 8, 16.0, 1.0), (2 * n, 1.0, 4.0)):
        found = laws.amplitude_reduction_venner_1997(3e-5 * length, 3e-5, M1, L)
        assert float(found) == pytest.approx(left, abs=1e-4)


@given(n=st.floats(0.0, 100.0), more=st.floats(1e-3, 10.0))
def test_longer_waves_are_flattened_more(n, more):
    short, long = (
        float(laws.amplitude_reduction_venner_1997(x, 1.0, 1.0, 1.0)) for x in (n, n + more)
    )
    assert 0 < long < short <= 1


@given(speed=st.floats(1e-3, 1.0))
def test_the_film_does_not_fall_with_the_speed(speed):
    slow, fast = laws.central_film_line(LINE, np.array([1.0, 1.2]) * speed, 0.06, 2e-8)
    assert 0 < slow < fast
    assert float(laws.central_film_line(LINE, speed, 0.12, 2e-8)) > slow


@pytest.mark.parametrize(
    ('pressure', 'speed'),
    [(0.6e9, 0.03), (0.6e9, 0.3), (0.9e9, 0.03), (0.9e9, 0.1), (0.9e9, 0.3), (1.3e9, 0.3)],
)
def test_the_film_is_that_of_a_smooth_strip(pressure, speed):
    """5 to 20 % above a solved line contact, most where pressure and speed are high."""
    strip = StripContact(
        radius=2.5e-3, reduced_modulus=226.4e9, max_pressure=pressure, width=30e-6, columns=4
    )
    oil = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)
    settings = MarchSettings(nx=129, places=1, film_floor=1e-10)
    solved = march_strip(
        strip, oil, speed, lambda x, y: 0 * x * y, transits=1.0, settings=settings
    )
    line = replace(LINE, max_pressure=np.array(pressure))
    formula = float(laws.central_film_line(line, speed, 0.06, 2e-8))
    assert 1.0 < formula / solved.central_film < 1.21
