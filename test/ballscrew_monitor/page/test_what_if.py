# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Maps that follow an axis, and questions over its surface, through the answers to a browser."""

import asyncio
import math
from types import SimpleNamespace

from ballscrew_monitor.core.conversions import kelvin
from ballscrew_monitor.page.hub import Browser, Hub
from ballscrew_monitor.page.phrases import english, phrase
from ballscrew_monitor.page.what_if import WARMER, WhatIf
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.units import RPM

NAME = '/monitor/x'
# Speed [rev/min], load on the nut [N], temperature [degC] and the load that opposes the motion.
LIMITED = (
    (300.0, -2860.0, 20.0, 2860.0),
    (300.0, 2860.0, 45.0, -2860.0),
    (-300.0, 1000.0, math.nan, 1000.0),
)


@pytest.fixture(scope='module')
def surface():
    return Surface.load(shipped_surface())


class Asked:
    """One axis that moves, and what is answered of it."""

    def __init__(self, parts, surface, oils=()):
        self.parts, self.hub, self.view, self.stamp = parts, Hub(), parts.axis(), 2.0
        self.view.know({}, surface, 'no map here')
        self.hub.add(self.view)
        self.what_if = WhatIf(self.hub, oils)

    def move(self, load=-500.0, warmth=40.0, speed=300.0, **limits):
        for _ in range(3):
            self.stamp += 0.1
            row = self.parts.row(self.stamp, speed_rpm=speed, load_N=load, temperature_degC=warmth)
            self.view.hear(row, {}, self.parts.limits | limits, 0.0)

    def keep(self):
        before = self.view.map_frame
        asyncio.run(self.what_if.keep(self.view, self.view.surface))
        return self.view.map_frame is not before

    def ask(self, do, **request):
        handler = self.what_if.handlers[do]
        return asyncio.run(handler(Browser(), {'axis': NAME, **request}))


@pytest.fixture
def asked(page_parts, surface):
    one = Asked(page_parts, surface)
    one.move()
    return one


def test_a_map_is_made_when_temperature_limits_or_loads_leave_it(asked):
    assert asked.keep()
    assert not asked.keep()
    asked.move(warmth=40.0 + 0.9 * WARMER)
    assert not asked.keep()
    asked.move(warmth=40.0 + 1.1 * WARMER)
    assert asked.keep()
    asked.move(load=-3000.0, warmth=40.6)
    assert asked.keep()
    asked.move(load=-400.0, warmth=40.6)
    assert not asked.keep()
    asked.move(rcs_limit=0.02, warmth=40.6)
    assert asked.keep()


def test_a_browser_is_sent_the_map_and_greeted_with_it(asked, page_parts):
    browser = Browser()
    asked.hub.browsers.add(browser)
    asked.keep()
    (made,) = browser._waiting
    assert page_parts.read(made)[0]['kind'] == 'map'
    later = Browser()
    asked.hub.join(later, 0.0)
    assert made in later._waiting


def test_the_limit_is_that_of_the_newest_row(asked, surface):
    asked.keep()
    for at, (speed, load, warmth, opposing) in enumerate(LIMITED):
        row = asked.parts.row(9.0 + at, speed_rpm=speed, load_N=load, temperature_degC=warmth)
        asked.view.history.take(row)
        limit, heat = asked.view.limit, asked.view.warmth if math.isnan(warmth) else warmth
        rcs = surface.lookup(limit['speed_rpm'] * RPM, opposing, kelvin(heat)).rcs
        assert rcs == pytest.approx(asked.view.limits['rcs_limit'], rel=0.02)
    asked.view.know({}, None, 'no map here')
    assert asked.view.limit is None


def test_map_read_ghosts_and_limit_are_those_of_the_corrected_surface(page_parts, surface):
    """A full solve has found contact where the axis moves and the file knows none."""
    asked = Asked(page_parts, surface)
    asked.move(speed=800.0, load=-1500.0)
    place = SimpleNamespace(speed=800.0 * RPM, opposing_load=1500.0, temperature=kelvin(40.0))
    said = []
    for known in (surface, surface.with_correction(place, SimpleNamespace(rcs=0.3))):
        asked.view.know({}, known, '')
        assert asked.keep()
        record, arrays = page_parts.read(asked.view.map_frame)
        assert record['without'] == 0
        ghost = asked.ask('ghosts', factors=[1])[0]['ghosts'][0]
        point, _ = asked.ask('read', speed_rpm=800, load_N=1500.0)
        said.append((point['rcs'], ghost['outside_share'], asked.view.limit, arrays['zone']))
    (rcs, share, limit, zone), (solved, share_then, limit_then, zone_then) = said
    assert (rcs < 0.001, share) == (True, 0.0)
    assert (solved, share_then) == (pytest.approx(0.3), 1.0)
    assert limit['speed_rpm'] < 800.0 < limit_then['speed_rpm']
    assert np.any((zone == 1.0) & (zone_then == 0.0))
    assert not np.any((zone == 0.0) & (zone_then == 1.0))


