# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The files of the page, by one table: nothing else is served, and no path is made of a request.

The components of `report.html` serve both pages.

"""

import functools
from importlib import resources

from ballscrew_monitor.report.page import CHARTS, component, element, UPLOT_CSS

FOLDER = resources.files('ballscrew_monitor.page').joinpath('components')
SHARED = tuple(name for name in CHARTS if name != 'page.js')
"""Scripts of `report.html` that this page uses too; `page.js` begins that one."""
OWN: tuple[str, ...] = ()
"""Scripts of this page alone, in the order in which they build on each other."""
SHEETS = (UPLOT_CSS, 'page.css')
TYPES = {'js': 'text/javascript; charset=utf-8', 'css': 'text/css; charset=utf-8'}


@functools.cache
def table() -> dict[str, tuple[bytes, str]]:
    """Return content and type of each file by its name."""
    files = {name: component(name) for name in (*SHARED, *SHEETS)}
    files |= {name: FOLDER.joinpath(name).read_text(encoding='utf-8') for name in OWN}
    return {name: (text.encode(), TYPES[name.rpartition('.')[2]]) for name, text in files.items()}


def _document(title: str, *body: str, scripts: tuple[str, ...] = ()) -> str:
    sheets = (element('link', rel='stylesheet', href=f'/components/{name}') for name in SHEETS)
    head = element(
        'head',
        element('meta', charset='utf-8'),
        element('meta', name_='viewport', content='width=device-width, initial-scale=1'),
        element('title', title),
        *sheets,
    )
    tail = (element('script', src=f'/components/{name}') for name in scripts)
    return f'<!DOCTYPE html>\n{element("html", head, element("body", *body, *tail), lang="en")}\n'


@functools.cache
def index() -> str:
    """Return the page; all that changes comes over its socket."""
    main = element(
        'main',
        element('noscript', element('p', 'The page needs JavaScript.')),
        element('p', 'Waiting for the server.', id='waiting'),
        id='page',
    )
    return _document('Ball screws', main, scripts=(*SHARED, *OWN))


def login(said: str = '') -> str:
    """Return the form that asks for the token, and what became of the last one."""
    field = element('input', type='password', name_='token', autocomplete='current-password')
    form = element(
        'form',
        element('label', 'Token ', field),
        element('button', 'Open', type='submit'),
        method='post',
        action='/login',
    )
    return _document('Ball screws', element('main', form, element('p', said)))
