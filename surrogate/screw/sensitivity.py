# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sensitivity of onset, friction torque and zone to each input, one at a time."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.formulas import torque
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.screw import closed_form
from surrogate.screw.onset_bands import bands_of, spread
from surrogate.screw.opened import Contacts
from surrogate.screw.uncertain_inputs import INPUTS, ScrewCase, Varied
from surrogate.surface.aims import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT
from surrogate.surface.contact_onset import law_doubt
from surrogate.surface.lookup import both_bands
from surrogate.tasks.progress import OnProgress
from surrogate.units import digits, RPM, ZERO_CELSIUS

Array = NDArray[np.float64]
ONSET, TORQUE = 'onset_speed_rad_s', 'friction_torque_Nm'
RCS_SPEED, EFFICIENCY_SPEED = 'rcs_limit_speed_rad_s', 'efficiency_limit_speed_rad_s'
ENDS = 'low', 'stated', 'high'
AROUND = 2.5
"""Factor about the onset within which RCS passes the limit of the zone [-]."""
SPEEDS = 60
"""Speeds among which a limit of the zone is looked for [-]."""
BANDS = {'not known': 'limit_band', 'numerics': 'numerical_band', 'both': 'band'}
"""Bands of a record in words."""
KEYS = {
    'screw': 'name of the sheet',
    'oil': 'name of the sheet',
    'speed_rad_s': 'of the point',
    'load_N': 'of the point',
    'temperature_K': 'of the point',
    'stated': '`onset_speed_rad_s`; `friction_torque_Nm`; `rcs_limit_speed_rad_s` (RCS 0.01 in '
    'the worst contact); `efficiency_limit_speed_rad_s` (fastest speed with 0.85)',
    'inputs': 'the largest effect on the onset first: `key`, `low`, `stated`, `high` in the '
    'unit of the key, `reason`, `measured`, `refused`, `onset_factors`, `at_low`, '
    '`at_high`',
    'band': 'least and largest onset over the stated one',
    'limit_band': 'the same by what is not known alone',
    'numerical_band': 'the same by law and lookup alone',
    'measure': 'the two measurements that narrow `limit_band` most, each with what is left of it',
    'law_doubt': 'where the law is beyond the marches; else empty',
}
"""Keys of the record."""


def sensitivity_record(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    *,
    inputs: Iterable[Varied] = INPUTS,
    progress: OnProgress = lambda done, total: None,
) -> dict[str, Any]:
    """
    Return what each input changes at a point, the largest effect on the onset first.

    SI units, but the values of an input are in the unit of its `key`. Speeds and torque are those
    of the closed form. `progress(done, total)` counts inputs. Raises InputError if all is smooth.

    """
    if not screw.composite_rms:
        raise InputError('screw: raceway and ball are smooth, allowed is a rough one')
    case = ScrewCase(screw=screw, lubricant=lubricant, point=point).faster_side
    used = [varied for varied in inputs if varied.bounds(case)]
    progress(0, len(used))
    stated, rows, sheet = _outcome(case), [], screw.roughness
    for done, varied in enumerate(used):
        rows.append(_row(varied, case, stated))
        progress(done + 1, len(used))
    rows.sort(key=lambda row: spread(row['onset_factors']), reverse=True)
    bands = bands_of(case, [(row['measured'], row['onset_factors']) for row in rows])
    return {
        'screw': screw.name,
        'oil': lubricant.name,
        'speed_rad_s': point.speed,
        'load_N': point.load,
        'temperature_K': point.temperature,
        'stated': stated,
        'inputs': rows,
        'band': list(bands.whole),
        **bands.record(),
        'law_doubt': law_doubt(
            rms=sheet.rms, likely_rms=sheet.likely_rms, measured=sheet.measured
        ),
    }


def _row(varied: Varied, case: ScrewCase, stated: Mapping[str, float]) -> dict[str, Any]:
    """Return what one input changes, NaN at an end that the model refuses, with its sentence."""
    rules, ends, outcomes, refused = varied.rules(case, varied.name), varied.bounds(case), [], ''
    assert ends is not None  # those without were left out
    for value in ends:
        try:
            outcomes.append(
                _outcome(varied.at(case, value)) if value != varied.stated(case) else stated
            )
        except InputError as error:
            outcomes.append(dict.fromkeys(stated, math.nan))
            refused = str(error)
    shown = (
        None if value is None else value / rules['factor'] - rules['shift']
        for value in (ends[0], varied.stated(case), ends[1])
    )
    return {
        'key': f'{varied.name}_{rules["unit"]}'.rstrip('_'),
        **dict(zip(ENDS, shown, strict=True)),
        'reason': varied.reason,
        'measured': varied.measured,
        'refused': refused,
        'onset_factors': [end[ONSET] / stated[ONSET] for end in outcomes],
        'at_low': outcomes[0],
        'at_high': outcomes[1],
    }


