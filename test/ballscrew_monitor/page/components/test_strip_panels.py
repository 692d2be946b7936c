# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Panels have the limits and units of their axis, and any values can be drawn on them."""

import numpy as np
import pytest


@pytest.fixture
def shown(tab, greeted):
    tab.visit(greeted.url)
    tab.until("document.querySelectorAll('.u-over').length === 7")
    return tab


def test_limits_are_those_of_the_axis_in_the_unit_of_the_panel(shown):
    limits = shown.ask("""StripPanels.of(page.axis.facts).flatMap((panel) =>
        panel.limits.map((one) => [panel.title, one.value, one.label]))""")
    assert limits == [
        ['Efficiency [%]', 85, 'limit 85 %'],
        ['Contact (RCS): share of the load on metal [%]', 1, 'limit 1 %'],
    ]


def test_a_logarithmic_scale_begins_at_a_round_number_below_its_values(shown):
    """From another beginning uPlot steps beside the next decade, and never comes to an end."""
    least = np.geomspace(0.01, 99.0, 400).tolist()
    found = shown.ask(f"""{least}.map((least) =>
        Panel.scale({{ floor: 0.01, show: [] }}).range(null, least, 100)[0])""")
    for value, begin in zip(least, found, strict=True):
        assert 0.3 * value < begin <= value / 1.3
        assert f'{begin:.9e}'.startswith(f'{begin:.0e}'[0] + '.000000000')


def test_values_just_above_a_decade_are_drawn(shown, greeted, frames):
    greeted.send(
        {'kind': 'history', 'axis': '/ballscrew_monitor/x'}, frames.rows(200, rcs=1.26e-4)
    )
    shown.until('page.axis.rows.count === 200')
    shown.until('page.strips.panels[4].plot.data[1].at(-1) === 0.0126')
    assert shown.ask('page.strips.panels[4].plot.scales.y.min') == pytest.approx(0.009)
