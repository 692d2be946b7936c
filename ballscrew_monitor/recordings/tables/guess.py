# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A first map of a log, by names, ranges and rates of its columns.

What nothing in the log tells stands under `assumed` with a value and a reason. The rate, the unit
of a time and the decimal sign are not assumed: they stand without a value, to be stated.

"""

from collections.abc import Iterator, Mapping
import contextlib
import dataclasses
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import LINEAR_SPEED_UNITS
from ballscrew_monitor.recordings.tables import estimates
from ballscrew_monitor.recordings.tables.first_map.columns import Columns, SEPARATED_BY
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.first_map.machine import state_machine
from ballscrew_monitor.recordings.tables.first_map.motion import compare_motion
from ballscrew_monitor.recordings.tables.first_map.own_times import OwnTimes
from ballscrew_monitor.recordings.tables.first_map.questions import (
    ask_for_columns,
    ask_for_factors,
    note_joined_tables,
    note_unused,
)
from ballscrew_monitor.recordings.tables.first_map.signs import assume_direction, set_sign
from ballscrew_monitor.recordings.tables.first_map.time_column import TimeColumn
from ballscrew_monitor.recordings.tables.first_map.units import leave_out_unitless, set_unit
from ballscrew_monitor.recordings.tables.first_map.validity import ask_for_gaps, set_marks
from ballscrew_monitor.recordings.tables.names import is_commanded, read_name
from ballscrew_monitor.recordings.tables.quantities import INPUTS, MOTION
from ballscrew_monitor.recordings.tables.sources import source_of
from ballscrew_monitor.recordings.tables.stated_rate import (
    doubts_of_rate,
    rates_of_head,
    two_rates,
)
from ballscrew_monitor.recordings.words import listed, short, Shown, shown_progress
import numpy as np
from surrogate.files import InputError
import yaml

NUMBERS = 4_000_000  # of the first rows that are in memory


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Guess:
    """
    A map as its content, and what is to be said about it.

    `unstated` says of each place of the map that is null why nothing is assumed there; `picture`
    is what was found in the file. `lead_mm` is that which the head of the log states [mm], NaN
    without.

    """

    content: dict[str, Any]
    lead_mm: float
    unstated: tuple[str, ...]
    notes: tuple[str, ...]
    picture: tuple[str, ...]

    @property
    def text(self) -> str:
        """Return the map as YAML."""
        head = (
            '# A first map of a machine log. What it assumes is judged with as it stands; who\n'
            '# knows a value writes it in its place and takes it out of `assumed`, such as\n'
            '# `axes: {x: {lead_mm: 5.0, screw: my_screw, oil: my_oil, surface: my_screw.npz}}`.\n'
        )
        head += ''.join(f'# {" ".join(line.split())}\n' for line in self.picture)
        if self.unstated:
            head += '# The log cannot be judged before a value stands where this map says null:\n'
        head += ''.join(f'#   {" ".join(why.split())}\n' for why in self.unstated)
        return head + yaml.safe_dump(
            self.content, sort_keys=False, width=96, allow_unicode=True, default_flow_style=None
        )


def names_motion(path: Path) -> bool:
    """Return False for a table of which no column is named as a motion."""
    with contextlib.suppress(InputError):
        source = source_of(path)
        texts = source.head.symbols
        named = [read_name(name, texts.get(name, '')) for name in source.names()]
        kinds = {kind for one in named for kind in (one.kind, one.doubtful)}
        return bool(kinds & set(MOTION))
    return True


@np.errstate(over='ignore', invalid='ignore')  # of numbers that no machine has
def guess(path: Path, *, shown: Shown = shown_progress) -> Guess:
    """
    Return a first map of the log at `path`, and show how far it is read.

    Raises InputError when it has no speed.

    """
    log = Columns(path, NUMBERS, shown)
    draft = Draft(log)
    time = TimeColumn(draft)
    times = OwnTimes(draft, time)
    if time.column is not None and time.times is not None:
        log.refuse_sources_in_turn(time.column.column, time.times)
    for name in log.axes:
        _fill(draft, times, name)
    stated = time.stated or time.without_column()
    if stated.get('rate_Hz'):
        _ask_for_rate(draft, time, stated)
    ask_for_factors(draft)
    note_joined_tables(draft)
    note_unused(draft, {*stated.values(), *times.of_inputs.values()})
    content: dict[str, Any] = {'log': path.name}
    if log.source.sheet and (others := log.source.left_out):
        content['sheet'] = log.source.sheet
        draft.notes.append(
            f'sheet {short(log.source.sheet)} is read, not {listed([*others])}: `sheet` in the '
            'map names another'
        )
    content |= {'date_from': draft.date_from} if draft.date_from else {}
    content |= {'decimal': None} if log.is_decimal_open else {}
    stated |= {'order': draft.order} if draft.order else {}
    stated |= {'order': None} if 'order' in log.doubts else {}
    content |= {'time': stated, 'axes': draft.used, 'assumed': draft.assumed}
    lead = log.head.machine.get('lead_mm')
    return Guess(
        content=content,
        lead_mm=math.nan if lead is None else lead.value,
        unstated=tuple(draft.unstated),
        notes=tuple(draft.notes),
        picture=tuple(_picture(draft, times, stated)),
    )


def _ask_for_rate(draft: Draft, time: TimeColumn, stated: dict[str, Any]) -> None:
    """Leave the rate of the head without a value, and ask for it, if the rows deny it."""
    table = draft.log.table
    inputs = {
        f'axes.{name}.{kind}': one['column']
        for name, kinds in draft.used.items()
        for kind, one in kinds.items()
        if kind in INPUTS and 'column' in one
    }
    doubts = [two_rates(rates_of_head(table.source, {*inputs.values()}))]
    doubts += [
        f'the head states {stated["rate_Hz"]:g} Hz, but {doubt}'
        for doubt in doubts_of_rate(stated['rate_Hz'], inputs, table)
    ]
    if why := next(filter(None, doubts), ''):
        draft.unstated.append(why)
        stated['rate_Hz'], time.step = None, math.nan


def _fill(draft: Draft, times: OwnTimes, name: str) -> None:
    """Let the map say of an axis what its columns and their numbers tell."""
    log, chosen = draft.log, draft.log.axes[name]
    # A force or current of nothing but 0 is unknown.
    used = draft.used[name] = {
        kind: {'column': one.column} | ({'scale': one.scale} if one.scale != 1.0 else {})
        for kind in INPUTS
        if (one := chosen.get(kind))
        and (kind in MOTION or not estimates.is_silent(log.extremes[one.column]))
    }
    draft.notes += [
        f'axis {name}: {short(chosen[kind].column)} is a command, no measured {kind} is there'
        for kind in used
        if is_commanded(chosen[kind])
    ]
    leave_out_unitless(draft, name)
    compare_motion(draft, times, name)
    for kind in used:
        set_unit(draft, name, kind)
        set_marks(draft, name, kind)
        set_sign(draft, times, name, kind)
        times.say(name, kind)
    state_machine(draft, name)
    if 'speed' in used and not log.is_decimal_open:
        speeds, unit = log.extremes[used['speed']['column']], draft.unit(name, 'speed')
        draft.notes += estimates.oddities(name, speeds, unit, LINEAR_SPEED_UNITS)
    assume_direction(draft, name)
    ask_for_gaps(draft, times, name)
    ask_for_columns(draft, name)


def _picture(draft: Draft, times: OwnTimes, time: Mapping[str, Any]) -> Iterator[str]:
    """Yield what was found in the file, a line each."""
    log, main = draft.log, time.get('column', '')
    groups: dict[tuple[str, tuple[int, int]], list[tuple[str, str]]] = {}
    for name, kinds in draft.used.items():
        for kind in filter(kinds.__contains__, INPUTS):
            if column := kinds[kind].get('column', ''):
                key = (times.of_inputs.get(column, main), log.table.readings[column].holes)
                unit = draft.unit(name, kind) or 'in an unknown unit'
                groups.setdefault(key, []).append((column, f'{name} {kind} {unit} ({column})'))
    for number, ((own, _), members) in enumerate(groups.items()):
        step = times.step(own, members[0][0])
        known = math.isfinite(step) and not log.is_decimal_open
        each = f'{1e3 * step:.4g} ms' if known else 'an unknown period'
        yield f'Group {number + 1}: {each}, {", ".join(told for _, told in members)}'
    head = log.head
    between = SEPARATED_BY.get(head.separator, repr(head.separator))
    found = [f'{len(head.names)} columns separated by {between}'] if head.separator else []
    found += [f'first numbers in row {head.first}']
    found += [f'written by {head.program.program}'] if head.program else []
    found += filter(None, [draft.begin, log.table.decision.words])
    yield f'Found: {"; ".join(found)}'
