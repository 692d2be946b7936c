# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""No input makes a command end as a fault of the program does, with exit code 70."""

import copy
import dataclasses
from pathlib import Path
import re

from ballscrew_monitor import cli
from hypothesis import example, given, settings
from hypothesis import strategies as st
import polars as pl
import pytest
from surrogate.surface.file import read, write

ROOT = Path(__file__).resolve().parents[2]
SOUND = (0, 1, 2)
"""Exit codes of commands that are no fault of the program."""
NUMBERS = (
    *('1e200', '-1e300', '1e400', '9' * 400, '1e-320', '-0.0', 'nan', 'inf', '-inf'),
    *('', ' ', 'x', 'true', '0x1F', '1,5', '1.000,5', '1e', '2020-13-45', '\x1b[2J', '"'),
)
NAMES = ('t_s', 'x_position_mm', 'x_speed_mm_s', 'x_load_N')
ROWS = [(f'{n / 100}', f'{n * n / 200}', f'{n % 7}', f'{100 + n % 5}') for n in range(60)]
MAP = """time: {column: t_s, unit: s, epoch: 2000-01-01T00:00:00Z}
axes:
  x:
    lead_mm: 10.0
    position: {column: x_position_mm, unit: mm}
    speed: {column: x_speed_mm_s, unit: mm/s}
    load: {column: x_load_N, unit: N}
    temperature_degC: 40.0
    screw: nominal
    oil: iso_vg_68
"""
PARAMS = (ROOT / 'config' / 'nominal_cycle.yaml').read_text(encoding='utf-8')
FEWER = settings(max_examples=settings.default.max_examples // 10)  # each takes long
VALUE = re.compile(r'(?<=: )[0-9.]+')
"""A number of a YAML text."""


def code_of(*arguments):
    """Return the exit code of a command."""
    return cli.main([*map(str, arguments)])


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    """Return the function that gives a new folder."""

    def make():
        return tmp_path_factory.mktemp('case')

    return make


def written(folder, rows=ROWS, mapping=MAP):
    """Return a log in a new folder and its map."""
    log, place = folder / 'log.csv', folder / 'map.yaml'
    log.write_text('\n'.join(','.join(row) for row in [NAMES, *rows]), encoding='utf-8')
    place.write_text(mapping, encoding='utf-8')
    return log, place


@FEWER
@given(
    changes=st.lists(
        st.tuples(
            st.integers(0, len(ROWS) - 1), st.integers(0, len(NAMES) - 1), st.sampled_from(NUMBERS)
        ),
        min_size=1,
        max_size=5,
    )
)
@example(changes=[(7, 1, '1e200')])
@example(changes=[(7, 1, '9' * 400), (8, 2, '9' * 400)])
@example(changes=[(0, 0, '1e300')])
@example(changes=[(0, 0, '-1e300'), (0, 2, '1e200')])
def test_no_cell_of_a_log_is_a_fault_of_the_program(folder, changes):
    rows = [list(row) for row in ROWS]
    for row, column, text in changes:
        rows[row][column] = text
    log, mapping = written(folder(), rows)
    assert code_of('import', log, '--guess') in SOUND
    assert code_of('replay', log, '--map', mapping) in SOUND


@pytest.mark.parametrize('kind', ['map', 'parameters'])
@FEWER
@given(place=st.floats(0.0, 1.0, exclude_max=True), text=st.sampled_from(NUMBERS))
@example(place=0.0, text='9' * 400)
def test_no_number_of_a_map_or_of_parameters_is_a_fault_of_the_program(folder, kind, place, text):
    whole = MAP if kind == 'map' else PARAMS
    places = [match.span() for match in VALUE.finditer(whole)]
    begin, end = places[int(place * len(places))]
    changed = whole[:begin] + text + whole[end:]
    log, mapping = written(folder(), mapping=changed if kind == 'map' else MAP)
    command = ['replay', log, '--map', mapping]
    if kind == 'parameters':
        command = ['replay', ROOT / 'bags' / 'nominal_cycle', '--params', log.with_name('p.yaml')]
        command[-1].write_text(changed, encoding='utf-8')
    assert code_of(*command) in SOUND


LIST, STRUCT = pl.List, lambda kind: pl.Struct({'a': kind})


@pytest.mark.parametrize(
    ('nest', 'depth'), [(LIST, 1), (LIST, 100), (LIST, 500), (STRUCT, 1), (STRUCT, 100)]
)
def test_nested_columns_of_a_parquet_file_are_no_fault_of_the_program(
    tmp_path, capsys, nest, depth
):
    kind = pl.Float64
    for _ in range(depth):
        kind = nest(kind)
    path = tmp_path / 'log.parquet'
    columns = {'t_s': [0.1, 0.2], 'x_speed_mm_s': pl.Series([None, None], dtype=kind)}
    pl.DataFrame(columns).write_parquet(path)
    assert code_of('import', path, '--guess') == 2
    assert capsys.readouterr().err.count('ballscrew: ') == 1


def places_of(header, above=()):
    """Yield the keys that lead to each value of a header."""
    for key, value in header.items():
        yield (*above, key)
        if isinstance(value, dict):
            yield from places_of(value, (*above, key))


@pytest.mark.parametrize('value', [..., None], ids=repr)
def test_no_value_of_a_surface_is_a_fault_of_the_program(tmp_path, capsys, value):
    """Each value of its header is left out or another one, and the file verifies."""
    data, path = read(ROOT / 'test' / 'data' / 'golden_surface.npz'), tmp_path / 'surface.npz'
    for place in places_of(data.header):
        header = copy.deepcopy(data.header)
        part = header
        for key in place[:-1]:
            part = part[key]
        if value is ...:
            del part[place[-1]]
        else:
            part[place[-1]] = value
        write(path, dataclasses.replace(data, header=header))
        assert code_of('surface', 'info', path) in SOUND, (place, capsys.readouterr().err)
