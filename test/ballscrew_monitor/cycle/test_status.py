# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The line that a person watches."""

import io
import math

from ballscrew_monitor.cycle.status import fit, progress_bar, state_cells, StatusLine
from ballscrew_msgs.msg import BallScrewState, Finding, PointResult
import pytest


def make_state(**changes):
    state = BallScrewState(
        level=BallScrewState.LEVEL_OK, zone=BallScrewState.ZONE_OPTIMAL, event_id=3
    )
    state.point.speed, state.point.axial_load, state.point.temperature = 83.8, -1308.4, 26.04
    state.result.efficiency, state.result.film_ratio = 0.9149, 2.756
    state.result.rcs, state.result.regime = 0.00228, PointResult.REGIME_MIXED
    for name, value in changes.items():
        setattr(state, name, value)
    return state


def line(state):
    return '  '.join(state_cells(state))


def test_a_state_in_columns_and_a_warning_with_its_causes(says):
    assert line(make_state()) == says('800_rev_min')
    causes = [Finding(code=Finding.CODE_RCS_HIGH), Finding(code=Finding.CODE_EFFICIENCY_LOW)]
    warned = make_state(
        level=BallScrewState.LEVEL_WARN, zone=BallScrewState.ZONE_OUTSIDE, findings=causes
    )
    assert line(warned).endswith(says('outside_warning_3'))
    warned.findings = []
    assert line(warned).endswith('WARNING 3: held')


def test_what_is_not_judged_is_a_dash():
    light = line(make_state(active_gates=[BallScrewState.GATE_LIGHT_LOAD]))
    assert 'eff    - %' in light
    assert 'optimal (light)' in light
    still = make_state(
        zone=BallScrewState.ZONE_UNKNOWN,
        active_gates=[BallScrewState.GATE_STANDSTILL, BallScrewState.GATE_LIGHT_LOAD],
    )
    assert 'Lambda    -  RCS      -  standstill ' in line(still)
    lost = make_state(
        zone=BallScrewState.ZONE_UNKNOWN,
        level=BallScrewState.LEVEL_UNKNOWN,
        findings=[Finding(code=Finding.CODE_INPUT_LOST)],
    )
    lost.point.speed = lost.result.rcs = math.nan
    assert line(lost).startswith('    - rev/min')
    assert line(lost).endswith('not judged       level unknown')


def test_columns_keep_their_place_and_a_narrow_terminal_what_matters():
    lengths = {
        tuple(len(cell) for cell in state_cells(state)[:-1])
        for state in (
            make_state(),
            make_state(active_gates=[1, 2], zone=0),
            make_state(active_gates=[2], zone=BallScrewState.ZONE_OUTSIDE),
        )
    }
    assert len(lengths) == 1
    cells = [progress_bar(0.5, 30.0), *state_cells(make_state())]
    assert fit(cells, 200) == '  '.join(cells).rstrip()
    for width in (120, 80, 60, 40, 20):
        assert len(fit(cells, width)) <= width
    assert fit(cells, 60).startswith('  800 rev/min')
    assert fit(cells, 60).endswith('ok')


@pytest.mark.parametrize(
    ('part', 'left', 'expected'),
    [
        (0.0, 60.0, '[............] 1:00 left'),
        (0.5, 29.2, '[######......] 0:30 left'),
        (1.0, -0.1, '[############] 0:00 left'),
        (1.1, 3600.0, '[############] 60:00 left'),
    ],
)
def test_progress(part, left, expected):
    assert progress_bar(part, left) == expected


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self):
        return True


def test_plain_lines_once_a_second():
    stream = io.StringIO()
    status = StatusLine(stream)
    for tenth in range(25):
        now = 100.0 + tenth / 10.0
        if status.due(now):
            status.show(['bar', f'{tenth}'], now)
    status.close()
    assert stream.getvalue() == 'bar  0\nbar  10\nbar  20\n'


def test_a_terminal_line_is_written_over_and_closed(monkeypatch):
    monkeypatch.setenv('COLUMNS', '31')
    stream = Terminal()
    status = StatusLine(stream)
    status.show(['', 'a long line of some text'], 0.0)
    assert not status.due(0.05)
    status.show(['', 'short'], 0.1)
    status.close()
    status.close()
    assert stream.getvalue() == f'\r{"  a long line of some text":30}\r{"  short":30}\n'
