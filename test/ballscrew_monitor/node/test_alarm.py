# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The plain topics: their values, and that they come over the middleware when asked for."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.messages.state_messages import plain_values
from ballscrew_monitor.node.axis_publisher import PLAIN
import numpy as np
from rclpy.serialization import deserialize_message, serialize_message
from surrogate.surface import Regime

STAMP = 1000 * SECOND


def state_of(core, *, speed=10.0, load=1000.0, **numbers):
    monitor = core.monitor(core.surface(**numbers), core.limits(raise_delay=0))
    inputs = ((Source.LOAD, load), (Source.SPEED, speed))
    samples = [InputSample(source=source, value=value, stamp=STAMP) for source, value in inputs]
    return core.feed(monitor, samples)[-1].message


def test_values_of_a_state_outside_the_zone_survive_the_wire(core):
    values = plain_values(state_of(core, rcs=np.float64(0.5), film_ratio=np.float64(2.0)))
    told = {
        name: deserialize_message(serialize_message(PLAIN[name](data=value)), PLAIN[name]).data
        for name, value in values.items()
    }
    assert told == {
        'efficiency': 0.9,
        'rcs': 0.5,
        'film_ratio': 2.0,
        'regime': 'MIXED',
        'out_of_zone': True,
    }
    assert {type(value) for value in values.values()} == {float, str, bool}


def test_what_is_not_known_is_nan(core):
    values = plain_values(state_of(core, load=1e5))
    assert all(math.isnan(values[name]) for name in ('efficiency', 'rcs', 'film_ratio'))
    assert (values['regime'], values['out_of_zone']) == ('UNKNOWN', False)


def test_they_come_with_each_state_of_the_axes_that_ask_for_them(node):
    node.start(
        axes="['x','y']", x__plain_topics='true', x__max_future=3600.0, x__limits__raise_delay=0.0
    )
    prefix = f'{node.name}/x/plain/'
    heard = {name: node.listen(kind, prefix + name) for name, kind in PLAIN.items()}
    states, publish = node.watched()
    publish(0.8)
    node.until(lambda: heard['out_of_zone'] and heard['out_of_zone'][-1].data, 'the warning')
    judged = node.until(lambda: [state for state in states if state.judged], 'the state')[0].result
    expected = {
        'efficiency': judged.efficiency,
        'rcs': judged.rcs,
        'film_ratio': judged.film_ratio,
    }
    expected['regime'] = Regime(judged.regime).name

    def told(name):
        return {message.data for message in heard[name]}

    node.until(lambda: all(expected[name] in told(name) for name in expected), 'the values')
    assert node.node.count_publishers(f'{node.name}/y/plain/rcs') == 0