def _outcome(case: ScrewCase) -> dict[str, float]:
    """Return onset, friction torque and both limits of the zone, NaN where there is none."""
    onset, point = case.onset or math.nan, case.point
    near = onset * np.geomspace(1 / AROUND, AROUND, SPEEDS)
    most = case.screw.fastest_speed
    wide = np.geomspace(min(near[0], most), most, SPEEDS)
    speed = np.concatenate([[abs(point.speed)], near, wide])
    load = point.opposing_load
    place = case.lubricant, speed, load, point.temperature
    points = closed_form.solve(Contacts.of(case.screw), *place)
    slow, fast = points.rcs[1:-SPEEDS], points.friction_torque[-SPEEDS:]
    with np.errstate(divide='ignore'):
        contact = np.log(slow / RCS_LIMIT)
    lead = case.screw.lead
    efficiency = np.array([torque.efficiency(loss, load, lead) for loss in fast.tolist()])
    light = abs(load) < LIGHT_LOAD * case.screw.preload
    return {
        ONSET: onset,
        TORQUE: float(points.friction_torque[0]),
        RCS_SPEED: _fastest(near, contact),
        EFFICIENCY_SPEED: math.nan if light else _fastest(wide, efficiency - EFFICIENCY_LIMIT),
    }


def _fastest(speed: Array, spare: Array) -> float:
    """Return the speed [rad/s] at which something spare [-] runs out, NaN where it does not."""
    last = np.flatnonzero(spare[:-1] >= 0)[-1:]
    if not last.size or not spare[-1] < 0:
        return math.nan
    k = int(last[0])
    share = spare[k] / (spare[k] - spare[k + 1])
    return float(speed[k] * (speed[k + 1] / speed[k]) ** share)


def sensitivity_page(record: Mapping[str, Any]) -> str:
    """Return the lines that a person reads."""
    return '\n'.join(_lines(record))


def _lines(record: Mapping[str, Any]) -> Iterator[str]:
    onset = record['stated'][ONSET]
    yield (
        f'{record["screw"]}, {record["oil"]}: {record["speed_rad_s"] / RPM:g} rev/min, '
        f'{record["load_N"]:g} N, {record["temperature_K"] - ZERO_CELSIUS:g} degC, closed form'
    )
    yield _line('', ('low', 'stated', 'high'), ('onset', 'torque', 'RCS 0.01', 'eta 0.85'))
    yield _line('', ('',) * 3, ('rev/min', 'N m', 'rev/min', 'rev/min'))
    yield _line('as stated', ('',) * 3, _cells(record['stated']))
    for row in record['inputs']:
        values = ['-' if row[end] is None else shown(row[end]) for end in ENDS]
        cells = _cells(row['at_low'], row['at_high'])
        yield _line(row['key'], values, cells) + f'  {row["refused"] or row["reason"]}'
    for words, name in BANDS.items():
        low, high = record[name]
        yield (
            f'  {words:10} contact begins at {low:.2g} to {high:.2g} times the stated speed: '
            f'{digits(low * onset / RPM)} to {digits(high * onset / RPM)} rev/min'
        )
    if record['law_doubt']:
        yield f'  {"law":10} {record["law_doubt"]}'
    for word, step in zip(('measure', 'then'), record['measure'], strict=False):
        low, high = both_bands(step['limit_band'], record['numerical_band'])
        yield f'  {word:10} {step["measurement"]}: {low:.2g} to {high:.2g} times is left'


def shown(value: float) -> str:
    """Return a value of an input with four digits, as a whole number rather than by powers."""
    return digits(value, 4)


def _line(key: str, values: Sequence[str], cells: Sequence[str]) -> str:
    columns = [f'{value:>7}' for value in values] + [f'{text:>15}' for text in cells]
    return ' '.join([f'  {key:21}', *columns])


def _cells(*ends: Mapping[str, float]) -> list[str]:
    """Return the numbers of one or two ends per column."""
    return [
        ' to '.join(digits(end[name] / unit) for end in ends).replace('nan', '-')
        for name, unit in ((ONSET, RPM), (TORQUE, 1.0), (RCS_SPEED, RPM), (EFFICIENCY_SPEED, RPM))
    ]
