# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A surface as NetCDF with CF-style names and units, or as a table; numbers bit for bit."""

import csv
import io
import json
from typing import Any

import numpy as np
from surrogate.surface.file import SurfaceData
from surrogate.surface_tools.fields import derived_key, FIELD_TEXTS, WORST_CONTACTS

NODES = ('speed_coordinate', 'load', 'temperature')
CELLS = tuple(f'{name}_cell' for name in NODES)
Variables = dict[str, tuple[tuple[str, ...], Any, dict[str, Any]]]


def to_netcdf(data: SurfaceData) -> bytes:
    """Return a surface as NetCDF 3, which every reader knows, with 64-bit offsets."""
    import xarray

    cell_fields: Variables = {}
    for name, values in data.errors.items():
        text = FIELD_TEXTS[name]
        words = f'{text.words}, measured interpolation error'
        cell_fields[f'error_{name}'] = (CELLS, values, _texts(text.unit or '1', words))
    screw, oil = (data.header['inputs'][kind]['name'] for kind in ('screw', 'lubricant'))
    dataset = xarray.Dataset(
        data_vars={**_node_fields(data), **cell_fields},
        coords=_coordinates(data),
        attrs={
            'Conventions': 'CF-1.11',
            'title': f'Ball screw {screw} with oil {oil}: friction and contact over speed, load '
            'and temperature',
            'source': f'ballscrew_monitor, tier {data.header["tier"]}',
            'tier': str(data.header['tier']),
            'screw': screw,
            'oil': oil,
            'sha256': data.sha256,
            'header': json.dumps(data.header, sort_keys=True),
            'provenance': json.dumps(data.provenance, sort_keys=True),
        },
    )
    return bytes(dataset.to_netcdf(engine='scipy', format='NETCDF3_64BIT'))


def _coordinates(data: SurfaceData) -> Variables:
    middle = {
        f'{name}_cell': 0.5 * (getattr(data, name)[1:] + getattr(data, name)[:-1])
        for name in NODES
    }
    texts = {
        'speed_coordinate': ('1', 'logarithm of the speed over the onset speed'),
        'load': ('N', 'axial load, positive opposes the motion'),
        'temperature': ('K', 'oil temperature'),
    }
    coordinates: Variables = {}
    for name, (unit, words) in texts.items():
        coordinates[name] = ((name,), getattr(data, name), _texts(unit, words))
        cell = f'{name}_cell'
        coordinates[cell] = ((cell,), middle[cell], _texts(unit, f'{words}, middle of the cell'))
    coordinates['speed'] = (NODES, speeds(data), _texts('rad s-1', 'speed of the screw'))
    return coordinates


def speeds(data: SurfaceData) -> Any:
    """Return the speed of every node [rad/s]."""
    return np.exp(data.speed_coordinate[:, None, None] + data.log_onset[None])


def _texts(unit: str, words: str) -> dict[str, Any]:
    return {'units': unit, 'long_name': words}


def _node_fields(data: SurfaceData) -> Variables:
    fields: Variables = {
        'log_onset': (
            NODES[1:],
            data.log_onset,
            _texts('1', 'logarithm of the onset speed in rad/s'),
        ),
        'worst_contact': (
            NODES,
            data.worst_contact.astype(np.int8),
            {
                'long_name': 'contact with the largest share at punctured film',
                'flag_values': np.arange(4, dtype=np.int8),
                'flag_meanings': ' '.join(
                    words.replace(', ', '_').replace(' ', '_') for words in WORST_CONTACTS
                ),
            },
        ),
        'mask': (
            NODES,
            data.mask.astype(np.int8),
            {
                'long_name': 'nodes that did not converge',
                'flag_values': np.arange(2, dtype=np.int8),
                'flag_meanings': 'converged not_converged',
            },
        ),
    }
    kinds = (
        ('', data.fields, ''),
        ('std_', data.deviations, ', standard deviation between strips of the raceway'),
        (
            'stderr_',
            data.standard_errors,
            ', standard error of the mean over strips of the raceway',
        ),
    )
    for prefix, group, more in kinds:
        for name, values in group.items():
            text = FIELD_TEXTS[name]
            fields[prefix + name] = (
                NODES,
                values,
                _texts(text.unit or '1', f'{text.words}{more}'),
            )
    return fields


def to_table(data: SurfaceData) -> str:
    """Return a surface as a table, a line per node, units in the names of the columns."""
    columns: dict[str, Any] = {
        'speed_rad_s': speeds(data),
        'opposing_load_N': np.broadcast_to(data.load[None, :, None], data.mask.shape),
        'temperature_K': np.broadcast_to(data.temperature, data.mask.shape),
        **{FIELD_TEXTS[name].key: values for name, values in data.fields.items()},
        **{derived_key(name, 'std'): values for name, values in data.deviations.items()},
        **{derived_key(name, 'stderr'): values for name, values in data.standard_errors.items()},
        'worst_contact': data.worst_contact,
        'converged': (~data.mask).astype(int),
    }
    out = io.StringIO()
    writer = csv.writer(out, lineterminator='\n')
    writer.writerow(columns)
    writer.writerows(zip(*(np.ravel(values).tolist() for values in columns.values())))
    return out.getvalue()
