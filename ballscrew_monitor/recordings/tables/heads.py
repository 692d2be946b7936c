# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Heads of tables: the block of numbers is found first, and what stands above it is its properties.

The block is the longest run of rows whose cells are numbers and times in the same columns. Above
it, rows as wide as the block say something of each column, and narrow ones of the file.

"""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
import dataclasses
import functools
import itertools
import math
import re
from typing import Any

from ballscrew_monitor.recordings.tables.cell_units import is_amount
from ballscrew_monitor.recordings.tables.layouts import (
    COLUMN,
    Format,
    format_of,
    LONGEST_PERIOD,
    MACHINE,
    MAY_BE_PERIOD,
    OTHER_PERIOD,
    OTHER_ROWS,
    period_of,
    property_of,
    REMARK,
    STARTS,
    unit_of_period,
)
from ballscrew_monitor.recordings.tables.lines import BLANKS, cells_of_line, Line, separators_of
from ballscrew_monitor.recordings.tables.names import base_of, read_name
from ballscrew_monitor.recordings.tables.numerals import plain_numeral
from ballscrew_monitor.recordings.tables.quantities import column_name, Layout
from ballscrew_monitor.recordings.tables.sections import END_OF_HEAD
from ballscrew_monitor.recordings.tables.unit_names import (
    BRACKETS,
    is_unit,
    unit_and_scale,
    unit_of,
)
from ballscrew_monitor.recordings.words import short

KEY_AND_VALUE = re.compile(r'\W*([^:=]{2,40}?)\s*[:=]\s*(\S.*?)\s*')
CHANNEL = re.compile(r'CH\s?\d+', re.I)
COMMENTS = ('#', '%', '//')
COMMENT = '#'
NUMBER = re.compile(
    r"(?:[-+\u2212\u2013] *)?(?:\d+|[1-9]\d{0,2}(?:[ '’\xa0\u202f]\d{3})+)?(?:[.,]\d+)*[.,]?"
    r'(?:[eE][-+]?\d+)?\s*%?'
)
TIME = re.compile(
    r'(?:\w{2,9}\.?,? )?(?=.*\d)(?:\d{1,4}[-./ ](?:\d{1,2}|\w{3,9}\.?)[-./ ]\d{1,4}|\w{3,9}\.? '
    r'\d{1,2},? \d{4}|\d{8}(?=T))?,?[ T_-]?(?:\d{1,2}:\d{2}(?::\d{2}(?:[.,:;]\d+)?|\.\d+)?)?'
    r'(?: ?[AaPp]\.?[Mm]\.?)?(?: ?(?:Z|UTC|GMT|[-+]\d{2}:?\d{2}))?'
)
"""A date, a time of day or both."""
NO_NUMBER = frozenset(
    {'nan', 'n/a', 'na', 'null', 'none', 'inf', '-inf', '-nan', '#n/a', '--', '-'}
)
"""Cells that stand for a number that is not known."""
OF_SPREADSHEET = re.compile(r'#(?:[^\W\d_]+/?\d?[!?]|NV|N/V)', re.I)
"""What a spreadsheet writes for the result of a wrong formula."""
BARE_FACTOR = re.compile(r'10*(?:[.,]0+)?|0?[.,]0*1|1(?:[.,]0+)?e[-+]?\d+', re.I)
"""A factor of a time, where a row of factors says no more."""
USUAL = 0.5, 2.0  # times the usual step, within which a time goes on
LONGEST_GAP = 100.0  # times the usual step, after the first time of a table
_FACTOR = (
    r'(scale|scaling|factor|gain|offset|faktor|skalierung|multiplier|resolution|slope|sensitivity|'
    r'calibration|conversion|lsb|decimals|exponent|kalibrierung|umrechnung|auflösung|wertigkeit|'
    r'empfindlichkeit|(?:scaling|polynomial) coefficient)s?'
)
FACTOR, FACTOR_WITHIN = re.compile(rf'{_FACTOR}\W*$'), re.compile(rf'\b{_FACTOR}\b')
"""Words of what scales or shifts the cells, at the end of a label and anywhere in it."""
TIMES = re.compile(r'\b(?:values?|raw) ?[x×*/] ?\d', re.I)
"""A factor that a sentence states."""
COUNTED = re.compile(
    r'min|max|mean|avg|average|std|rms|sum|count|samples|mittel|anzahl|x0|delta|start|end|'
    r'length|size|länge|tara|^t0$',
    re.I,
)
"""Labels of rows of numbers that do not scale the cells."""
MOSTLY = 0.8
SURE = 0.7  # weight of blanks, which stand in texts and dates as well
FULL = 0.5  # of the cells of the fullest row: emptier ones belong to no table
TORN = 0.02  # of the rows of numbers, at most, that hold more cells than the others
FOLLOWING = 12  # rows that show whether a block begins
UNNAMED = 'column {}'
NO_NAME = re.compile(r'column \d+|Unnamed: \d+')
"""Names that are given to columns without one, here and by pandas."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Property:
    """
    What a head says, and the row in which it does so.

    What it says of the machine has a value in the unit of a map, NaN where it is unclear.

    """

    text: str
    row: int
    value: float = math.nan
    label: str = ''


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Head:
    """
    Names of the columns, how the cells are parted, and what stands above the first of them.

    The first cells are the line `begin` of those that were looked at, in the row `first` of the
    file. `symbols` are longer names, or the short ones where these repeat, `periods` [s] those
    that columns state, NaN for none; `labelled` are the columns that the head gives no name of
    their own; without `named` it names none. `properties` are those of the file by their words,
    `dates` those that may say when it begins, `factors` a row that scales cells, `unclear_period`
    a line with a period that may be one of something else than rows, `machine` what is said of the
    machine, by the keys of `MACHINE`.

    """

    names: tuple[str, ...]
    separator: str
    begin: int
    first: int
    symbols: Mapping[str, str] = dataclasses.field(default_factory=dict)
    periods: Mapping[str, float] = dataclasses.field(default_factory=dict)
    labelled: frozenset[str] = frozenset()
    named: bool = True
    program: Format | None = None
    properties: Mapping[str, Property] = dataclasses.field(default_factory=dict)
    dates: tuple[Property, ...] = ()
    period: float = math.nan
    period_row: int = 0
    unclear_period: str = ''
    machine: Mapping[str, Property] = dataclasses.field(default_factory=dict)
    factors: str = ''

    def renamed(self, names: Mapping[str, str]) -> 'Head':
        """Return it with other names of some columns."""

        def of_new(held: Mapping[str, Any]) -> dict[str, Any]:
            return {names.get(name, name): value for name, value in held.items()}

        return dataclasses.replace(
            self,
            names=tuple(names.get(name, name) for name in self.names),
            symbols=of_new(self.symbols),
            periods=of_new(self.periods),
            labelled=frozenset(names.get(name, name) for name in self.labelled),
        )

    def surplus(self, row: int, cells: int) -> str:
        """Return what is wrong with a row of more cells than there are columns."""
        return _surplus(row, cells, len(self.names), self.separator)


