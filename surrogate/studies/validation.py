# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Published values beside ours: the record of all comparisons, SI units, and its tables."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from surrogate.limits import read_text
from surrogate.parameters import load_lubricant, load_screw
from surrogate.plain_yaml import plain_values
from surrogate.studies import ours
from surrogate.studies.ours import FAST, torque_table, ValidationCase
from surrogate.units import RPM

PUBLISHED = plain_values(read_text(Path(__file__).parents[1] / 'data' / 'published.yaml'))
"""Published values, each declared once with its source, and measurements without a number."""


def validation_record() -> dict[str, Any]:
    """Compute every comparison now, some half a minute."""
    case = ValidationCase(screw=load_screw('nominal'), lubricant=load_lubricant('iso_vg_68'))
    return {
        'screw': case.screw.name,
        'oil': case.lubricant.name,
        'temperature_K': case.temperature,
        'comparisons': [_compared(case, value) for value in PUBLISHED['values']],
        'without_number': PUBLISHED['without_number'],
        'rolling': case.rolling,
        'rolling_over_width': case.rolling_over_width,
        'torque_Nm': torque_table(case),
    }


def _compared(case: ValidationCase, value: dict[str, Any]) -> dict[str, Any]:
    found = getattr(ours, value['ours'])(case)
    whole = {'unit': '', 'tolerance': 0.0, 'comparable': True} | value
    return whole | {'ours': found, 'verdict': verdict(whole, found)}


def verdict(value: Mapping[str, Any], found: Sequence[float]) -> str:
    """Return whether all of our numbers lie within the published range and its tolerance."""
    if not value['comparable']:
        return 'not comparable'
    low, high = value['published']
    low, high = low * (1 - value['tolerance']), high * (1 + value['tolerance'])
    return 'agrees' if all(low <= one <= high for one in found) else 'differs'


def validation_page(record: Mapping[str, Any]) -> str:
    """Return the tables of a record in Markdown."""
    tables = _comparisons(record), _rolling(record), _width(record), _torque(record)
    return '\n\n'.join('\n'.join(lines) for lines in tables)


def _comparisons(record: Mapping[str, Any]) -> Iterator[str]:
    yield '| what | source | what was read | published | ours | verdict | reason |'
    yield '|---|---|---|---|---|---|---|'
    for one in record['comparisons']:
        within = f' ± {100 * one["tolerance"]:.0f} %' if one['tolerance'] else ''
        cells = [
            *(one[key] for key in ('what', 'source', 'read')),
            f'{span(one["published"])}{within} {one["unit"]}'.strip(),
            f'{span(one["ours"])} {one["unit"]}'.strip(),
            *(one[key] for key in ('verdict', 'reason')),
        ]
        yield f'| {" | ".join(cells)} |'
    yield ''
    yield from (f'* {sentence}' for sentence in record['without_number'])


def _rolling(record: Mapping[str, Any]) -> Iterator[str]:
    yield '| normal force [N] | rev/min | M of Moes | domain | with the tail | with ripples |'
    yield '|---|---|---|---|---|---|'
    for one in record['rolling']:
        ratios = [one[f'{name}_over_formula'] for name in ('domain', 'smooth', 'rough')]
        cells = [
            f'{one["load_N"]:g}',
            f'{one["speed_rad_s"] / RPM:.0f}',
            f'{one["moes_load"]:.0f}',
        ]
        yield f'| {" | ".join([*cells, *(f"{ratio:.2f}" for ratio in ratios)])} |'


def _width(record: Mapping[str, Any]) -> Iterator[str]:
    ratios = record['rolling_over_width']
    yield f'| half width of the oil over the semi-axis | {" | ".join(f"{w:g}" for w in ratios)} |'
    yield f'|---|{"---|" * len(ratios)}'
    cells = ' | '.join(f'{ratio:.2f}' for ratio in ratios.values())
    yield f'| rolling force over the formula | {cells} |'


def _torque(record: Mapping[str, Any]) -> Iterator[str]:
    yield f'| friction torque at {FAST:g} rev/min | N m |'
    yield '|---|---|'
    yield from (f'| {name} | {torque:.3f} |' for name, torque in record['torque_Nm'].items())


def span(values: Sequence[float]) -> str:
    """Return one number, or the range of several, to two digits or decimals."""
    low, high = (
        f'{value:.2g}' if value < 0.1 else f'{value:.2f}' for value in (min(values), max(values))
    )
    return low if low == high else f'{low} to {high}'
