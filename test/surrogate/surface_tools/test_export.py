# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Exports: every number of the surface bit for bit, with names and units that others read."""

import csv
from dataclasses import replace
import json
import math

import numpy as np
import pytest
from surrogate.surface import FIELDS, shipped_surface
from surrogate.surface.file import read, write
from surrogate.surface_tools.fields import FIELD_TEXTS

COMMAND = ('surface', 'export')

DATA = read(shipped_surface(tier='closed_form'))
SPREAD = np.linspace(0.0, 0.1, DATA.mask.size).reshape(DATA.mask.shape)
DRAWN = replace(
    DATA, deviations={'friction_torque': SPREAD}, standard_errors={'rcs': 0.5 * SPREAD}
)


def test_netcdf_holds_everything(run, tmp_path, capsys):
    """Fields, errors, spreads, axes and speeds; CF units; header and hash in the attributes."""
    xarray = pytest.importorskip('xarray')
    write(tmp_path / 'a.npz', DRAWN)
    assert run(tmp_path / 'a.npz', '--netcdf', tmp_path / 'a.nc') == 0
    assert DRAWN.sha256 in capsys.readouterr().out
    with xarray.open_dataset(tmp_path / 'a.nc', engine='scipy') as found:
        for name in FIELDS:
            assert found[name].dims == ('speed_coordinate', 'load', 'temperature')
            assert np.array_equal(found[name], DATA.fields[name])
            assert found[name].attrs['units'] == (FIELD_TEXTS[name].unit or '1')
            assert found[name].attrs['long_name']
            assert np.array_equal(found[f'error_{name}'], DATA.errors[name], equal_nan=True)
        assert np.array_equal(found['std_friction_torque'], SPREAD)
        assert found['std_friction_torque'].attrs['units'] == 'N m'
        assert np.array_equal(found['stderr_rcs'], 0.5 * SPREAD)
        assert np.array_equal(found['load'], DATA.load)
        assert np.array_equal(found['log_onset'], DATA.log_onset)
        assert np.array_equal(found['worst_contact'], DATA.worst_contact)
        speed = found['rcs'].coords['speed']
        assert speed.attrs['units'] == 'rad s-1'
        assert float(speed[3, 4, 5]) == math.exp(DATA.speed_coordinate[3] + DATA.log_onset[4, 5])
        assert found.attrs['Conventions'] == 'CF-1.11'
        assert found.attrs['sha256'] == DRAWN.sha256
        assert json.loads(found.attrs['header']) == json.loads(json.dumps(DRAWN.header))


def test_a_table_holds_every_node(run, tmp_path):
    """A line per node, units in the names, numbers that read back bit for bit."""
    write(tmp_path / 'a.npz', DRAWN)
    assert run(tmp_path / 'a.npz', '--csv', tmp_path / 'a.csv') == 0
    with (tmp_path / 'a.csv').open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == DATA.mask.size
    for name, text in FIELD_TEXTS.items():
        column = np.reshape([float(row[text.key]) for row in rows], DATA.mask.shape)
        assert np.array_equal(column, DATA.fields[name])
    loads = np.reshape([float(row['opposing_load_N']) for row in rows], DATA.mask.shape)
    assert np.array_equal(loads[0, :, 0], DATA.load)
    spread = np.reshape([float(row['friction_torque_std_Nm']) for row in rows], DATA.mask.shape)
    assert np.array_equal(spread, SPREAD)
    assert {row['converged'] for row in rows} == {'1'}


def test_what_cannot_be_written_is_one_sentence(run, tmp_path, refused):
    refused('cannot_written_regular', run, '--csv', tmp_path)
