# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a surface: what they draw, not how they look."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.surface import onset_of_surface, shipped_surface, Surface
from surrogate.surface.file import read

COMMAND = ('surface', 'plot')

figures = pytest.importorskip('surrogate.surface_tools.figures')
DATA = read(shipped_surface(tier='closed_form'))
SHIPPED = Surface(DATA)


@pytest.fixture
def coarse(monkeypatch):
    """Draw fewer points: titles, axes and words do not depend on them."""
    monkeypatch.setattr(figures, 'GRID', (31, 25))


@pytest.fixture(scope='module')
def part():
    return figures.cut(SHIPPED, 313.15)


def titles(figure):
    return [axes.get_title() for axes in figure.axes if axes.get_title()]


def test_a_slice_is_the_lookup_and_its_zone_classes_are_the_limits(part):
    """Load along the rows, speed in rev/min along the columns, both ends included."""
    j, i = 100, 120
    speed = part.speed[i] * np.pi / 30
    found = SHIPPED.lookup(speed, part.load[j], 313.15)
    assert part.fields['rcs'][j, i] == pytest.approx(found.rcs, rel=1e-9)
    assert part.fields['efficiency'][j, i] == pytest.approx(found.efficiency, rel=1e-9)
    assert np.isfinite(part.fields['rcs']).all()
    classes = figures.zone_classes(part)
    rcs, efficiency = part.fields['rcs'], part.fields['efficiency']
    judged = np.broadcast_to(np.abs(part.load)[:, None] >= part.light, rcs.shape)
    assert np.array_equal(classes == 0, judged & (rcs < 0.01) & (efficiency >= 0.85))
    assert np.array_equal(np.isin(classes, (1, 3)), rcs >= 0.01)
    assert set(np.unique(classes)) == {0, 1, 2, 3, 4}


def test_panels_and_axes(coarse):
    figure = figures.figure_surface(SHIPPED, 313.15)
    assert titles(figure) == [
        'Zone: RCS < 0.01, efficiency >= 0.85',
        'Efficiency, line: 0.85',
        'RCS, line: 0.01',
        'Film ratio Lambda, lines: 1 and 3',
        'Regime by Lambda',
        'Interpolation error, larger of both',
    ]
    assert figure.axes[4].get_xlabel() == 'speed [rev/min]'
    assert figure.axes[0].get_ylabel() == 'load against motion [N]'
    assert figure.axes[0].get_xscale() == 'log'
    words = ' '.join(figure.get_suptitle().split())
    assert onset_of_surface(SHIPPED, 313.15).sentence() in words


def test_what_is_good_is_bright_in_every_map(coarse):
    """The brightest colour is that of the highest efficiency and film, the least RCS and error."""
    figure = figures.figure_surface(SHIPPED, 313.15)
    maps = {axes.get_title(): axes.collections[0] for axes in figure.axes if axes.get_title()}
    assert len(maps) == 6
    for title, mesh in maps.items():
        if not title.startswith(('Zone', 'Regime')):
            low, high = (sum(mesh.cmap(end)[:3]) for end in (0.0, 1.0))
            assert (low > high) == title.startswith(('RCS', 'Interpolation')), title


def test_what_strips_differ_by_is_shown_when_it_is_known(coarse):
    """In place of the regime, which the lines of the film ratio tell; the limit gets its band."""
    header = {**DATA.header, 'limit_band': [0.5, 1.4], 'numerical_band': [0.8, 1.25]}
    drawn = replace(DATA, header=header, deviations={'rcs': 0.1 * DATA.fields['rcs']})
    shown = titles(figures.figure_surface(Surface(drawn), 313.15))
    assert 'RCS over strips' in shown
    assert 'Regime by Lambda' not in shown
    assert 'RCS, line: 0.01, dashed: its band, dotted: numerics alone' in shown


def test_a_surface_without_answers_is_drawn(coarse):
    hidden = Surface(replace(DATA, mask=np.ones_like(DATA.mask)))
    figure = figures.figure_surface(hidden, 313.15)
    assert [text.get_text() for text in figure.axes[1].texts] == ['not known']


def test_pictures_per_temperature(run, part, tmp_path, capsys, monkeypatch):
    """Of one slice as fine as always: names and sizes do not depend on the temperature."""
    monkeypatch.setattr(figures, 'cut', lambda surface, temperature: part)
    assert run('--out', tmp_path / 'a', '--temperature-degC', 30, 62.5) == 0
    paths = sorted((tmp_path / 'a').iterdir())
    assert [path.name for path in paths] == ['surface_30degC.png', 'surface_62.5degC.png']
    assert all(path.stat().st_size < 300_000 for path in paths)
    assert capsys.readouterr().out.split() == [str(path) for path in paths]


@pytest.mark.parametrize('celsius', [9.9, 80.1])
def test_a_temperature_that_is_not_covered(run, tmp_path, celsius, refused):
    refused('degc_surface_covers', run, '--out', tmp_path, '--temperature-degC', celsius)
