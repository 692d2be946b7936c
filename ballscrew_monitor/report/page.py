# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A page that opens anywhere: all it needs is inside, and nothing else may run in it.

It carries numbers as compact columns, and texts as JSON that ends no element.

"""

import base64
import functools
import hashlib
from importlib import resources
import json
from typing import Any

from ballscrew_monitor.report.markup import element, joined, Markup
import numpy as np
from numpy.typing import ArrayLike
from surrogate.files import to_json

FOLDER = resources.files('ballscrew_monitor.report').joinpath('components')
UPLOT_JS, UPLOT_CSS = 'uplot/uPlot.iife.min.js', 'uplot/uPlot.min.css'
CHARTS = (
    UPLOT_JS,
    'format.js',
    'table.js',
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
    tail = [_data(data)] if data is not None else []
    tail += [_raw('script', text) for text in texts]
    whole = element('html', head, element('body', body, joined(tail)), lang='en')
    return f'<!DOCTYPE html>\n{whole}\n'


def _hashes(texts: list[str]) -> str:
    return (
        ' '.join(
            f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
            for text in texts
        )
        or "'none'"
    )


def _raw(name: str, text: str) -> Markup:
    """Return an element whose text is read as it stands; ours, and it never ends the element."""
    if f'</{name}' in text.lower():
        raise ValueError(f'a component holds </{name}')
    return Markup(f'<{name}>{text}</{name}>')


def _data(text: str) -> Markup:
    return Markup(f'<script type="application/json" id="data">{text}</script>')


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
    low, high = _span(numbers[known])
    steps = np.zeros(numbers.size, dtype=np.uint16)
    # The span may be subnormal, and its reciprocal infinite: it divides.
    steps[known] = 1 + np.rint((numbers[known] - low) / ((high - low) or 1.0) * LEVELS)
    record = {'low': low, 'high': high}
    starts = np.flatnonzero(np.diff(steps, prepend=steps[:1] + 1))
    if SELDOM * starts.size > steps.size:
        return record | {'data': _encoded('<u2', steps)}
    runs = np.diff(starts, append=steps.size)
    return record | {'data': _encoded('<u2', steps[starts]), 'runs': _encoded('<u4', runs)}


def _span(numbers: Any) -> tuple[float, float]:
    return (float(numbers.min()), float(numbers.max())) if numbers.size else (0.0, 0.0)


def script_json(record: Any) -> str:
    """Return a record as JSON within a script element: no text in it can end the element."""
    text = json.dumps(to_json(record), separators=(',', ':'), allow_nan=False)
    return text.replace('<', '\\u003c').replace('>', '\\u003e').replace('&', '\\u0026')