def test_a_map_says_how_many_corrections_it_lacks(page_parts, surface):
    asked = Asked(page_parts, surface, [Surface.load(shipped_surface(tier='closed_form'))])
    asked.move()
    asked.what_if._oils[0].header['inputs']['lubricant']['name'] = 'thick'
    asked.view.know({}, surface, '', 2)
    asked.keep()
    assert page_parts.read(asked.view.map_frame)[0]['without'] == 2
    assert asked.ask('map', quantity='rcs')[0]['without'] == 2
    # Of another oil nothing has been corrected.
    assert asked.ask('map', quantity='rcs', oil='thick')[0]['without'] == 0


def test_without_a_load_there_is_no_limit(asked):
    asked.view.history.take(asked.parts.row(19.0, speed_rpm=300.0, load_N=math.nan))
    assert asked.view.limit is None


def test_questions_are_answered(asked, surface):
    record, arrays = asked.ask('map', quantity='rcs', temperature_degC=20)
    assert (record['quantity'], record['temperature_degC']) == ('rcs', 20.0)
    assert arrays['cells'].size == record['rows'] * record['columns']
    record, _ = asked.ask('read', speed_rpm=1500, load_N=1000.0, temperature_degC=None)
    assert record['temperature_degC'] == 40.0
    assert record['zone'] == 'optimal'
    record, arrays = asked.ask('ghosts', factors=[0.8, 1])
    assert len(record['ghosts']) == len(arrays) == 2


def test_other_oils_are_asked_by_name(page_parts, surface, says, refused):
    asked = Asked(page_parts, surface, [Surface.load(shipped_surface(tier='closed_form'))])
    asked.move()
    other = asked.what_if._oils[0]
    other.header['inputs']['lubricant']['name'] = 'thick'
    asked.keep()
    assert asked.view.hello()['grades'] == ['iso_vg_68', 'thick']
    record, _ = asked.ask('map', quantity='rcs', oil='thick')
    assert record['oil'] == 'thick'
    refused('oil', asked.ask, 'map', quantity='rcs', oil='water')


@pytest.mark.parametrize(
    ('do', 'key', 'request_made'),
    [
        ('map', 'axis', {'axis': '/none/x', 'quantity': 'rcs'}),
        ('map', 'axis_text', {'axis': 7}),
        ('map', 'quantity', {'quantity': 'wear'}),
        ('read', 'speed', {'speed_rpm': 'fast', 'load_N': 1.0}),
        ('ghosts', 'factors', {'factors': 1.0}),
        ('ghosts', 'factors', {'factors': [1.0] * 6}),
        ('ghosts', 'factor', {'factors': [0.01]}),
        ('ghosts', 'factor_number', {'factors': ['x']}),
    ],
)
def test_what_cannot_be_answered_is_refused(asked, refused, do, key, request_made):
    refused(key, asked.ask, do, **request_made)


def test_without_motion_or_surface_there_are_sentences(page_parts, surface, refused):
    asked = Asked(page_parts, surface)
    asked.stamp = 1e6
    asked.view.hear(page_parts.row(1e6, speed_rpm=0.0), {}, page_parts.limits, 0.0)
    asked.view.history._begin = asked.view.history.count
    refused('no_motion', asked.ask, 'ghosts', factors=[1.0])
    asked.view.know({}, None, phrase('no_map_none'))
    refused('no_map', asked.ask, 'read', speed_rpm=1.0, load_N=0.0)


@pytest.mark.parametrize('come', [lambda *given: None, lambda *given: 1 / 0])
def test_a_surface_that_comes_during_a_map_is_left_as_it_is(asked, monkeypatch, come):
    def another(*given):
        asked.view.know({}, None, 'x')
        return come()

    monkeypatch.setattr('ballscrew_monitor.page.maps.map_of', another)
    asyncio.run(asked.what_if._try(asked.view, asked.view.surface))
    assert (asked.view.map_frame, asked.view.no_map) == (None, 'x')


def test_nothing_is_kept_of_an_axis_that_is_forgotten(asked):
    asked.keep()
    assert len(asked.what_if._followed) == 1
    asked.hub.forget(NAME)
    asked.view = None
    assert len(asked.what_if._followed) == 0


def test_a_defect_of_one_axis_is_said_and_stops_its_map(asked, monkeypatch, caplog):
    monkeypatch.setattr('ballscrew_monitor.page.maps.map_of', lambda *given: 1 / 0)
    asyncio.run(asked.what_if._try(asked.view, asked.view.surface))
    assert asked.view.surface is None
    assert 'ZeroDivisionError' in english(asked.view.no_map)
    assert 'ZeroDivisionError' in caplog.text
