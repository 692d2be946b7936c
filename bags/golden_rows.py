# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Golden rows: lists of events, and each judgement that a monitor made of them.

    python bags/golden_rows.py            # writes test/data/golden_{surface,rows}.npz

The surface is a small one of the closed form with spreads of its own and a masked node. The rows
are one .npz without pickle; its arrays are columns of four tables, of numbers but for `run_*`.

* `run_name`, `run_settings` (JSON of MonitorSettings, times [ns], sources by name), `run_memory`
  (JSON of what is kept from before: the totals, number, stamp and start of the last event, and
  the end of a shelving).
* `event_*`, one for each that is fed in, in order: `run`; `kind` of KINDS; `source`; `value`;
  `stamp` and `arrival` [ns]; `stamp_source`; `lost`, -1: not known; `why` of a refusal, else -1.
  A tick, an acknowledgement and a reset have their clock as the stamp; a shelving has the stamp of
  its end and its begin as arrival, and is done by the line `monitor.shelving = Shelving(...)`.
  A correction has its row of `pull_*` as value: speed, opposing_load, temperature, and `solved_`
  fields, NaN where not solved.
* `row_*`, one for each speed sample that is judged and each tick without speed: `event` is that
  which gave it. Then what Instant holds: `gates` and `findings` are sums of 2^number, the values
  of findings are `rcs_finding` and `efficiency_finding`. Integers are the numbers of the enums,
  -1: none (`derived` is the validity of a load of the motor torque). `told_*` is the event that is
  active or the last one; `edge`: it began or ended here. `reason` counts `texts`.
* `state_*`, one for each state that was published: `row`, counted from 0, or -1 where it was none;
  totals, window, and for each of the sources temperature, load, torque, speed what Health holds.

"""

import argparse
from collections.abc import Callable, Iterator, Mapping
import dataclasses
import enum
import json
import math
from pathlib import Path
import tempfile
from typing import Any, NamedTuple
from unittest import mock

from ballscrew_monitor.core.conversions import nanoseconds, SECOND
from ballscrew_monitor.core.derived_load import LoadDerivation
from ballscrew_monitor.core.differentiation import PositionSettings
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from ballscrew_monitor.core.judgement import Code, Limits
from ballscrew_monitor.core.memory import Memory
from ballscrew_monitor.core.shelving import Shelving
from ballscrew_monitor.core.state import Event, Instant, MonitorSettings, State
from ballscrew_monitor.core.tally import Totals
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.node.axis import build_axis
from ballscrew_monitor.node.parameters import read_file
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay
import nominal_cycle
import numpy as np
from scenario import generate, PARAMETERS
from scenarios import SCENARIOS
from surrogate.builder.closed_form import build_closed_form, default_settings
from surrogate.parameters import load_lubricant, load_screw
from surrogate.surface import FIELDS, Surface, SurfacePoint
from surrogate.surface import file as surface_file

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT / 'test' / 'data'
SURFACE, ROWS = DATA / 'golden_surface.npz', DATA / 'golden_rows.npz'
KINDS = ('sample', 'refusal', 'tick', 'acknowledge', 'shelve', 'correct', 'reset')
THINNED = 4  # every which sample of speed, load and torque of a scenario is kept
START, STEP, TICK = 1000 * SECOND, SECOND // 50, SECOND // 10
BEGIN, END = 30.0, 48.0  # [s] of the nominal cycle that is kept
USUAL = Limits(
    rcs=0.01,
    efficiency=0.85,
    light_load=247.5,
    standstill_speed=0.5,
    raise_delay=SECOND // 2,
    clear_delay=SECOND,
    hysteresis=0.1,
)


class Command(NamedTuple):
    """What is done to a monitor beside its samples; stamps [ns], see the table of events."""

    kind: str
    stamp: int
    arrival: int = 0
    value: float = math.nan


Fed = InputSample | Refusal | Command


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Run:
    """One list of events, and the monitor that it is fed to."""

    name: str
    settings: MonitorSettings
    events: list[Fed]
    memory: Memory = Memory()


PULLS = (
    {'speed': 31.3, 'opposing_load': 1040.0, 'temperature': 314.0, 'rcs': 0.4},
    {'speed': 95.0, 'opposing_load': 1100.0, 'temperature': 313.15, 'friction_torque': 0.35},
    {'speed': 96.0, 'opposing_load': -900.0, 'temperature': 312.0, 'film_ratio': 0.9, 'rcs': 0.02},
)
"""Full solves that correct the surface: place, and the fields that they give."""


def small_surface() -> surface_file.SurfaceData:
    """Return a surface of few nodes with spreads, one node of which has not converged."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    settings = dataclasses.replace(
        default_settings(screw),
        speed_nodes=18,
        load_cells=4,
        unloaded_cells=2,
        temperature_nodes=4,
    )
    data = build_closed_form(screw, oil, settings)
    mask = data.mask.copy()
    mask[8, -2, -1] = True
    torque, rcs = data.fields['friction_torque'], data.fields['rcs']
    return dataclasses.replace(
        data,
        header={**data.header, 'format_version': surface_file.ENSEMBLE_VERSION},
        mask=mask,
        deviations={'friction_torque': 0.03 * torque, 'rcs': 0.2 * rcs},
        standard_errors={'friction_torque': 0.01 * torque, 'rcs': 0.07 * rcs},
        provenance={},
    )


