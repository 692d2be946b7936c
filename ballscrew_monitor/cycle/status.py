# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The live status: one line on a terminal that is written over, or one plain line a second."""

from collections.abc import Mapping, Sequence
import math
import shutil
from typing import TextIO

from ballscrew_msgs.msg import BallScrewState, Finding
from surrogate.surface import REGIMES
from surrogate.tasks.progress import bar
from surrogate.units import RPM

REGIME_WORDS = {int(regime): regime.word for regime in REGIMES}
ZONES = {BallScrewState.ZONE_OPTIMAL: 'optimal', BallScrewState.ZONE_OUTSIDE: 'outside'}
GATES = {BallScrewState.GATE_STANDSTILL: 'standstill', BallScrewState.GATE_LIGHT_LOAD: 'light'}
LEVELS = {BallScrewState.LEVEL_UNKNOWN: 'level unknown', BallScrewState.LEVEL_OK: 'ok'}
CAUSES = {
    Finding.CODE_RCS_HIGH: 'RCS high',
    Finding.CODE_EFFICIENCY_LOW: 'efficiency low',
    Finding.CODE_OUT_OF_RANGE: 'out of range',
    Finding.CODE_INPUT_LOST: 'input lost',
}
BAR_WIDTH = 12
PLAIN_PERIOD = 1.0  # [s] between plain lines
# Cells left out on a narrow terminal, the first one first: bar, oil, load, film ratio, regime, ...
DROPPED = (0, 3, 2, 6, 5, 4, 7)
TERMINAL_PERIOD = 0.1  # [s] between updates on a terminal


def state_cells(state: BallScrewState) -> list[str]:
    """Return what a person watches, in cells of fixed width and without the bar."""
    point, result = state.point, state.result
    standstill = BallScrewState.GATE_STANDSTILL in state.active_gates
    light = BallScrewState.GATE_LIGHT_LOAD in state.active_gates
    efficiency = math.nan if light or standstill else 100.0 * result.efficiency
    causes = [CAUSES[finding.code] for finding in state.findings if finding.code in CAUSES]
    warning = f'WARNING {state.event_id}: {" and ".join(causes) or "held"}'
    return [
        f'{_number(point.speed / RPM, 5, 0)} rev/min',
        f'{_number(point.axial_load, 5, 0)} N',
        f'{_number(point.temperature, 4, 1)} degC',
        f'eff {_number(efficiency, 4, 1)} %',
        f'{"-" if standstill else REGIME_WORDS.get(result.regime, "-"):12}',
        f'Lambda {_number(math.nan if standstill else result.film_ratio, 4, 2)}',
        f'RCS {_number(math.nan if standstill else result.rcs, 6, 4)}',
        f'{_zone(state):15}',
        LEVELS.get(state.level, warning),
    ]


def progress_bar(part: float, left: float) -> str:
    """Return a bar for the `part` done [-] and the time `left` [s]."""
    minutes, seconds = divmod(math.ceil(max(left, 0.0)), 60)
    return f'[{bar(part, BAR_WIDTH, blank=".")}] {minutes}:{seconds:02d} left'


def fit(cells: Sequence[str], width: int) -> str:
    """Return the cells in one line of at most `width` characters, less important ones left out."""
    kept = dict(enumerate(cells))
    for number in DROPPED:
        if len(_join(kept)) <= width:
            break
        kept.pop(number, None)
    return _join(kept)[:width]


def _join(cells: Mapping[int, str]) -> str:
    return '  '.join(cells.values()).rstrip()


class StatusLine:
    """Writes the status to a stream, as often as the kind of the stream can bear."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._terminal = stream.isatty()
        self._next = -math.inf
        self._open = False

    def due(self, now: float) -> bool:
        """Return True if it is time for the next status; `now` [s] of a steady clock."""
        return now >= self._next

    def show(self, cells: Sequence[str], now: float) -> None:
        """Write bar and cells at `now` [s] of a steady clock."""
        self._next = now + (TERMINAL_PERIOD if self._terminal else PLAIN_PERIOD)
        if self._terminal:
            # Never wrapped: a line that wraps cannot be written over.
            width = max(shutil.get_terminal_size().columns - 1, 20)
            self._stream.write(f'\r{fit(cells, width):{width}}')
            self._open = True
        else:
            self._stream.write(f'{"  ".join(cells).rstrip()}\n')
        self._stream.flush()

    def close(self) -> None:
        """Leave the cursor on a fresh line."""
        if self._open:
            self._stream.write('\n')
            self._stream.flush()
            self._open = False


def _zone(state: BallScrewState) -> str:
    zone = ZONES.get(state.zone, 'not judged')
    gates = [GATES[gate] for gate in state.active_gates if gate in GATES]
    if 'standstill' in gates:
        return 'standstill'
    return f'{zone} ({gates[0]})' if gates else zone


def _number(value: float, width: int, decimals: int) -> str:
    return f'{"-":>{width}}' if math.isnan(value) else f'{value:{width}.{decimals}f}'
