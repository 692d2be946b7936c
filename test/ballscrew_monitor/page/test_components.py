# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The documents are safe by their making, and begin with nothing from elsewhere."""

import re

from ballscrew_monitor.page import components
from ballscrew_monitor.page.guard import POLICY
import pytest


def test_documents_ask_for_files_of_the_table_alone():
    for text in (components.index(), components.login()):
        asked = re.findall(r'(?:src|href)="/components/([^"]*)"', text)
        assert len(asked) == len(re.findall(r'(?:src|href)=', text))
        assert set(asked) <= components.table().keys()
        assert not re.search(r'<script>|<style|style=|\bon\w+=|://', text)


def test_all_scripts_are_in_the_page_and_each_once():
    """Those whose file is there, in the order of the table."""
    asked = re.findall(r'src="/components/([^"]*)" defer', components.index())
    assert asked == [name for name in components.SCRIPTS if name in components.table()]
    assert len(asked) == len(set(asked)) > 4


def test_the_language_is_the_first_that_is_accepted(monkeypatch):
    monkeypatch.setattr(components, 'languages', lambda: {'en': {}, 'de': {}})
    accepted = {'de-CH,en;q=0.5': 'de', 'DE': 'de', 'fr,de': 'en', '': 'en', 'en;q=1': 'en'}
    assert {one: components.language_of(one) for one in accepted} == accepted
    assert components.language_of('en', 'de') == 'de'
    assert components.language_of('de', 'xx') == 'en'


@pytest.mark.parametrize('language', components.languages())
def test_the_form_for_the_token_speaks_the_language_of_its_reader(language):
    words = components.languages()[language]
    text = components.login(language, 'login_wrong')
    assert f'lang="{language}"' in text
    assert all(words[key] in text for key in ('login_token', 'login_open', 'login_wrong'))


def test_the_policy_lets_in_nothing_from_elsewhere():
    """Every source is this server or none, and no script or style stands in the document."""
    parts = dict(part.split(' ', 1) for part in POLICY.split('; '))
    assert parts.pop('default-src') == "'none'"
    assert set(parts.values()) == {"'self'", "'none'"}
