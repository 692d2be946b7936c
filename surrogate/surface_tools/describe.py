# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A surface file described: a record, and a page for a person."""

from collections.abc import Iterator, Mapping
import math
from pathlib import Path
from typing import Any

import numpy as np
from surrogate.files import InputError
from surrogate.parameters import screw_and_oil
from surrogate.raceway.ball import roughness_sentence
from surrogate.surface import onset_of_surface, Surface
from surrogate.surface.file import SurfaceData
from surrogate.surface_tools.fields import FIELD_TEXTS
from surrogate.units import digits, RPM, ZERO_CELSIUS


def info_record(path: Path, data: SurfaceData) -> dict[str, Any]:
    """Return what a surface file is and states, as plain numbers in SI, NaN where unknown."""
    surface = Surface(data)
    try:
        screw, oil = screw_and_oil(data.header['inputs'])
    except InputError as error:
        raise InputError(f'{path}: {error}') from None
    return {
        'file': str(path),
        'bytes': path.stat().st_size,
        'format_version': data.header['format_version'],
        'sha256': surface.sha256,
        'tier': surface.tier,
        'screw': surface.screw_name,
        'oil': surface.oil_name,
        'preload_N': surface.preload,
        'lead_m': surface.lead,
        'roughness_rms_m': screw.composite_rms,
        'roughness': roughness_sentence(screw.roughness, screw.ball_roughness),
        'film_floor_m': oil.film_floor,
        'film_factor': oil.film_factor,
        'speed_range_rad_s': list(surface.speed_range),
        'load_range_N': list(surface.load_range),
        'temperature_range_K': list(surface.temperature_range),
        'nodes': list(data.mask.shape),
        'cells': list(surface.cells),
        'masked_nodes': int(data.mask.sum()),
        'masked_cells': surface.masked_cells,
        'load_breaks_N': list(data.header['load_breaks']),
        'temperature_nodes_K': data.temperature.tolist(),
        'errors': {
            name: {'max': worst, 'p95': usual}
            for name, (worst, usual) in sorted(surface.errors.items())
        },
        'spreads': {
            name: {
                'std': _summary(data, 'deviations', name),
                'stderr': _summary(data, 'standard_errors', name),
            }
            for name in FIELD_TEXTS
            if name in data.deviations or name in data.standard_errors
        },
        'contact_onset': onset_of_surface(surface).record(),
        'formula_warnings': surface_warnings(data),
        'onset_band': data.header.get('limit_band') and list(surface.onset_band),
        'limit_band': data.header.get('limit_band'),
        'numerical_band': data.header.get('numerical_band'),
        'accuracy_reached': data.header.get('reached'),
        'march': data.header.get('march'),
        'settings': dict(data.header['settings']),
        'provenance': dict(data.provenance),
    }


def surface_warnings(data: SurfaceData) -> list[str]:
    """Return where the formulas of a surface leave their ranges; solved contacts replace them."""
    if data.header['tier'] != 'closed_form':
        return []
    from surrogate.screw import closed_form  # slow to load
    from surrogate.screw.closed_form_record import formula_warnings
    from surrogate.screw.opened import Contacts

    places = np.meshgrid(data.header['settings']['speed_range'], data.load, data.temperature)
    # The groups of films do not depend on what asperities do.
    screw, oil = screw_and_oil(data.header['inputs'])
    solution = closed_form.solve(Contacts.of(screw), oil, *places, share_of=np.zeros_like)
    return formula_warnings(solution)


def _summary(data: SurfaceData, group: str, name: str) -> dict[str, float]:
    values = getattr(data, group).get(name, np.empty(0))
    known = values[np.isfinite(values)]
    if not known.size:
        return {'median': math.nan, 'max': math.nan}
    return {'median': float(np.median(known)), 'max': float(known.max())}


