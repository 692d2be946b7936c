# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the comparison with the published study: what they draw, on made-up rows."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from surrogate.asperities.law import AsperityLaw
from surrogate.parameters import load_screw
from surrogate.studies.curves import StudyRow
from surrogate.studies.report import marks, report, table, trends
from surrogate.studies.solve import Study
from surrogate.studies.tasks import FIGURES, MAP_LOADS, PRELOAD, SMOOTH, SPEEDS, StudyTask, tasks

figures = pytest.importorskip('surrogate.studies.figures')
screws = pytest.importorskip('surrogate.studies.screw_figures')
entrainment = screws.entrainment

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
        entrainment_speed=1e-3 * float(entrainment(task.rpm)),
        central_film=1e-8 * task.rpm**0.5 * (1 + 0.01 * task.draw),
        mean_film=1.1e-8 * task.rpm**0.5 * (1 + 0.01 * task.draw),
        minimum_film=4e-9,
        rcs=slow if task.kind == 'screw' or task.draw != SMOOTH else 0.0,
        asperity_share=0.7 * slow if task.rpm < 40 else 0.0,
        asperity_distance=0.6,
        rcs_loaded=slow,
        rcs_relieved=slow,
        friction_torque=torque,
        sliding_torque=0.6 * torque,
        rolling_torque=0.4 * torque,
        central_film_torque=0.62 * torque,
        track_torque=10 * torque,
        friction_coefficient=0.02 + 0.08 * slow,
        film_coefficient=0.02 * (1 - slow),
        asperity_coefficient=0.1 * slow,
        seconds=1.0,
    )


@pytest.fixture(scope='module')
def study():
    """Return a study of six draws with the same small fields for every picture."""
    x, y = np.linspace(-90e-6, 60e-6, 31), np.linspace(-450e-6, 450e-6, 21)
    wanted = tasks(FIGURES, 6)
    fields = {
        task.key: hump(x, y if task.fields == 'map' else y[10:11])
        for task in wanted
        if task.fields
    }
    return Study(rows={task.key: made_up(task) for task in wanted}, fields=fields)


def hump(x, y):
    """Return fields of a contact with an asperity in the middle."""
    inside = np.maximum(1 - (x[:, None] / 40e-6) ** 2 - (y[None, :] / 360e-6) ** 2, 0)
    return {
        'x': x,
        'y': y,
        'semi_axis_x': 40e-6,
        'semi_axis_y': 360e-6,
        'hertz_pressure': 0.9e9,
        'film_pressure': 0.8e9 * np.sqrt(inside),
        'asperity_pressure': np.where(inside > 0.9, 1e9, 0.0),
        'film': 4e-9 + 1e-7 * (1 - inside),
        'heights': 1e-7 * inside,
    }


def test_a_picture_is_written(study, tmp_path):
    (path,) = figures.draw_figures(study, ['8'], tmp_path)
    assert path.read_bytes().startswith(b'\x89PNG')
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.long
def test_all_pictures_are_written(study, tmp_path):
    paths = list(figures.draw_figures(study, FIGURES, tmp_path))
    assert [path.name for path in paths] == [
        'paper_04_surface.png',
        'paper_06b_torque.png',
        'paper_07_smooth_speed.png',
        'paper_08_smooth_load.png',
        'paper_09_rough_speed.png',
        'paper_10_rough_load.png',
        'paper_11_stribeck.png',
        'paper_12_maps.png',
        'paper_13_zone.png',
        'paper_trends.png',
    ]
    for path in paths:
        assert path.read_bytes().startswith(b'\x89PNG')
    assert len(list(tmp_path.iterdir())) == len(paths)


@pytest.mark.parametrize('name', FIGURES)
def test_axes_say_quantity_and_unit(study, name):
    figure = figures.pictures(study)[name]()
    labels = [
        label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label
    ]
    assert len(labels) >= 2
    for label in labels:
        assert label.split(',')[0].endswith(UNITS), label
    assert len(figure.get_supxlabel()) > 60


def test_torque_with_measurements(study):
    measured = np.array([100.0]), np.array([0.05]), np.array([0.01])
    axes = screws.figure_torque(list(study.rows.values()), measured).axes[0]
    lines = {line.get_label(): line for line in axes.get_lines()}
    for name in ('rolling', 'standing'):
        torque = lines[f'friction torque, {name} roughness']
        np.testing.assert_allclose(torque.get_xdata(), entrainment(SPEEDS))
    bars = axes.containers[0].lines[0]
    assert bars.get_xdata()[0] == pytest.approx(83.776, abs=1e-3)
    assert bars.get_ydata()[0] == pytest.approx(50.0)


def test_stribeck_marks_limit_and_film_and_zone_needs_the_map_alone(study):
    """RCS 0.01; 153 nm at 502.65 mm/s."""
    figure = screws.figure_stribeck(LAW, list(study.rows.values()))
    labels = [label for axes in figure.axes for label in axes.get_legend_handles_labels()[1]]
    assert 'limit 0.01' in labels
    assert 'reported, rough: 153 nm at 502.65 mm/s' in labels
    assert {'asperity share', 'film share'} <= set(labels)
    only = [row for row in study.rows.values() if row.load > 0 and row.kind == 'screw']
    assert screws.figure_maps(SCREW, only).axes
    assert screws.figure_zone(SCREW, LAW, only).axes


def test_maps_meet_their_nodes_and_a_point_that_failed_leaves_a_gap(study):
    """Between the nodes lies a map that returns them; efficiency rises with load."""
    speed, load, rcs, eta = screws.fine_map(SCREW, list(study.rows.values()))
    corner = study.rows[
        StudyTask(kind='screw', rpm=SPEEDS[0], load=MAP_LOADS[-1], draw=SMOOTH).key
    ]
    assert rcs[-1, 0] == pytest.approx(corner.rcs)
    ideal = corner.load * SCREW.lead / (2 * np.pi)
    assert eta[-1, 0] == pytest.approx(ideal / (ideal + corner.friction_torque))
    assert (np.diff(eta, axis=0) > 0).all()
    assert (speed[-1], load[0]) == pytest.approx((entrainment(SPEEDS[-1]), MAP_LOADS[0]))
    failed = [
        StudyTask(kind='contact', rpm=600.0, load=PRELOAD).key,
        StudyTask(kind='screw', rpm=SPEEDS[3], load=MAP_LOADS[0]).key,
    ]
    rows = study.rows | {key: replace(study.rows[key], status='STALLED') for key in failed}
    gap = replace(study, rows=rows)
    figure = figures.pictures(gap)['7']()
    labels = figure.axes[0].get_legend_handles_labels()[1]
    assert len(labels) == 4
    assert not [label for label in labels if '600 rev/min' in label]
    assert np.isfinite(screws.fine_map(SCREW, list(rows.values()))[3]).all()


def test_report_leaves_out_what_the_rows_cannot_tell(study):
    """Without rows neither number nor trend; of some rows only theirs; none is not finite."""
    assert marks(SCREW, {}) == []
    assert trends(SCREW, LAW, []) == []
    names = [mark.name for mark in marks(SCREW, study.rows)]
    assert len(names) == len(set(names)) == 12
    torque = {
        key: row for key, row in study.rows.items() if row.load == PRELOAD and row.kind == 'screw'
    }
    few = marks(SCREW, torque)
    assert 1 < len(few) < 6
    assert table(few).count('\n') == len(few) + 1
    text = report(SCREW, LAW, torque)
    assert 'nan' not in text
    assert '| friction torque' in text
    assert '| film over load' not in text
