# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Texts and JSON are read up to a size and a depth."""

import json

import pytest
from surrogate.files import limits


def test_a_text_is_read_to_its_last_allowed_character(tmp_path, refused):
    path = tmp_path / 'text'
    path.write_bytes(b'a\r\n' + b'b' * 3)
    assert limits.read_text(path, most=5) == 'a\nbbb'
    refused('text_large', limits.read_text, path, most=4)


def test_json_is_read_to_its_last_allowed_depth(refused):
    deepest = '[' * limits.DEPTH + ']' * limits.DEPTH
    assert limits.read_json(deepest) == json.loads(deepest)
    refused('json_deep', limits.read_json, f'{{"a": {deepest}}}')
    refused('json_deeper', limits.read_json, '[' * 100_000)
    refused('json_large', limits.read_json, bytes(limits.TEXT + 1))


@pytest.mark.parametrize('text', ['', '{', '[1,]', '9' * 5000, b'\xff'])
def test_what_is_no_json_is_a_sentence(text, refused):
    refused('json_none', limits.read_json, text)
