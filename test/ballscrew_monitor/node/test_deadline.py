# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The deadline that the state offers, whether it holds, and who may ask for it."""

from ballscrew_monitor.core.conversions import nanoseconds, SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.qos import state_qos
from ballscrew_msgs.msg import BallScrewState
from hypothesis import given
from hypothesis import strategies as st
import pytest
from rclpy.duration import Duration, Infinite
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile

START = 1000 * SECOND
VALUES = parameters.defaults(['x'])


def deadline(simulated=False, **changes):
    """Return the deadline [s], a `__` for each dot in the names of the parameters."""
    changed = {name.replace('__', '.'): value for name, value in changes.items()}
    return state_qos('x', VALUES | changed, simulated=simulated).deadline.nanoseconds / SECOND


def test_it_follows_the_parameters():
    assert deadline() == pytest.approx(1.0 + 0.5 + 0.3)
    assert deadline(x__publish_period=10.0, x__speed__timeout=2.0) == pytest.approx(12.3)
    assert deadline(x__publish_period=0.0, tick_period=1.0) == pytest.approx(1.0 + 0.5 + 3.0)
    assert deadline(simulated=True) == 0.0  # no deadline


@given(
    st.sampled_from([0.0, 0.1, 1.0, 3.0]),
    st.sampled_from([0.01, 0.1, 1.0]),
    st.sampled_from([0.05, 0.5, 2.0]),
    st.lists(st.floats(0.001, 5.0), min_size=5, max_size=40),
)
def test_a_state_comes_by_then_however_the_samples_come(core, period, tick, timeout, gaps):
    monitor = core.monitor(
        timeouts={Source.SPEED: nanoseconds(timeout), Source.LOAD: nanoseconds(timeout)},
        publish_period=nanoseconds(period),
        tick_period=nanoseconds(tick),
    )
    events, now = [], START
    for gap in gaps:
        now += nanoseconds(gap)
        events.append((now, True))
    events += [(stamp, False) for stamp in range(START, now, nanoseconds(tick))]
    last = START
    promised = deadline(x__publish_period=period, tick_period=tick, x__speed__timeout=timeout)
    for stamp, is_sample in sorted(events):
        if is_sample:
            state = monitor.update(InputSample(source=Source.SPEED, value=10.0, stamp=stamp))
        else:
            state = monitor.tick(stamp)
        if state is not None:
            assert stamp - last <= nanoseconds(promised)
            last = stamp
    assert now - last <= nanoseconds(promised)


def offered(node, **parameters):
    topic = f'{node.name}/x/state'
    node.start(**parameters)
    node.until(lambda: node.node.count_publishers(topic))
    (publisher,) = node.node.get_publishers_info_by_topic(topic)
    return publisher.qos_profile.deadline, topic


def test_over_the_middleware(node, says):
    promise, topic = offered(node, x__publish_period=0.1)
    assert promise.nanoseconds == nanoseconds(deadline())
    refused, heard = [], {30.0: [], 0.5: []}
    for seconds, states in heard.items():
        node.node.create_subscription(
            BallScrewState,
            topic,
            states.append,
            QoSProfile(depth=10, deadline=Duration(seconds=seconds)),
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=refused.append),
        )
    node.until(lambda: len(heard[30.0]) > 2 and refused, 'states, and a refusal')
    assert heard[0.5] == []
    assert node.set_parameters(x__publish_period=1.0).successful
    answer = node.set_parameters(x__publish_period=1.5)
    assert not answer.successful
    assert answer.reason == says('publish_period_1_5')
    assert node.transition('deactivate')
    assert node.transition('cleanup')
    assert node.set_parameters(x__publish_period=1.5).successful


def test_simulated_time_promises_nothing(node):
    assert offered(node, use_sim_time='true')[0] == Infinite
