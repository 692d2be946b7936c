# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One recording, judged and reported into a directory of its own."""

from collections.abc import Callable, Mapping, Sequence
import dataclasses
import functools
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import POSITION_UNITS
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.node.axis import is_configured, load_surface, scalings_of, settings_of
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.columns import AxisOutcome
from ballscrew_monitor.recordings.replay import replay_columns
from ballscrew_monitor.report.case import AxisCase, badness, InputSetting
from ballscrew_monitor.report.judged_bag import write_judged_bag
from ballscrew_monitor.report.log_page import LogCase, report_page, verdicts_of
from ballscrew_monitor.report.logs import EVENTS, JUDGED, PAGE, STATES
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.report.products import write_events, write_summary
from ballscrew_monitor.report.store import RowStore
from ballscrew_monitor.report.survey import survey
from surrogate.files import replace_file

SUMMARY = 'summary.json'
OnShare = Callable[[float], None]
"""Told which share of a recording is judged [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisLine:
    """
    What an overview says of an axis of a recording.

    `begins` [s] since 1970, time recorded, in motion and outside [s], NaN where not known; the
    worst event in words, and its depth [-].

    """

    axis: str
    standing: str
    verdict: str
    begins: float = math.nan
    recorded: float = math.nan
    running_time: float = math.nan
    outside_time: float = math.nan
    warnings: int = 0
    worst: str = ''
    depth: float = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogResult:
    """
    What became of a recording: a line for each axis, and those on which nothing was judged.

    `summaries` holds the totals of each axis, None where there are none.

    """

    name: str
    lines: Sequence[AxisLine]
    unjudged: Sequence[str]
    notes: Sequence[str] = ()
    summaries: Mapping[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def judged(self) -> bool:
        """Tell whether something was judged on at least one axis."""
        return len(self.unjudged) < len(self.lines)


def report_log(
    bag: Bag, out: Path, parameters: LogParameters, *, on_share: OnShare = lambda share: None
) -> LogResult:
    """
    Judge a recording; write page, states, events, summary and judged bag into `out`.

    Raises InputError when it cannot be read with the parameters; then nothing is written.

    """
    with RowStore(out) as store:
        outcomes = []
        for part in replay_columns(bag, parameters.values, on_done=on_share):
            if isinstance(part, AxisOutcome):
                outcomes.append(part)
            else:
                store.add(part)
        log = _log_case(bag.path.name, parameters, outcomes, store, bag.notes)
        store.write(out / STATES)
        write_events(out / EVENTS, log)
        write_summary(out / SUMMARY, log)
        replace_file(out / PAGE, report_page(log).encode())
        write_judged_bag(bag, parameters.values, out / JUDGED, parameters.metadata)
        return _result(log)


def _log_case(
    name: str,
    parameters: LogParameters,
    outcomes: Sequence[AxisOutcome],
    store: RowStore,
    notes: Sequence[str],
) -> LogCase:
    rows = set(store.axes)
    return LogCase(
        name=name,
        parameters=parameters.short_origin,
        axes=[
            axis_case(
                one,
                parameters.values,
                functools.partial(store.blocks, one.axis),
                load_from=parameters.load_from.get(one.axis, ''),
                assumed=parameters.of_axis(one.axis),
                stated=parameters.stated_of(one.axis),
                nominal=parameters.nominal,
            )
            for one in outcomes
            if one.axis in rows
        ],
        empty=[one.axis for one in outcomes if one.axis not in rows],
        assumptions=parameters.assumptions,
        notes=[*parameters.notes, *notes],
    )


def axis_case(
    outcome: AxisOutcome, values: Mapping[str, Any], blocks: Callable[[], Any], **known: Any
) -> AxisCase:
    """Return an axis with all that a report says of it; `known` are more fields of `AxisCase`."""
    axis = outcome.axis
    surface = load_surface(axis, values)
    settings = settings_of(axis, values, surface)
    return AxisCase(
        axis=axis,
        surface=surface,
        settings=settings,
        inputs={
            source: _setting(axis, values, source, surface.lead)
            for source in Source
            if is_configured(axis, values, source)
        },
        outcome=outcome,
        survey=survey(
            axis,
            blocks(),
            standstill=settings.limits.standstill_speed,
            max_gap=settings.timeouts[Source.SPEED],
        ),
        blocks=blocks,
        **known,
    )


def _setting(axis: str, values: Mapping[str, Any], source: Source, lead: float) -> InputSetting:
    prefix = f'{axis}.{source.name.lower()}'
    scalings, unit = scalings_of(axis, values, source, lead), values[f'{prefix}.unit']
    return InputSetting(
        topic=values[f'{prefix}.topic'],
        field=values[f'{prefix}.field'],
        unit=unit if unit in scalings else next(iter(scalings)),
        scalings=scalings,
        from_position=unit in POSITION_UNITS,
    )


def _result(log: LogCase) -> LogResult:
    verdicts = verdicts_of(log)
    lines = [
        _axis_line(case, verdict.standing.value, f'{verdict.word}: {verdict.sentence}')
        for case, verdict in zip(log.axes, verdicts, strict=False)
    ]
    lines += [
        AxisLine(
            axis=axis,
            standing=verdict.standing.value,
            verdict=f'{verdict.word}: {verdict.sentence}',
        )
        for axis, verdict in zip(reversed(log.empty), reversed(verdicts), strict=False)
    ]
    return LogResult(
        name=log.name,
        lines=lines,
        unjudged=log.unjudged,
        notes=log.notes,
        summaries={case.axis: case.outcome.summary() for case in log.axes}
        | dict.fromkeys(log.empty),
    )


def _axis_line(case: AxisCase, standing: str, verdict: str) -> AxisLine:
    summary, worst = case.outcome.summary(), next(iter(case.worst_first), None)
    return AxisLine(
        axis=case.axis,
        standing=standing,
        verdict=verdict,
        begins=case.begins,
        recorded=case.survey.span,
        running_time=math.nan if summary is None else summary.running_time,
        outside_time=math.nan if summary is None else summary.outside_time,
        warnings=len(case.outcome.events),
        worst='' if worst is None else f'{worst.quantity} {worst.worst_value:.3g}',
        depth=math.nan if worst is None else badness(worst)[0],
    )
