# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Answers of a surface for operating points: a record, a page, and a table for a table."""

from collections.abc import Iterable
import csv
import io
import math
from typing import Any

from surrogate.files import InputError
from surrogate.formulas.torque import DRAGS
from surrogate.parameters import OperatingPoint
from surrogate.surface import regime_of, Surface, Validity
from surrogate.surface_tools.fields import derived_key, FIELD_TEXTS, WORST_CONTACTS
from surrogate.units import digits, RPM, ZERO_CELSIUS

COLUMNS = ('speed_rpm', 'load_N', 'temperature_degC')
"""Columns of a table of points; the last may be missing."""
DRAG_KEY = 'typical_drag'
SPREAD_OF = ('friction_torque', 'rcs')


def query_record(surface: Surface, point: OperatingPoint) -> dict[str, Any]:
    """Look up one point and return it as plain numbers, SI, NaN with a reason where unknown."""
    answer = surface.lookup(abs(point.speed), point.opposing_load, point.temperature)
    known = answer.validity is Validity.VALID
    drag = surface.with_typical_drag(answer.friction_torque, point.opposing_load)
    return {
        'tier': surface.tier,
        'screw': surface.screw_name,
        'oil': surface.oil_name,
        'sha256': surface.sha256,
        'speed_rad_s': point.speed,
        'load_N': point.load,
        'opposing_load_N': point.opposing_load,
        'temperature_K': point.temperature,
        'validity': answer.validity.name,
        'efficiency': answer.efficiency,
        'efficiency_error': answer.efficiency_error if known else math.nan,
        'efficiency_std': answer.efficiency_std if known else math.nan,
        **{text.key: getattr(answer, name) for name, text in FIELD_TEXTS.items()},
        **{derived_key(name, 'error'): getattr(answer, f'{name}_error') for name in SPREAD_OF},
        **{derived_key(name, 'std'): getattr(answer, f'{name}_std') for name in SPREAD_OF},
        **{derived_key(name, 'stderr'): getattr(answer, f'{name}_stderr') for name in SPREAD_OF},
        'driving_torque_Nm': answer.driving_torque,
        'back_driving': answer.back_driving,
        **{
            f'{DRAG_KEY}_{end}_{key}': value
            for key, row in drag.items()
            for end, value in row.items()
        },
        'regime': regime_of(answer.film_ratio).word,
        'worst_contact': WORST_CONTACTS[answer.worst_contact] if known else '',
        'reason': _reason(surface, answer.validity),
    }


def _reason(surface: Surface, validity: Validity) -> str:
    """Return why there are no numbers, with the limit that was passed; empty when there are."""
    slow, fast = (speed / RPM for speed in surface.speed_range)
    low, high = surface.load_range
    cold, warm = (kelvin - ZERO_CELSIUS for kelvin in surface.temperature_range)
    return {
        Validity.VALID: '',
        Validity.SPEED_BELOW_RANGE: f'the surface begins at {digits(slow)} rev/min',
        Validity.SPEED_ABOVE_RANGE: f'the surface ends at {digits(fast, 4)} rev/min',
        Validity.LOAD_OUT_OF_RANGE: f'the surface covers {low:g} to {high:g} N against the motion',
        Validity.TEMPERATURE_OUT_OF_RANGE: f'the surface covers {cold:g} to {warm:g} degC',
        Validity.MASKED: 'a node beside this point did not converge',
    }.get(validity, 'not known')


def query_page(record: dict[str, Any]) -> str:
    """Return the record of a point as a page."""
    lines = [
        f'tier {record["tier"]}: {record["speed_rad_s"] / RPM:g} rev/min, '
        f'{record["load_N"]:g} N, {record["temperature_K"] - ZERO_CELSIUS:g} degC',
        f'  screw, oil           {record["screw"]}, {record["oil"]}',
    ]
    if record['reason']:
        return '\n'.join([*lines, f'  no answer: {record["reason"]}'])
    lines += [_line('efficiency', '-', record, 'efficiency', 'efficiency')]
    for name, text in FIELD_TEXTS.items():
        lines.append(_line(name.replace('_', ' '), text.unit or '-', record, text.key, name))
    drag = []
    if f'{DRAG_KEY}_low_drag_Nm' in record:
        torque, share = (
            '{1:.4g} ({0:.3g} to {2:.3g})'.format(
                *sorted(record[f'{DRAG_KEY}_{end}_{key}'] for end in DRAGS)
            )
            for key in ('friction_torque_Nm', 'efficiency')
        )
        drag.append(f'  with typical drag    efficiency {share}, friction torque {torque} N m')
    driving = ', the load drives the screw' if record['back_driving'] else ''
    return '\n'.join(
        [
            *lines,
            f'  driving torque       {record["driving_torque_Nm"]:.4g} N m{driving}',
            *drag,
            f'  regime               {record["regime"]} by the film ratio; RCS decides',
            f'  worst contact        {record["worst_contact"]}',
        ]
    )


def _line(title: str, unit: str, record: dict[str, Any], key: str, name: str) -> str:
    """Return one number with its errors, as far as they are known."""
    texts = []
    for kind, words in (
        ('error', 'interpolation'),
        ('std', 'between strips'),
        ('stderr', 'of mean'),
    ):
        column = 'efficiency_' + kind if name == 'efficiency' else derived_key(name, kind)
        value = record.get(column, math.nan)
        if math.isfinite(value):
            texts.append(f'{words} {value:.2g}')
    errors = f'   ({", ".join(texts)})' if texts else ''
    return f'  {title:20} {record[key]:.4g} {unit if unit != "-" else ""}'.rstrip() + errors


def query_table(surface: Surface, lines: Iterable[str], name: str) -> tuple[str, int, int]:
    """
    Return a table of points with what the surface says of them, how many points, how many answers.

    Raises InputError that names file, line and column of what is wrong.

    """
    reader = csv.DictReader(lines)
    given = list(reader.fieldnames or ())
    for column in COLUMNS[:2]:
        if column not in given:
            raise InputError(
                f'{name}: column {column} is missing, a table has {", ".join(COLUMNS)}'
            )
    out = io.StringIO()
    writer: csv.DictWriter[str] | None = None
    answers = count = 0
    for row in reader:
        numbers = _row(surface, row, f'{name}, line {reader.line_num}')
        if writer is None:
            added = [key for key in numbers if key not in given]
            writer = csv.DictWriter(out, [*given, *added], lineterminator='\n')
            writer.writeheader()
        writer.writerow({**numbers, **{column: row[column] for column in given}})
        count += 1
        answers += numbers['validity'] == Validity.VALID.name
    if not count:
        raise InputError(f'{name}: no points')
    return out.getvalue(), count, answers


def _row(surface: Surface, row: dict[str, str], where: str) -> dict[str, Any]:
    if None in row or None in row.values():
        raise InputError(f'{where}: not as many values as columns')
    speed, load = (_number(row[column], column, where) for column in COLUMNS[:2])
    kelvin = surface.reference_temperature
    if row.get(COLUMNS[2], '') != '':
        kelvin = _number(row[COLUMNS[2]], COLUMNS[2], where) + ZERO_CELSIUS
    try:
        point = OperatingPoint(speed=speed * RPM, load=load, temperature=kelvin)
    except InputError as error:
        raise InputError(f'{where}: {error}') from None
    record = query_record(surface, point)
    return {key: value for key, value in record.items() if key not in ('tier', 'screw', 'oil')}


def _number(text: str, column: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f'{where}: {column} is {text!r}, allowed is a number') from None
