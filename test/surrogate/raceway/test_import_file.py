# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files of measured surfaces: every form, and one sentence for every mistake."""

import sys

import numpy as np
import pytest
from surrogate.raceway.import_file import read_surface

X = np.arange(40) * 0.5
Y = np.arange(20) * 2.0
PROFILE = 80 * np.sin(X)
MAP = 80 * np.sin(X)[:, None] + 30 * np.cos(Y / 5)[None, :]


def write(folder, *lines, name='surface.csv'):
    """Write lines to a file and return its path."""
    path = folder / name
    path.write_text('\n'.join(str(line) for line in lines) + '\n', encoding='utf-8')
    return path


def columns(*values):
    return [','.join(repr(float(number)) for number in row) for row in zip(*values, strict=True)]


def test_a_profile_with_places_in_one_column_or_one_line(tmp_path):
    """Along x or y, with units of each column; the spacing says along which direction."""
    lines = columns(X, PROFILE)
    along = read_surface(write(tmp_path, '# stylus', 'x_um, z_nm', '', *lines))
    assert along.raw.shape == (40, 1)
    assert along.spacing_x == pytest.approx(0.5e-6)
    np.testing.assert_allclose(along.raw[:, 0], PROFILE * 1e-9)
    across = read_surface(write(tmp_path, 'y_mm,z_µm', *lines))
    assert across.raw.shape == (1, 40)
    assert across.spacing_y == pytest.approx(0.5e-3)
    np.testing.assert_allclose(across.raw[0], PROFILE * 1e-6)
    column = read_surface(write(tmp_path, 'z_nm,spacing_x_um=0.5', *PROFILE))
    line = read_surface(write(tmp_path, 'z_nm spacing_x_nm=500', ';'.join(map(str, PROFILE))))
    across = read_surface(write(tmp_path, 'z_nm,spacing_y_um=5e-1', *PROFILE))
    np.testing.assert_allclose(column.raw[:, 0], PROFILE * 1e-9)
    np.testing.assert_allclose(line.raw, column.raw)
    np.testing.assert_allclose(across.raw.T, column.raw)
    assert line.spacing_x == pytest.approx(column.spacing_x) == pytest.approx(0.5e-6)


def test_a_map_as_a_matrix_and_as_points_and_options(tmp_path):
    """Columns run along x and lines along y; points come in any order."""
    matrix = read_surface(write(tmp_path, 'z_nm,spacing_x_um=0.5,spacing_y_um=2', *columns(*MAP)))
    places = [part.ravel() for part in np.meshgrid(X, Y, indexing='ij')]
    order = np.random.default_rng(1).permutation(MAP.size)
    table = columns(places[0][order], places[1][order], MAP.ravel()[order])
    points = read_surface(write(tmp_path, 'x_um,y_um,z_nm', *table))
    for found in (matrix, points):
        np.testing.assert_allclose(found.raw, MAP * 1e-9)
        assert (found.spacing_x, found.spacing_y) == pytest.approx((0.5e-6, 2e-6))
        assert found.heights([0.0], [0.0]).shape == (1, 1)
    path = write(tmp_path, 'x_um,z_nm', *columns(X, PROFILE))
    found = read_surface(path, shortest_wavelength=4e-6, outside='mirror')
    assert found.shortest_wavelength == 4e-6
    assert np.ptp(found.raw) < 0.9 * np.ptp(PROFILE) * 1e-9
    assert found.heights([1.0], [0.0]).shape == (1, 1)


@pytest.mark.parametrize(
    ('lines', 'sentence'),
    [
        ([], 'empty_line_names'),
        (['x_um,z_um'], 'has_numbers_below'),
        (['1.0,2.0', '3.0,4.0'], 'first_line_has'),
        (['x,z', '1,2'], 'first_line'),
        (['x_um,z_inch', '1,2'], 'z_inch_has_wrong'),
        (['z_um,x_um', '1,2'], 'first_line_z_um'),
        (['z_um', '1'], 'z_um_with_spacing'),
        (['x_um,z_um,spacing_x_um=1', '1,2'], 'x_um_z_um'),
        (['z_um,spacing_x_um=-', '1'], 'line_1_has'),
        (['z_um,spacing_x_um=0', *PROFILE], 'spacing_0_m'),
        (['x_um,z_um', '1,2', '2,nan'], 'line_3_has'),
        (['x_um,z_um', '1,2', '2,high'], 'line_3'),
        (['x_um,z_um', '1,2', '2,'], 'line_3_has_finite'),
        (['x_um,z_um', '1,2', '# note', '2,3,4'], 'line_4_has'),
        (['x_um,y_um,z_um', '1,2'], 'line_has_2'),
        (['x_um,z_um', *columns(X[:9], X[:9])], '9_1_points'),
        (['x_um,z_um', *columns(X**2, PROFILE)], 'goes_by_um'),
        (['x_um,z_um', *columns(0 * X, PROFILE)], '40_points_do'),
        (['x_um,y_um,z_um', '0,0,1', '0,1,1', '1,0,1'], '3_points_do'),
        (['x_um,y_um,z_um', '0,0,1', '0,1,1', '1,0,1', '1,0,2'], '4_points_do'),
        (['z_um,spacing_x_um=1', '1,2', '3,4'], '2_lines_2'),
    ],
)
def test_bad_files_are_one_sentence(tmp_path, lines, sentence, refused):
    path = write(tmp_path, *lines)
    with refused(sentence) as caught:
        read_surface(path)
    assert str(caught.value).startswith(str(path))
    assert '\n' not in str(caught.value)


def test_files_that_cannot_be_read_or_need_the_library(tmp_path, refused, monkeypatch):
    refused('there_such_file', read_surface, tmp_path / 'absent.csv')
    path = tmp_path / 'binary.csv'
    path.write_bytes(bytes(range(256)))
    refused('cannot_read_as', read_surface, path)
    monkeypatch.setitem(sys.modules, 'SurfaceTopography', None)
    refused('needs_surfacetopography', read_surface, write(tmp_path, 'nothing', name='map.x3p'))


def test_areal_files(tmp_path, refused):
    """A file of an instrument comes through SurfaceTopography, in its own unit."""
    library = pytest.importorskip('SurfaceTopography')
    topography = library.Topography(MAP, (20.0, 40.0), unit='um')
    path = tmp_path / 'map.nc'
    topography.to_netcdf(str(path))
    found = read_surface(path)
    np.testing.assert_allclose(found.raw, MAP * 1e-6)
    assert (found.spacing_x, found.spacing_y) == pytest.approx((0.5e-6, 2e-6))
    garbage = write(tmp_path, 'nothing', name='map.x3p')
    refused('map_x3p_cannot', read_surface, garbage)
