# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The judgement gives the golden rows, which an earlier one made of the same events.

The events come from all scenarios of `bags/`, from the nominal cycle and from lists that meet
every refusal, command and correction; the surface is a small one of the closed form with spreads
and a masked node. `golden_rows.npz` holds columns of four tables. Their names tell what they hold:

* `run_`: name, settings and kept memory as JSON.
* `event_`: kind of KINDS in `conftest`, source, value, stamps, and -1 for what there is none of.
  A tick, an acknowledgement and a reset have their clock as stamp; a shelving has its end as stamp
  and its begin as arrival; a correction has its row of `pull_` as value.
* `row_`: each judgement, and the `event` that gave it. `gates` and `findings` are sums of
  2^number; `told_` is the excursion that is active or was the last; `reason` counts `texts`.
* `state_`: each published state; `row` -1 where none gave it.

Four things have changed since. The light-load gate has a hysteresis, an excursion keeps limit and
place of its worst sample: these are left out here. Its last stamp moves with a clock that is set
back, so while it is active its length is held. The lookup adds up its sums in another order, for
which numbers have a relative tolerance.

"""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.judge import monitor as monitors
from ballscrew_monitor.judge.step import NOTHING, step
from ballscrew_monitor.messages.state_messages import findings_of
from ballscrew_monitor.messages.unjudged import reason_of
import numpy as np

TOLERANCE = 1e-12  # of numbers [-]: the lookup adds up its sums in another order
SAME = (
    'stamp now tick published level speed axial_load temperature motor_torque speed_source '
    'axial_load_source temperature_source motor_torque_source direction direction_held '
    'axial_load_uncertainty validity rcs efficiency machine_torque regime '
    'contact_state friction_torque film_ratio worst_contact driving_torque corrected zone'
).split()
"""Columns that a row has under the same name."""
REST = (
    'asperity_share central_film minimum_film friction_coefficient max_pressure '
    'friction_torque_error friction_torque_std friction_torque_stderr rcs_error rcs_std '
    'rcs_stderr efficiency_error efficiency_std efficiency_stderr back_driving'
).split()
"""Columns that only a row of a state has."""
INPUT = (
    'state stamp_source age rate received dropped slow lag lagging lost losing implausible '
    'glitching longest_gap why'
).split()


def close(found, wanted):
    if isinstance(wanted, float):
        same = math.isnan(found) and math.isnan(wanted)
        return same or math.isclose(found, wanted, rel_tol=TOLERANCE)
    return int(found) == wanted


def check(found, wanted, names, place):
    for name in names:
        here, there = getattr(found, name), getattr(wanted, name)
        assert close(-1 if here is None else here, there), f'{place}: {name} {here} {there}'


def check_row(row, memory, wanted, texts, monitor, lengths, place):
    check(row, wanted, SAME, place)
    if wanted.published:
        check(row, wanted, REST, place)
    assert bool(row.clears) == bool(wanted.clear), place
    assert row.gates * 2 == wanted.gates, place
    assert row.machine_nut == wanted.worst_nut, place
    assert (row.derived == 0) == (wanted.derived < 0), place
    assert bool(row.edge) == bool(wanted.edge), place
    reason = reason_of(row, monitor.surface)
    assert reason == texts[wanted.reason], place
    findings = findings_of(row, monitor.settings.limits, reason)
    values = {one.code: one.value for one in findings}
    assert sum(2**code for code in values) == wanted.findings, place
    assert close(values.get(Code.RCS_HIGH, math.nan), wanted.rcs_finding), place
    assert close(values.get(Code.EFFICIENCY_LOW, math.nan), wanted.efficiency_finding), place
    told = {'number': memory.event_number, 'active': memory.event_active}
    told |= {'start': memory.event_start[0]}
    if not memory.event_active:
        told |= {'stamp': memory.event_stamp}
    elif memory.event_number:  # whose last stamp moves with its begin
        length = wanted.told_stamp - wanted.told_start
        length = lengths.setdefault(int(memory.event_number), length)
        assert memory.event_stamp - memory.event_start[0] == length, place
    told |= {'worst_value': memory.event_worst[0], 'cause': memory.event_code[0]}
    for name, value in told.items():
        there = getattr(wanted, f'told_{name}')
        assert close(value, there), f'{place}: told {name} {value} {there}'


def check_state(state, wanted, place):
    check(state, wanted, ('stamp', 'level_since', 'event_id', 'judged'), place)
    check(state.message, wanted, ('measured_torque', 'torque_residual'), place)
    until = state.message.shelved_until
    assert until.sec * SECOND + until.nanosec == wanted.shelved_until, place
    for name in vars(state.totals).keys() - {'revolutions'}:
        here, there = getattr(state.totals, name), getattr(wanted, f'total_{name}')
        assert close(here, there), f'{place}: total {name} {here} {there}'
    assert state.window.count == wanted.window_count, place
    for name in ('speed', 'axial_load', 'efficiency', 'rcs', 'film_ratio'):
        for part, stored in (('min', 'low'), ('mean', 'mean'), ('max', 'high')):
            here = getattr(state.window, f'{name}_{part}')
            there = getattr(wanted, f'window_{name}_{stored}')
            assert close(here, there), f'{place}: window {name} {part} {here} {there}'
    for one in state.inputs:
        prefix = one.source.name.lower()
        for name in INPUT:
            here, there = getattr(one, name), getattr(wanted, f'{prefix}_{name}')
            assert close(-1 if here is None else here, there), f'{place}: {prefix} {name}'


def test_rows_are_the_golden_ones(run, golden, core, monkeypatch):
    rows = []

    def observed(tables, settings, memory, *others):
        memory.light = False  # the gate without its hysteresis
        found = step(tables, settings, memory, *others)
        if found != NOTHING:
            rows.append(others[-1])
        return found

    monkeypatch.setattr(monitors, 'step', observed)
    monitor, numbers = golden.monitor(run), golden.numbers(run)
    of_run = np.isin(golden.arrays['row_event'], numbers)
    wanted_rows = iter(golden.table('row_', of_run))
    wanted_states = iter(golden.table('state_', of_run[golden.arrays['state_row']]))
    lengths = {}  # of excursions, by their numbers [ns]
    for number, stored in zip(numbers.tolist(), golden.table('event_', numbers)):
        place, event, states = f'event {number}', golden.event(stored), []
        if event is None:
            golden.command(monitor, stored)
        else:
            states = core.feed(monitor, [event])
        if rows:
            wanted = next(wanted_rows)
            assert wanted.event == number
            texts = golden.arrays['texts']
            check_row(rows.pop(), monitor.memory, wanted, texts, monitor, lengths, place)
        for state in states:
            check_state(state, next(wanted_states), place)
    assert next(wanted_rows, None) is None
    assert next(wanted_states, None) is None
