# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A page that opens anywhere: all it needs is inside, and nothing else may run in it."""

import base64
import hashlib
from importlib import resources

from ballscrew_monitor.report.markup import element, joined, Markup

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


def component(name: str) -> str:
    """Return the text of a file of the components."""
    return FOLDER.joinpath(name).read_text(encoding='utf-8')


def page(
    title: str, body: Markup, *, scripts: tuple[str, ...] = (), data: str | None = None
) -> str:
    """
    Return a page; `data` is JSON for its scripts, made by `encoding.script_json`.

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
