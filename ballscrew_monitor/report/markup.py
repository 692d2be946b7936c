# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""HTML that is safe by its making: every text is escaped, whatever a log or an axis is called."""

from collections.abc import Iterable, Sequence
import dataclasses
import html
import math

LEADING = 'leading'  # kind of a table whose rows lead to moments, of which there may be many
DOTS = 'M0 3H26M0 9H26'  # two rows of a sample in a legend
VOID = frozenset({'meta', 'rect', 'line', 'path', 'br', 'polyline'})


class Markup(str):
    """A piece of a page: never escaped again."""

    __slots__ = ()


def element(name: str, *content: str, **attributes: str | float | None) -> Markup:
    """
    Return an element; content that is no `Markup` is escaped, as are the values of attributes.

    A trailing `_` of the name of an attribute is dropped, any other becomes `-`; None leaves an
    attribute out.

    """
    parts = [name]
    for key, value in attributes.items():
        if value is not None:
            shown = f'{value:g}' if isinstance(value, float) else str(value)
            parts.append(f'{key.rstrip("_").replace("_", "-")}="{html.escape(shown)}"')
    opened = f'<{" ".join(parts)}>'
    if name in VOID and not content:
        return Markup(opened if name in ('meta', 'br') else f'{opened[:-1]}/>')
    return Markup(f'{opened}{joined(content)}</{name}>')


def joined(content: Iterable[str]) -> Markup:
    """Return pieces one after the other, escaped where they are no markup."""
    return Markup(
        ''.join(part if isinstance(part, Markup) else html.escape(part) for part in content)
    )


@dataclasses.dataclass(frozen=True, slots=True)
class TableCell:
    """What a cell shows; `value` is what it is sorted by, `kind` its class."""

    text: str
    _: dataclasses.KW_ONLY
    kind: str = ''
    value: float | None = None


@dataclasses.dataclass(frozen=True, slots=True)
class TableRow:
    """Cells of a row, or their texts alone, and the time [s] that it leads to if any."""

    cells: Sequence[TableCell | str]
    _: dataclasses.KW_ONLY
    begin: float | None = None
    end: float | None = None
    kind: str = ''


def table(heads: Sequence[str], rows: Iterable[TableRow], *, kind: str = '') -> Markup:
    """Return a table; a head that ends in `]`, a unit, is that of a column of numbers."""
    head = (element('th', text, class_=_class_of(text), scope='col') for text in heads)
    body = (_row(row) for row in rows)
    made = element(
        'table',
        element('thead', element('tr', *head)),
        element('tbody', *body),
        class_=kind or None,
    )
    return element('div', made, class_='wide tall' if LEADING in kind else 'wide')


def _class_of(head: str) -> str | None:
    return 'number' if head.endswith(']') else None


def _row(row: TableRow) -> Markup:
    cells = (
        element('td', cell.text, class_=cell.kind or None, data_value=_stated(cell.value))
        for cell in (TableCell(one) if isinstance(one, str) else one for one in row.cells)
    )
    return element(
        'tr',
        *cells,
        class_=row.kind or None,
        data_begin=None if row.begin is None else f'{row.begin:.4f}',
        data_end=None if row.end is None else f'{row.end:.4f}',
    )


def _stated(value: float | None) -> str | None:
    if value is None:
        return None
    return f'{value!r}' if math.isfinite(value) else 'NaN'


def share_bar(parts: Sequence[tuple[float, str]], title: str) -> Markup:
    """Return a bar of parts, each of an amount and with a class, as long as they are large."""
    total = math.fsum(amount for amount, _ in parts)
    at, pieces = 0.0, []
    for amount, kind in parts:
        width = 1000.0 * amount / total if total else 0.0
        pieces.append(element('rect', x=at, y='0', width=f'{width:.2f}', height='22', class_=kind))
        at += width
    return element(
        'svg',
        element('title', title),
        *pieces,
        class_='bar',
        viewBox='0 0 1000 22',
        preserveAspectRatio='none',
        role='img',
    )


def swatch(kind: str, shape: str = 'fill', dash: str | None = None) -> Markup:
    """Return a sample of a colour, as an area, as dots or as a line, for a legend."""
    if shape == 'fill':
        piece = element('rect', width='26', height='12', class_=f'fill-{kind}')
    elif shape == 'dots':
        piece = element(
            'path', d=DOTS, class_=f'line-{kind}', stroke_width='2', stroke_dasharray='2 5'
        )
    else:
        piece = element(
            'line',
            x1='0',
            x2='26',
            y1='6',
            y2='6',
            class_=f'line-{kind}',
            stroke_width='2',
            stroke_dasharray=dash,
        )
    return element('svg', piece, viewBox='0 0 26 12', aria_hidden='true')
