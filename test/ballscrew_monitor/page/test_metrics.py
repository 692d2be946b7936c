# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers for Prometheus, read by its own parser."""

import math

from ballscrew_monitor.page import metrics
from ballscrew_monitor.page.hub import Hub
from ballscrew_monitor.page.metrics import HubCollector, Metrics
from prometheus_client.openmetrics.parser import text_string_to_metric_families
import pytest

STATE = {
    'level': 'warn',
    'zone': 'outside',
    'totals': {
        'running_time': 100.0,
        'optimal_time': 60.0,
        'outside_time': 20.0,
        'energy_lost': 5000.0,
    },
    'inputs': [
        {'name': 'speed', 'state': 'ok', 'age_s': 0.5, 'lost': 3, 'dropped': 1},
        {'name': 'load', 'state': 'stale', 'age_s': math.nan, 'lost': None, 'dropped': 0},
        {'name': 'torque', 'state': 'not_configured', 'age_s': None, 'lost': 0, 'dropped': 0},
    ],
}
HEALTH = {'quantities': [{'name': 'life used', 'unit': '-', 'value': 0.25}]}


@pytest.fixture
def hub(page_parts):
    made, view = Hub(), page_parts.axis(axis='x "y"')
    view.hear(page_parts.row(2.0, rcs=0.02, efficiency=math.nan), STATE, page_parts.limits, 0.0)
    view.hear_health(HEALTH)
    made.add(view)
    return made


def numbers(hub):
    """Return the samples by name and the labels beyond node and axis."""
    text = Metrics(HubCollector(hub, lambda: 7))().body.decode()
    found = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            labels = {key: value for key, value in sample.labels.items() if key != 'node'}
            assert labels.pop('axis', 'x "y"') == 'x "y"'
            found[(sample.name.removeprefix('ballscrew_'), *labels.values())] = sample.value
    return found


def test_numbers_are_those_of_the_state(hub):
    found = numbers(hub)
    assert found['level',] == 2.0
    assert found['outside_share_ratio',] == 0.25
    assert found['rcs_ratio',] == 0.02
    assert math.isnan(found['efficiency_ratio',])
    assert found['energy_lost_joules_total',] == 5000.0
    assert found['input_ok', 'speed'] == 1.0
    assert found['input_ok', 'load'] == 0.0
    assert found['input_lost_total', 'speed'] == 3.0
    assert found['health', 'life used', '-'] == 0.25
    assert found['page_wrong_tokens_total',] == 7.0
    assert found['page_lost_messages_total',] == 0.0
    hub.miss(2)
    hub.miss(3)
    assert numbers(hub)['page_lost_messages_total',] == 5.0


def test_what_is_not_known_is_left_out(hub):
    found = numbers(hub)
    assert ('input_lost_total', 'load') not in found
    assert not [name for name in found if 'torque' in name]


def test_the_level_of_a_node_that_is_gone_is_unknown(hub):
    hub.lose('/monitor/x "y"')
    assert numbers(hub)['level',] == 0.0


def test_an_axis_of_which_nothing_was_heard_has_no_numbers(page_parts):
    hub = Hub()
    hub.add(page_parts.axis().__class__('/monitor', 'x "y"'))
    assert {name[0] for name in numbers(hub)} == {
        'level',
        'state_age_seconds',
        'page_browsers',
        'page_dropped_frames_total',
        'page_lost_messages_total',
        'page_wrong_tokens_total',
    }


def test_without_axes_there_are_the_numbers_of_the_page():
    assert numbers(Hub())['page_browsers',] == 0.0


def test_each_number_has_a_help_that_is_no_other(hub):
    helps = [text for text, _, _ in (*metrics.GAUGES.values(), *metrics.COUNTERS.values())]
    assert len(helps) == len(set(helps))
