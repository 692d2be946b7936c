# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Every text of the page has its key in each language, and components are plain files."""

import json
import re
from string import Formatter

import pytest

MOST_LINES = 200
# Keys that are made of a name that a frame sends.
GROUPS = (
    *'advice cause change condition event fault health input legend level line map'.split(),
    *'name quantity reason remedy short stage state total why zone'.split(),
)
PLAIN = {'title', 'shelve', 'axes', 'acknowledge', 'optimal', 'acknowledged'}
"""Keys of one word."""


def fields(text):
    return sorted(name for _, name, *_ in Formatter().parse(text) if name)


def tables(frames):
    return {path.stem: frames.words(path.stem) for path in sorted(frames.languages.glob('*.json'))}


def sources(frames):
    return {path.name: path.read_text(encoding='utf-8') for path in sorted(frames.own.iterdir())}


def test_languages_have_the_same_keys_and_values_in_order(frames):
    made = tables(frames)
    assert {'de', 'en'} <= made.keys()
    for language, table in made.items():
        assert list(table) == sorted(made['en']), language
        for key, text in table.items():
            assert fields(text) == fields(made['en'][key]), f'{language}: {key}'
            assert text.strip() == text
            assert text, key


def test_every_key_is_said_and_every_text_that_is_said_has_one(frames):
    code, table = '\n'.join(sources(frames).values()), frames.words('en')
    served = [path.read_text(encoding='utf-8') for path in frames.own.parent.glob('*.py')]
    literals = set(re.findall(r"""['"]([a-z]+(?:_\w+)+)['"]""", '\n'.join([code, *served])))
    unsaid = {
        key
        for key in table.keys() - literals - PLAIN
        if key.split('_')[0] not in GROUPS and key != 'decimal_mark'
    }
    assert not unsaid
    asked = re.findall(r"(?:Words\.say|Controls\.\w+)\('(\w+)'", code)
    asked += re.findall(r"Words\.element\('\w+', '[\w -]*', '(\w+)'", code)
    assert len(asked) > 40
    assert set(asked) <= table.keys()


def test_values_are_filled_in_once_and_unknown_keys_show_themselves(tab, greeted):
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    said = json.loads(
        tab.ask("""JSON.stringify([
          Words.say('limit_at', { limit: '{limit} {x}' }), Words.say('no such key'),
          Words.named('state', 'not_configured'), Words.named('quantity', 'drag change'),
          Words.named('quantity', 'of tomorrow')])""")
    )
    assert said == [
        'limit {limit} {x}',
        'no such key',
        'not configured',
        'Friction change',
        'of tomorrow',
    ]


def test_german_numbers_have_a_comma(tab, greeted, frames):
    tab.visit(greeted.url, language='de')
    tab.reads('.sign.level .word', 'Optimaler Bereich')
    assert tab.ask('document.documentElement.lang') == 'de'
    greeted.send(*frames.state(rows=frames.rows(1, speed_rpm=672.4)))
    tab.reads('.big', '6,72 m/min')


@pytest.mark.parametrize('kind', ['.js', '.css'])
def test_components_are_plain_and_small(frames, kind):
    texts = {name: text for name, text in sources(frames).items() if name.endswith(kind)}
    assert texts
    for name, text in texts.items():
        assert 'SPDX-License-Identifier: Apache-2.0' in text
        assert len(text.splitlines()) < MOST_LINES, name
        addresses = set(re.findall(r"https?:[^\s']+", text))
        assert addresses <= {'http://www.w3.org/2000/svg'}, name  # a name, not an address
        assert not re.search(r'@import|url\(', text), name
        if kind == '.js':
            assert "'use strict';" in text
            # Text becomes an element only as text.
            assert not re.search(
                r'innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(', text
            )
