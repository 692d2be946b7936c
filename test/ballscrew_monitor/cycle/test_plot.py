# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The picture appears whole or not at all; what it shows is for the eye."""

import dataclasses
import struct

from ballscrew_monitor.cycle import plot as cycle_plot
from ballscrew_monitor.cycle.state_trace import Tracer
from ballscrew_monitor.node.axis import load_surface
from ballscrew_monitor.node.parameters import defaults
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.recordings.summary import Summarizer
from matplotlib.figure import Figure
import numpy as np
import pytest
from surrogate.plotting.style import DPI


@pytest.fixture(scope='module')
def drawn(short_bag):
    """Return what is needed to draw the short bag."""
    values = defaults(['x']) | {'x.temperature.topic': 'oil_temperature'}
    summarizer, tracer = Summarizer(), Tracer()
    for state, event in replay(Bag(short_bag), values):
        summarizer.add_state(state)
        tracer.add_state(state)
        if event is not None:
            summarizer.add_event(event)
    return tracer.result(), summarizer.result(), load_surface('x', values)


def test_it_is_a_png_of_the_stated_size(drawn, tmp_path):
    cycle_plot.draw(*drawn, tmp_path / 'cycle.png')
    data = (tmp_path / 'cycle.png').read_bytes()
    assert data.startswith(b'\x89PNG')
    size = struct.unpack('>II', data[16:24])
    assert size == tuple(round(side * DPI) for side in cycle_plot.SIZE)
    assert [path.name for path in tmp_path.iterdir()] == ['cycle.png']


def test_without_any_oil_temperature_there_is_a_picture(drawn, tmp_path):
    trace, summary, surface = drawn
    unknown = np.full(trace.time.size, np.nan)
    trace = dataclasses.replace(trace, temperature=unknown)
    cycle_plot.draw(trace, summary, surface, tmp_path / 'cycle.png')
    assert (tmp_path / 'cycle.png').read_bytes().startswith(b'\x89PNG')


@pytest.mark.parametrize(('span', 'others'), [(3.0, False), (6.0, True)])
def test_borders_at_other_temperatures_are_announced_when_they_are_drawn(drawn, span, others):
    trace, _, surface = drawn
    temperature = np.linspace(40.0 - span / 2, 40.0 + span / 2, trace.time.size)
    speed = np.full(trace.time.size, 10.0)
    trace = dataclasses.replace(trace, temperature=temperature, speed=speed)
    mean, drawn_others = cycle_plot.draw_map(Figure().subplots(), trace, surface)
    assert (mean, drawn_others) == (40.0, others)


def test_a_failure_leaves_no_picture(drawn, tmp_path, monkeypatch):
    monkeypatch.setattr(cycle_plot, 'draw_map', lambda *arguments: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        cycle_plot.draw(*drawn, tmp_path / 'cycle.png')
    assert not list(tmp_path.iterdir())
