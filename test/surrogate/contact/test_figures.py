# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a contact: what they draw, not how they look."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.contact.case import CaseGrid, CaseRoughness, CaseStrip, load_case
from surrogate.contact.rolling import march_case
from surrogate.contact.solve import solve_case
from surrogate.ehl import Status
from surrogate.ehl.moving import MarchStatus, MovingSolution

figures = pytest.importorskip('surrogate.contact.figures')
GRID = CaseGrid(nx=65, ny=33)
SMOOTH = replace(load_case('nominal_smooth'), grid=GRID)
ROUGH = replace(
    SMOOTH,
    entrainment_speed=0.1,
    roughness=CaseRoughness(rms=0.12e-6, shortest_wavelength=1e-4, seed=1),
)


def curves(axes):
    return {line.get_label(): line for line in axes.get_lines()}


@pytest.fixture(scope='module')
def smooth():
    return solve_case(SMOOTH)[0]


@pytest.fixture(scope='module')
def mixed():
    """Return a rough solution and its surface, some load moved to an asperity off the centre."""
    solution, surface = solve_case(ROUGH)
    asperity = np.zeros_like(solution.film_pressure)
    asperity[30:33, 20] = 1e9
    mask = asperity > 0
    return replace(solution, asperity_pressure=asperity, contact_mask=mask), surface


def test_smooth_profiles_and_maps_cover_the_ellipse(smooth):
    """Maps go beyond both semi-axes; the title of what did not converge warns."""
    upper, lower = figures.figure_profiles(smooth).axes
    assert list(curves(upper)) == ['film', 'Hertz, dry and smooth']
    expected = 1e-9 * smooth.film_pressure[:, 16]
    np.testing.assert_allclose(curves(upper)['film'].get_ydata(), expected)
    hertz = curves(upper)['Hertz, dry and smooth'].get_ydata()
    assert max(hertz) == pytest.approx(1e-9 * smooth.hertz_pressure, rel=1e-2)
    wanted = 1e9 * smooth.film[:, 16]
    np.testing.assert_allclose(curves(lower)['film on this line'].get_ydata(), wanted)
    assert curves(lower)['film floor'].get_ydata()[0] == pytest.approx(3.0)
    assert upper.get_ylabel().endswith('[GPa]')
    assert lower.get_ylabel().endswith('[nm]')
    left, right = figures.figure_maps(smooth).axes[:2]
    for axes in (left, right):
        assert axes.get_xlim()[0] < -1.1e6 * smooth.semi_axis_x
        assert axes.get_ylim()[1] > 1.1e6 * smooth.semi_axis_y
    figure = figures.figure_maps(replace(smooth, status=Status.STALLED))
    assert 'NOT CONVERGED' in figure.get_suptitle()


def test_mixed_profiles(mixed):
    """A second line runs through the asperities; they, the total and the marks are drawn."""
    figure = figures.figure_profiles(mixed[0])
    centre, loaded = figure.axes[:2]
    assert 'asperities' not in curves(centre)
    assert {'film', 'asperities', 'total'} < set(curves(loaded))
    assert max(curves(loaded)['asperities'].get_ydata()) == pytest.approx(1.0)
    marks = curves(figure.axes[3])['asperity contact']
    assert len(marks.get_xdata()) == 3


def test_all_pictures_are_written(tmp_path, mixed):
    paths = list(figures.draw_contact(tmp_path, *mixed))
    expected = 'contact_profiles.png contact_maps.png contact_roughness.png'.split()
    assert [path.name for path in paths] == expected
    assert sorted(tmp_path.iterdir()) == sorted(paths)
    for path in paths:
        assert path.read_bytes().startswith(b'\x89PNG')


def panels(solution):
    return {axes.get_title()[:3]: axes for axes in figures.figure_rolling(solution).axes}


def test_three_panels_of_rolling_roughness(marched):
    """Film over the contact, RCS along x in per cent, film at the centre over the transits."""
    solution, _ = marched
    found = panels(solution)
    a = 1e6 * solution.x_nodes[-1] / solution.x[-1]
    outline = found['(a)'].get_lines()[0].get_xdata()
    assert max(outline) == pytest.approx(a, rel=1e-3)
    (along,) = [line for line in found['(b)'].get_lines() if len(line.get_xdata()) > 2]
    np.testing.assert_allclose(along.get_ydata(), 100 * solution.rcs_along)
    lines = {line.get_label(): line for line in found['(c)'].get_lines()}
    wanted = 1e9 * solution.centre_films
    np.testing.assert_allclose(lines['film at the centre'].get_ydata(), wanted)
    assert lines['film at the centre'].get_xdata()[-1] == pytest.approx(solution.transits)
    assert lines['floor 3 nm'].get_ydata()[0] == pytest.approx(3.0)
    assert lines['next place'].get_xdata()[0] == pytest.approx(solution.transits / 2)
    expected = ['y across the track [µm]', 'RCS per semi-axis [%]', 'film [nm]']
    assert [found[letter].get_ylabel() for letter in ('(a)', '(b)', '(c)')] == expected


def test_a_strip_has_two_lines_for_its_zone(rolling_case):
    strip = CaseStrip(place=0.0, width=60e-6, columns=12)
    rough = replace(rolling_case.roughness, rms=0.02e-6)
    case = replace(rolling_case, strip=strip, roughness=rough, places=1, transits=1.0)
    solution, _ = march_case(case)
    edges = {line.get_xdata()[0] for line in panels(solution)['(a)'].get_lines()}
    b = 1e6 * solution.contact.semi_axis
    assert sorted(edges) == pytest.approx([-b, b])


def test_the_picture_of_a_march_is_written_where_there_is_one(marched, tmp_path):
    """A march that averaged nothing has none; one that ended early says so in its title."""
    solution, _ = marched
    (path,) = figures.draw_contact(tmp_path, solution)
    assert path.read_bytes().startswith(b'\x89PNG')
    early = replace(solution, status=MarchStatus.STALLED)
    assert 'NOT CONVERGED' in figures.figure_rolling(early).get_suptitle()
    inputs = {
        one: getattr(solution, one) for one in ('contact', 'lubricant', 'condition', 'settings')
    }
    bare = MovingSolution(**inputs, status=MarchStatus.NO_SMOOTH_FILM)
    assert not list(figures.draw_contact(tmp_path, bare))
