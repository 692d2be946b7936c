# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The verdict of health in a sentence, the advice for a cause, and health as plain data."""

from collections.abc import Sequence
import dataclasses
import enum
import math
from typing import Any

from ballscrew_monitor.health.records import (
    Cause,
    CauseCode,
    Condition,
    Health,
    Quantity,
    TOLERANCE,
)

ADVICE = {
    CauseCode.PRELOAD_LOST: 'measure the backlash, and have the preload set or the nut replaced',
    CauseCode.OIL_THINNER: 'check grade and temperature of the oil; name a new baseline after an '
    'intended change of oil',
    CauseCode.OIL_THICKER: 'check grade and temperature of the oil; name a new baseline after an '
    'intended change of oil',
    CauseCode.WARMER_THAN_MEASURED: 'check the temperature sensor, and cooling',
    CauseCode.FILM_STARVED: 'lubricate now, and check the lubricator',
    CauseCode.WIPER: 'look at wipers, covers and bearings',
    CauseCode.CHURNING: 'look for too much grease or oil in the nut',
    CauseCode.LOAD_SIGN_OR_UNIT: 'check sign, unit and zero of the axial load; scale -1 turns it',
    CauseCode.TORQUE_CONSTANT: 'check torque constant and gear ratio',
    CauseCode.SENSOR_OFFSET: 'set the zero of the torque sensor',
}


def verdict_of(
    axis: str, condition: Condition, drag: Quantity, preload: Quantity, causes: Sequence[Cause]
) -> str:
    """Return the condition of an axis, the size of its change and its cause in one sentence."""
    if not drag.is_known:
        return f'Axis {axis}: whether it is normal or worse is {drag.reason}.'
    change = percent(drag)
    if condition is Condition.NORMAL:
        return f'Axis {axis} is normal: its drag has changed by {change}.'
    if condition is Condition.UNKNOWN:
        return f'Axis {axis}: its drag has changed by {change}, which does not tell yet.'
    why = _why(drag, preload, causes)
    return f'Axis {axis} is worse: its drag has changed by {change}; {why}.'


def percent(quantity: Quantity) -> str:
    """Return a relative change as people read it, with its interval."""
    value, low, high = (100.0 * part for part in (quantity.value, quantity.low, quantity.high))
    return f'{value:+.0f} % ({low:+.0f} to {high:+.0f} %)'


class Certainty(enum.Enum):
    """How sure the cause of a change is, in words around it."""

    NONE = 'the cause is not known'
    PERHAPS = 'perhaps {}, or the preload is lost, which could not be tried'
    LIKELY = 'most likely {}'
    SURE = 'the cause is that {}'


def explained(change: float, causes: Sequence[Any]) -> tuple[Certainty, Sequence[Any]]:
    """
    Return how sure the cause of a change of the drag [-] is, and the likely ones, the best first.

    `causes` are those of health or of its message. Likely is one that fits, and about as well as
    any, be it excluded or not.

    """
    most = max((one.weight for one in causes), default=0.0)
    likely = [one for one in causes if not one.excluded and one.weight > 0.25 * most]
    if not likely:
        return Certainty.NONE, likely
    if change < -TOLERANCE and all(one.code != CauseCode.PRELOAD_LOST for one in causes):
        return Certainty.PERHAPS, likely
    return Certainty.LIKELY if len(likely) > 1 else Certainty.SURE, likely


def _why(drag: Quantity, preload: Quantity, causes: Sequence[Cause]) -> str:
    certainty, likely = explained(drag.value, causes)
    said = likely[0].text if likely else ''
    if likely and likely[0].code is CauseCode.PRELOAD_LOST and preload.is_known:
        value, low, high = (100 * part for part in (preload.value, preload.low, preload.high))
        said = f'the preload is {value:.0f} % of what it was ({low:.0f} to {high:.0f} %)'
    return certainty.value.format(said)


def advice_of(condition: Condition, causes: Sequence[Cause]) -> str:
    """Return what to do about the likely causes, empty for nothing."""
    if condition is not Condition.WORSE:
        return ''
    _, likely = explained(math.nan, causes)
    return '; or '.join(dict.fromkeys(ADVICE[one.code] for one in likely))


def health_record(health: Health) -> dict[str, Any]:
    """Return health as plain data for JSON, what is not known as None."""
    record: dict[str, Any] = {
        'axis': health.axis,
        'stamp_ns': health.stamp,
        'condition': health.condition.name.lower(),
        'verdict': health.verdict,
        'advice': health.advice,
        'quantities': {one.name: _quantity(one) for one in health.quantities},
        'causes': [
            {
                'code': one.code.name.lower(),
                'size': {'name': one.size.name, **_quantity(one.size)},
                'weight': one.weight,
                'excluded': one.excluded,
                'text': one.text,
            }
            for one in health.causes
        ],
        'notes': list(health.notes),
    }
    if health.baseline is not None:
        names = 'begin', 'end', 'reason', 'named_at'
        record['baseline'] = {name: getattr(health.baseline, name) for name in names}
    return record


def _quantity(quantity: Quantity) -> dict[str, Any]:
    made = dataclasses.asdict(quantity)
    del made['name']
    return {
        key: None if isinstance(value, float) and math.isnan(value) else value
        for key, value in made.items()
    }
