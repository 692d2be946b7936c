# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The picture of a page appears whole or not at all, and holds what the page does."""

import dataclasses
import struct
from types import SimpleNamespace

from ballscrew_monitor.report import picture
from ballscrew_monitor.report.log_page import maps_of
from ballscrew_monitor.report.map_record import OperatingMap
from ballscrew_monitor.report.page import component
from matplotlib.colors import to_rgb
import numpy as np
import pytest
from surrogate.plotting.style import DPI, REGIMES_BY_METAL
from surrogate.surface import REGIMES


def small_map(*marks):
    return OperatingMap(
        temperature=40.0,
        others=False,
        banded=False,
        speed=(5.0, 2000.0),
        load=(-1000.0, 2000.0),
        light_load=250.0,
        zone=np.ones((4, 3), dtype=int),
        lines=[],
        dwell=np.zeros((2, 2)),
        events=list(marks),
    )


def test_axes_are_side_by_side_in_one_png(judged, tmp_path):
    cases = [judged.case([judged.rows(axis=axis)]) for axis in ('x', 'y')]
    picture.draw_log(judged.log(*cases), [small_map()] * 2, tmp_path / 'log.png')
    data = (tmp_path / 'log.png').read_bytes()
    assert data.startswith(b'\x89PNG')
    size = struct.unpack('>II', data[16:24])
    assert size == (round(2 * picture.WIDTH * DPI), round(picture.HEIGHT * DPI))
    assert [path.name for path in tmp_path.iterdir()] == ['log.png']


def test_a_failure_leaves_no_picture(judged, tmp_path, monkeypatch):
    monkeypatch.setattr(picture, '_draw_map', lambda *arguments: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        picture.draw_log(
            judged.log(judged.case([judged.rows()])), [small_map()], tmp_path / 'log.png'
        )
    assert not list(tmp_path.iterdir())


def strips_of(judged, case):
    (part,) = picture.figure_log(judged.log(case), [small_map()]).subfigs
    bars, *strips = part.subfigs[1].axes
    return bars, {strip.get_title(loc='left'): strip for strip in strips}


def test_panels_and_numbers_are_those_of_the_page(judged):
    case = judged.case([judged.rows(rcs=0.0)], [judged.event(7, 0.2, 0.4)])
    bars, strips = strips_of(judged, case)
    assert [text.get_text() for text in bars.texts] == ['7']
    assert bars.texts[0].get_position() == pytest.approx((0.4, 1.45))
    assert [tick.get_text() for tick in bars.get_yticklabels()] == ['Regime', 'Warning', 'Zone']
    expected = ['Screw', 'Axial', 'Oil', 'Efficiency,', 'Film', 'RCS:']
    assert [title.split()[0] for title in strips] == expected
    load = strips['Axial load, positive along the axis [N]']
    np.testing.assert_array_equal(load.lines[0].get_ydata(), judged.rows().rows['axial_load'])
    (shade,) = load.patches
    assert (shade.get_x(), shade.get_width()) == pytest.approx((0.2, 0.4))
    lowest = next(strip for title, strip in strips.items() if title.startswith('RCS'))
    assert set(lowest.lines[0].get_ydata()) == {1e-4}  # what is smaller is drawn on it


def test_a_long_verdict_keeps_within_the_width_of_the_picture(judged, monkeypatch):
    verdict = SimpleNamespace(whole='outside ' * 40, contact='contact ' * 40)
    monkeypatch.setattr(picture, 'verdict_of', lambda case: verdict)
    (part,) = picture.figure_log(judged.log(judged.case([judged.rows()])), [small_map()]).subfigs
    lines = part.subfigs[0].axes[0].get_title().splitlines()
    assert ' '.join(lines).count('outside') == 40
    assert max(map(len, lines)) <= picture.LINE


def test_colours_are_those_of_the_page(judged):
    assert f'--outside: {picture.COLOURS["outside"]};' in component('page.css')
    assert {colour for colour, _, _ in picture.STYLES.values()} <= picture.COLOURS.keys()


@pytest.mark.parametrize('temperature', [313.15, np.nan])
def test_names_of_lines_are_on_the_map_and_apart(judged, temperature):
    log = judged.log(judged.case([judged.rows(temperature=temperature)]))
    maps = maps_of(log)
    figure = picture.figure_log(log, maps)
    figure.draw_without_rendering()
    (axes,) = figure.subfigs[0].subfigs[0].axes
    inside = axes.get_window_extent()
    boxes = [text.get_window_extent() for text in axes.texts]
    assert {text.get_text() for text in axes.texts} >= {'40 °C', 'Λ 1', '85 %'}
    assert all(inside.x0 <= box.x0 and box.x1 <= inside.x1 for box in boxes)
    assert not any(
        one.overlaps(other) for place, one in enumerate(boxes) for other in boxes[:place]
    )


def test_a_map_of_feeds_has_them_below_and_the_speed_of_the_screw_above(judged):
    """Each tick stands at the speed that it is."""
    chart = dataclasses.replace(small_map(), feed=0.02)
    (part,) = picture.figure_log(judged.log(judged.case([judged.rows()])), [chart]).subfigs
    axes = part.subfigs[0].axes[0]
    (above,) = axes.child_axes
    assert axes.get_xlabel() == 'feed, either direction [m/min]'
    assert above.get_xlabel() == 'screw speed [rev/min]'
    for drawn, unit in ((axes, 0.02), (above, 1.0)):
        texts = [float(text.get_text()) for text in drawn.get_xticklabels()]
        assert texts == pytest.approx(unit * drawn.get_xticks())
        assert len(texts) > 5


def test_a_colour_has_one_meaning():
    """Zone, regimes, quantities and curves share none; regimes are those of other pictures."""
    names = 'optimal outside unjudged boundary mixed hydrodynamic heat rcs efficiency measured'
    colours = [picture.COLOURS[name] for name in [*names.split(), 'zone', 'none', 'modelled']]
    assert len(set(colours)) == len(colours)
    regimes = [picture.COLOURS[regime.word] for regime in REGIMES]
    assert regimes == list(REGIMES_BY_METAL)


@pytest.mark.parametrize(
    'darkest_first', ['outside optimal unjudged none', 'boundary mixed hydrodynamic']
)
def test_what_is_worse_is_darker_in_a_print_without_colours(darkest_first):
    colours = [to_rgb(picture.COLOURS[name]) for name in darkest_first.split()]
    grey = [0.3 * r + 0.59 * g + 0.11 * b for r, g, b in colours]
    assert np.diff(grey).min() > 0.15