def info_page(record: Mapping[str, Any], *, verbose: bool = False) -> str:
    """Return the record as a page; `verbose` with the formulas that leave their ranges."""
    lines = [
        f'{record["file"]}',
        f'  {record["contact_onset"]["sentence"]}',
        *_head(record),
        *(f'  formulas     {text}' for text in record['formula_warnings'] if verbose),
    ]
    for name, words in (
        ('onset_band', 'both'),
        ('limit_band', 'what is not known'),
        ('numerical_band', 'the numerics'),
    ):
        if record[name] is not None:
            low, high = record[name]
            lines.append(
                f'  contact      begins between {low:.2g} and {high:.2g} times the stated speed, '
                f'by {words}'
            )
    if record['accuracy_reached'] is not None:
        lines.append(
            '  accuracy     the worst held-out point has '
            f'{record["accuracy_reached"]:.2g} times the error that is aimed at'
        )
    lines += [f'  {line}' for line in march_lines(record['march'] or {})]
    lines.append('  measured interpolation error                    max         p95')
    for name, error in record['errors'].items():
        lines.append(f'    {_label(name):44} {error["max"]:<10.3g}  {error["p95"]:.3g}')
    if record['spreads']:
        heads = 'deviation: median, max    of the mean'
        lines.append(f'  over strips of the raceway               {heads}')
    for name, spread in record['spreads'].items():
        kinds = [spread[kind][part] for kind in ('std', 'stderr') for part in ('median', 'max')]
        numbers = '  '.join(f'{value:<10.3g}' for value in kinds).rstrip()
        lines.append(f'    {_label(name):36} {numbers}')
    lines.append('  provenance (not hashed)')
    lines += [f'    {name:12} {value}' for name, value in record['provenance'].items()]
    return '\n'.join(lines)


def _label(name: str) -> str:
    unit = FIELD_TEXTS[name].unit if name in FIELD_TEXTS else ''
    return f'{name} [{unit or "-"}]'


def _head(record: Mapping[str, Any]) -> Iterator[str]:
    low, high = record['speed_range_rad_s']
    cold, warm = record['temperature_range_K']
    yield f'  tier         {record["tier"]}, format version {record["format_version"]}'
    yield (
        f'  screw, oil   {record["screw"]}, {record["oil"]}; lead {1e3 * record["lead_m"]:g} mm, '
        f'preload {record["preload_N"]:g} N, Rq {1e6 * record["roughness_rms_m"]:g} um, '
        f'film floor {1e9 * record["film_floor_m"]:g} nm'
    )
    yield f'  roughness    {record["roughness"]}'
    yield f'  sha256       {record["sha256"]}'
    yield f'  size         {record["bytes"]} bytes'
    yield f'  speed        {digits(low / RPM)} to {digits(high / RPM, 4)} rev/min'
    yield '  load         {:g} to {:g} N, positive opposes the motion'.format(
        *record['load_range_N']
    )
    yield '  kinks at     {} N'.format(
        ', '.join(f'{load:.4g}' for load in record['load_breaks_N']) or 'no load,'
    )
    yield f'  temperature  {cold - ZERO_CELSIUS:g} to {warm - ZERO_CELSIUS:g} degC, nodes at ' + (
        ', '.join(f'{kelvin - ZERO_CELSIUS:.3g}' for kelvin in record['temperature_nodes_K'])
    )
    yield '  nodes        {} x {} x {}'.format(*record['nodes']) + (
        f', {record["masked_nodes"]} without a number: unsolved, or beyond the speed range'
    )
    yield '  cells        {} x {} x {}'.format(*record['cells']) + (
        f', {record["masked_cells"]} masked'
    )


def march_lines(march: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for each strip of the raceway that was marched, beside the law."""
    for name, strip in march.items():
        marched, by_law = strip['marched_m_s'], strip['told_m_s']
        begins = 'does not begin'
        if marched is not None:
            begins = (
                f'begins at {marched:.3g} m/s, with {strip["film_factor"]:.2f} times the film of '
                f'the law, told over marched {by_law / marched:.2f}'
            )
        about = ''
        if marched is not None and (share := strip.get('failed_share')) != 0.0:
            part = 'an unknown share' if share is None else f'{100 * share:.0f} %'
            about = f' Of the steps about the onset {part} failed.'
        yield (
            f'{name}, waves down to {1e6 * strip["shortest_wave_m"]:.2g} um: contact {begins}, '
            f'told {by_law:.3g} m/s; {strip["status"]}{about}'
        )