def factor_word(label: str, names: Iterable[str] = ()) -> str:
    """
    Return the word of a label for what scales or shifts the cells, empty for any other label.

    It ends the label, or stands in one that names a quantity or one of the columns as well.

    """
    text, columns = label.lower(), {BRACKETS.sub('', name).strip().lower() for name in names}
    match = FACTOR.search(text)
    if match is None and (within := FACTOR_WITHIN.search(text)):
        named = any(re.search(rf'(?<!\w){re.escape(one)}(?!\w)', text) for one in columns - {''})
        match = within if named or read_name(label).kind else None
    return match[1] if match else ''


def are_other_names(
    cells: Sequence[str], names: Sequence[str], *, is_remark: bool = False
) -> bool:
    """
    Return True if cells of columns are names or units, and others than those of the head.

    Words of which no two are alike, and none says that a number is missing, are names as well,
    unless they are those of a remark.

    """
    words = [cell.strip(f'{COMMENT} []()') for cell in cells]
    texts = [word for word in words if word and not word[0].isdigit()]
    plain = {word.lower() for word in texts}
    are_names = len(plain) == len(texts) > 1 and not plain & NO_NUMBER
    are_known = (are_names and not is_remark) or any(
        is_unit(one) or read_name(one).kind for one in texts
    )
    return len(texts) == len(words) and are_known and not are_names_again(cells, names)


def are_names_again(cells: Sequence[str], names: Sequence[str]) -> bool:
    """Return True if cells of columns are the names or the units of the head."""
    words = [cell.strip(f'{COMMENT} []()') for cell in cells]
    plain = [base_of(name) for name in names]
    known = [
        {name.strip(' []()'), BRACKETS.sub('', name).strip(), *BRACKETS.findall(name)}
        for name in plain
    ]
    return all(one in held for one, held in zip(words, known, strict=True))


def _surplus(row: int, cells: int, names: int, separator: str) -> str:
    held = f'row {row} holds {cells} cells, its columns have {names} names'
    if separator == ',' and cells == 2 * names:
        return f'{held}, as where commas are decimal signs too: save it with semicolons between'
    twice = separator == ',' and cells < 2 * names
    comma = 'if the decimal sign is a comma, save the table with semicolons between its cells, '
    either = f'{comma}else ' if twice else ''
    return f'{held}: {either}name each column, or take surplus cells out'


def find_head(lines: Sequence[Line], layout: Layout | None = None) -> Head:
    """
    Return the head of a table by its first lines, or as a map states it.

    Raises ValueError where no line can be that of a table.

    """
    blocks = {sign: _Block(lines, sign) for sign in separators_of(lines)}
    if layout is not None:
        return _stated_head(lines, layout, blocks)
    block = max(blocks.values(), key=lambda one: (one.score, max(map(len, one.rows))))
    if not block.score:
        return _stated_head(lines, Layout(), blocks)
    return _Above(lines[: block.begin], block).head(lines[block.begin].row)


