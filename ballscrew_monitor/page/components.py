# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The files of the page, by one table: nothing else is served, and no path is made of a request.

Components of `report.html` serve both pages.

"""

import functools
from importlib import resources

from ballscrew_monitor.report.page import component, element, UPLOT_CSS, UPLOT_JS
from surrogate.files.limits import read_json

ROOM = resources.files('ballscrew_monitor.page')
SHARED = {
    **{path.rpartition('/')[2]: path for path in (UPLOT_CSS, UPLOT_JS)},
    **{
        name: name
        for name in ('page.css', 'format.js', 'ticks.js', 'frame.js', 'map.js', 'panel.js')
    },
}
"""Names of the components of `report.html`, and where they lie there."""
SHEETS = ('uPlot.min.css', 'page.css', 'live.css')
SCRIPTS = (
    *('uPlot.iife.min.js', 'format.js', 'ticks.js', 'frame.js', 'map.js', 'panel.js'),
    *('words.js', 'controls.js', 'quantities.js', 'axis.js', 'painter.js', 'live.js'),
    *('first_screen.js', 'cards.js', 'trail.js', 'live_map.js', 'map_legend.js'),
    *(
        'strip_panels.js',
        'strips.js',
        'what_if.js',
        'events.js',
        'health.js',
        'player.js',
        'fault.js',
        'live_page.js',
    ),
)
"""Scripts in the order in which they build on each other."""
TYPES = {'js': 'text/javascript; charset=utf-8', 'css': 'text/css; charset=utf-8'}
ENGLISH = 'en'


@functools.cache
def table() -> dict[str, tuple[bytes, str]]:
    """Return content and type of each file by its name."""
    files = {}
    for name in (*SHEETS, *SCRIPTS):
        file = ROOM.joinpath('components', name)
        if name in SHARED or file.is_file():
            text = component(SHARED[name]) if name in SHARED else file.read_text(encoding='utf-8')
            files[name] = text.encode(), TYPES[name.rpartition('.')[2]]
    return files


@functools.cache
def languages() -> dict[str, dict[str, str]]:
    """Return the words of each language by its name, such as `en`."""
    texts = {
        file.name.removesuffix('.json'): file.read_text(encoding='utf-8')
        for file in ROOM.joinpath('languages').iterdir()
        if file.name.endswith('.json')
    }
    return {name: read_json(text) for name, text in texts.items()}


def language_of(accepted: str, wanted: str = '') -> str:
    """Return the language that is `wanted`, else the first that a reader accepts, or English."""
    first = (
        wanted or accepted.partition(',')[0].partition(';')[0].partition('-')[0].strip().lower()
    )
    return first if first in languages() else ENGLISH


def _document(language: str, *body: str) -> str:
    sheets = (
        element('link', rel='stylesheet', href=f'/components/{name}')
        for name in SHEETS
        if name in table()
    )
    head = element(
        'head',
        element('meta', charset='utf-8'),
        element('meta', name_='viewport', content='width=device-width, initial-scale=1'),
        element('title', languages()[language]['title']),
        *sheets,
    )
    return f'<!DOCTYPE html>\n{element("html", head, element("body", *body), lang=language)}\n'


@functools.cache
def index(language: str = ENGLISH) -> str:
    """Return the page; all that changes comes over its socket."""
    first = languages()[language]['link_first']
    scripts = (
        element('script', src=f'/components/{name}', defer='')
        for name in SCRIPTS
        if name in table()
    )
    main = element('main', element('p', first, class_='link', role='status'), id='page')
    return _document(language, main, *scripts)


def login(language: str = ENGLISH, key: str = '') -> str:
    """Return the form that asks for the token, and by a key what became of the last one."""
    words = languages()[language]
    field = element('input', type='password', name_='token', autocomplete='current-password')
    form = element(
        'form',
        element('label', f'{words["login_token"]} ', field),
        element('button', words['login_open'], type='submit'),
        method='post',
        action='/login',
    )
    return _document(language, element('main', form, element('p', words.get(key, ''))))
