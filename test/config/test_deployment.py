# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The systemd unit and the layouts name what is there."""

import argparse
import configparser
import importlib
import json
from pathlib import Path
import re
import xml.etree.ElementTree as ElementTree

from ballscrew_monitor import options
from ballscrew_monitor.settings import parameters
from ballscrew_msgs.msg import BallScrewState
from rosidl_parser.definition import BasicType, NamespacedType
import yaml

CONFIG = Path(__file__).resolve().parents[2] / 'config'
STATE = '/ballscrew_monitor/x/state'
FOXGLOVE = CONFIG / 'layouts' / 'foxglove_axis_x.json'


def unit():
    """Return the lines of the systemd unit that are no comments, by section."""
    parser = configparser.ConfigParser(strict=False, interpolation=None, delimiters=['='])
    parser.optionxform = str
    parser.read(CONFIG / 'ballscrew_monitor.service')
    return parser


def test_the_unit_starts_the_executable_with_a_parameter_file():
    service = unit()['Service']
    program, *arguments = service['ExecStart'].split()
    assert Path(program).name == parameters.NODE_NAME
    assert arguments[:2] == ['--ros-args', '--params-file']
    assert service['RestartPreventExitStatus'] == '2'
    assert service['KillSignal'] == 'SIGINT'
    assert unit()['Install']['WantedBy'] == 'multi-user.target'


def is_a_number_of_the_state(path):
    """Tell whether names, outermost first, lead to a number in a state."""
    kind, message = None, BallScrewState()
    for name in path:
        kind = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES)).get(name)
        if isinstance(kind, NamespacedType):
            message = getattr(message, name)
    return isinstance(kind, BasicType)


def drawn_by_foxglove():
    """Return the paths that the layout of Foxglove draws, and check that each panel is placed."""
    text = FOXGLOVE.read_text()
    panels = json.loads(text)['configById']
    assert set(re.findall(r'"((?:\w+)!x\d*)"(?!:)', text)) == set(panels)
    paths = [path['value'] for panel in panels.values() for path in panel.get('paths', [])]
    return {tuple(path.removeprefix(f'{STATE}.').split('.')) for path in paths}


def drawn_by_plotjuggler():
    tree = ElementTree.parse(CONFIG / 'layouts' / 'plotjuggler_axis_x.xml')
    names = [curve.get('name') for curve in tree.iter('curve')]
    return {tuple(name.removeprefix(f'{STATE}/').split('/')) for name in names}


def test_layouts_draw_the_same_numbers_of_the_state():
    drawn = drawn_by_foxglove()
    assert drawn == drawn_by_plotjuggler()
    assert {('result', 'efficiency'), ('result', 'rcs'), ('level',)} <= drawn
    assert all(is_a_number_of_the_state(path) for path in drawn)
    assert not is_a_number_of_the_state(('result', 'efficency'))


def test_plots_of_foxglove_show_a_whole_recording_under_titles_and_labels():
    panels = json.loads(FOXGLOVE.read_text())['configById']
    plots = [panel for name, panel in panels.items() if name.startswith('Plot!')]
    assert len(plots) == 5
    for plot in plots:
        # Foxglove and its open fork read a title under different names, and neither as `title`.
        assert plot['foxglovePanelTitle'] == plot['lichtblickPanelTitle'] != ''
        assert all(path['label'] for path in plot['paths'])
        # A width that follows the playhead leaves a recording empty until it is played.
        assert 'followingViewWidth' not in plot


def test_the_dashboard_draws_what_the_page_serves():
    """Every metric that Grafana asks for is one of `ballscrew page`."""
    metrics = importlib.import_module('ballscrew_monitor.page.metrics')
    names = {f'ballscrew_{name}' for name in metrics.GAUGES}
    names |= {f'ballscrew_{name}_total' for name in metrics.COUNTERS}
    names |= {f'ballscrew_page_{name}' for name in ('browsers', 'dropped_frames_total')}
    names |= {'ballscrew_state_age_seconds'}
    dashboard = json.loads((CONFIG / 'grafana_dashboard.json').read_text())
    drawn = [one['expr'] for panel in dashboard['panels'] for one in panel['targets']]
    asked = {name for expr in drawn for name in re.findall(r'\bballscrew_\w+', expr)}
    assert asked <= names
    assert {'ballscrew_level', 'ballscrew_health', 'ballscrew_rcs_ratio'} <= asked


def test_prometheus_asks_where_the_page_is_served():
    example = yaml.safe_load((CONFIG / 'prometheus.yml').read_text())
    (job,) = example['scrape_configs']
    parser = argparse.ArgumentParser()
    options.add_page(parser)
    served = parser.parse_args([])
    assert job['static_configs'] == [{'targets': [f'{served.host}:{served.port}']}]
