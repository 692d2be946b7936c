# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A recording judged in one pass, for a page or for a terminal on a machine without its tools."""

from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.health.records import LoadSource
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.log_report import scratch_folder
from ballscrew_monitor.report.parameters import parameters_for
from ballscrew_monitor.report.row_table import RowStore
import pytest


@pytest.fixture(scope='module')
def parameters(request, short_bag):
    params = request.config.rootpath / 'config' / 'nominal_cycle.yaml'
    return parameters_for(Bag(short_bag), params, params)


def test_rows_are_kept_where_they_are_asked_for(short_bag, parameters, tmp_path):
    with scratch_folder(tmp_path) as folder:
        kept = judge_log(Bag(short_bag), parameters, rows=RowStore(folder)).axes[0]
        assert kept.row_table.rows == kept.survey.rows == kept.outcome.rows
    printed = judge_log(Bag(short_bag), parameters).axes[0]
    assert printed.survey == kept.survey
    assert printed.outcome.totals == kept.outcome.totals
    with pytest.raises(ValueError, match='the rows of axis x were not kept'):
        assert printed.row_table


def test_a_recording_that_no_node_made_numbers_no_messages(short_bag, parameters):
    assert not judge_log(Bag(short_bag), parameters).axes[0].numbered


@pytest.mark.parametrize('free', [False, True])
def test_what_is_advised_follows_the_parameters_of_the_axis(judged, free):
    """On warnings and in the health of a report alike."""
    values = judged.values(**{'x.advice.speed': free})
    case = judged.case([judged.rows()], values=values, health=True)
    assert case.settings.speed_allowed is free
    assert case.history.speed_allowed is free


def test_a_log_of_an_axis_without_process_force_tells_of_its_friction(judged):
    derived = judged.rows(count=300, motor_torque_source=1, axial_load_source=PointSource.DERIVED)
    block = judged.changed(derived, speed=100.0, motor_torque=derived.rows['machine_torque'])
    values = judged.values(**{'x.health.free_load': -200.0, 'x.health.always_free': True})
    (cell,) = judged.case([block], values=values, health=True).history.cells
    assert (cell.load_source, cell.axial_load) == (LoadSource.FREE, -200.0)
    (cell,) = judged.case([block], health=True).history.cells
    assert cell.load_source == LoadSource.DERIVED
