# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tables with a value a line, as historians write them: a time, the name of a signal and its value.

They become a frame of texts with a column for each signal: lines of one time are one row, and a
cell is empty where a signal has no sample.

"""

from collections.abc import Iterable, Sequence
import csv
import dataclasses
import io
from pathlib import Path
import re
import statistics

from ballscrew_monitor.recordings.tables.apart import check_room
from ballscrew_monitor.recordings.tables.cells import Unreadable
from ballscrew_monitor.recordings.tables.codings import text_of
from ballscrew_monitor.recordings.tables.heads import NO_NUMBER, NUMBER, TIME, unlike
from ballscrew_monitor.recordings.tables.lines import whole_times
from ballscrew_monitor.recordings.tables.marks import STATUS, valid_cells
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.unit_names import BRACKETS, is_unit, words_of
from ballscrew_monitor.recordings.words import listed, short
import polars as pl
from surrogate.files import limits

COMMENT = '#'
SEPARATORS = (';', '\t', '|', ',')
WIDEST = 12  # columns of a table with a value a line
LOOKED_AT = 200  # of the first lines
FEWEST = 4  # lines that show what a text is
MOSTLY = 0.9  # of the lines
MOST_PARTS = 64  # that one word tells apart, such as axes
OWN = '\t'  # before names of columns that no signal has
REPEATED = 2  # lines that a name of a signal has, at least, on average
ROLES = {
    'name': frozenset(
        'name tag tagname signal signalname variable variablename varname channel channelname '
        'point pointname sensor item field dataitem dataitemid parameter metric topic kanal '
        'messstelle bezeichnung variablenname itemname'.split()
    ),
    'value': frozenset('value varvalue val wert messwert istwert datavalue'.split()),
    'unit': frozenset('unit units einheit uom engunits engineeringunits'.split()),
    'quality': frozenset(
        'quality status validity valid state qualität qualitaet statuscode qualitycode opcquality '
        'opcstatus opcuastatus isgood isbad ok'.split()
    ),
}
"""Words over the columns of a table with a value a line, without blanks and signs."""
TIMES = re.compile('time|zeit|date|datum|stamp', re.I)
AXIS = re.compile('axis|achse|joint|gelenk', re.I)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LongForm:
    """
    Where a table with a value a line holds what.

    `names` stand above its columns, empty without any; `first` is the first line of values;
    `times` are the columns of a time and their names; `more` may tell signals of one name apart,
    such as an axis; `unit` and `quality` are -1 without such a column.

    """

    separator: str
    names: Sequence[str]
    first: int
    name: int
    value: int
    times: dict[int, str]
    more: tuple[int, ...]
    unit: int = -1
    quality: int = -1

    @property
    def has_names(self) -> bool:
        """Return True if a line names its columns."""
        return any(self.names)


def first_lines(head: bytes) -> list[str]:
    """Return the whole lines of a text that begins so."""
    lines = text_of(head).splitlines()
    return whole_times(lines if head.endswith((b'\n', b'\r')) else lines[:-1] or lines)


def read_long(path: Path) -> tuple[pl.DataFrame, str]:
    """
    Return the signals of a table with a value a line, and what separates its cells.

    Lines of one time are one row, in the order in which the times first occur. Raises ValueError.

    """
    lines = whole_times(text_of(path.read_bytes()).splitlines())
    form = long_form(lines)
    if form is None:
        raise Unreadable('its first lines hold a name and a value each, all of them do not')
    first = form.first
    cells = _columns(lines[first:], form)
    times = [pl.col(f'{place}').alias(f'{OWN}time {place}') for place in form.times]
    names = cells[f'{form.name}']
    for place in form.more:  # what tells signals of one name apart
        pair = pl.DataFrame({'name': names, 'more': cells[f'{place}']})
        if AXIS.search(form.names[place]) or pair.unique().height > names.n_unique():
            names = pair.select(pl.concat_str('more', 'name', separator=' '))['more']
    rows = cells.select(*times, name=names, value=_values(cells, form))
    if form.unit >= 0:
        rows = rows.with_columns(name=_with_units(rows['name'], cells[f'{form.unit}']))
    heads = ['', form.names[form.name]]  # which stand above each part of an export
    rows = rows.filter(~cells[f'{form.name}'].fill_null('').is_in(heads))
    if rows['name'].n_unique() > limits.COLUMNS:
        raise Unreadable(f'it names more than {limits.COLUMNS} signals')
    of_time, turn = [f'{OWN}time {place}' for place in form.times], f'{OWN}turn'
    rows = rows.with_columns(pl.int_range(pl.len()).over([*of_time, 'name']).alias(turn))
    height = rows.select(pl.struct(*of_time, turn).n_unique()).item()
    check_room(height, len(of_time) + rows['name'].n_unique(), limits.TEXT_CELL)
    wide = rows.pivot(on='name', index=[*of_time, turn], values='value', maintain_order=True)
    signals = [name for name in wide.columns if name not in (*of_time, turn)]
    wide = wide.select(*of_time, *signals)
    wide.columns = list(unlike([*form.times.values(), *signals]))
    return wide, form.separator


def long_form(lines: Sequence[str]) -> LongForm | None:
    """Return how the lines of a text hold a value each, None where they do not."""
    first = lines[:LOOKED_AT]
    if sum(map(bool, map(str.strip, first))) < FEWEST:
        return None
    forms = (_form(first, separator) for separator in SEPARATORS)
    return next((form for form in forms if form is not None), None)


def _form(lines: Sequence[str], separator: str) -> LongForm | None:
    rows = [_cells(line, separator) for line in lines]
    width = statistics.mode(map(len, filter(None, rows)))
    if not 3 <= width <= WIDEST:
        return None
    wide = [at for at, row in enumerate(rows) if len(row) == width]
    names_it = (at for at in wide[:FEWEST] if {'name', 'value'} <= set(_roles(rows[at])))
    first = next(names_it, wide[0])  # a remark above it may be as wide
    roles = _roles(rows[first])
    header = 'name' in roles and 'value' in roles
    if header:
        wide = [at for at in wide if at > first]
    begin = wide[0] if wide else len(rows)
    if len(wide) < FEWEST or len(wide) < MOSTLY * sum(map(bool, rows[begin:])):
        return None
    columns = list(zip(*(rows[at] for at in wide), strict=True))
    if not header:
        roles = _roles_by_cells(columns)
    if not {'name', 'value'} <= set(roles):
        return None
    signals = columns[roles['name']]  # several, each of them again and again
    different = set(signals) - {''}
    if not different or len(different) * REPEATED > len(signals) or any(map(is_number, signals)):
        return None
    names = rows[first] if header else [''] * width
    for at, cells in enumerate(columns):
        if all(map(STATUS.fullmatch, cells)):
            roles.setdefault('quality', at)
    times = _times(columns, names, set(roles.values()))
    if not times:
        return None
    taken = {*roles.values(), *times}
    more = [at for at in range(width) if at not in taken and len(set(columns[at])) <= MOST_PARTS]
    more.sort(key=lambda at: _share(map(is_number, columns[at])))
    return LongForm(
        separator=separator,
        more=tuple(more),
        names=names,
        first=wide[0],
        name=roles['name'],
        value=roles['value'],
        times=times,
        unit=roles.get('unit', -1),
        quality=roles.get('quality', -1),
    )


def _cells(line: str, separator: str) -> list[str]:
    if not line.strip() or line.startswith(COMMENT):
        return []
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]


def _roles(row: Sequence[str]) -> dict[str, int]:
    """Return the column of each role by the words of a row; an `id` is a name without another."""
    roles: dict[str, int] = {}
    words = [re.sub(r'[\W\d_]+', '', BRACKETS.sub('', cell).lower()) for cell in row]
    for at, plain in enumerate(words):
        role = next((role for role, words in ROLES.items() if plain in words), '')
        if role:
            roles.setdefault(role, at)
    if 'name' not in roles and 'id' in words:
        roles['name'] = words.index('id')
    return roles


def _roles_by_cells(columns: Sequence[Sequence[str]]) -> dict[str, int]:
    """Return the column of names and that of values, where cells alone show which these are."""
    texts = [at for at, cells in enumerate(columns) if not _share(map(is_number, cells))]
    units = [at for at in texts if all(is_unit(cell) for cell in columns[at] if cell.strip('-'))]
    names = [at for at in texts if at not in units and not _share(map(_is_time, columns[at]))]
    numbers = [
        at
        for at, cells in enumerate(columns)
        if at not in texts and _share(map(is_number, cells)) >= MOSTLY
    ]
    if any(_share(map(_is_time, cells)) >= MOSTLY for cells in columns) or len(numbers) < 2:
        values = [at for at in numbers if not _share(map(_is_time, columns[at]))]
    else:  # of a time and a value the time rises
        values = [at for at in numbers if not _rises(columns[at])]
    if len(names) != 1 or len(values) != 1:
        return {}
    known = {read_name(name).kind for name in set(columns[names[0]])} - {'', 'time'}
    if not known:
        return {}
    return {'name': names[0], 'value': values[0]} | ({'unit': units[0]} if units else {})


def _times(
    columns: Sequence[Sequence[str]], names: Sequence[str], others: set[int]
) -> dict[int, str]:
    """Return the columns of a time, each with its name."""
    times = {
        at: name
        for at, name in enumerate(names)
        if at not in others and TIMES.search(name) and read_name(name).kind in ('time', '')
    }
    if times:
        return times
    left = [at for at in range(len(columns)) if at not in others]
    dated = [at for at in left if _share(map(_is_time, columns[at])) >= MOSTLY]
    numbers = [at for at in left if _share(map(is_number, columns[at])) == 1.0]
    chosen = dated or [at for at in numbers if _rises(columns[at])][:1]
    if len(chosen) == 1:
        return {chosen[0]: names[chosen[0]] or 'time'}
    return {at: names[at] or f'time {number + 1}' for number, at in enumerate(chosen)}


def _share(flags: Iterable[bool]) -> float:
    return statistics.fmean(flags)


def is_number(cell: str) -> bool:
    """Return True if a cell is a number, or a word for one that is not known."""
    known = any(letter.isdigit() for letter in cell) and bool(NUMBER.fullmatch(cell))
    return known or cell.lower() in NO_NUMBER - {'-', '--'}


def _is_time(cell: str) -> bool:
    return bool(TIME.fullmatch(cell)) and not NUMBER.fullmatch(cell)


def _rises(cells: Sequence[str]) -> bool:
    """Return True if numbers fall almost nowhere, and are not all the same."""
    try:
        numbers = [float(cell.replace(',', '.')) for cell in cells if cell]
    except ValueError:
        return False
    rising = [later >= one for one, later in zip(numbers, numbers[1:])]
    return bool(rising) and len(set(numbers)) > 1 and statistics.fmean(rising) >= MOSTLY


def _columns(lines: Sequence[str], form: LongForm) -> pl.DataFrame:
    """Return the cells of lines as texts, columns by their numbers."""
    text = '\n'.join(line for line in lines if line.strip() and not line.startswith(COMMENT))
    frame = pl.read_csv(
        io.BytesIO(text.encode()),
        separator=form.separator,
        has_header=False,
        new_columns=[str(at) for at in range(len(form.names))],
        infer_schema=False,
        truncate_ragged_lines=True,
    )
    return frame.with_columns(pl.all().str.strip_chars())


def _values(cells: pl.DataFrame, form: LongForm) -> pl.Expr:
    """Return the values; one of bad quality is not known."""
    value = pl.col(f'{form.value}')
    if form.quality < 0:
        return value
    name, held = form.names[form.quality], cells[f'{form.quality}'].drop_nulls().unique().to_list()
    valid = valid_cells(words_of(name), held)
    if valid is None:
        raise Unreadable(
            f'column {short(repr(name))} holds {listed(sorted(held))}, of which nothing tells '
            'when a value is valid: write Good and Bad in it, or take it out if all are'
        )
    bad = [cell for cell in held if cell and cell not in valid] if valid else []
    quality = pl.col(f'{form.quality}')
    return pl.when(quality.is_in(bad)).then(pl.lit('nan')).otherwise(value)


def _with_units(names: pl.Series, units: pl.Series) -> pl.Series:
    """Return names of signals with their units; raises ValueError for one with several."""
    pairs = pl.DataFrame({'name': names, 'unit': units.fill_null('')}).unique(maintain_order=True)
    called: dict[str, str] = {}
    for name, unit in pairs.drop_nulls('name').iter_rows():
        if name in called and unit != called[name]:
            raise Unreadable(
                f'signal {short(repr(name))} is in {called[name] or "no unit"} and in '
                f'{unit or "no unit"}: one of them must go'
            )
        called[name] = unit
    renamed = {
        name: name
        if BRACKETS.search(name) or not is_unit(unit)
        else f'{name} [{unit.strip("[]()")}]'
        for name, unit in called.items()
    }
    return names.replace(renamed)
