# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The verdict of health in a sentence, the advice for a cause, and health as plain data."""

from collections.abc import Sequence
import dataclasses
import datetime
import enum
import math
from typing import Any

from ballscrew_monitor.health.causes import BEARING_DRAG
from ballscrew_monitor.health.change import LEAST_GAIN, LEAST_OFFSET, Marks
from ballscrew_monitor.health.history import groups_of
from ballscrew_monitor.health.records import (
    Cause,
    CauseCode,
    CellKind,
    Condition,
    Health,
    LoadSource,
    Missing,
    Quantity,
)
from ballscrew_monitor.health.rows import DAY
import numpy as np
from numpy.typing import NDArray
from surrogate.files import to_json

MOST_TOLD = 3  # causes that are told together
LEAST_WEIGHT = 0.05  # of a cause that is told [-]: the others carry 95 %
NOT_ASSESSED = 'nothing has been assessed yet'
MISSING = {
    Missing.CLOCK: 'the clock was not set, or leapt',
    Missing.LOAD: 'the map takes the motor torque for the load, so that no friction is left: '
    'state load: {from: motor_torque} for the axis, and always_free: true if it has no process '
    'force',
    Missing.TORQUE: 'no torque was measured while the axis moved',
    Missing.STEADY: 'no motion was steady for a quarter of a second',
    Missing.MOTION: 'the axis did not move',
}

ONE_WAY = (
    'no speed and load ran in both directions with a measured torque: log motion without load '
    'forth and back'
)
TOO_LITTLE = (
    'the measured torque is less than the load needs: check the lead, and sign and unit of torque '
    'and load'
)
OIL = 'check grade and temperature of the oil; name a new baseline after an intended change of oil'
ADVICE = {
    'preload_lost': 'measure the backlash, and have the preload set or the nut replaced',
    'oil_thinner': OIL,
    'oil_thicker': OIL,
    'film_starved': 'lubricate now, and check the lubricator',
    'wiper': 'look at wipers, covers, guideway and bearings',
    'bearing_play': 'measure the play of the support bearing, and have it set or replaced',
    'torque_constant': 'check torque constant and gear ratio',
}
"""What to do, by the names of causes."""


def cause_name(cause: Any) -> str:
    """Return the name of a cause, be it a record or a message, '' for one of another version."""
    if cause.size.name == BEARING_DRAG:
        return 'bearing_play'
    return next((code.name.lower() for code in CauseCode if code == cause.code), '')


def verdict_of(
    axis: str, condition: Condition, drag: Quantity, causes: Sequence[Cause], since: int
) -> str:
    """
    Return the condition of an axis, the size of its change, its date and cause in one sentence.

    `since` [ns] is the date of the change, 0 for none.

    """
    if not drag.is_known:
        return f'Axis {axis}: whether it is normal or worse is {drag.reason}.'
    change = percent(drag)
    if condition is Condition.NORMAL:
        return f'Axis {axis} is normal: its friction has changed by {change}.'
    if condition is Condition.UNKNOWN:
        return f'Axis {axis}: its friction has changed by {change}, which does not tell yet.'
    state = 'is worse' if condition is Condition.WORSE else 'has slightly changed'
    date = f'since about {date_words(since)} ' if since else ''
    if drag.low * drag.high <= 0.0:
        return f'Axis {axis} {state}: {date}it changed, and is now back at {change}.'
    certainty, likely = explained(causes)
    why = certainty.value.format(', or '.join(cause.text for cause in likely))
    return f'Axis {axis} {state}: {date}its friction is {lower_or_higher(drag)}; {why}.'


def normal_answer(health: Health | None) -> str:
    """Return whether an axis is normal, or since when it has changed, in a few words."""
    if health is None:
        return f'not known yet: {NOT_ASSESSED}'
    drag = next((each for each in health.quantities if each.name == 'drag change'), None)
    if health.condition is Condition.NORMAL:
        return 'normal for this axis'
    if health.condition is Condition.UNKNOWN or drag is None:
        return drag.reason if drag and not drag.is_known else 'not known yet: too few logs'
    date = f'since about {date_words(health.since)}' if health.since else 'since its baseline'
    if not drag.is_known or drag.low * drag.high <= 0.0:
        return f'changed {date}, and its friction is now back'
    word = 'changed' if health.condition is Condition.WORSE else 'slightly changed'
    return f'{word} {date}: its friction is {lower_or_higher(drag)}'