def recorded_runs() -> Iterator[Run]:
    """Yield every scenario, thinned, and a part of the nominal cycle."""
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, made) in enumerate(SCENARIOS.items()):
            bag = Path(folder) / name
            generate(made(), bag)
            values = read_file(bag / PARAMETERS)
            values['x.publish_period'] = (0.0, 0.5)[number % 2]
            yield thinned(captured(name, bag, values), THINNED)
        bag = Path(folder) / 'nominal_cycle'
        nominal_cycle.generate(bag)
        run = captured(bag.name, bag, read_file(ROOT / 'config' / 'nominal_cycle.yaml'))
        begin = run.events[0].arrival
        low, high = (begin + nanoseconds(time) for time in (BEGIN, END))
        cut = [one for one in run.events if low <= (one.arrival or one.stamp) < high]
        yield thinned(dataclasses.replace(run, events=cut), 2 * THINNED)


def captured(name: str, bag: Path, values: dict[str, Any]) -> Run:
    """Return what the monitor of axis x is fed when a bag is replayed."""
    values['x.surface'] = str(SURFACE)
    events: list[Fed] = []
    tick, update = Monitor.tick, Monitor.update

    def taken(monitor: Monitor, event: InputSample | Refusal) -> State | None:
        events.append(event)
        return update(monitor, event)

    def ticked(monitor: Monitor, now: int) -> State | None:
        events.append(Command('tick', now))
        return tick(monitor, now)

    with mock.patch.object(Monitor, 'update', taken), mock.patch.object(Monitor, 'tick', ticked):
        for _ in replay(Bag(bag), values):
            pass
    return Run(name=name, settings=build_axis('x', values).monitor.settings, events=events)


def thinned(run: Run, every: int) -> Run:
    """Return the run with each `every`th sample of all inputs but the temperature."""
    counts, kept = dict.fromkeys(Source, 0), []
    for one in run.events:
        if isinstance(one, InputSample) and one.source is not Source.TEMPERATURE:
            counts[one.source] += 1
            if counts[one.source] % every:
                continue
        kept.append(one)
    return dataclasses.replace(run, events=kept)


