# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Rows at a rate that a map states, and what the table itself says of their times beside it.

A rate closes up the gap that lost samples leave. It puts values into one row that have times of
their own. Columns that count samples and columns of times show both.

"""

from collections.abc import Collection, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import itertools
import math

from ballscrew_monitor.recordings.tables.cells import Array, Cells, empties
from ballscrew_monitor.recordings.tables.estimates import NEAR, usual_step
from ballscrew_monitor.recordings.tables.heads import are_names_again, Head, USUAL
from ballscrew_monitor.recordings.tables.mapping import TableMap
from ballscrew_monitor.recordings.tables.names import base_of, read_name
from ballscrew_monitor.recordings.tables.read import Table
from ballscrew_monitor.recordings.tables.sources import Source
from ballscrew_monitor.recordings.words import short
import numpy as np
import polars as pl
from surrogate.files import InputError

MOSTLY = 0.9  # of the steps of a counter are 1
INSTEAD = 'in the map instead of `rate_Hz`'


def first_numbers(source: Source, names: Collection[str]) -> dict[str, Array]:
    """Return the numbers in the first rows of those columns that hold some."""
    cells = source.first_rows() if names else pl.DataFrame()
    found = {}
    for name in names:
        column = Cells(source.path, name, first_row=source.head.first)
        with contextlib.suppress(InputError):
            column.add(cells[name])
            found[name] = column.reading().numbers(cells[name])
    return found


def twin_times(source: Source) -> dict[str, Array]:
    """Return columns of one name that rise evenly, as the times of several groups do."""
    names = source.names()
    bases = [base_of(name) for name in names]
    twins = [
        name
        for name, base in zip(names, bases, strict=True)
        if bases.count(base) > 1 and read_name(name).kind in ('', 'time')
    ]
    found = {name: one for name, one in first_numbers(source, twins).items() if _is_even(one)}
    held = [base_of(name) for name in found]
    return {name: one for name, one in found.items() if held.count(base_of(name)) > 1}


def _is_even(values: Array) -> bool:
    """Return True if the known numbers of a column rise evenly."""
    steps, usual = np.diff(values[np.isfinite(values)]), usual_step(values)
    least, most = (part * usual for part in USUAL)
    return usual > 0.0 and bool(((steps >= least) & (steps <= most)).all())


def rates_of_head(source: Source, columns: Collection[str]) -> tuple[float, ...]:
    """
    Return the rates of rows [Hz] that the period of a head may mean, none without one.

    It is that of the rows. Where each signal stands on rows of its own, it may be that of the
    signals as well.

    """
    if not math.isfinite(source.head.period):
        return ()
    cells = source.first_rows()
    apart = [np.diff(np.flatnonzero(~empties(cells[name]))) for name in columns]
    rows = min((float(np.median(steps)) for steps in apart if len(steps)), default=1.0)
    return tuple(dict.fromkeys((1.0 / source.head.period, rows / source.head.period)))


def two_rates(rates: Sequence[float]) -> str:
    """Return in words which of two rates of rows [Hz] a period may mean, empty for one."""
    if len(rates) < 2:
        return ''
    return (
        f'state time.rate_Hz in the map: {rates[0]:.6g} if the period of {1.0 / rates[0]:.4g} s '
        f'that the head states is that of the rows, {rates[1]:.6g} if it is that of each signal, '
        f'whose values are {rates[1] / rates[0]:.3g} rows apart'
    )


def doubts_of_rate(rate: float, inputs: Mapping[str, str], table: Table) -> Iterator[str]:
    """
    Yield why the rows of a table are not at the equal distances of a rate [Hz].

    `inputs` are the columns that are read, by their places in the map.

    """
    source = table.source
    rates = rates_of_head(source, {*inputs.values()})
    if rates and all(abs(rate / one - 1.0) > NEAR for one in rates):
        yield (
            f'its head states a period of {source.head.period:.4g} s, and time.rate_Hz of the map '
            f'is {rate:.6g}: state time.rate_Hz: {" or ".join(f"{one:.6g}" for one in rates)}, or '
            '`skip`, the lines before the names, by which the head is not read'
        )
    torn, used = dataclasses.replace(source.short), {*inputs.values()}
    others = first_numbers(source, [name for name in source.names() if name not in used])
    counter = next((name for name, values in others.items() if _counts_samples(values)), '')
    place = f'`time: {{column: {counter}, unit: s, scale: {1.0 / rate:.9g}}}` {INSTEAD}'
    if counter and (jump := _jump(source, counter)):
        row, before, after = jump
        yield (
            f'column {short(repr(counter))} counts the samples, and goes from {before:.12g} to '
            f'{after:.12g} in row {row}, which rows at equal distances close up: state {place}'
        )
    cure = f'name a time as `column` {INSTEAD}, or split the log there'
    cure = f'state {place}' if counter else cure
    last = table.first_row + table.rows - 1 - torn.blanks * (torn.blank > torn.first)
    odd = [
        (torn.named or _named_again(table), 1, 'names the columns again'),
        (torn.blank, torn.blanks, 'is blank'),
    ]
    if 0 < torn.cells < len(source.head.names):
        held = f'holds {torn.cells} of {len(source.head.names)} cells'
        odd.insert(0, (torn.first, torn.count, held))
    for row, count, words in odd:
        if row and row + count - 1 < last:
            yield (
                f'row {row} {words}, and rows follow it: samples may be missing there, which rows '
                f'at equal distances close up: {cure}'
            )
    yield from _of_twins(inputs, source)


def _named_again(table: Table) -> int:
    """Return the first row that names the columns again as the head does, 0 for none."""
    row = table.first_row
    names = [name for name, reading in table.readings.items() if reading.note]
    for block in table.source.blocks(names) if names else ():
        if all(kind == pl.String for kind in block.dtypes):
            are_words = pl.all_horizontal(pl.all().str.contains(r'\p{L}'))
            for at in block.select(are_words.fill_null(False).arg_true()).to_series():
                if are_names_again(block.row(at), names):
                    return row + int(at)
        row += block.height
    return 0


def _counts_samples(values: Array) -> bool:
    """Return True if values are whole numbers of which most are the next after the one before."""
    steps = np.diff(values[np.isfinite(values)])
    whole = bool((values[np.isfinite(values)] % 1.0 == 0.0).all())
    return whole and len(steps) > 1 and float(np.mean(steps == 1.0)) >= MOSTLY


def _jump(source: Source, counter: str) -> tuple[int, float, float] | None:
    """
    Return the first row in which a counter is not the next number, with that before and it.

    A counter goes on that begins again at its least number behind its largest one, if these are
    of a power of two or if it does so several times.

    """
    row, last, least, most = source.head.first, math.nan, math.inf, -math.inf
    jumps: dict[tuple[float, float], list[int]] = {}
    for block in source.blocks([counter]):
        if block[counter].dtype.is_temporal():
            return None  # times of whole seconds
        cells = block[counter].cast(pl.Float64, strict=False).to_numpy()
        places = np.flatnonzero(np.isfinite(cells))
        values = np.append(last, cells[places])
        least = float(np.nanmin(values, initial=least))
        most = float(np.nanmax(values, initial=most))
        for at in np.flatnonzero(np.abs(np.diff(values) - 1.0) > 0.0):
            pair = float(values[at]), float(values[at + 1])
            jumps.setdefault(pair, []).append(row + int(places[at]))
        if len(jumps) > 1:
            break
        row, last = row + len(cells), float(values[-1])
    rows = jumps.get((most, least), [])
    if len(rows) > 1 or (rows and math.log2(most - least + 1.0).is_integer()):
        del jumps[most, least]
    return next(((rows[0], *pair) for pair, rows in jumps.items()), None)


def _of_twins(inputs: Mapping[str, str], source: Source) -> Iterator[str]:
    """Yield what is wrong if inputs stand behind different times of one name."""
    twins, names = twin_times(source), source.names()
    held: dict[str, str] = {}
    for key, column in inputs.items():
        before = [name for name in names[: names.index(column)] if name in twins]
        if before:
            held.setdefault(before[-1], key)
    for name, other in itertools.pairwise(held):
        first, later = twins[name], twins[other]
        if base_of(name) == base_of(other) and not np.array_equal(first, later, equal_nan=True):
            yield (
                f'columns {short(repr(name))} and {short(repr(other))} rise evenly, as times of '
                f'two groups do, and begin with {first[0]:.12g} and {later[0]:.12g}, while rows '
                f'at equal distances have one time: state `time: {{column: {name}, unit: ...}}` '
                f'{INSTEAD}, and `time: {other}` below {held[other]}'
            )


def other_period(head: Head, mapping: TableMap, period: float) -> str:
    """Return in a sentence how times by a map differ from the period [s] of a head, if so."""
    if mapping.time is None or not abs(period / head.period - 1.0) > NEAR:
        return ''
    return (
        f'the head states a period of {head.period:.4g} s, the rows are {period:.4g} s apart by '
        'time.column of the map, which decides'
    )
