# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Golden outputs on file: their form, what is masked in them, and how two of them are compared.

An output is a text, or a table: arrays of equal lengths by name. Texts and codes are equal or not;
numbers with a point or an exponent may differ by TOLERANCE of their amount.

"""

from itertools import zip_longest
import math
from pathlib import Path
import re
import zipfile

import numpy as np

FOLDER = Path(__file__).resolve().parents[1]
DATA, TREE = FOLDER / 'data', FOLDER.parents[1]
TOLERANCE = 1e-12  # of a number [-]
ROUNDING = 1e-18  # by which numbers near zero may differ besides
SHOWN = 8  # differences of a file
TEXT, TABLE = '.txt', '.npz'
NUMBER = re.compile(r'[-+]?(?:\d+\.\d*(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+)')
HASH = re.compile(r'(?<![\w.+])(?=[0-9a-f]*[a-f])[0-9a-f]{16,64}(?![\w.+-])')
VERSION = re.compile(r'(?<![\w.:])\d+\.\d+\.\d+(?![\w.])')
# How much is done by now is said by the clock of the wall.
PROGRESS = re.compile(r'^\d+/\d+ \w.*\n', re.M)
WRITTEN_AT = re.compile(r'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}\+00:00')
"""When an entry of the event log was written, by the clock of the wall."""


def masked(text, folder):
    """Return a text without what differs from run to run, machine to machine, or by version."""
    for path, name in ((folder, '<folder>'), (TREE, '<tree>')):
        text = text.replace(str(path), name)
    text = PROGRESS.sub('', text)
    text = WRITTEN_AT.sub('<written at>', text)
    return VERSION.sub('<version>', HASH.sub('<hash>', text))


def same_number(one, other):
    """Return True for two numbers as texts that are equal but for rounding."""
    return math.isclose(float(one), float(other), rel_tol=TOLERANCE, abs_tol=ROUNDING)


def same_line(one, other):
    """Return True if all words of two lines are equal, and their numbers but for rounding."""
    if one == other:
        return True
    if one is None or other is None or NUMBER.split(one) != NUMBER.split(other):
        return False
    return all(map(same_number, NUMBER.findall(one), NUMBER.findall(other)))


def text_differences(recorded, found):
    """Yield a sentence for each line that differs."""
    lines = zip_longest(recorded.splitlines(), found.splitlines())
    for number, (one, other) in enumerate(lines, start=1):
        if not same_line(one, other):
            yield f'line {number}:\n    recorded {one!r}\n    found    {other!r}'


def same_values(one, other):
    """Return which values of two arrays are equal, but for rounding if they are floats."""
    if one.dtype.kind == other.dtype.kind == 'f':
        close = np.isclose(other, one, rtol=TOLERANCE, atol=ROUNDING, equal_nan=True)
        return np.asarray(close, dtype=bool)
    if (one.dtype.kind == 'U') is not (other.dtype.kind == 'U'):
        return np.zeros(len(one), dtype=bool)
    return one == other


def table_differences(recorded, found):
    """Yield a sentence for each value that differs, row by row."""
    if recorded.keys() != found.keys():
        gone, new = recorded.keys() - found.keys(), found.keys() - recorded.keys()
        yield f'columns: gone {sorted(gone)}, new {sorted(new)}'
    wrong = []
    for name in recorded.keys() & found.keys():
        one, other = recorded[name], found[name]
        if len(one) != len(other):
            yield f'{name}: recorded {len(one)} rows, found {len(other)}'
        end = min(len(one), len(other))
        same = same_values(one[:end], other[:end])
        wrong += [(row, name) for row in np.flatnonzero(~same).tolist()]
    for row, name in sorted(wrong):
        one, other = recorded[name][row].item(), found[name][row].item()
        yield f'row {row}, {name}: recorded {one!r}, found {other!r}'


def differences(recorded, found):
    """Return sentences on how an output differs from the recorded one; none where it does not."""
    if recorded is None or found is None:
        return ['it is new' if recorded is None else 'it is gone']
    if isinstance(recorded, str) is not isinstance(found, str):
        return ['it is a text now' if isinstance(found, str) else 'it is a table now']
    compare = text_differences if isinstance(found, str) else table_differences
    said = list(compare(recorded, found))
    more = len(said) - SHOWN
    return said if more <= 0 else [*said[:SHOWN], f'and {more} more']


def path_of(case, name, output):
    """Return where an output of a case is on file."""
    return DATA / case / f'{name}{TEXT if isinstance(output, str) else TABLE}'


def recorded_outputs(case):
    """Return the outputs of a case that are on file, by name."""
    found = {}
    for path in sorted((DATA / case).glob('*')):
        found[path.stem] = read_table(path) if path.suffix == TABLE else path.read_text('utf-8')
    return found


def read_table(path):
    """Return a table on file."""
    with np.load(path, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def compare_all(case, found):
    """Return how the outputs of a case differ from those on file, by name."""
    recorded, said = recorded_outputs(case), {}
    for name in sorted(recorded.keys() | found.keys()):
        if how := differences(recorded.get(name), found.get(name)):
            said[name] = how
    return said


def keep(case, found):
    """Put on file what differs from it; return how it differs, by name."""
    recorded, said = recorded_outputs(case), compare_all(case, found)
    for name in said:
        if name in recorded:
            path_of(case, name, recorded[name]).unlink()
        if name in found:
            write(case, name, found[name])
    return said


def write(case, name, output):
    """Put an output of a case on file."""
    path = path_of(case, name, output)
    path.parent.mkdir(parents=True, exist_ok=True)
    if isinstance(output, str):
        path.write_text(output, 'utf-8')
    else:
        write_table(path, output)


def write_table(path, table):
    """Put a table on file; the same numbers give the same bytes."""
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, values in table.items():
            entry = zipfile.ZipInfo(f'{name}.npy')
            entry.compress_type = zipfile.ZIP_DEFLATED
            with archive.open(entry, 'w') as stream:
                np.lib.format.write_array(stream, np.asanyarray(values), allow_pickle=False)
