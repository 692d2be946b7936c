# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of the QoS of the inputs."""

from ballscrew_monitor.settings.qos import check_overrides, input_qos, overridden
import pytest

TOPICS = {'/joint_states', '/axial_load'}


def test_good_overrides_and_those_of_ros_pass():
    check_overrides(
        {
            'x.speed.topic': 'joint_states',
            'use_sim_time': True,
            'qos_overrides./joint_states.subscription.reliability': 'reliable',
            'qos_overrides./joint_states.subscription.durability': 'transient_local',
            'qos_overrides./axial_load.subscription.history': 'keep_all',
            'qos_overrides./axial_load.subscription.depth': 1,
            'qos_overrides./parameter_events.publisher.depth': 7,
        },
        TOPICS,
    )


@pytest.mark.parametrize(
    ('name', 'value', 'match'),
    [
        ('/joint_state.subscription.depth', 5, 'input_axial_load'),
        ('/joint_states.publisher.depth', 5, 'input'),
        ('/joint_states.subscription.lifespan', 5, 'policy_history_depth'),
        ('/joint_states.subscription', 5, 'input'),
        ('/joint_states.subscription.depth', 0, '0_whole_number'),
        ('/joint_states.subscription.depth', 5.0, '5_0_whole'),
        ('/joint_states.subscription.depth', True, 'true_whole_number'),
        ('/joint_states.subscription.reliability', 'Reliable', 'reliable_one_best_effort'),
    ],
)
def test_a_bad_override_is_refused(name, value, match, refused):
    refused(match, check_overrides, {f'qos_overrides.{name}': value}, TOPICS)


def test_what_is_asked_for_is_the_default_or_the_override():
    given = {'qos_overrides./t.subscription.reliability': 'reliable'}
    assert overridden(given, '/t', 'reliability') == 'reliable'
    assert overridden(given, '/s', 'reliability') == 'best_effort'
    assert overridden(given, '/t', 'durability') == input_qos().durability.name.lower()
