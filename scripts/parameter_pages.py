# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Write the products of the parameter table: config/example.yaml, and the table of the page."""

from pathlib import Path
import re
import sys
from typing import Any

from ballscrew_monitor.settings.parameter_row import ParameterRow
from ballscrew_monitor.settings.parameter_table import AXIS_ROWS, NODE_ROWS
from ballscrew_monitor.settings.parameters import default_of, NODE_NAME

TREE = Path(__file__).resolve().parent.parent


def main() -> int:
    """Write the files."""
    for path, text in pages().items():
        path.write_text(text, encoding='utf-8')
    return 0


def pages() -> dict[Path, str]:
    """Return what each file is to hold."""
    page = TREE / 'docs' / 'reference' / 'parameters.md'
    table = re.compile(r'^\| parameter \|.*^\|[^\n]*\n', re.MULTILINE | re.DOTALL)
    text = table.sub(lambda found: markdown_table(), page.read_text(encoding='utf-8'))
    return {TREE / 'config' / 'example.yaml': example_yaml(), page: text}


def example_yaml() -> str:
    """Return the example parameter file: every parameter of one axis, with its comment."""
    lines = [
        '# Every parameter of ballscrew_monitor with its default, made from the table in',
        '# ballscrew_monitor/settings/parameter_table.py. Numbers need a decimal point.',
        f'/**/{NODE_NAME}:',
        '  ros__parameters:',
    ]
    for row in NODE_ROWS:
        lines += example_lines(row, row.name, row.name, 4)
    lines += ['    # Axis x; each axis of `axes` has such a group.', '    x:']
    group = ''
    for row in AXIS_ROWS:
        head, _, leaf = row.name.rpartition('.')
        if head != group and head:
            lines.append(f'      {head}:')
        group = head
        lines += example_lines(row, f'x.{row.name}', leaf, 8 if head else 6)
    return '\n'.join(lines) + '\n'


def example_lines(row: ParameterRow, name: str, leaf: str, indent: int) -> list[str]:
    space = ' ' * indent
    unit = f'[{row.unit}]' if row.unit else ''
    allowed = f'Allowed: {row.allowed}.' if row.allowed else ''
    said = (f'{row.text.rstrip(".")}.', unit, allowed, f'Changes {row.change.value}.')
    facts = filter(None, said)
    return [f'{space}# {" ".join(facts)}', f'{space}{leaf}: {yaml_of(default_of(name, row))}']


def yaml_of(value: Any) -> str:
    if isinstance(value, bool):
        return 'true' if value else 'false'
    return repr(value)


def markdown_table() -> str:
    """Return the table of all parameters for docs/reference/parameters.md."""
    lines = [
        '| parameter | default | allowed | unit | changes | meaning |',
        '|---|---|---|---|---|---|',
    ]
    for prefix, rows in (('', NODE_ROWS), ('<axis>.', AXIS_ROWS)):
        for row in rows:
            default = str(row.default).replace('{axis}', '<axis>')
            lines.append(
                f'| `{prefix}{row.name}` | `{default}` | {row.allowed} | {row.unit} '
                f'| {row.change.value} | {row.text} |'
            )
    return '\n'.join(lines) + '\n'


if __name__ == '__main__':
    sys.exit(main())
