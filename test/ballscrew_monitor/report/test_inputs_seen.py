# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What inputs were like, and hints where they contradict their stated unit."""

import math

from ballscrew_monitor.core.health import InputState
from ballscrew_monitor.core.inputs import Source, Why
from ballscrew_monitor.report.inputs_seen import inputs_seen, REFUSALS
import numpy as np
import pytest


def seen_of(case, source):
    return next(one for one in inputs_seen(case) if one.source is source)


def test_an_input_is_shown_in_its_unit(judged):
    values = judged.values(**{'x.speed.unit': 'rev/min'})
    speed = seen_of(judged.case([judged.columns()], values=values), Source.SPEED)
    assert speed.low == pytest.approx(100.0 * 30.0 / math.pi, rel=0.01)
    assert (speed.origin, speed.unit, speed.hints) == ('measured', 'rev/min', ())
    assert speed.rate == pytest.approx(100.0)


def test_a_default_temperature_is_not_called_measured(judged):
    values = judged.values(**{'x.temperature.topic': ''})
    case = judged.case([judged.columns(temperature_source=2)], values=values)
    oil = seen_of(case, Source.TEMPERATURE)
    assert (oil.origin, oil.measured) == ('assumed, 40 °C', False)
    assert seen_of(case, Source.TORQUE).origin == 'not recorded'


def test_metres_read_as_millimetres_are_doubted(judged):
    values = judged.values(**{'x.speed.unit': 'mm/s'})
    block = judged.columns(speed=0.1 * np.sin(np.arange(100)))
    hints = seen_of(judged.case([block], values=values), Source.SPEED).hints
    assert len(hints) == 1
    assert 'the axis never moves' in hints[0]
    assert 'm/s' in hints[0].partition('which may be')[2]


def test_a_feed_of_more_than_2_metres_a_second_is_doubted(judged):
    values = judged.values(**{'x.speed.unit': 'm/s'})
    block = judged.columns(speed=2000.0)
    hints = seen_of(judged.case([block], values=values), Source.SPEED).hints
    assert any('it feeds with up to 3.18 m/s' in hint for hint in hints)


def test_a_load_that_never_changes_is_doubted(judged):
    hints = seen_of(judged.case([judged.columns(axial_load=0.0)]), Source.LOAD).hints
    assert hints == ('x.load: it never changes, is it connected?',)


def test_refused_samples_are_counted_by_why(judged):
    refused = {Source.LOAD: {Why.IMPLAUSIBLE: 7, Why.NOT_A_NUMBER: 2}}
    load = seen_of(judged.case([judged.columns()], refused=refused), Source.LOAD)
    assert load.refused == '7 beyond what is plausible, 2 not a number'
    assert 'check x.load.unit and scale' in load.hints[0]


def test_every_reason_of_a_refusal_has_words():
    assert set(REFUSALS) == set(Why)


def test_an_input_that_never_came(judged):
    inputs = tuple(
        judged.health(source, received=0, state=InputState.MISSING) for source in Source
    )
    block = judged.columns(axial_load=math.nan, axial_load_source=0)
    load = seen_of(judged.case([block], inputs=inputs), Source.LOAD)
    assert (load.origin, load.measured) == ('never received', False)
    assert math.isnan(load.low)
