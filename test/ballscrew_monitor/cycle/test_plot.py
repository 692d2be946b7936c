# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The picture appears whole or not at all; what it draws of events, by its artists."""

import dataclasses
import struct

from ballscrew_monitor.cycle import plot as cycle_plot
from ballscrew_monitor.cycle.state_trace import Tracer
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.recordings.summary import EventRecord, Summarizer
from ballscrew_monitor.settings.axis import load_surface
from ballscrew_monitor.settings.parameters import defaults
from ballscrew_msgs.msg import BallScrewState
from matplotlib.figure import Figure
import numpy as np
import pytest
from surrogate.plotting.style import DPI
from surrogate.units import RPM


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


@pytest.fixture
def bare_map(monkeypatch):
    """Let the map have its limits and no lines, which take most of the time."""

    def draw_map(axes, trace, surface):
        axes.set_xscale('log')
        axes.set_xlim(0.5 / RPM, surface.speed_range[1] / RPM)
        axes.set_ylim(surface.load_range)
        return 40.0, False

    monkeypatch.setattr(cycle_plot, 'draw_map', draw_map)


def events_of(summary, *spans):
    """Return the summary with events at spans [s]; without an end one is on, as known at 0.5 s."""
    return dataclasses.replace(
        summary,
        events=tuple(
            EventRecord(
                event_id=number,
                start=summary.first + round(begin * 1e9),
                duration=0.5 if end is None else end - begin,
                active=end is None,
                quantity='efficiency',
                relation='<',
                worst_value=0.5,
                limit=0.85,
                advice='',
            )
            for number, (begin, end) in enumerate(spans, start=1)
        ),
    )


def laid_out(drawn, *spans):
    """Return the strips of a picture as it is drawn, with events at `spans` [s]."""
    trace, summary, surface = drawn
    figure = cycle_plot.figure_cycle(trace, events_of(summary, *spans), surface)
    figure.draw_without_rendering()
    return figure.subfigs[1].axes


def shaded(strip):
    """Return the spans [s] that are shaded in a strip of the course."""
    return [
        (patch.get_x(), patch.get_x() + patch.get_width())
        for patch in strip.patches
        if patch.get_height() == 1.0
    ]


@pytest.mark.usefixtures('bare_map')
def test_an_event_that_is_still_on_is_shaded_to_the_end(drawn):
    end = float(drawn[0].time[-1])
    for strip in laid_out(drawn, (0.2, 0.7), (1.0, None))[:2]:
        assert np.allclose(shaded(strip), [(0.2, 0.7), (1.0, end)], atol=1e-6)


@pytest.mark.usefixtures('bare_map')
def test_the_name_of_an_event_that_is_still_on_is_in_its_middle(drawn):
    level = laid_out(drawn, (1.0, None))[-1]
    (name,) = level.texts
    end = float(drawn[0].time[-1])
    assert name.get_text() == '1: efficiency'
    assert name.get_position()[0] * end == pytest.approx((1.0 + end) / 2)


@pytest.mark.usefixtures('bare_map')
@pytest.mark.parametrize(
    ('spans', 'names'),
    [
        ([(0.0, 0.01)], ['1: efficiency']),
        ([(2.98, None)], ['1: efficiency']),
        ([(0.0, 0.1), (0.15, 0.2), (0.5, None)], ['1', '2: efficiency', '3: efficiency']),
        ([(0.0, 0.001), (0.002, 0.003), (0.004, 2.0)], ['3: efficiency']),
    ],
)
def test_names_of_events_stay_off_the_name_of_the_strip_and_each_other(drawn, spans, names):
    level = laid_out(drawn, *spans)[-1]
    assert [text.get_text() for text in level.texts] == names
    inside = level.get_window_extent()
    edges = [level.yaxis.label.get_window_extent().x1, inside.x0]
    for text in level.texts:
        box = text.get_window_extent()
        edges += [box.x0, box.x1]
    assert edges + [inside.x1] == sorted(edges + [inside.x1])


@pytest.mark.usefixtures('bare_map')
@pytest.mark.parametrize('corner', [(0, 0), (1, 1)], ids=['slow, assisting', 'fast, opposing'])
def test_the_number_of_an_event_is_within_the_map(drawn, corner):
    trace, summary, surface = drawn
    speeds, still = (0.6, surface.speed_range[1]), np.zeros(trace.time.size)
    fixed = dataclasses.replace(
        trace,
        speed=still + speeds[corner[0]],
        opposing_load=still + surface.load_range[corner[1]],
        zone=still + BallScrewState.ZONE_OUTSIDE,
    )
    figure = cycle_plot.figure_cycle(fixed, events_of(summary, (0.0, None)), surface)
    figure.draw_without_rendering()
    (axes,) = figure.subfigs[0].axes
    (number,) = (text for text in axes.texts if text.get_text() == '1')
    inside, mark = axes.get_window_extent(), number.get_bbox_patch().get_window_extent()
    assert inside.y0 <= mark.y0 <= mark.y1 <= inside.y1
    assert inside.x0 <= mark.x0 <= mark.x1 <= inside.x1
