# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The documents are safe by their making, and begin with nothing from elsewhere."""

import re

from ballscrew_monitor.page import components
from ballscrew_monitor.page.guard import POLICY


def test_documents_ask_for_files_of_the_table_alone():
    for text in (components.index(), components.login()):
        asked = re.findall(r'(?:src|href)="/components/([^"]*)"', text)
        assert len(asked) == len(re.findall(r'(?:src|href)=', text))
        assert set(asked) <= components.table().keys()
        assert not re.search(r'<script>|<style|style=|\bon\w+=|://', text)


def test_all_scripts_are_in_the_page_and_each_once():
    asked = re.findall(r'src="/components/([^"]*)"', components.index())
    assert asked == [*components.SHARED, *components.OWN]
    assert len(asked) == len(set(asked))


def test_what_is_said_of_a_token_is_escaped():
    assert '<b>' not in components.login('<b>')


def test_the_policy_lets_in_nothing_from_elsewhere():
    """Every source is this server or none, and no script or style stands in the document."""
    parts = dict(part.split(' ', 1) for part in POLICY.split('; '))
    assert parts.pop('default-src') == "'none'"
    assert set(parts.values()) == {"'self'", "'none'"}
