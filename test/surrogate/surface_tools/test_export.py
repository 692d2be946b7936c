# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A table: every number of the surface bit for bit, with names and units that others read."""

import csv
from dataclasses import replace

import numpy as np
from surrogate.surface import shipped_surface
from surrogate.surface.file import read, write
from surrogate.surface_tools.fields import FIELD_TEXTS

COMMAND = ('surface', 'export')

DATA = read(shipped_surface(tier='closed_form'))
SPREAD = np.linspace(0.0, 0.1, DATA.mask.size).reshape(DATA.mask.shape)
DRAWN = replace(
    DATA, deviations={'friction_torque': SPREAD}, standard_errors={'rcs': 0.5 * SPREAD}
)


def test_a_table_holds_every_node(run, tmp_path, capsys):
    """A line per node, units in the names, numbers that read back bit for bit."""
    write(tmp_path / 'a.npz', DRAWN)
    assert run(tmp_path / 'a.npz', '--csv', tmp_path / 'a.csv') == 0
    assert DRAWN.sha256 in capsys.readouterr().out
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
