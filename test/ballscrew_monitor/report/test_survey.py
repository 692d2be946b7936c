# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The survey of rows: the same whatever the blocks, gaps, and a time line that can be trusted."""

import dataclasses
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.recordings.columns import COLUMNS, joined, Reason
from ballscrew_monitor.report.survey import Surveyor
import numpy as np
import pytest

GAP = SECOND // 2


def survey_of(*blocks):
    surveyor = Surveyor('x', standstill=0.5, max_gap=GAP)
    for block in blocks:
        surveyor.add(block)
    return surveyor.result()


def test_it_does_not_depend_on_the_blocks(judged):
    blocks = [judged.columns(0, 70), judged.columns(70, 30), judged.columns(100, 1)]
    parts, whole = survey_of(*blocks), survey_of(joined(blocks))
    assert parts.reasons == pytest.approx(whole.reasons)
    assert parts.energy == pytest.approx(whole.energy)
    assert (parts.rows, parts.first, parts.last) == (whole.rows, whole.first, whole.last)
    assert parts.inputs[Source.SPEED].mean == pytest.approx(whole.inputs[Source.SPEED].mean)
    assert whole.span == pytest.approx(1.0)


def test_time_and_energy_are_summed_and_only_measured_inputs_have_extremes(judged):
    found = survey_of(judged.columns(speed=10.0, friction_torque=0.5))
    assert found.reasons == {Reason.JUDGED: pytest.approx(0.99)}
    assert found.energy[Zone.OPTIMAL] == pytest.approx(0.99 * 5.0)
    found = survey_of(judged.columns(speed=0.0, reason=Reason.STANDSTILL, zone=Zone.UNKNOWN))
    assert sum(found.energy.values()) == 0.0
    assert math.isnan(found.opposing.mean)
    found = survey_of(judged.columns(temperature_source=2))
    assert math.isnan(found.inputs[Source.TEMPERATURE].low)
    assert found.inputs[Source.LOAD].high == pytest.approx(-950.0)


def test_gaps_are_listed_longest_first_and_are_no_time_of_a_reason(judged):
    blocks = [judged.columns(0, 10), judged.columns(110, 10), judged.columns(420, 10)]
    found = survey_of(*blocks)
    speed = found.gaps[Source.SPEED]
    assert [length / SECOND for _, length in found.speed_gaps] == pytest.approx([3.01, 1.01])
    assert (speed.count, speed.time) == (2, pytest.approx(4.02))
    assert found.reasons[Reason.JUDGED] == pytest.approx(0.27)
    assert sum(found.reasons.values()) + found.uncounted == pytest.approx(found.span)


def test_gaps_of_another_input_are_stretches_without_a_valid_sample(judged):
    sources = np.ones(100)
    sources[40:50] = sources[90:] = 3
    block = judged.columns(axial_load_source=sources)
    halves = [
        dataclasses.replace(block, **{name: getattr(block, name)[part] for name in COLUMNS})
        for part in (slice(0, 45), slice(45, 100))
    ]
    for blocks in ([block], halves):
        gaps = survey_of(*blocks).gaps
        assert (gaps[Source.LOAD].count, gaps[Source.LOAD].time) == (2, pytest.approx(0.19))
        assert gaps[Source.TEMPERATURE].count == 0


def test_a_stray_stamp_makes_the_log_the_time_line(judged):
    block = judged.columns()
    stamps = block.stamp.copy()
    stamps[50] = 1
    found = survey_of(dataclasses.replace(block, stamp=stamps))
    assert not found.by_stamp
    assert found.span == pytest.approx(0.99)
    assert found.shift == 1000


def test_torque_is_compared_by_direction(judged):
    block = judged.columns(motor_torque_source=1, motor_torque=1.7)
    directions = np.where(np.arange(100) < 50, 1, 2).astype(np.uint8)
    torque = np.where(directions == 1, 1.7, -1.9)
    machine = np.where(directions == 1, 1.5, -1.5)
    found = survey_of(
        dataclasses.replace(
            block, direction=directions, motor_torque=torque, machine_torque=machine
        )
    ).torque
    expected = (100, pytest.approx(0.2), pytest.approx(-0.4))
    assert (found.count, found.forward, found.backward) == expected
