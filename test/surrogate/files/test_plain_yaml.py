# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""YAML of a bounded depth and number of values, an alias counted with its values."""

import pytest
from surrogate.files.limits import DEPTH, TEXT, VALUES
from surrogate.files.plain_yaml import plain_values


def test_plain_values_and_aliases_are_read():
    text = 'a: &a {x: 1, y: [2.5, yes]}\nb: *a\nc: {<<: *a, x: 3}\nd: 2020-01-02\n'
    found = plain_values(text)
    assert found['a'] == found['b'] == {'x': 1, 'y': [2.5, True]}
    assert found['c'] == {'x': 3, 'y': [2.5, True]}
    assert str(found['d']) == '2020-01-02'
    assert plain_values('') is None


def test_the_last_allowed_depth_and_number_are_read(refused):
    deepest = '[' * (DEPTH - 1) + '1' + ']' * (DEPTH - 1)
    assert str(plain_values(deepest)) == deepest
    refused('deep', plain_values, f'[{deepest}]')
    thousand = f'[{", ".join(["1"] * 999)}]'  # with the list itself
    lists, ones = VALUES // 1000 - 1, 999
    most = f'[&a {thousand}{", *a" * (lists - 1)}{", 1" * ones}]'
    assert len(plain_values(most)) == lists + ones
    refused('many', plain_values, f'[{most}]')
    refused('many', plain_values, most.replace('[&a', '[1, &a'))
    refused('large', plain_values, '#' * (TEXT + 1))


def test_an_alias_counts_as_what_it_stands_for(refused):
    lines = [f'a0: &a0 [{", ".join(["ha"] * 9)}]']
    lines += [f'a{n}: &a{n} [{", ".join([f"*a{n - 1}"] * 9)}]' for n in range(1, 9)]
    refused('many', plain_values, '\n'.join(lines))
    merged = ['a0: &a0 {k: 1}']
    merged += [f'a{n}: &a{n} {{<<: [{", ".join([f"*a{n - 1}"] * 9)}]}}' for n in range(1, 9)]
    refused('many', plain_values, '\n'.join(merged))
    refused('itself', plain_values, 'a: &a [*a]')


@pytest.mark.parametrize(
    'text',
    [
        *('2020-13-45', '!!timestamp a', "!!int ''", '!!bool 5', '!!float a', '9' * 5000 + ': 1'),
        *('[: {', '{[1]: 2}', '\x01', '!!python/object:os.x {}', '*a', '!!set [1]', '0b'),
    ],
)
def test_what_is_no_value_is_refused_or_a_text(text, refused):
    if text == '0b':
        assert plain_values(text) == text
    else:
        refused('any', plain_values, text)


@pytest.mark.parametrize('sign', ['', '-'])
def test_a_whole_number_that_no_float_is_as_large_as_is_refused(sign, refused):
    assert plain_values(f'a: {sign}1{"0" * 308}') == {'a': int(f'{sign}1{"0" * 308}')}
    refused('large_number', plain_values, f'a:\n  - 1\n  - {sign}1{"0" * 309}')
    refused('large_number', plain_values, f'a:\n  - 1\n  - {sign}0x{"f" * 5000}')


def test_a_key_twice_is_refused_where_that_is_asked_for(refused):
    assert plain_values('1: a\n01: b') == {1: 'b'}
    refused('twice', plain_values, '1: a\n01: b', strict=True)
    refused('twice', plain_values, 'a: 1\n01: {}\n01: b', strict=True)
    assert plain_values('a: 1\nb: {a: 2}', strict=True) == {'a': 1, 'b': {'a': 2}}
