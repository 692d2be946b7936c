# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Mends of inputs whose sign or size contradicts the others: what to write, and where."""

from collections.abc import Sequence
import math

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.recordings.words import number
from ballscrew_monitor.report.judging import AxisCase
from surrogate.units import MILLI

WORDS = {Source.LOAD: 'axial load', Source.TORQUE: 'motor torque'}
TURNED = {
    Source.SPEED: 'load and motor torque drive it the other way',
    Source.LOAD: 'the motor torque falls where it asks for more, or it drives the nut both ways',
    Source.TORQUE: 'it brakes where friction must be overcome',
}
"""Reasons to think that the sign of an input is turned."""
TOLERANT = 30.0  # factor by which friction may miss that of the model
UNITS_APART = {
    (1e3, 1.0): (Source.LOAD, 'kN', 'unit: kN'),
    (1e-3, 1.0): (Source.LOAD, 'N', 'unit: N'),
    (1e3, 1e3): (Source.TORQUE, 'N mm', 'scale: 0.001'),
}
"""Torque over what the load needs, and friction over that of the model: the unit that is meant."""


def contradictions(case: AxisCase, source: Source, parameter: str) -> Sequence[str]:
    """Return that sign or size of an input contradicts the others, and what may mend it."""
    factor = case.balance.factor
    if source is case.balance.turned:
        said = f'{parameter}: its sign looks turned ({TURNED[source]})'
        return [f'{said}: {_write(case, source, "scale: -1")}, or 1 if it is -1']
    if source is not Source.LOAD or math.isnan(factor):
        return []
    said = (
        f'{parameter}: the motor torque changes {number(factor)} times as much as this load '
        f'needs at a lead of {case.surface.lead * MILLI:g} mm'
    )
    return [f'{said}: {_mend_of_size(case)}']


def _mend_of_size(case: AxisCase) -> str:
    """Return the unit that explains how torque and load differ in size, else what to check."""
    friction = case.balance.friction
    fitting = [
        meant
        for (factor, times), meant in UNITS_APART.items()
        if _is_near(case.balance.factor, factor)
        and (math.isnan(friction) or _is_near(friction, times, TOLERANT))
    ]
    if len(fitting) != 1:
        return 'check unit and scale of both, the lead, and a gear between motor and screw'
    source, unit, value = fitting[0]
    return f'the {WORDS[source]} looks like {unit}: {_write(case, source, value)}'


def _is_near(value: float, other: float, within: float = 2.0) -> bool:
    return other / within < value < other * within


def _write(case: AxisCase, source: Source, value: str) -> str:
    """Return where a value is to be written, in the map or among the parameters."""
    name = source.name.lower()
    if case.facts.is_mapped:
        return f'write `{value}` for axes.{case.axis}.{case.facts.column_of(name)} in the map'
    key, _, amount = value.partition(': ')
    return f'set {case.axis}.{name}.{key} to {amount}'
