# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Friction along the stroke and lost motion at reversals, of motions whose truth is known."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.records import CellKind, LoadSource, Stretch
from ballscrew_monitor.health.stroke import (
    level_of,
    Positions,
    reversal_cells,
    span_of,
    stroke_cells,
)
import numpy as np
import pytest

LEAD = 0.01
BEGIN = 1_767_600_000 * SECOND
SPEEDS = (10.0, 40.0, 160.0)  # [rad/s]


def stamps_of(time):
    return BEGIN + np.rint(time * SECOND).astype(np.int64)


def passes(friction, *, offset=0.0, begin=0.0, travel=0.6, rate=100.0, speeds=SPEEDS):
    """Yield stretches there and back at each speed with stamps, position and torque."""
    start = 0.0
    for speed in speeds:
        for way in (1.0, -1.0):
            feed = speed * LEAD / (2.0 * math.pi)
            time = np.arange(0.0, travel / feed, 1.0 / rate)
            position = begin + (feed * time if way > 0 else travel - feed * time)
            torque = offset + way * friction(speed, position)
            stretch = Stretch(
                start=int(stamps_of(np.array(start))),
                duration=float(time[-1]),
                samples=len(time),
                speed=way * speed,
                axial_load=0.0,
                temperature=310.0,
                motor_torque=float(torque.mean()),
            )
            yield stretch, stamps_of(start + time), position, torque
            start += travel / feed + 1.0


def along(parts):
    """Return the cells of passes one after the other."""
    stretches, *columns = zip(*parts, strict=True)
    return stroke_cells(*map(np.concatenate, columns), stretches, BEGIN)


def level_friction(speed, position):
    return (0.3 + 0.01 * math.sqrt(speed)) * np.ones_like(position)


def bumped(speed, position):
    return level_friction(speed, position) * np.where(
        (position > 0.32) & (position < 0.4), 1.25, 1.0
    )


def test_steps_lie_on_one_grid_whatever_a_log_travels():
    assert [level_of(*one) for one in ((0, 11), (0, 12), (-3, 60), (100, 111))] == [0, 1, 3, 0]
    assert span_of(4, 3) == pytest.approx((0.32, 0.40))
    for first, last in ((0, 7), (0, 59), (-200, 170), (7, 9)):
        level = level_of(first, last)
        assert (last >> level) - (first >> level) < 12
        assert level == 0 or (last >> (level - 1)) - (first >> (level - 1)) >= 12


def test_even_friction_is_even_along_the_stroke_and_weight_cancels():
    cells = along(passes(level_friction, offset=0.15))
    assert {cell.kind for cell in cells} == {CellKind.STROKE}
    assert len(cells) == 8  # 600 mm in steps of 80 mm
    usual = cells[0].motor_torque
    assert [cell.motor_torque for cell in cells] == pytest.approx([usual] * len(cells))
    low, high = (level_friction(speed, np.zeros(1))[0] for speed in (SPEEDS[0], SPEEDS[-1]))
    assert low < usual < high


def test_a_bump_stands_in_its_step_with_its_height():
    even = {cell.speed_band: cell.motor_torque for cell in along(passes(level_friction))}
    cells = {cell.speed_band: cell for cell in along(passes(bumped))}
    ratio = {step: cell.motor_torque / even[step] for step, cell in cells.items()}
    assert span_of(4, cells[4].load_band) == pytest.approx((0.32, 0.40))
    rest = [one for step, one in ratio.items() if step != 4]
    assert rest == pytest.approx([rest[0]] * len(rest), rel=1e-9)
    assert ratio[4] / rest[0] == pytest.approx(1.25, rel=5e-3)  # a sample or two beside it


def test_parts_that_run_at_another_speed_are_not_taken_for_worn_ones():
    """The left half runs at all speeds, the right half only at the slow one."""
    parts = list(passes(level_friction, travel=0.3))
    later = 1000 * SECOND
    for stretch, stamps, *columns in passes(
        level_friction, begin=0.3, travel=0.3, speeds=SPEEDS[:1]
    ):
        stretch.start += later
        parts.append((stretch, stamps + later, *columns))
    torques = [cell.motor_torque for cell in along(parts)]
    assert torques == pytest.approx([torques[0]] * len(torques))


def test_motion_one_way_or_without_torque_or_position_makes_no_cell():
    parts = list(passes(level_friction))
    assert along(part for part in parts if part[0].speed > 0.0) == []
    for lost in (2, 3):  # position, torque
        unknown = [
            tuple(np.full_like(x, math.nan) if at == lost else x for at, x in enumerate(part))
            for part in parts
        ]
        assert along(unknown) == []


def test_a_turntable_has_no_stroke():
    assert along(passes(level_friction, travel=150.0, speeds=(160.0,), rate=10.0)) == []


def test_a_derived_load_does_not_part_the_classes():
    parts = list(passes(level_friction))
    for number, (stretch, *_) in enumerate(parts):
        stretch.axial_load, stretch.load_source = 900.0 * (-1) ** number, LoadSource.DERIVED
    assert len(along(parts)) == 8


def turning(lost, *, rate=200.0, skew=0.0, amplitude=0.1, period=4.0, growth=0.0):
    """Return stamps, speed [m/s] and positions of a sine, with the play by its two branches."""
    time = np.arange(0.0, 40.0, 1.0 / rate) + 0.5 / rate
    phase = 2.0 * math.pi * time / period
    motor = amplitude * np.sin(phase)
    speed = amplitude * 2.0 * math.pi / period * np.cos(phase)
    # A table with play stands until the motor has come back by it from its turning point.
    peak = np.where(speed > 0.0, -amplitude, amplitude)
    way = np.sign(speed)
    table = np.where(np.abs(motor - peak) < lost, peak + way * lost / 2, motor - way * lost / 2)
    table = table * (1.0 + growth * time) + skew * speed
    return stamps_of(time), speed, motor, table


@pytest.mark.parametrize('lost', [0.0, 5e-6, 30e-6, 120e-6])
@pytest.mark.parametrize('skew', [0.0, 1e-3])
def test_lost_motion_is_the_play_whatever_the_encoders_are_sampled_apart(lost, skew):
    (cell,) = reversal_cells(*turning(lost, skew=skew), BEGIN)
    assert cell.kind == CellKind.REVERSAL
    assert cell.backlash == pytest.approx(lost, abs=0.2e-6)
    assert cell.stretches == 20


def test_a_screw_that_grows_loses_no_motion():
    (cell,) = reversal_cells(*turning(10e-6, growth=2e-6), BEGIN)
    assert cell.backlash == pytest.approx(10e-6, abs=0.5e-6)


def test_a_single_encoder_or_a_motion_one_way_tells_no_lost_motion():
    stamps, speed, motor, table = turning(30e-6)
    forth = speed > 0.0
    one_way = (column[forth] for column in (stamps, speed, motor, table))
    assert reversal_cells(stamps, speed, motor, np.full_like(table, math.nan), BEGIN) == []
    assert reversal_cells(*one_way, BEGIN) == []


def test_positions_hold_at_the_stamps_of_their_samples_alone():
    stamps = np.array([10, 20, 30])
    motor, table = Positions(stamps, np.array([1.0, 2.0, 3.0])).at(np.array([20, 25, 40]))
    assert motor.tolist() == pytest.approx([2.0, math.nan, math.nan], nan_ok=True)
    assert np.isnan(table).all()
