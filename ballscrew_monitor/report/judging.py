# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A recording judged in one pass, with all that page and terminal say of it.

Printing asks for no more than the node: nothing here loads what pages and tables are made with.

"""

from collections.abc import Callable, Iterator, Mapping
import functools
from typing import Any, TYPE_CHECKING

from ballscrew_monitor.core.conversions import POSITION_UNITS
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.recordings.axis_run import TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.columns import AxisOutcome, JudgedColumns
from ballscrew_monitor.recordings.own_recording import is_as_recorded
from ballscrew_monitor.recordings.replay import ignore, replay_columns, replay_parts
from ballscrew_monitor.report.case import AxisCase, AxisFacts, InputSetting, LogCase
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.report.survey import Surveyor
from ballscrew_monitor.settings.axis import is_configured, load_surface, scalings_of, settings_of

if TYPE_CHECKING:  # it asks for packages that printing does not need
    from ballscrew_monitor.report.store import RowStore

OnShare = Callable[[float], None]
"""Told which share of a recording is judged [-]."""
OnState = Callable[[TimedState], None]
"""Handed a state that would be published."""


class CaseMaker:
    """Takes the blocks of one axis in order, and makes its case of them."""

    def __init__(self, axis: str, values: Mapping[str, Any]) -> None:
        """Begin an axis of the parameters `values`; raises InputError without its surface."""
        self._axis, self._values = axis, values
        self._surface = load_surface(axis, values)
        self._settings = settings_of(axis, values, self._surface)
        self._surveyor = Surveyor(
            axis,
            standstill=self._settings.limits.standstill_speed,
            max_gap=self._settings.timeouts[Source.SPEED],
        )

    def add(self, block: JudgedColumns) -> None:
        """Take the next block of rows."""
        self._surveyor.add(block)

    def case(self, outcome: AxisOutcome, **known: Any) -> AxisCase:
        """Return the axis as it is after at least one row; `known` are more of its fields."""
        return AxisCase(
            axis=self._axis,
            surface=self._surface,
            settings=self._settings,
            inputs={
                source: self._setting(source)
                for source in Source
                if is_configured(self._axis, self._values, source)
            },
            outcome=outcome,
            survey=self._surveyor.result(),
            **known,
        )

    def _setting(self, source: Source) -> InputSetting:
        prefix, values = f'{self._axis}.{source.name.lower()}', self._values
        unit = values[f'{prefix}.unit']
        scalings = scalings_of(self._axis, values, source, self._surface.lead)
        return InputSetting(
            topic=values[f'{prefix}.topic'],
            field=values[f'{prefix}.field'],
            unit=unit if unit in scalings else next(iter(scalings)),
            scalings=scalings,
            from_position=unit in POSITION_UNITS,
        )


def judge_log(
    bag: Bag,
    parameters: LogParameters,
    *,
    on_share: OnShare = ignore,
    rows: 'RowStore | None' = None,
    on_state: OnState | None = None,
) -> LogCase:
    """
    Judge a recording and return what is said of it; its rows are kept in `rows`, if anywhere.

    `on_state` is handed each state that would be published. Raises InputError when it cannot be
    read with the parameters.

    """
    makers: dict[str, CaseMaker] = {}
    outcomes = []
    for part in _parts(bag, parameters.values, on_share, on_state):
        if isinstance(part, AxisOutcome):
            outcomes.append(part)
        elif len(part):
            if part.axis not in makers:
                makers[part.axis] = CaseMaker(part.axis, parameters.values)
            makers[part.axis].add(part)
            if rows is not None:
                rows.add(part)
    numbered = is_as_recorded(bag, parameters.values)
    return LogCase(
        name=bag.path.name,
        parameters=parameters.short_origin,
        axes=[
            makers[one.axis].case(
                one,
                blocks=tuple if rows is None else functools.partial(rows.blocks, one.axis),
                facts=parameters.axes.get(one.axis, AxisFacts()),
                nominal=parameters.nominal,
                numbered=numbered,
            )
            for one in outcomes
            if one.axis in makers
        ],
        empty=[one.axis for one in outcomes if one.axis not in makers],
        assumptions=parameters.assumptions,
        notes=[*parameters.notes, *bag.notes],
    )


def _parts(
    bag: Bag, values: Mapping[str, Any], on_share: OnShare, on_state: OnState | None
) -> Iterator[JudgedColumns | AxisOutcome]:
    """Yield rows and outcomes; states, which cost more than these, are made only if wanted."""
    if on_state is None:
        yield from replay_columns(bag, values, on_done=on_share)
        return
    for part in replay_parts(bag, values, on_done=on_share):
        if isinstance(part, TimedState):
            on_state(part)
        else:
            yield part
