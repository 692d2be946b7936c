# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The picture of an identification: everything in it stands over the same speeds."""

import numpy as np
import pytest
from surrogate.identify.data import no_load_run
from surrogate.identify.fit import identify
from surrogate.identify.model import closed_form_model
from surrogate.units import RPM

figures = pytest.importorskip('surrogate.identify.figures')
SPEEDS = [60.0, 120.0, 300.0, 600.0, 1200.0, 2400.0]
"""Screw speeds [rev/min]."""


def test_curves_bands_and_points_share_the_speed_axis(screw, oil):
    """In rev/min: lines and points reach from the slowest to the fastest speed."""
    speed = np.array(SPEEDS) * RPM
    columns = {'speed': speed, 'torque': 0.1 + 1e-4 * speed}
    run = no_load_run(columns, source='made up', temperature=oil.reference_temperature, notes=())
    contacts = closed_form_model(screw, oil, run)
    figure = figures.figure_identification(run, identify(screw, run, contacts, ()), 'made up')
    upper = figure.axes[0]
    lines = {line.get_label(): line for line in upper.get_lines()}
    for name in ('model, datasheet', 'model, identified'):
        np.testing.assert_allclose(lines[name].get_xdata(), SPEEDS)
    band = upper.collections[0].get_datalim(upper.transData)
    assert (band.x0, band.x1) == (pytest.approx(60.0), pytest.approx(2400.0))
    points = upper.containers[0].lines[0]
    np.testing.assert_allclose(points.get_xdata(), SPEEDS)
    assert upper.get_ylabel().endswith('[mN m]')


@pytest.mark.parametrize('reason', ['', 'the torque tells nothing of it'])
def test_the_onset_is_marked_with_its_interval_or_as_taken(screw, oil, reason):
    """A line over the speeds, and a band only where the data tell one."""
    speed = np.array(SPEEDS) * RPM
    columns = {'speed': speed, 'torque': 0.1 + 1e-4 * speed}
    run = no_load_run(columns, source='made up', temperature=oil.reference_temperature, notes=())
    found = identify(screw, run, closed_form_model(screw, oil, run), ())
    onset = {
        'speed_rad_s': 200 * RPM,
        'speed_low_rad_s': 150 * RPM,
        'speed_high_rad_s': 260 * RPM,
        'reason': reason,
    }
    axes = figures.figure_identification(run, found, 'made up', onset).axes[0]
    (line,) = (one for one in axes.get_lines() if one.get_label().startswith('onset'))
    np.testing.assert_allclose(line.get_xdata(), 200.0)
    assert len(axes.patches) == (0 if reason else 1)
