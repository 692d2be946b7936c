# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Film, asperity and rolling formulas against tables, asymptotes and each other."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.formulas import film as laws
from surrogate.formulas.geometry import Contact


def test_smooth_surfaces_have_no_end_of_the_ratio_and_resting_contacts_no_film():
    """Infinite above a film, 0 without one, unknown where the film is."""
    film = np.array([1e-7, 0.0, np.nan])
    np.testing.assert_array_equal(laws.film_ratio(film, 0.0), [np.inf, 0.0, np.nan])
    np.testing.assert_allclose(laws.film_ratio(film, 1e-7), [1.0, 0.0, np.nan])
    contact = Contact(radius_x=0.003, radius_y=0.08, reduced_modulus=2.26e11)
    g = laws.groups(contact, 27.6, 0.0, 0.06, 2e-8)
    assert laws.central_film_hamrock_dowson_1977(contact, g) == 0.0
    assert laws.rolling_force_biboulet_houpert_2010(contact, g) == 0.0


def dimensional(row):
    """Return contact, load, groups of a row of the dimensional table."""
    contact = Contact(
        radius_x=float(row['Rx_mm']) * 1e-3,
        radius_y=float(row['Ry_mm']) * 1e-3,
        reduced_modulus=float(row['E_reduced_GPa']) * 1e9,
    )
    load = float(row['load_N'])
    return (
        contact,
        load,
        laws.groups(
            contact,
            load,
            float(row['speed_m_s']),
            float(row['eta0_Pa_s']),
            float(row['alpha_1_Pa']),
        ),
    )


def moes(load, material, radius_ratio):
    """Return a unit contact and groups with Moes parameters M and L."""
    speed = 1e-11
    return (
        Contact(radius_x=1.0, radius_y=radius_ratio, reduced_modulus=1.0),
        laws.Groups(
            speed=np.float64(speed),
            load=np.float64(load * (2 * speed) ** 0.75),
            material=np.float64(material * (2 * speed) ** -0.25),
            radius_ratio=radius_ratio,
        ),
    )


def test_hamrock_and_dowson_against_converged_solutions_and_their_own_case(table):
    """Central film 4 to 11 % above; minimum film within 7 % for the long ellipse."""
    for row in table('ehl_dimensional.csv'):
        contact, _, g = dimensional(row)
        ratio = laws.central_film_hamrock_dowson_1977(contact, g) / (float(row['hc_nm']) * 1e-9)
        assert 1.04 < ratio < 1.11, row['case']
    row = next(r for r in table('ehl_dimensional.csv') if r['case'] == 'ball_screw_ellipse')
    contact, _, g = dimensional(row)
    found = laws.minimum_film_hamrock_dowson_1977(contact, g)
    assert found == pytest.approx(float(row['hmin_nm']) * 1e-9, rel=0.07)
    row = next(r for r in table('ehl_dimensional.csv') if r['case'] == 'hamrock_dowson_k1')
    contact, _, g = dimensional(row)
    assert g.speed == pytest.approx(1.683e-12, rel=2e-3)
    assert g.load == pytest.approx(1.106e-7, rel=2e-3)
    assert g.material == pytest.approx(4522, rel=2e-3)
    assert laws.outside_range('central_film_hamrock_dowson_1977', g) == ()
    expected = float(row['hmin_nm']) * 1e-9
    assert laws.minimum_film_hamrock_dowson_1977(contact, g) == pytest.approx(expected, rel=0.06)


@pytest.mark.parametrize(
    ('load', 'material', 'ratio', 'film'),
    [
        (500, 10, 25.0, 5.310),  # an incompressible solution extrapolated to 5.314
        (20, 10, 1.0, 4.265),
        # Elastic and isoviscous: 3.18 1.63^(-14/25) M^(-2/15), joined with 1.8 of no load.
        (10_000, 1e-3, 1.0, (0.70843**-4 + 1.8**-4) ** -0.25),
    ],
)
def test_nijenbanning_values(load, material, ratio, film):
    contact, g = moes(load, material, ratio)
    found = laws.central_film_nijenbanning_1994(contact, g) / np.sqrt(2 * g.speed)
    assert found == pytest.approx(film, rel=1e-3)


def test_nijenbanning_against_incompressible_solutions(table):
    """The fit lies within its 15 % band of the converged circular cases."""
    for row in table('ehl_circular.csv'):
        if row['fluid'] == 'barus_incompressible':
            contact, g = moes(float(row['M']), float(row['L']), 1.0)
            found = laws.central_film_nijenbanning_1994(contact, g) / np.sqrt(2 * g.speed)
            assert found == pytest.approx(float(row['Hc']), rel=0.15)


def test_rolling_force_of_short_domains_and_of_the_nominal_contact(table, screw):
    """A finite domain cuts the inlet and so the rolling force, by up to half."""
    row = next(r for r in table('ehl_dimensional.csv') if r['rolling_coefficient'])
    contact, load, g = dimensional(row)
    ratio = laws.rolling_force_biboulet_houpert_2010(contact, g) / load
    assert 1.0 < ratio / float(row['rolling_coefficient']) < 1.6
    # Extrapolated to a far inlet from the values at 4.5 and 10 half-widths, which fall as 1/x.
    assert ratio == pytest.approx(4.55e-4, rel=0.10)
    from surrogate.formulas.geometry import screw_contact

    contact = screw_contact(screw, 'screw')
    g = laws.groups(contact, 27.6, 0.49657, 0.060, 2e-8)
    found = laws.rolling_force_biboulet_houpert_2010(contact, g) / 27.6
    assert found == pytest.approx(1.05e-3, rel=0.25)


@given(st.floats(0.1, 1e3), st.floats(1.01, 100))
def test_rolling_force_has_its_isoviscous_limit(load, factor):
    """At M far below 6.6 the force is the rigid one and grows as U^(2/3)."""
    contact, slow = moes(1e-6 * load, 0.1, 4.0)
    fast = laws.Groups(
        speed=slow.speed * factor, load=slow.load, material=slow.material, radius_ratio=4.0
    )
    gain = laws.rolling_force_biboulet_houpert_2010(
        contact, fast
    ) / laws.rolling_force_biboulet_houpert_2010(contact, slow)
    assert gain == pytest.approx(factor ** (2 / 3), rel=1e-3)


def test_ranges_name_formulas_and_groups_and_leaving_one_is_told():
    import surrogate.formulas.film as module

    for formula, ranges in laws.RANGES.items():
        assert callable(getattr(module, formula))
        for name, (low, high) in ranges.items():
            assert hasattr(laws.Groups, name)
            assert low < high
    _, g = moes(500, 10, 25.0)
    expected = ('radius_ratio 25 (fitted 1 to 20)',)
    assert laws.outside_range('central_film_nijenbanning_1994', g) == expected
