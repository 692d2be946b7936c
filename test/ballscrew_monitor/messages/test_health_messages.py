# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Health in a message, field by field, and what of it warns by the policy."""

import math
from pathlib import Path
import re

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.health.records import (
    Baseline,
    Cause,
    CauseCode,
    Condition,
    Health,
    Quantity,
)
from ballscrew_monitor.messages.health_messages import (
    health_message,
    health_status,
    stamp_of,
    warns,
)
from ballscrew_msgs import msg
from diagnostic_msgs.msg import DiagnosticStatus
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message

CAUSES = Path(__file__).resolve().parents[3] / 'msg_defs' / 'msg' / 'HealthCause.msg'
OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
KNOWN = Quantity(
    name='drag change',
    unit='-',
    value=np.float32(0.25),
    low=np.float64(0.125),
    high=1,  # whatever a formula gives, the message holds floats
    confidence=0.95,
    evidence='10 stretches',
)
SILENT = Quantity(name='preload', reason='preload not known: build it')
CAUSE = Cause(
    code=CauseCode.WIPER, size=KNOWN, weight=np.float64(0.75), excluded=np.bool_(True), text='T'
)
BASELINE = Baseline(begin=3 * SECOND + 4, end=5 * SECOND + 6, reason='oil', named_at=7)


def health(condition=Condition.WORSE, **changes):
    values = {
        'axis': 'x',
        'stamp': 20 * SECOND + 9,
        'since': 11 * SECOND + 12,
        'verdict': 'Axis x is worse.',
        'advice': 'look at wipers',
        'quantities': (KNOWN, SILENT),
        'causes': (CAUSE,),
        'baseline': BASELINE,
        'notes': ('first', 'second'),
    }
    return Health(condition=condition, **values | changes)


def test_every_field_is_filled_in_and_survives_the_wire():
    made = health_message(health(), surface_id='0123', policy=WarningPolicy.BOTH)
    found = deserialize_message(serialize_message(made), msg.AxisHealth)
    assert (found.header.frame_id, stamp_of(found.header.stamp)) == ('x', 20 * SECOND + 9)
    assert stamp_of(found.since) == 11 * SECOND + 12
    assert (found.axis, found.condition, found.warning) == ('x', 2, True)
    assert (found.verdict, found.advice) == ('Axis x is worse.', 'look at wipers')
    known, silent = found.quantities
    assert (known.name, known.unit, known.value) == ('drag change', '-', 0.25)
    assert (known.low, known.high, known.confidence) == (0.125, 1.0, 0.95)
    assert (known.evidence, known.reason) == ('10 stretches', '')
    assert all(map(math.isnan, (silent.value, silent.low, silent.high)))
    assert (silent.name, silent.reason) == ('preload', SILENT.reason)
    (cause,) = found.causes
    assert (cause.code, cause.size, cause.weight) == (msg.HealthCause.CAUSE_WIPER, known, 0.75)
    assert (cause.excluded, cause.text) == (True, 'T')
    assert stamp_of(found.baseline_begin) == BASELINE.begin
    assert stamp_of(found.baseline_end) == BASELINE.end
    assert (found.baseline_reason, found.surface_id) == ('oil', '0123')
    assert list(found.notes) == ['first', 'second']
    fields = set(found.get_fields_and_field_types())
    empty = msg.AxisHealth()
    assert {name for name in fields if getattr(found, name) == getattr(empty, name)} == set()


def test_without_a_baseline_its_times_are_zero():
    made = health_message(health(baseline=None), surface_id='', policy=WarningPolicy.ZONE)
    assert (stamp_of(made.baseline_begin), made.baseline_reason) == (0, '')


def test_codes_and_conditions_are_those_of_the_records():
    declared = dict(re.findall(r'CAUSE_(\w+)=(\d+)', CAUSES.read_text(encoding='utf-8')))
    codes = {'UNKNOWN': '0'} | {code.name: str(int(code)) for code in CauseCode}
    assert declared == codes
    for code in CauseCode:
        assert getattr(msg.HealthCause, f'CAUSE_{code.name}') == code
    for condition in Condition:
        assert getattr(msg.AxisHealth, f'CONDITION_{condition.name}') == condition


@pytest.mark.parametrize(
    ('policy', 'of_zone', 'of_change'),
    [('zone', True, False), ('change', False, True), ('both', True, True)],
)
def test_a_policy_says_what_warns(policy, of_zone, of_change):
    policy = WarningPolicy(policy)
    assert (policy.of_zone, policy.of_change) == (of_zone, of_change)
    assert warns(health(), policy) is of_change
    assert not warns(health(Condition.NORMAL), policy)
    assert not warns(health(Condition.UNKNOWN), policy)


@pytest.mark.parametrize('policy', WarningPolicy)
@pytest.mark.parametrize('condition', Condition)
def test_the_status_warns_where_the_message_does(policy, condition):
    said = health(condition)
    status = health_status('/cell/node', 'x', 'screw', said, policy)
    message = health_message(said, surface_id='', policy=policy)
    assert status.level == (WARN if message.warning else OK)
    assert (status.name, status.message) == ('cell/node: x: Health', said.verdict)
    assert status.hardware_id == 'cell/x: screw'
    values = {pair.key: pair.value for pair in status.values}
    assert values['Condition'] == condition.name
    assert (values['Drag change [-]'], values['Drag change low [-]']) == ('0.25', '0.125')
    assert (values['Preload [-]'], values['Baseline'], values['Note 2']) == (
        'nan',
        'oil',
        'second',
    )


def test_what_is_not_known_is_a_sentence_and_no_warning(says):
    none = health_status('/node', 'x', 'screw', None, WarningPolicy.BOTH)
    assert (none.level, none.message) == (OK, says('not_assessed'))
    failed = health_status('/node', 'x', 's', None, WarningPolicy.BOTH, problem='it failed')
    assert (failed.level, failed.message) == (OK, 'not known: it failed')
    later = health_status('/node', 'x', 's', health(), WarningPolicy.BOTH, problem='it failed')
    assert later.level == WARN
    assert later.message == 'Axis x is worse. Not followed now: it failed'


@pytest.mark.parametrize(
    ('condition', 'problem', 'code'),
    [
        (Condition.WORSE, '', Fault.WORSE),
        (Condition.NORMAL, '', Fault.NONE),
        (Condition.UNKNOWN, '', Fault.NOT_KNOWN),
        (Condition.WORSE, 'the disk is full', Fault.NOT_FOLLOWED),
        (None, '', Fault.NOT_KNOWN),
        (None, 'the disk is full', Fault.NOT_FOLLOWED),
    ],
)
@pytest.mark.parametrize('policy', WarningPolicy)
def test_the_code_is_that_of_the_condition_whatever_warns(condition, problem, code, policy):
    found = None if condition is None else health(condition)
    status = health_status('/node', 'x', 'screw', found, policy, problem=problem)
    assert (status.values[0].key, int(status.values[0].value)) == ('Code', code)