def cells_of(lines: Sequence[Line], head: Head) -> dict[str, list[str]]:
    """Return the cells of the columns of a table in its first lines."""
    rows = (cells_of_line(line, head.separator) for line in lines[slice(head.begin, None)])
    count = len(head.names)
    whole = [row[:count] for row in rows if len(row) >= count]
    return dict(zip(head.names, map(list, zip(*whole, strict=True)), strict=False))


def holds_numbers(lines: Sequence[Line], fewest: int) -> bool:
    """Return True if some of the lines, at least so many, are rows of numbers."""
    return any(_Block(lines, sign).score >= fewest / 2 for sign in separators_of(lines))


def unlike(names: Iterable[str]) -> tuple[str, ...]:
    """Return names of columns in one line each, of which no two are equal."""
    counts: dict[str, int] = {}
    made = []
    for name in map(column_name, names):
        count = counts[name] = counts.get(name, -1) + 1
        made.append(f'{name}_duplicated_{count - 1}' if count else name)
    return tuple(made)


@functools.lru_cache(maxsize=1 << 16)
def _kind(cell: str) -> str:
    """Return n for a number or time, - for nothing, and x for any other cell."""
    if not cell or cell.lower() in NO_NUMBER or OF_SPREADSHEET.fullmatch(cell):
        return '-'
    if any(map(str.isdigit, cell)) and (
        NUMBER.fullmatch(cell)
        or NUMBER.fullmatch(plain_numeral(cell))
        or TIME.fullmatch(cell)
        or is_amount(cell)
    ):
        return 'n'
    return 'x'


