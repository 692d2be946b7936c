# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Codes of faults: numbers that never change, each with its words and its cure."""

import json
import math
from pathlib import Path

from ballscrew_monitor.core.fault_codes import cause_code, Fault, STATUSES
from ballscrew_monitor.core.inputs import refusal_text, Source, Why
from ballscrew_monitor.core.judgement import Code, Severity
from ballscrew_monitor.messages.state_messages import violation
import pytest

ROOT = Path(__file__).parents[3]
GOLDEN = json.loads((ROOT / 'test' / 'data' / 'fault_codes.json').read_text(encoding='utf-8'))


def test_no_number_ever_changes():
    """Append to the file; who changes or takes out a line breaks a controller somewhere."""
    assert {fault.name: int(fault) for fault in Fault} == GOLDEN
    assert list(GOLDEN.values()) == sorted(set(GOLDEN.values()))


def test_each_fault_has_words_and_a_status_of_its_own():
    assert len({fault.text for fault in Fault}) == len(Fault)
    assert {fault.status for fault in Fault} == set(STATUSES)


def test_each_fault_has_its_cure():
    assert [fault.name for fault in Fault if not fault.cure] == ['NONE']


@pytest.mark.parametrize('why', Why)
def test_each_reason_of_a_refusal_is_one_row_of_the_table(why):
    """The live sentence and that of one message; messages about other joints are no fault."""
    fault = why.fault
    assert fault is Fault[f'INPUT_{why.name}']
    assert fault.counted
    told = why is not Why.OTHER_JOINTS
    assert (bool(fault.said), bool(fault.detail or why is Why.TOO_SHORT)) == (told, told)
    said = refusal_text(Source.SPEED, why, 2.0, math.nan, most=3.0, field='speed')
    assert bool(said) == bool(fault.detail)
    assert '{' not in said


@pytest.mark.parametrize('cause', Code)
def test_a_cause_has_the_code_that_its_sentence_says(cause):
    code = cause_code(cause)
    known = cause in (Code.RCS_HIGH, Code.EFFICIENCY_LOW)
    assert code.name == (cause.name if known else 'CAUSE_UNKNOWN')
    if known:
        finding = violation(cause, 0.5, 0.25)
        assert finding.severity == Severity.WARN
        assert finding.text.startswith(code.text.removeprefix('outside the optimal zone: '))
