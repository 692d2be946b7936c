# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of plain values that the monitor gives of a bag, to be held against an expectation."""

import dataclasses

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.core.judgement import Code, Gate, Level, PointValidity, Zone
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.recordings.summary import Summary, summary_of
from ballscrew_monitor.settings.parameters import read_file
import pytest

REGIMES = ('UNKNOWN', 'BOUNDARY', 'MIXED', 'HYDRODYNAMIC')


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Judgement:
    """Every state as a row of names and numbers, events and their causes, totals, last inputs."""

    rows: list
    events: list
    causes: dict
    summary: Summary
    inputs: dict


@pytest.fixture(scope='session')
def judge():
    """Return what replays a bag with a parameter file."""
    return _judge


def _judge(bag, parameters):
    rows, events, causes, inputs = [], [], {}, {}

    def said():
        for state, event in replay(Bag(bag), read_file(parameters)):
            yield state
            if event is not None:
                yield event
                events.append(event)
                causes[event.event_id] = Code(event.cause.code).name
            rows.append(_row(state))
            for health in state.inputs:
                inputs[health.name] = health.state, health.dropped, health.received, health.lag

    summary = summary_of(said())
    return Judgement(summary=summary, rows=rows, events=events, causes=causes, inputs=inputs)


def _row(state):
    return {
        'stamp': stamp_of(state),
        'zone': Zone(state.zone).name,
        'level': Level(state.level).name,
        'regime': REGIMES[state.result.regime],
        'gates': [Gate(gate).name for gate in state.active_gates],
        'validity': PointValidity(state.result.validity).name,
        'reason': state.result.reason,
        'direction': Direction(state.point.direction).name,
        'torque': state.result.driving_torque,
        'residual': state.torque_residual,
    }