class _Block:
    """The longest run of rows of numbers that lines have when a sign separates their cells."""

    def __init__(self, lines: Sequence[Line], separator: str) -> None:
        self.separator = separator
        self.rows = [
            [] if line.raw.startswith(COMMENT) else cells_of_line(line, separator)
            for line in lines
        ]
        kinds = [[_kind(cell) for cell in row] for row in self.rows]
        self.data = [
            at
            for at, row in enumerate(kinds)
            if 2 * row.count('n') >= max(len(row) - row.count('-'), 1)
        ]
        widths = Counter(len(self.rows[at]) for at in self.data)
        few = TORN * len(self.data)  # torn or foreign rows
        self.width = max((width for width, count in widths.items() if count > few), default=0)
        counts: list[Counter[str]] = [Counter() for _ in range(self.width)]
        settled = len(self.data) // 3
        for at in self.data[settled:]:
            for count, kind in zip(counts, kinds[at], strict=False):
                count[kind] += 1
        self.numeric = [count['n'] >= MOSTLY * (count['n'] + count['x']) > 0 for count in counts]
        first = counts[0] if counts else Counter()
        self.indented = first['-'] >= MOSTLY * first.total()  # as where no time is written
        while self.width and not counts[self.width - 1].keys() - {'-'}:
            self.width -= 1  # a sign at the end of each line parts nothing
        fits = {at for at in self.data if self._fits(kinds[at])}
        self.begin = self._begin(kinds, fits)
        self.begin += (
            self._bare_factors()
            or -self._rows_with_words(kinds)
            or -self._hollow_rows(kinds, fits)
        )
        rows = [kinds[at] for at in fits if at >= self.begin]
        numbers = sum(row.count('n') for row in rows)
        filled = sum(len(row) - row.count('-') for row in rows)
        alone = (0.5 if self.width < 2 else 1.0) * (SURE if separator == BLANKS else 1.0)
        self.score = len(rows) * alone * numbers / filled if filled else 0.0

    def _fits(self, kinds: Sequence[str]) -> bool:
        """Return True if a row holds a number or nothing wherever most rows do."""
        if self.indented and kinds[0] == 'x':
            return False
        return not any(
            number and kind == 'x' for number, kind in zip(self.numeric, kinds, strict=False)
        )

    def _begin(self, kinds: Sequence[Sequence[str]], fits: set[int]) -> int:
        """Return the first row with as many numbers as is usual, which most of the next follow."""
        filled = sorted(kinds[at].count('n') for at in fits)
        usual = filled[len(filled) // 2] if filled else 0
        for place, at in enumerate(self.data):
            end = place + FOLLOWING
            following = self.data[place:end]
            whole = at in fits and kinds[at].count('n') >= FULL * usual
            if whole and sum(one in fits for one in following) >= MOSTLY * len(following):
                return at
        return len(self.rows)

    def _rows_with_words(self, kinds: Sequence[Sequence[str]]) -> int:
        """Return how many rows before the begin hold words for numbers, as rows behind it do."""
        rows = self.rows[slice(self.begin, None)]
        words = [
            {row[column] for row in rows if len(row) > column} for column in range(self.width)
        ]
        held, count = {*self.data} if rows else set(), 0
        while (at := self.begin - count - 1) in held and len(self.rows[at]) == self.width:
            odd = [
                cell in known
                for cell, kind, known in zip(self.rows[at], kinds[at], words, strict=True)
                if kind == 'x'
            ]
            if not odd or not all(odd):
                break
            count += 1
        return count

    def _hollow_rows(self, kinds: Sequence[Sequence[str]], fits: set[int]) -> int:
        """Return how many rows before the begin go on with its times, or hold no number at all."""
        rows = [self.rows[at] for at in sorted(fits) if at >= self.begin][: FOLLOWING + 2]
        widths, columns = {len(row) for row in rows}, list(zip(*rows, strict=False))
        time, found = next((at for at, cells in enumerate(columns) if _rises(cells)), -1), 0
        times = [*columns[time]] if columns else []
        for at in range(self.begin - 1, -1, -1):
            row = self.rows[at]
            if not any(row):
                continue
            times = [*(row[time:][:1]), *times][: FOLLOWING + 2]
            words = [
                cell
                for cell, kind, number in zip(row, kinds[at], self.numeric, strict=False)
                if number and kind == 'x'
            ]
            is_row = (time >= 0 and _rises(times)) or all(map(_is_unknown, row))
            is_named = any(is_unit(word) or read_name(word).kind for word in words)
            if len(row) not in widths or not is_row or is_named:
                break
            found = self.begin - at
        return found

    def _bare_factors(self) -> int:
        """Return how many rows at the begin are factors and offsets: no time goes on with them."""
        end = self.begin + FOLLOWING + 2
        rows = [row for row in self.rows[slice(self.begin, end)] if len(row) == self.width]
        columns = list(zip(*rows, strict=True))
        if any(map(_goes_on, columns)):
            return 0
        for count in (2, 1):
            long = [cells for cells in columns if len(cells) >= count + FOLLOWING // 2]
            time = next((cells for cells in long if _goes_on(cells[count:])), None)
            if time and BARE_FACTOR.fullmatch(time[0]) and not _follows(time, count):
                return count
        return 0


def _number(cell: str) -> float:
    try:
        return float(plain_numeral(cell).replace(',', '.'))
    except ValueError:
        return math.nan


def _goes_on(cells: Sequence[str]) -> bool:
    """Return True if cells are times that rise evenly, or all dates."""
    times = [*map(_number, cells)]
    if any(map(math.isnan, times)) or len(times) < 2:
        return all(TIME.fullmatch(one) and not NUMBER.fullmatch(one) for one in cells)
    steps = sorted(later - before for before, later in zip(times, times[1:]))
    least, most = (part * steps[len(steps) // 2] for part in USUAL)
    return least > 0.0 and least <= steps[0] and steps[-1] <= most


def _is_unknown(cell: str) -> bool:
    """Return True for a word that stands for a number, as NaN does and a dash need not."""
    return cell.lower() in NO_NUMBER and bool(cell.strip('-'))


def _rises(cells: Sequence[str]) -> bool:
    """Return True if cells are times that never fall and have no long gap, or all dates."""
    times = [*map(_number, cells)]
    if any(map(math.isnan, times)):
        return all(
            any(map(str.isdigit, one)) and TIME.fullmatch(one) and not NUMBER.fullmatch(one)
            for one in cells
        )
    steps = sorted(later - before for before, later in zip(times, times[1:]))
    usual = [step for step in steps if step > 0.0]
    return bool(usual) and steps[0] >= 0.0 and steps[-1] < LONGEST_GAP * usual[len(usual) // 2]


def _follows(cells: Sequence[str], count: int) -> bool:
    """Return True if times that rise evenly from a place on do so a gap after the cell before."""
    before = count - 1
    times = [*map(_number, cells[before:])]
    return 0.0 < times[1] - times[0] < LONGEST_GAP * (times[-1] - times[1]) / (len(times) - 2)


def _stated_head(lines: Sequence[Line], layout: Layout, blocks: Mapping[str, _Block]) -> Head:
    """Return the head of a table whose names stand where a map states it, or in its first row."""
    begin = next(
        (
            at
            for at, line in enumerate(lines)
            if line.row > layout.skip
            and (any(line.cells) or (line.raw.strip() and not line.raw.startswith(COMMENT)))
        ),
        None,
    )
    if begin is None:
        raise ValueError('no line names its columns')
    line, end = lines[begin], begin + layout.header_rows
    block = max(blocks.values(), key=lambda one: one.score)
    separator = block.separator
    if not block.score and not line.cells:
        plain = re.sub('"[^"]*"', '', line.raw)
        separator = max((',', '|', '\t', ';'), key=plain.count)
    rows = [cells_of_line(line, separator) for line in lines[begin:end]]
    if len(rows) < layout.header_rows:
        raise ValueError('no line names its columns')
    first = lines[end].row if end < len(lines) else lines[end - 1].row + 1
    if not rows:
        names = [UNNAMED.format(at + 1) for at in range(len(cells_of_line(line, separator)))]
    else:
        below = [*(rows[1] if len(rows) > 1 else []), *[''] * len(rows[0])]
        names = [_joined(name, part) for name, part in zip(rows[0], below, strict=False)]
    return Head(names=unlike(names), separator=separator, begin=end, first=first, named=bool(rows))


def _check_unit(name: str, below: str) -> None:
    """Raise ValueError where a name states another unit than the cell of units below it."""
    kind = read_name(name).kind
    told = unit_and_scale(name, kind)
    of_row = unit_and_scale(f'[{below.strip("[]() ")}]', kind)
    if told[0] and of_row[0] and told != of_row:
        raise ValueError(
            f'the name of column {short(repr(name))} states another unit than the row of units, '
            f'which says {short(below)}: take the wrong one out'
        )


def with_unit(name: str, unit: Any) -> str:
    """
    Return a name with its unit in brackets, if that is a text and the name holds none.

    The brackets of the name must hold no unit; a letter there that names a unit of another
    quantity is taken for an axis. An unknown unit is kept, lest the usual one be assumed.

    """
    kind, unit = _kind_of(name), unit if isinstance(unit, str) else ''
    held = any(
        is_unit(text) and (len(text) > 1 or not kind or unit_and_scale(f'[{text}]', kind)[0])
        for text in BRACKETS.findall(name)
    )
    unknown = (kind not in ('', 'time') or unit[:1].isdigit()) and any(map(str.isalpha, unit))
    return f'{name} [{unit}]' if not held and (is_unit(unit) or unknown) else name


def _joined(name: str, below: str) -> str:
    bare = is_unit(below) and below[0] not in '[('
    return f'{name} [{below}]' if bare else f'{name} {below}'.strip()


class _Above:
    """The lines above a block: rows about its columns, properties of the file, and remarks."""

    def __init__(self, lines: Sequence[Line], block: _Block) -> None:
        self.block, self.separator, self.width = block, block.separator, block.width
        self.lines = [
            pair
            for line, row in zip(lines, block.rows, strict=False)
            for pair in _pairs_of_properties(line, row) or [(line, row)]
        ]
        self.text = '\n'.join(line.raw or '\t'.join(line.cells) for line in lines)
        self.program = format_of(self.text)
        self.wide = [(line, row) for line, row in self.lines if self._is_wide(row)]
        self.rows: dict[str, list[str]] = {}
        for _, row in self.wide:
            kind = property_of(row[0])
            if kind in ('name', 'symbol', 'unit') or (
                kind in ('period', 'rate')
                and sum(_kind(one) == 'n' or math.isfinite(period_of(one)) for one in row) > 1
            ):
                held = self.rows.get(kind, [])
                self.rows[kind] = row if sum(map(bool, row)) > sum(map(bool, held)) else held
        names = self.rows.get('name', [])
        if names and any(
            sum(map(bool, row)) > sum(map(bool, names)) and _known(row) > _known(names)
            for _, row in self.wide
            if not _is_of_numbers(row)
        ):
            del self.rows['name']  # a remark: a longer row has more names that are known

    def _is_wide(self, row: Sequence[str]) -> bool:
        fills = sum(map(bool, row)) > FULL * (self.block.width - 1)
        if not fills and len(row) == self.block.width:  # columns of marks have no unit
            fills = any(row[1:]) and all(is_unit(cell) for cell in row if cell)
        return fills and (len(row) > 1 or self.block.width == 1)

    def head(self, first: int) -> Head:
        names, named = self._names()
        names = self._called(names)
        if named and len(names) < self.width:
            raise ValueError(self._surplus(first, len(names)))
        filled = [at + 1 for at, name in enumerate(names) if name]
        self.width = max([self.width, *filled])  # columns without a number have names, too
        names = [*names[: self.width], *[''] * (self.width - len(names))]
        units = self._units(names)
        for name, unit in zip(names, units, strict=False):
            _check_unit(name, unit)
        told = unlike(
            with_unit(name, unit) or unnamed
            for name, unit, unnamed in zip(
                names, units, (UNNAMED.format(at + 1) for at in range(self.width)), strict=True
            )
        )
        labelled = {
            one
            for one, name in zip(told, names, strict=True)
            if property_of(name) in ('name', 'symbol')
        }
        symbols = self._row('name' if names[0] == self._row('symbol')[0] else 'symbol')
        properties = self._properties()
        periods = self._periods(told)
        period, row, unclear = self._period({*periods.values()})
        return Head(
            names=told,
            separator=self.separator,
            begin=self.block.begin,
            first=first,
            symbols={name: symbol for name, symbol in zip(told, symbols) if symbol},
            periods=periods,
            labelled=frozenset(labelled),
            named=named,
            program=self.program,
            properties=properties,
            dates=tuple(self._dates()),
            period=period,
            period_row=row,
            unclear_period=unclear,
            machine=self._machine(),
            factors=self._factors(names),
        )

    def _factors(self, names: Sequence[str]) -> str:
        """Return the first row that states a scale other than 1, or an offset other than 0."""
        begin = self.block.begin
        first = self.block.rows[begin:][:FOLLOWING]
        for row in [*(row for _, row in self.lines), *first]:
            label, *cells = row or ['']
            key, sign, value = re.sub(r'[\[(].*?[\])]', '', label).replace('=', ':').partition(':')
            word = '' if property_of(label) else factor_word(key, names)
            numbers = [value.split()[0]] if sign and value.split() else cells
            numbers = [
                one for one in numbers if NUMBER.fullmatch(one) and any(map(str.isdigit, one))
            ]
            usual = 0.0 if word == 'offset' else 1.0
            if word and any(_number(one) != usual for one in numbers):
                return ' '.join(filter(None, row))
            if TIMES.search(label):
                return label
        rows = [*self._rows_of_factors(), *self._labelled_rows(first)]
        return next((' '.join(row) for row in rows), '')

    def _rows_of_factors(self) -> Iterator[list[str]]:
        """Yield rows of numbers below the names that are neither 1, 0, nor those of columns."""
        for row in self._below_names():
            if len(row) == self.width and all(_kind(cell) == 'n' for cell in row):
                numbers = {*map(_number, row)}
                first = int(row[0]) if row[0] in ('0', '1') else math.nan
                numbered = [float(first + at) for at in range(self.width)]
                if numbers - {1.0} and numbers - {0.0} and [*map(_number, row)] != numbered:
                    yield row

    def _below_names(self) -> list[list[str]]:
        """Return the rows from the first on that names most columns."""
        named = [row for _, row in self._rows_of_names()]
        rows, begin = [row for _, row in self.wide], max(named, key=_known, default=None)
        return [*itertools.dropwhile(lambda row: row is not begin, rows)]

    def _rows_of_names(self) -> list[tuple[Line, list[str]]]:
        """Return the rows that may name the columns: those of numbers, or of units alone, none."""
        rows = [
            (line, row)
            for line, row in self.wide
            if not _is_of_numbers(row)
            and not _is_of_a_channel(row)
            and (len(row) == self.width or self.separator != BLANKS)
        ]
        return [one for one in rows if not _is_of_units(one[1])] or rows

    def _labelled_rows(self, first: Sequence[list[str]]) -> Iterator[list[str]]:
        """Yield rows of numbers behind a label that stand between the names and the rows."""
        if [_kind(row[0]) for row in first if row].count('x') > 2:
            return  # a column of texts
        for row in [*self._below_names(), *first[:2]]:
            label, *cells = row or ['']
            numbers = {*map(_number, cells)}
            of_time = unit_of(f'[{label}]', 'time')
            of_others = COUNTED.search(label) or of_time or property_of(label)
            if len(row) == self.width > 2 and _kind(label) == 'x' and not of_others:
                if (
                    all(_kind(cell) == 'n' for cell in cells)
                    and numbers - {1.0}
                    and numbers - {0.0}
                ):
                    yield row

    def _surplus(self, first: int, names: int) -> str:
        begin = self.block.begin
        rows = self.block.rows[begin:]
        at = next((at for at, row in enumerate(rows) if any(row[names:])), 0)
        return _surplus(first + at, len(rows[at]), names, self.separator)

    def _row(self, kind: str) -> list[str]:
        row = self.rows.get(kind, [])
        return [*row[: self.width], *[''] * (self.width - len(row))]

    def _names(self) -> tuple[list[str], bool]:
        """Return what the columns are called, and whether anything calls them so."""
        by_their_place = (self._below_end_of_head, self._labelled, self._symbols)
        by_their_words = (self._row_of_names, self._comment)
        by_their_form = (self._numbered, self._below_each_other)
        named = (find() for find in (*by_their_place, *by_their_words, *by_their_form))
        names = next(filter(None, named), [])
        return names, bool(names)

    def _below_end_of_head(self) -> list[str]:
        """Return the row behind the line that ends the head of a file of LabVIEW."""
        ends = [line.row for line, _ in self.lines if line.raw.startswith(END_OF_HEAD)]
        rows = [row for line, row in self.wide if ends and line.row > ends[-1]]
        return rows[0] if rows and not _is_of_numbers(rows[0]) else []

    def _labelled(self) -> list[str]:
        """Return the row that is labelled as names, or the longer symbols where these are few."""
        row, symbols = self.rows.get('name', []), self._symbols()
        plain = [one for one in row if property_of(one) != 'name']
        return symbols if len(set(plain)) < len(plain) and len(symbols) == len(row) else row

    def _symbols(self) -> list[str]:
        return self.rows.get('symbol', [])

    def _row_of_names(self) -> list[str]:
        """Return the lowest row that names most columns: units and remarks may stand below it."""
        rows = self._rows_of_names()
        if not rows:
            return []
        at = max(range(len(rows)), key=lambda at: (_known(rows[at][1]), at))
        line, row = rows[at]
        above = rows[at - 1][1] if at else []
        if len(set(row)) < len(row) - 1 and len(above) == len(row) and not _is_of_units(above):
            groups = [name or '' for name in above]
            joined = [f'{group} {name}'.strip() for group, name in zip(groups, row)]
            row = joined if len(set(joined)) == len(joined) else row
        return self._with_groups(line, list(row))

    def _with_groups(self, line: Line, row: list[str]) -> list[str]:
        """Return names with those right above, where a unit or nothing stands below these."""
        rows = [cells for each, cells in self.lines if each.row == line.row - 1]
        above = [*rows[0], *[''] * (len(row) - len(rows[0]))] if rows else []
        named = [
            bool(head and read_name(head).kind) and (not cell or is_unit(cell))
            for head, cell in zip(above, row, strict=False)
        ]
        if not any(named) or _is_of_units(above) or _is_of_units(row):
            return row
        made, group = [], ''
        for head, cell, is_named in zip(above, row, named, strict=False):
            group = '' if is_named else head or group
            made.append(_joined(head, cell) if is_named else f'{group} {cell}'.strip())
        return made

    def _called(self, names: Sequence[str]) -> list[str]:
        """Return names of channels as lines above call them: channel, words of its name, unit."""
        called = {}
        for channel, *words in [row for _, row in self.lines if _is_of_a_channel(row)]:
            words = [*filter(None, words)]
            unit = words.pop() if len(words) > 1 and is_unit(words[-1]) else ''
            if read_name(name := with_unit(' '.join(words), unit)).kind:
                called[channel] = name
        return [called.get(name, name) for name in names]

    def _comment(self) -> list[str]:
        """Return the names in the last remark that has as many as there are columns."""
        for line, _ in reversed(self.lines):
            text = line.raw.strip()
            mark = next((mark for mark in COMMENTS if text.startswith(mark)), '')
            if mark:
                row = cells_of_line(
                    Line(raw=text.removeprefix(mark).strip(), row=0), self.separator
                )
                if len(row) == self.width > 1 and not _is_of_numbers(row):
                    return row
        return []

    def _numbered(self) -> list[str]:
        """Return the names of lines such as `channel 1: X position [mm]`."""
        found: dict[int, str] = {}
        for line, _ in self.lines:
            key, value = _key_and_value(line, self.separator)
            match = COLUMN.match(key)
            if match and value:
                found.setdefault(int(match[1]), value)
        if not found:
            return []
        shift = 0 if 0 in found else 1
        shift -= self.width - len(found) if len(found) == self.width - 1 else 0
        names = [''] * self.width
        for number, name in found.items():
            if 0 <= number - shift < self.width:
                names[number - shift] = name
        return names

    def _below_each_other(self) -> list[str]:
        """Return the names of a column each in as many lines as there are columns."""
        lines = [line.raw.strip() for line, _ in self.lines if line.raw.strip()]
        begin = max(len(lines) - self.width, 0)
        last = lines[begin:]
        if self.width < 2 or len(last) < self.width:
            return []
        return last if sum(bool(read_name(one).kind) for one in last) >= FULL * self.width else []

    def _units(self, names: Sequence[str]) -> list[str]:
        if 'unit' in self.rows:
            return self._row('unit')
        for _, row in reversed(self.wide):
            if row[: self.width] != list(names[: len(row)]) and _is_of_units(row):
                cells = [cell.strip('[]() ') for cell in row[: self.width]]
                return [*cells, *[''] * (self.width - len(cells))]
        return [''] * self.width

    def _periods(self, names: Sequence[str]) -> dict[str, float]:
        """Return the periods [s] that rows of them or of rates state; NaN where two differ."""
        found: dict[str, float] = {}
        for kind in ('period', 'rate'):
            label = self.rows[kind][0] if kind in self.rows else ''
            stated = BRACKETS.findall(label)
            usual = unit_of_period(label) if kind == 'period' else 'Hz'
            periods = [period_of(cell, stated[0] if stated else usual) for cell in self._row(kind)]
            for name, period in zip(names, periods, strict=False):
                if math.isfinite(period):
                    same = math.isclose(found.get(name, period), period)
                    found[name] = period if same else math.nan
        return found

    def _properties(self) -> dict[str, Property]:
        found: dict[str, Property] = {}
        for line, _ in self._narrow():
            key, value = _key_and_value(line, self.separator)
            kind = property_of(key)
            if kind not in ('', 'period', 'rate', *found, *self.rows) and value:
                found[kind] = Property(text=value, row=line.row)
        return found

    def _dates(self) -> Iterator[Property]:
        """Yield dates and times of a day, by the first line of each label."""
        labels = set()
        for line, row in self.lines:
            cells = row if len(row) > 1 else re.split('[;\t]', line.raw)
            stated = [match.groups() for cell in cells if (match := KEY_AND_VALUE.fullmatch(cell))]
            pairs = stated if len(stated) > 1 else [_key_and_value(line, self.separator)]
            for label, value in pairs:
                if property_of(label) in (*STARTS, 'clock') and value and label not in labels:
                    labels.add(label)
                    yield Property(text=value, row=line.row, label=label)

    def _machine(self) -> dict[str, Property]:
        """Return what the lines say of the machine; several that differ are unclear."""
        found: dict[str, Property] = {}
        for line, row in self._narrow():
            text = ' '.join((line.raw or ' '.join(line.cells)).split())
            if (len(row) > 1 and _known(row)) or _is_of_numbers(row):
                continue
            key, value = _key_and_value(line, self.separator)
            for name, of in MACHINE.items():
                stated = of.value_of(key, value)
                if math.isfinite(stated) or of.hint.search(text):
                    if (before := found.get(name)) and before.value != stated:
                        text, stated = f'{before.text}; {text}', math.nan
                    found[name] = Property(text=text, row=line.row, value=stated)
        return found

    def _narrow(self) -> Iterator[tuple[Line, list[str]]]:
        """Yield the lines that say something of the file."""
        wide = {line.row for line, row in self.wide if sum(map(bool, row)) > 2}
        return ((line, row) for line, row in self.lines if line.row not in wide)

    def _period(self, of_columns: Collection[float]) -> tuple[float, int, str]:
        """
        Return the period [s] that the head states, and the row that does so, 0 if for columns.

        That of columns is one of the file if it is the same for all. What may be one of something
        else than rows is returned as its line, and no period with it.

        """
        stated, unclear, others = [], [], []
        for line, row in self.lines:
            text = ' '.join((line.raw or ' '.join(line.cells)).split())
            period = self._stated_period(line, row)
            if period is not None and 0.0 < period <= LONGEST_PERIOD:
                stated.append((period, line.row, text))
            elif len(row) > 1 and _known(row) and not any(_kind(cell) == 'n' for cell in row):
                continue  # names of columns
            elif period is not None or MAY_BE_PERIOD.search(text):
                unclear.append(text)
            if OTHER_ROWS.search(text):
                others.append(text)
        if len(of_columns) == 1:
            stated = [(next(iter(of_columns)), 0, '')]
        if stated and not others and all(math.isclose(one, stated[0][0]) for one, *_ in stated):
            return *stated[0][:2], ''
        texts = dict.fromkeys([*(text for *_, text in stated), *unclear, *others])
        return math.nan, 0, '; '.join(filter(None, texts))

    def _stated_period(self, line: Line, row: Sequence[str]) -> float | None:
        """Return the period [s] that a line states, NaN if it is unclear, None for none."""
        text = line.raw or ' '.join(line.cells)
        key, value = _key_and_value(line, self.separator)
        cells = [cell for cell in row if cell]
        if len(cells) == 3 and _kind(cells[1]) == 'n' and math.isfinite(period_of(*cells[1:])):
            key, value = cells[0], f'{cells[1]} {cells[2]}'
        elif len(cells) > 2 and self._is_wide(row):
            return None
        kind = property_of(key)
        if kind in ('period', 'rate') and value and kind not in self.rows:
            stated = BRACKETS.findall(key)
            usual = unit_of_period(key) if kind == 'period' else 'Hz'
            bare = usual if re.fullmatch(r'[\d.,e+-]+', value, re.I) else ''
            period = period_of(f'{value} {stated[0] if stated else bare}')
        elif match := REMARK.search(text):
            period = period_of(match['number'], match['unit'])
        else:
            return None
        return math.nan if OTHER_PERIOD.search(text) else period


def _pairs_of_properties(line: Line, row: Sequence[str]) -> list[tuple[Line, list[str]]]:
    """Return the properties of a row that holds several, each with its value, as lines."""
    keys, values = row[::2], row[1::2]
    if not 1 < len(keys) == len(values) or not all(map(property_of, keys)):
        return []
    if any(_kind(value) != 'n' for value in values):
        return []
    pairs = [[key, value] for key, value in zip(keys, values, strict=True)]
    return [(Line(raw=': '.join(pair), row=line.row), pair) for pair in pairs]


def _is_of_a_channel(row: Sequence[str]) -> bool:
    """Return True for a row that says of one channel what it is."""
    channels = [bool(CHANNEL.fullmatch(cell)) for cell in row]
    return len(row) > 1 and channels[0] and not any(channels[1:])


def _key_and_value(line: Line, separator: str) -> tuple[str, str]:
    """Return key and value of a line such as `key: value`, empty for any other."""
    text = line.raw.strip().lstrip('#%/*; \t').strip() or ' '
    cells = [cell for cell in line.cells if cell]
    if line.cells:
        return (cells[0].rstrip(':='), cells[1]) if len(cells) > 1 else ('', '')
    signs = [
        sign for sign in (separator, '\t', ';', ':', '=', ',') if sign.strip() or sign == '\t'
    ]
    for pattern in (r'^([^:=;\t,]{2,40}?)\s*[:=;\t]\s*(.+)$', r'^([^,]{2,40}?)\s*,\s*(.+)$'):
        if signs and (match := re.match(pattern, text)):
            value = re.split(r'[;\t]', match[2].strip())[0].strip(' ,"')
            return match[1].strip(' "'), value
    return '', ''


def _kind_of(name: str) -> str:
    """Return the kind of quantity of a name, whatever its brackets hold."""
    return read_name(BRACKETS.sub(' ', name)).kind or read_name(name).kind


def _known(row: Sequence[str]) -> int:
    return sum(bool(_kind_of(cell)) for cell in row)


def _is_of_numbers(row: Sequence[str]) -> bool:
    return 2 * sum(_kind(cell) == 'n' for cell in row) > sum(map(bool, row))


def _is_of_units(row: Sequence[str]) -> bool:
    filled = [cell for cell in row if cell]
    return bool(filled) and 2 * sum(is_unit(cell) for cell in filled) >= len(filled)
