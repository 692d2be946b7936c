# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the comparison with the published study: what they draw, on made-up rows."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from surrogate.asperities.law import AsperityLaw
from surrogate.parameters import load_screw
from surrogate.studies.curves import StudyRow
from surrogate.studies.report import report, trends
from surrogate.studies.tasks import FIGURES, MAP_LOADS, PRELOAD, SMOOTH, SPEEDS, StudyTask, tasks

figures = pytest.importorskip('surrogate.studies.figures')
entrainment = figures.entrainment

SCREW, LAW = load_screw('nominal'), AsperityLaw(onsets={}, deviation=0.16)
UNITS = ('[-]', '[mm/s]', '[mN m]', '[nm]', '[N]', '[GPa]', '[µm]', '[rev/min]')


def made_up(task):
    """Return a row with numbers of the right size: friction falls, then rises with speed."""
    slow = 1 / (1 + (task.rpm / 8) ** 4)
    torque = 0.02 + 0.07 * slow + 1e-4 * task.rpm
    return StudyRow(
        **asdict(task),
        inputs='made up',
        status='CONVERGED',
        normal_force=27.6,
        central_film=1e-8 * task.rpm**0.5 * (1 + 0.01 * task.draw),
        mean_film=1.1e-8 * task.rpm**0.5 * (1 + 0.01 * task.draw),
        rcs=slow if task.kind == 'screw' or task.draw != SMOOTH else 0.0,
        asperity_share=0.7 * slow if task.rpm < 40 else 0.0,
        asperity_distance=0.6,
        rcs_loaded=slow,
        rcs_relieved=slow,
        friction_torque=torque,
        sliding_torque=0.6 * torque,
        rolling_torque=0.4 * torque,
        friction_coefficient=0.02 + 0.08 * slow,
        film_coefficient=0.02 * (1 - slow),
        asperity_coefficient=0.1 * slow,
        seconds=1.0,
    )


@pytest.fixture(scope='module')
def rows():
    """Return the rows of six draws by their keys."""
    return {task.key: made_up(task) for task in tasks(FIGURES, 6)}


@pytest.mark.long
def test_all_pictures_are_written(rows, tmp_path):
    """The trends are a table and have none."""
    paths = list(figures.draw_figures(SCREW, LAW, list(rows.values()), FIGURES, tmp_path))
    assert [path.name for path in paths] == [
        'paper_06b_torque.png',
        'paper_11_stribeck.png',
        'paper_12_maps.png',
        'paper_13_zone.png',
    ]
    for path in paths:
        assert path.read_bytes().startswith(b'\x89PNG')
    assert len(list(tmp_path.iterdir())) == len(paths)


@pytest.mark.parametrize('name', figures.DECLARED)
def test_axes_say_quantity_and_unit(rows, name):
    figure = figures.picture(SCREW, LAW, list(rows.values()), name)
    labels = [
        label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label
    ]
    assert len(labels) >= 2
    for label in labels:
        assert label.split(',')[0].endswith(UNITS), label
    assert len(figure.get_supxlabel()) > 60


def test_torque_over_entrainment(rows):
    axes = figures.figure_torque(list(rows.values())).axes[0]
    lines = {line.get_label(): line for line in axes.get_lines()}
    assert {'friction torque', 'sliding', 'rolling losses'} == set(lines)
    np.testing.assert_allclose(lines['friction torque'].get_xdata(), entrainment(SPEEDS))
    assert entrainment(100.0) == pytest.approx(83.776, abs=1e-3)


def test_stribeck_marks_limit_and_film_and_zone_needs_the_map_alone(rows):
    """RCS 0.01; 153 nm at 502.65 mm/s."""
    figure = figures.figure_stribeck(LAW, list(rows.values()))
    labels = [label for axes in figure.axes for label in axes.get_legend_handles_labels()[1]]
    assert 'limit 0.01' in labels
    assert 'reported, rough: 153 nm at 502.65 mm/s' in labels
    assert {'asperity share', 'film share'} <= set(labels)
    only = [row for row in rows.values() if row.load > 0 and row.kind == 'screw']
    assert figures.figure_maps(SCREW, only).axes
    assert figures.figure_zone(SCREW, LAW, only).axes


def test_maps_meet_their_nodes_and_a_point_that_failed_leaves_a_gap(rows):
    """Between the nodes lies a map that returns them; efficiency rises with load."""
    speed, load, rcs, eta = figures.fine_map(SCREW, list(rows.values()))
    corner = rows[StudyTask(kind='screw', rpm=SPEEDS[0], load=MAP_LOADS[-1], draw=SMOOTH).key]
    assert rcs[-1, 0] == pytest.approx(corner.rcs)
    ideal = corner.load * SCREW.lead / (2 * np.pi)
    assert eta[-1, 0] == pytest.approx(ideal / (ideal + corner.friction_torque))
    assert (np.diff(eta, axis=0) > 0).all()
    assert (speed[-1], load[0]) == pytest.approx((entrainment(SPEEDS[-1]), MAP_LOADS[0]))
    key = StudyTask(kind='screw', rpm=SPEEDS[3], load=MAP_LOADS[0]).key
    gap = rows | {key: replace(rows[key], status='STALLED')}
    assert np.isfinite(figures.fine_map(SCREW, list(gap.values()))[3]).all()


def test_report_leaves_out_what_the_rows_cannot_tell(rows):
    """Without rows no trend; of some rows only theirs; none is not finite."""
    assert trends(SCREW, LAW, []) == []
    names = [trend.name for trend in trends(SCREW, LAW, rows.values())]
    assert len(names) == len(set(names)) == 13
    torque = {key: row for key, row in rows.items() if row.load == PRELOAD and row.kind == 'screw'}
    text = report(SCREW, LAW, torque)
    assert 'nan' not in text
    assert '| friction torque' in text
    assert '| film over load' not in text