def settings(**changes: Any) -> MonitorSettings:
    """Return settings with all inputs and a publication at each sample."""
    usual: dict[str, Any] = {
        'axis': 'x',
        'limits': USUAL,
        'timeouts': dict.fromkeys(Source, SECOND // 2),
        'default_temperature': 313.15,
        'max_future': SECOND // 10,
        'max_lag': SECOND,
        'tick_period': TICK,
        'plausible': {Source.SPEED: 700.0, Source.LOAD: 12000.0},
    }
    return MonitorSettings(**(usual | changes))


Readings = Callable[[float], Mapping[Source, float]]


def course(readings: Readings, duration: float, *, start: int = START) -> list[Fed]:
    """Return samples of all inputs each STEP, and the ticks between them; duration [s]."""
    made: list[Fed] = []
    for number in range(round(duration * SECOND / STEP)):
        stamp = start + number * STEP
        if stamp % TICK == 0:
            made.append(Command('tick', stamp))
        for source, value in sorted(readings(number * STEP / SECOND).items()):
            sample = InputSample(source=source, value=value, stamp=stamp, arrival=stamp + 300_000)
            made.append(sample)
    return made


def feeding(time: float) -> dict[Source, float]:
    """Return a feed that creeps for three seconds of ten, and reverses."""
    turn = 1.0 if time % 20.0 < 10.0 else -1.0
    speed = turn * (31.0 if 3.0 <= time % 10.0 < 6.0 else 95.0)
    made = {Source.SPEED: speed + math.sin(7 * time), Source.LOAD: -1050.0 + 40 * math.sin(time)}
    if round(time / 0.02) % 25 == 0:
        made |= {Source.TEMPERATURE: 313.15 + 0.1 * time, Source.TORQUE: turn * 1.9}
    return made


def made_runs() -> Iterator[Run]:
    """Yield what no bag shows."""
    torque_settings = LoadDerivation(
        inertia=1.5e-3,
        window=SECOND // 10,
        torque_uncertainty=0.03,
        parts_uncertainty=0.1,
        largest_share=0.7,
    )
    three = {source: SECOND // 2 for source in Source if source is not Source.LOAD}
    derived = settings(timeouts=three, derivation=torque_settings, publish_period=SECOND // 4)
    yield Run(name='motor_torque', settings=derived, events=course(driven, 16.0))
    calm = dataclasses.replace(torque_settings, inertia=0.0, torque_uncertainty=0.6)
    rough = dataclasses.replace(derived, derivation=calm)
    yield Run(name='motor_torque_rough', settings=rough, events=course(driven, 6.0) + corrected())
    angle = PositionSettings(window=SECOND // 10, wrap=2 * math.pi)
    yield Run(name='angles', settings=settings(positions=angle), events=positions(2 * math.pi))
    way = PositionSettings(window=SECOND // 10)
    yield Run(name='positions', settings=settings(positions=way), events=positions(0.0))
    yield Run(name='corrections', settings=settings(), events=corrected())
    yield Run(name='set_back', settings=settings(), events=set_back())
    yield Run(name='refusals', settings=settings(publish_period=TICK), events=refusals())
    kept = Memory(
        totals=Totals(running_time=5 * SECOND, optimal_time=5 * SECOND, angle=300.0, since=START),
        event=Event(number=7, stamp=START - SECOND, start=START - 3 * SECOND),
        shelving=Shelving(until=START + 2 * SECOND, reason='kept'),
    )
    yield Run(name='commands', settings=settings(), events=commands(), memory=kept)
    yield Run(name='light_load', settings=settings(publish_period=TICK), events=around_the_gate())
    yield Run(name='soup', settings=settings(publish_period=TICK), events=soup())
    yield Run(name='position_soup', settings=settings(positions=angle), events=soup())
    yield Run(name='torque_soup', settings=rough, events=soup())
    yield Run(name='masked', settings=settings(), events=course(hot, 4.0))
    sure = dataclasses.replace(calm, torque_uncertainty=1e-6, largest_share=1e3)
    about = settings(timeouts=three, derivation=sure, publish_period=SECOND // 4)
    yield Run(name='idle_torque', settings=about, events=course(idling, 6.0))


def driven(time: float) -> dict[Source, float]:
    """Return speed and torque of an axis that ramps, cuts, idles and is pushed."""
    speed = 90.0 * max(-1.0, min(1.0, 3.0 * math.sin(0.9 * time)))
    acceleration = 243.0 * math.cos(0.9 * time) if abs(speed) < 90.0 else 0.0
    turn = math.copysign(1.0, speed) if speed else 0.0
    cut = 2.0 * math.sin(0.37 * time) + 0.02 * math.sin(90 * time)
    if 11.0 < time < 12.0:
        cut = 30.0
    made = {
        Source.SPEED: speed + 0.01 * math.sin(50 * time),
        Source.TORQUE: 1.5e-3 * acceleration + turn * (0.25 + cut),
    }
    if round(time / 0.02) % 20 == 0:
        made[Source.TEMPERATURE] = 313.15 + 0.3 * time
    return made


def hot(time: float) -> dict[Source, float]:
    """Return a feed that gets faster with hot oil under a high load."""
    speed = math.exp(1.3 * time)
    return {Source.SPEED: speed, Source.LOAD: -3300.0, Source.TEMPERATURE: 345.0 + time}


def idling(time: float) -> dict[Source, float]:
    """Return torques about that of an idle nut."""
    torque = 0.1 + 0.12 * math.sin(0.8 * time)
    return {Source.SPEED: 20.0 + 20.0 * time, Source.TORQUE: torque, Source.TEMPERATURE: 313.15}


def positions(wrap: float) -> list[Fed]:
    """Return positions of a feed with a hole, a leap, receive times and a loss."""
    place, events = 0.0, []
    for one in course(feeding, 9.0):
        if isinstance(one, InputSample) and one.source is Source.SPEED:
            place += one.value * STEP / SECOND
            time = (one.stamp - START) / SECOND
            if 4.0 < time < 5.0:
                continue
            leap = 900.0 if 6.0 < time < 6.5 else 0.0
            turned = (place + leap) % wrap if wrap else place + leap
            late = 7.0 < time < 8.0
            one = dataclasses.replace(
                one,
                value=turned,
                stamp=one.arrival if late else one.stamp,
                stamp_source=StampSource.RECEIVE if late else StampSource.HEADER,
            )
        events.append(one)
    return events


def corrected() -> list[Fed]:
    """Return a feed under which the surface is corrected, more than once."""
    events = course(feeding, 9.0, start=START + 100 * SECOND)
    for number in range(len(PULLS)):
        at = (number + 1) * len(events) // 4
        events.insert(at, Command('correct', 0, value=float(number)))
    return events


def set_back() -> list[Fed]:
    """Return a feed whose stamps, and then whose clock, are set back, and a clock at zero."""
    events: list[Fed] = []
    for one in course(feeding, 5.0):
        events.append(one)
        if isinstance(one, InputSample) and one.stamp % SECOND == 0:  # out of order
            events.append(dataclasses.replace(one, stamp=one.stamp - SECOND // 5))
    stamps_back = course(feeding, 5.0, start=START + 2 * SECOND)
    events += [
        dataclasses.replace(one, arrival=one.arrival + 3 * SECOND)
        for one in stamps_back
        if isinstance(one, InputSample)
    ]
    events += course(feeding, 4.0, start=START - 500 * SECOND)
    events += [Command('tick', START - 600 * SECOND + number * TICK) for number in range(9)]
    events += course(feeding, 3.0, start=START + 50 * SECOND)
    events += [Command('tick', START + number * TICK) for number in range(9)]
    zero = [one for one in course(feeding, 3.0) if isinstance(one, InputSample)]
    events += [dataclasses.replace(one, arrival=one.stamp) for one in zero[:150]]
    events += [Command('tick', 0)]
    return events + course(feeding, 3.0, start=SECOND)


def refusals() -> list[Fed]:
    """Return a feed with a refusal of every kind by each input, losses and late arrivals."""
    events: list[Fed] = []
    whys, counts = list(Why), [1, 3, None, 0]
    for number, one in enumerate(course(feeding, 24.0)):
        if isinstance(one, InputSample):
            lag = 2 * SECOND if 14 * SECOND < one.stamp - START < 17 * SECOND else 0
            one = dataclasses.replace(one, arrival=one.arrival + lag)
            if number % 31 == 0:
                place = number // 31
                refusal = Refusal(
                    source=list(Source)[place % 4],
                    why=whys[place // 4 % len(whys)],
                    arrival=one.arrival,
                    lost=counts[place % 3],
                )
                events.append(refusal)
            if number % 57 == 0:
                one = dataclasses.replace(one, lost=counts[number // 57 % 4])
            if number % 83 == 0:
                value = (math.nan, math.inf, 1e6, -1e6)[number // 83 % 4]
                one = dataclasses.replace(one, value=value)
            if one.source is Source.LOAD and 18 * SECOND < one.stamp - START < 20 * SECOND:
                continue
        events.append(one)
    return events


def commands() -> list[Fed]:
    """Return a feed in which a warning is acknowledged, shelved, and totals are reset."""
    events: list[Fed] = []
    for one in course(feeding, 13.0):
        events.append(one)
        if isinstance(one, Command):
            time = round((one.stamp - START) / TICK)
            if time in (45, 70, 125):
                events.append(Command('acknowledge', one.stamp))
            if time in (50, 110):
                until = one.stamp + (3 * SECOND if time == 50 else 0)
                events.append(Command('shelve', until, one.stamp))
            if time == 80:
                events.append(Command('reset', one.stamp))
    return events


def around_the_gate() -> list[Fed]:
    """Return loads and speeds about the gates, slow samples, and unloaded stretches."""

    def readings(time: float) -> dict[Source, float]:
        load = -247.5 + 30 * math.sin(5 * time) + 20 * math.sin(23 * time)
        speed = 60.0 if time < 4.0 else 0.5 + 0.3 * math.sin(3 * time)
        made = {Source.SPEED: speed, Source.LOAD: load if time < 6.0 else -5e-324 * (time < 7.0)}
        return made | {Source.TEMPERATURE: 313.15}

    events = course(readings, 8.0)
    slow = course(feeding, 9.0, start=START + 20 * SECOND)
    return events + [one for one in slow if isinstance(one, Command) or one.stamp % SECOND == 0]


def soup() -> list[Fed]:
    """Return events drawn at random, mostly in order."""
    draw = np.random.Generator(np.random.PCG64(29))
    now, events = START, []
    for _ in range(700):
        steps = [STEP // 4, STEP, 10 * STEP, 40 * STEP, -STEP, -2 * SECOND]
        now += int(draw.choice(steps, p=[0.4, 0.48, 0.06, 0.01, 0.04, 0.01]))
        source = Source(int(draw.choice([0, 1, 2, 3, 3, 3])))
        value = {
            Source.SPEED: draw.choice([30.0, 60.0, 95.0, -60.0, 0.2, 300.0, math.inf]),
            Source.LOAD: draw.choice([-1000.0, 1000.0, -200.0, 0.0, 9000.0, 2e4]),
            Source.TEMPERATURE: draw.choice([313.0, 320.0, 353.15, 400.0]),
            Source.TORQUE: draw.choice([2.0, -2.0, 0.05, 0.3]),
        }[source]
        kind, arrival = draw.random(), now + int(draw.integers(0, 4)) * STEP
        if kind < 0.05:
            events.append(Refusal(source=source, why=Why(int(draw.integers(9))), arrival=arrival))
        elif kind < 0.12:
            events.append(Command('tick', now))
        else:
            stated = StampSource.HEADER if kind < 0.9 else StampSource.RECEIVE
            lost = None if kind > 0.98 else int(kind > 0.95)
            events.append(
                InputSample(
                    source=source,
                    value=float(value),
                    stamp=now,
                    arrival=arrival,
                    stamp_source=stated,
                    lost=lost,
                )
            )
    return events


@dataclasses.dataclass(slots=True)
class Tables:
    """The columns of all tables, row by row."""

    events: list[dict[str, float]] = dataclasses.field(default_factory=list)
    rows: list[dict[str, float]] = dataclasses.field(default_factory=list)
    states: list[dict[str, float]] = dataclasses.field(default_factory=list)
    texts: dict[str, int] = dataclasses.field(default_factory=dict)

    def take(self, number: int, run: Run, surface: Surface) -> None:
        """Feed a run to a monitor of its own."""
        monitor = Monitor(surface, run.settings, run.memory)
        monitor.observer = self._observe
        for one in run.events:
            self.events.append({'run': number, **event_columns(one)})
            rows = len(self.rows)
            state = apply(monitor, one)
            if state is not None:
                row = len(self.rows) - 1 if len(self.rows) > rows else -1
                self.states.append({'row': row, **state_columns(state)})

    def _observe(self, found: Instant) -> None:
        reason = self.texts.setdefault(found.estimate.reason, len(self.texts))
        place = len(self.events) - 1
        self.rows.append({'event': place, **row_columns(found), 'reason': reason})


def apply(monitor: Monitor, event: Fed) -> State | None:
    """Let a monitor take one event."""
    if not isinstance(event, Command):
        return monitor.update(event)
    if event.kind == 'tick':
        return monitor.tick(event.stamp)
    if event.kind == 'acknowledge':
        monitor.acknowledge(event.stamp)
    elif event.kind == 'shelve':
        monitor.shelving = Shelving(until=event.stamp, reason='known')
    elif event.kind == 'correct':
        monitor.use_surface(pulled(monitor.surface, PULLS[int(event.value)]))
    else:
        monitor.reset_totals()
    return None


def pulled(surface: Surface, pull: Mapping[str, float]) -> Surface:
    """Return a surface corrected by one of the PULLS."""

    class Given:
        def __init__(self, names: tuple[str, ...]) -> None:
            self.__dict__.update({name: pull[name] for name in names if name in pull})

    place = Given(('speed', 'opposing_load', 'temperature'))
    return surface.with_correction(place, Given(FIELDS))  # type: ignore[arg-type]


def event_columns(event: Fed) -> dict[str, float]:
    """Return the columns of one event but its run."""
    if isinstance(event, Command):
        made = {'kind': KINDS.index(event.kind), 'source': -1, 'why': -1, 'stamp_source': 0}
        return made | {
            'value': event.value,
            'stamp': event.stamp,
            'arrival': event.arrival,
            'lost': 0,
        }
    sample = isinstance(event, InputSample)
    return {
        'kind': KINDS.index('sample' if sample else 'refusal'),
        'source': event.source,
        'why': -1 if sample else event.why,
        'stamp_source': event.stamp_source if sample else 0,
        'value': event.value if sample else math.nan,
        'stamp': event.stamp if sample else 0,
        'arrival': event.arrival,
        'lost': -1 if event.lost is None else event.lost,
    }


POINT = (
    'speed',
    'axial_load',
    'temperature',
    'motor_torque',
    'speed_source',
    'axial_load_source',
    'temperature_source',
    'motor_torque_source',
    'direction',
    'direction_held',
    'axial_load_uncertainty',
)
ESTIMATE = (
    'validity',
    'rcs',
    'efficiency',
    'machine_torque',
    'worst_nut',
    'regime',
    'contact_state',
)
NUMBERS = (
    'friction_torque',
    'film_ratio',
    'asperity_share',
    'central_film',
    'minimum_film',
    'friction_coefficient',
    'max_pressure',
    'worst_contact',
    'driving_torque',
    'friction_torque_error',
    'friction_torque_std',
    'friction_torque_stderr',
    'rcs_error',
    'rcs_std',
    'rcs_stderr',
    'efficiency_error',
    'efficiency_std',
    'efficiency_stderr',
    'back_driving',
    'corrected',
)


def row_columns(found: Instant) -> dict[str, float]:
    """Return the columns of one judgement but its event and reason."""
    point, numbers, findings = found.point, found.estimate.numbers, found.verdict.findings
    values = {one.code: one.value for one in findings}
    return {
        **{name: getattr(found, name) for name in ('stamp', 'now', 'tick', 'published', 'level')},
        **{name: getattr(point, name) for name in POINT},
        'derived': -1 if point.derived is None else point.derived.validity,
        **{name: getattr(found.estimate, name) for name in ESTIMATE},
        **{name: _number(numbers, name) for name in NUMBERS},
        'zone': found.verdict.zone,
        'clear': found.verdict.clear,
        'gates': sum(2**gate for gate in found.verdict.gates),
        'findings': sum(2**code for code in values),
        'rcs_finding': values.get(Code.RCS_HIGH, math.nan),
        'efficiency_finding': values.get(Code.EFFICIENCY_LOW, math.nan),
        'edge': found.edge is not None,
        'told_number': found.event.number,
        'told_active': found.event.active,
        'told_stamp': found.event.stamp,
        'told_start': found.event.start,
        'told_worst_value': found.event.worst_value,
        'told_cause': found.event.cause.code,
    }


def _number(numbers: SurfacePoint | None, name: str) -> float:
    if numbers is None:
        return {'worst_contact': -1, 'back_driving': 0, 'corrected': 0}.get(name, math.nan)
    found: float = getattr(numbers, name)
    return found


def state_columns(state: State) -> dict[str, float]:
    """Return the columns of one state but its row."""
    made = {name: getattr(state, name) for name in ('stamp', 'level_since', 'event_id', 'judged')}
    made |= {name: getattr(state, name) for name in ('measured_torque', 'torque_residual')}
    made['shelved_until'] = state.shelving.until
    made |= {f'total_{name}': value for name, value in dataclasses.asdict(state.totals).items()}
    for name, value in dataclasses.asdict(state.window).items():
        parts = value.items() if isinstance(value, dict) else [('', value)]
        made |= {f'window_{name}_{part}'.rstrip('_'): number for part, number in parts}
    for health in state.inputs:
        for field in dataclasses.fields(health):
            if field.name not in ('source', 'refusal', 'joints'):
                value = getattr(health, field.name)
                name = f'{health.source.name.lower()}_{field.name}'
                made[name] = -1 if value is None else value
    return made


def columns_of(prefix: str, rows: list[dict[str, float]]) -> dict[str, np.ndarray]:
    """Return each column as an array, of floats where one of its numbers is a float."""
    made = {}
    for name in rows[0]:
        values = [row[name] for row in rows]
        real = any(isinstance(value, float) for value in values)
        made[f'{prefix}_{name}'] = np.array(values, dtype=np.float64 if real else np.int64)
    return made


def plain(value: Any) -> Any:
    """Return settings as JSON takes them."""
    if dataclasses.is_dataclass(value):
        return {one.name: plain(getattr(value, one.name)) for one in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {key.name: plain(each) for key, each in value.items()}
    return int(value) if isinstance(value, enum.IntEnum) else value


def kept_of(memory: Memory) -> dict[str, Any]:
    """Return what is kept as JSON takes it."""
    event = {name: getattr(memory.event, name) for name in ('number', 'stamp', 'start')}
    kept = {'totals': plain(memory.totals), 'event': event}
    return kept | {'shelved_until': memory.shelving.until}


def main(arguments: list[str] | None = None) -> int:
    """Write the surface and the rows, from the command line."""
    parser = argparse.ArgumentParser(description='Write the golden rows.')
    parser.add_argument('--keep-surface', action='store_true', help='judge by the surface there')
    if not parser.parse_args(arguments).keep_surface:
        surface_file.write(SURFACE, small_surface())
    surface, tables = Surface.load(SURFACE), Tables()
    runs = [*recorded_runs(), *made_runs()]
    for number, run in enumerate(runs):
        tables.take(number, run, surface)
    places = ('speed', 'opposing_load', 'temperature')
    np.savez_compressed(
        ROWS,
        run_name=[run.name for run in runs],
        run_settings=[json.dumps(plain(run.settings)) for run in runs],
        run_memory=[json.dumps(kept_of(run.memory)) for run in runs],
        texts=list(tables.texts),
        **columns_of('event', tables.events),
        **columns_of('row', tables.rows),
        **columns_of('state', tables.states),
        **{f'pull_{name}': [pull[name] for pull in PULLS] for name in places},
        **{f'pull_solved_{name}': [pull.get(name, math.nan) for pull in PULLS] for name in FIELDS},
    )
    print(f'{ROWS}: {len(tables.events)} events, {len(tables.rows)} rows, {ROWS.stat().st_size} B')
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
