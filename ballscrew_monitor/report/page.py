# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A page that opens anywhere: all it needs is inside, and nothing else may run in it.

Its HTML is safe by its making: every text is escaped, whatever a log or an axis is called. Numbers
are compact columns, and texts are JSON that ends no element.

"""

import base64
from collections.abc import Iterable, Sequence
import functools
import hashlib
import html
from importlib import resources
import json
import math
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike
from surrogate.files import to_json

FOLDER = resources.files('ballscrew_monitor.report').joinpath('components')
UPLOT_JS, UPLOT_CSS = 'uplot/uPlot.iife.min.js', 'uplot/uPlot.min.css'
CHARTS = (
    UPLOT_JS,
    'format.js',
    'table.js',
    'ticks.js',
    'frame.js',
    'map.js',
    'course.js',
    'strip.js',
    'panel.js',
    'series.js',
    'page.js',
)
"""Scripts of a page with charts, in the order in which they build on each other."""
LEVELS = 65534  # steps of a packed number between the lowest and the highest
LARGEST = np.finfo(float).max / 2  # number that is packed, of which a span is finite
SELDOM = 4  # numbers to a change from which on runs are the shorter form
LEADING = 'leading'  # kind of a table whose rows lead to moments, of which there may be many
DOTS = 'M0 3H26M0 9H26'  # two rows of a sample in a legend
VOID = frozenset({'meta', 'link', 'input', 'rect', 'line', 'path', 'br', 'polyline'})


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
    return Markup(f'{opened}{joined(*content)}</{name}>')


def joined(*pieces: str) -> Markup:
    """Return pieces one after the other, escaped where they are no markup."""
    return Markup(
        ''.join(piece if isinstance(piece, Markup) else html.escape(piece) for piece in pieces)
    )


class TableCell(Markup):
    """A cell of a table; `value` is what it is sorted by, `kind` its class."""

    __slots__ = ()

    def __new__(cls, text: str, *, kind: str = '', value: float | None = None) -> Self:
        shown = None if value is None else f'{value!r}' if math.isfinite(value) else 'NaN'
        return super().__new__(cls, element('td', text, class_=kind or None, data_value=shown))


class TableRow(Markup):
    """A row of a table: cells, or their texts alone, and the time [s] that it leads to if any."""

    __slots__ = ()

    def __new__(
        cls,
        cells: Iterable[str],
        *,
        begin: float | None = None,
        end: float | None = None,
        kind: str = '',
    ) -> Self:
        drawn = (cell if isinstance(cell, TableCell) else TableCell(cell) for cell in cells)
        times = (None if at is None else f'{at:.4f}' for at in (begin, end))
        named = dict(zip(('data_begin', 'data_end'), times))
        return super().__new__(cls, element('tr', *drawn, class_=kind or None, **named))


def table(heads: Sequence[str], rows: Iterable[TableRow], *, kind: str = '') -> Markup:
    """Return a table; a head that ends in `]`, a unit, is that of a column of numbers."""
    head = (
        element('th', text, class_='number' if text.endswith(']') else None, scope='col')
        for text in heads
    )
    drawn = element(
        'table',
        element('thead', element('tr', *head)),
        element('tbody', *rows),
        class_=kind or None,
    )
    return element('div', drawn, class_='wide tall' if LEADING in kind else 'wide')


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


def component(name: str) -> str:
    """Return the text of a file of the components."""
    return FOLDER.joinpath(name).read_text(encoding='utf-8')


def page(
    title: str, body: Markup, *, scripts: tuple[str, ...] = (), data: str | None = None
) -> str:
    """
    Return a page; `data` is JSON for its scripts, made by `script_json`.

    It asks for nothing over the net, and its policy lets run and look only what is in it here.

    """
    texts = [component(name) for name in scripts]
    sheets = [component(UPLOT_CSS)] if UPLOT_JS in scripts else []
    sheets.append(component('page.css'))
    policy = (
        f"default-src 'none'; script-src {_hashes(texts)}; style-src {_hashes(sheets)}; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )
    head = element(
        'head',
        element('meta', charset='utf-8'),
        element('meta', http_equiv='Content-Security-Policy', content=policy),
        element('meta', name_='viewport', content='width=device-width, initial-scale=1'),
        element('title', title),
        *(_raw('style', sheet) for sheet in sheets),
    )
    tail = [_raw('script', text) for text in texts]
    if data is not None:
        tail.insert(0, Markup(f'<script type="application/json" id="data">{data}</script>'))
    whole = element('html', head, element('body', body, *tail), lang='en')
    return f'<!DOCTYPE html>\n{whole}\n'


def _hashes(texts: list[str]) -> str:
    digests = (base64.b64encode(hashlib.sha256(text.encode()).digest()) for text in texts)
    return ' '.join(f"'sha256-{digest.decode()}'" for digest in digests) or "'none'"


def _raw(name: str, text: str) -> Markup:
    """Return an element whose text is read as it stands; ours, and it never ends the element."""
    if f'</{name}' in text.lower():
        raise ValueError(f'a component holds </{name}')
    return Markup(f'<{name}>{text}</{name}>')


def _encoded(kind: str, values: ArrayLike) -> str:
    return base64.b64encode(np.asarray(values, dtype=kind).tobytes()).decode()


floats, doubles, codes = (functools.partial(_encoded, kind) for kind in ('<f4', '<f8', '<u1'))
"""Return numbers as base64 of little-endian float32, of float64, and of bytes."""


def packed(values: ArrayLike) -> dict[str, Any]:
    """
    Return numbers in 65534 steps from the lowest to the highest, two bytes each, 0 for NaN.

    A number beyond half of the largest double counts as NaN: the reader's span would overflow.
    Where the numbers seldom change, `runs` says how often each is repeated.

    """
    numbers = np.asarray(values, dtype=float)
    known = np.abs(numbers) <= LARGEST
    low, high = 0.0, 0.0
    if known.any():
        low, high = float(numbers[known].min()), float(numbers[known].max())
    steps = np.zeros(numbers.size, dtype=np.uint16)
    # The span may be subnormal, and its reciprocal infinite: it divides.
    steps[known] = 1 + np.rint((numbers[known] - low) / ((high - low) or 1.0) * LEVELS)
    record = {'low': low, 'high': high}
    starts = np.flatnonzero(np.diff(steps, prepend=steps[:1] + 1))
    if SELDOM * starts.size > steps.size:
        return record | {'data': _encoded('<u2', steps)}
    runs = np.diff(starts, append=steps.size)
    return record | {'data': _encoded('<u2', steps[starts]), 'runs': _encoded('<u4', runs)}


def script_json(record: Any) -> str:
    """Return a record as JSON within a script element: no text in it can end the element."""
    text = json.dumps(to_json(record), separators=(',', ':'), allow_nan=False)
    return text.replace('<', '\\u003c').replace('>', '\\u003e').replace('&', '\\u0026')