def lower_or_higher(drag: Quantity) -> str:
    """Return a change as people say it, `11 % lower (9 to 13 %)`."""
    ends = sorted(abs(100.0 * end) for end in (drag.low, drag.high))
    word = 'lower' if drag.value < 0.0 else 'higher'
    return f'{abs(100.0 * drag.value):.0f} % {word} ({ends[0]:.0f} to {ends[1]:.0f} %)'


def date_words(stamp: int) -> str:
    """Return the day of a stamp [ns] for people, UTC."""
    day = datetime.date(1970, 1, 1) + datetime.timedelta(days=stamp // DAY)
    return f'{day.day} {day:%B %Y}'


def percent(quantity: Quantity) -> str:
    """Return a relative change as people read it, with its interval."""
    ends = (quantity.value, quantity.low, quantity.high)
    value, low, high = (round(100.0 * part) for part in ends)
    return f'{value:+d} % ({low:+d} to {high:+d} %)'


class Certainty(enum.Enum):
    """How sure the cause of a change is, in words around it."""

    NONE = 'the cause is not told'
    LIKELY = 'most likely {}'
    SURE = 'the cause is that {}'


def explained(causes: Sequence[Any]) -> tuple[Certainty, Sequence[Any]]:
    """
    Return how sure the cause of a change is, and the likely ones, the best first.

    `causes` are those of health or of its message. Causes that cannot be told apart are likely
    together; more than three are not told. One of less than `LEAST_WEIGHT` is not likely.

    """
    likely = [cause for cause in causes if not cause.excluded and cause.weight >= LEAST_WEIGHT]
    if not 1 <= len(likely) <= MOST_TOLD:
        return Certainty.NONE, []
    return Certainty.LIKELY if len(likely) > 1 else Certainty.SURE, likely


def advice_of(condition: Condition, causes: Sequence[Cause]) -> str:
    """Return what to do about the likely causes, empty for nothing."""
    if condition not in (Condition.WORSE, Condition.SLIGHTLY_CHANGED):
        return ''
    _, likely = explained(causes)
    return '; or '.join(dict.fromkeys(ADVICE[cause_name(cause)] for cause in likely))


def input_notes(marks: Marks) -> list[str]:
    """Return sentences on inputs that have drifted."""
    notes = []
    if marks.offset.is_proven(LEAST_OFFSET):
        rest = marks.standstill
        seen = ', and the torque at rest has moved' if rest.is_proven(LEAST_OFFSET) else ''
        notes.append(
            f'the torques of both directions have moved by {100 * marks.offset.value:+.0f} % of '
            f'the friction against each other{seen}: check the zero of the torque, and weight '
            'or counterbalance'
        )
    if marks.gain.is_proven(LEAST_GAIN):
        change = 100.0 * math.expm1(marks.gain.value)
        notes.append(
            f'the torque over the measured load has changed by {change:+.0f} %: '
            'check the gain of the load, and the torque constant'
        )
    return notes


def missing_reason(cells: NDArray[Any]) -> str:
    """Return why the friction of an axis is not known."""
    motion = cells[(cells['kind'] == CellKind.MOTION) & np.isfinite(cells['motor_torque'])]
    known = motion[motion['load_source'] != LoadSource.DERIVED]
    if len(known):
        return f'not known: {TOO_LITTLE if groups_of(known, both=True)[0] else ONE_WAY}'
    reasons = set(cells['missing'][cells['kind'] == CellKind.NOTHING].tolist())
    for code, text in MISSING.items():
        if int(code) in reasons:
            return f'not known: {text}'
    return 'not known: no steady motion with a measured torque yet'


def health_record(health: Health) -> dict[str, Any]:
    """Return health as plain data for JSON, what is not known as None."""
    record: dict[str, Any] = {
        'axis': health.axis,
        'stamp_ns': health.stamp,
        'condition': health.condition.name.lower(),
        'since_ns': health.since or None,
        'verdict': health.verdict,
        'advice': health.advice,
        'quantities': {each.name: _plain(each) for each in health.quantities},
        'causes': [
            {
                'code': cause.code.name.lower(),
                'size': {'name': cause.size.name, **_plain(cause.size)},
                'weight': cause.weight,
                'excluded': cause.excluded,
                'text': cause.text,
            }
            for cause in health.causes
        ],
        'notes': list(health.notes),
    }
    if health.baseline is not None:
        names = 'begin', 'end', 'reason', 'named_at'
        record['baseline'] = {name: getattr(health.baseline, name) for name in names}
    return record


def _plain(quantity: Quantity) -> dict[str, Any]:
    plain: dict[str, Any] = to_json(dataclasses.asdict(quantity))
    return {key: value for key, value in plain.items() if key != 'name'}
