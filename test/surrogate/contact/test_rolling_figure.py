# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The picture of a rolling contact: what it draws, not how it looks."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.contact.case import CaseStrip
from surrogate.contact.rolling import march_case
from surrogate.ehl.moving import MarchStatus, MovingSolution

figures = pytest.importorskip('surrogate.contact.rolling_figure')


def panels(solution):
    return {axes.get_title()[:3]: axes for axes in figures.figure_rolling(solution).axes}


def test_three_panels(marched):
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


def test_the_picture_is_written_where_there_is_one(marched, tmp_path):
    """A march that averaged nothing has none; one that ended early says so in its title."""
    solution, _ = marched
    (path,) = figures.draw_rolling(tmp_path, solution)
    assert path.read_bytes().startswith(b'\x89PNG')
    early = replace(solution, status=MarchStatus.STALLED)
    assert 'NOT CONVERGED' in figures.figure_rolling(early).get_suptitle()
    inputs = {
        one: getattr(solution, one) for one in ('contact', 'lubricant', 'condition', 'settings')
    }
    bare = MovingSolution(**inputs, status=MarchStatus.NO_SMOOTH_FILM)
    assert not list(figures.draw_rolling(tmp_path, bare))
