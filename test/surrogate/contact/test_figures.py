# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a contact: what they draw, not how they look."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.contact.case import CaseGrid, CaseRoughness, load_case
from surrogate.contact.solve import solve_case

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
    from surrogate.ehl import Status

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
    expected = 'contact_profiles.png contact_maps.png contact_3d.png contact_roughness.png'.split()
    assert [path.name for path in paths] == expected
    assert sorted(tmp_path.iterdir()) == sorted(paths)
    for path in paths:
        assert path.read_bytes().startswith(b'\x89PNG')
