# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The pages of docs/reference and config/example.yaml, made from what declares each name."""

import argparse
import ast
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields, is_dataclass, MISSING
from pathlib import Path
import sys
from types import SimpleNamespace
from typing import Any

from ballscrew_monitor import cli
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.page.metrics import HubCollector
from ballscrew_monitor.recordings.tables import mapping
from ballscrew_monitor.recordings.tables.quantities import UNITS
from ballscrew_monitor.settings.parameter_row import ParameterRow
from ballscrew_monitor.settings.parameter_table import AXIS_ROWS, NODE_ROWS
from ballscrew_monitor.settings.parameters import default_of, NODE_NAME
from surrogate.contact import case
from surrogate.contact import record as contact_record
from surrogate.files.datasheet import key_of
from surrogate.parameters import Lubricant, Material, Screw
from surrogate.raceway.stated import BallRoughness, Roughness
from surrogate.screw import full_record, record, sensitivity

TREE = Path(__file__).resolve().parent.parent
REFERENCE = TREE / 'docs' / 'reference'
MADE = 'Made by `python scripts/reference.py` from `{}`.'
KEYS_ON_FILE = (
    'YAML. Keys carry their unit. A key without a default is needed; one with `-` may be left out.'
)
Rows = Iterable[Sequence[object]]


def main() -> int:
    """Write the files."""
    for path, text in pages().items():
        path.write_text(text, encoding='utf-8')
    return 0


def pages() -> dict[Path, str]:
    """Return what each file holds."""
    made = {
        'parameters.md': parameter_page(),
        'datasheets.md': datasheet_page(),
        'case.md': case_page(),
        'messages.md': message_page(),
        'faults.md': fault_page(),
        'commands.md': command_page(),
        'json.md': json_page(),
        'map.md': map_page(),
        'metrics.md': metrics_page(),
    }
    references = {REFERENCE / name: text for name, text in made.items()}
    return {TREE / 'config' / 'example.yaml': example_yaml(), **references}


def page(title: str, source: str, *parts: str) -> str:
    """Return a page with its title, where its content is declared, and its parts."""
    return '\n\n'.join([f'# {title}', MADE.format(source), *filter(None, parts)]) + '\n'


def table(heads: Sequence[str], rows: Rows) -> str:
    """Return a table in Markdown."""
    lines = [heads, ['---'] * len(heads), *rows]
    cells = (' | '.join(str(cell).replace('|', '\\|') for cell in line) for line in lines)
    return '\n'.join(f'| {line} |'.replace('|  |', '| |') for line in cells)


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


def parameter_page() -> str:
    """Return the page of all parameters of the node."""
    rows = []
    for prefix, declared in (('', NODE_ROWS), ('<axis>.', AXIS_ROWS)):
        for row in declared:
            default = str(row.default).replace('{axis}', '<axis>')
            name = f'`{prefix}{row.name}`'
            changes = row.change.value
            rows.append([name, f'`{default}`', row.allowed, row.unit, changes, row.text])
    heads = ['parameter', 'default', 'allowed', 'unit', 'changes', 'meaning']
    axes = '`<axis>` is each name in `axes`. Numbers need a decimal point in YAML.'
    source = 'ballscrew_monitor/settings/parameter_table.py'
    return page('Parameters', source, axes, table(heads, rows))


def datasheet_page() -> str:
    """Return the page of the sheets of screws and oils."""
    sheets = {
        'Screw': Screw,
        'Steel, `raceway` and `ball`': Material,
        'Raceway, `roughness`': Roughness,
        'Balls, `ball_roughness`': BallRoughness,
        'Oil': Lubricant,
    }
    return page('Datasheets', 'surrogate/parameters.py', KEYS_ON_FILE, *sheet_parts(sheets))


def case_page() -> str:
    """Return the page of the case of one contact."""
    cases = {
        'Case': case.ContactCase,
        '`roughness`': case.CaseRoughness,
        '`grid`': case.CaseGrid,
        '`domain`': case.CaseDomain,
        '`strip`': case.CaseStrip,
    }
    source = 'surrogate/contact/case.py'
    return page('The case of one contact', source, KEYS_ON_FILE, *sheet_parts(cases))


def sheet_parts(sheets: dict[str, type]) -> Iterator[str]:
    for title, sheet in sheets.items():
        yield f'## {title}'
        assert is_dataclass(sheet)
        rows = [sheet_row(spec) for spec in fields(sheet)]
        yield table(['key', 'default', 'allowed', 'meaning'], rows)


def sheet_row(spec: Any) -> list[str]:
    rules = spec.metadata
    allowed = rules.get('allowed', ', '.join(map(str, rules.get('choice', ()))))
    if 'low' in rules:
        allowed = f'{rules["low"]:g} to {rules["high"]:g}'
    if 'block' in rules:
        allowed = 'a block of keys'
    return [f'`{key_of(spec)}`', sheet_default(spec), allowed, rules['means']]


def sheet_default(spec: Any) -> str:
    """Return the default on file: nothing if the key is needed, `-` if it may be absent."""
    default, rules = spec.default, spec.metadata
    if default is MISSING:
        return ''
    if default in (None, ()):
        return '-'
    if 'factor' in rules:
        return f'{default / rules["factor"] - rules["shift"]:g}'
    return str(default)


VERSIONS = """\
Interfaces grow by fields at the end of a message, and no field changes its meaning: programs that
use them build again without a change, and a bag is read by the definitions that it holds. On the
wire versions do not mix. Of a message with a field more at its very end an older subscriber reads
the fields that it knows; a newer subscriber cannot decode the older message, and logs that or
hears nothing; behind a nested message that has grown, and in services, values are wrong or
missing. Give node, page and listeners of a domain one version of `ballscrew_msgs`."""


def message_page() -> str:
    """Return the page of all messages, services and the action."""
    parts = [VERSIONS]
    for path in sorted((TREE / 'msg_defs').glob('*/*.*')):
        if path.suffix in ('.msg', '.srv', '.action'):
            parts += [f'## {path.stem}', *message_parts(path)]
    return page('Messages, services, action', 'msg_defs', *parts)


def message_parts(path: Path) -> Iterator[str]:
    """Yield what a file of interfaces is for, and the table of each of its sections."""
    lines = path.read_text(encoding='utf-8').splitlines()
    begin = next(number for number, line in enumerate(lines) if not line.startswith('#'))
    yield ' '.join(line.strip('# ') for line in lines[:begin])
    names = {'.srv': ('request', 'response'), '.action': ('goal', 'result', 'feedback')}
    sections = '\n'.join(lines[begin:]).split('\n---\n')
    for name, section in zip(names.get(path.suffix, ('field',)), sections, strict=True):
        rows = list(message_rows(section.splitlines()))
        if rows:
            yield table([name, 'type', 'meaning'], rows)


def message_rows(lines: Iterable[str]) -> Iterator[list[str]]:
    """
    Yield names, type and meaning; names with one comment and type have one row.

    The comment of a field holds up to the next one or an empty line, that of a constant for it.

    """
    comment: list[str] = []
    row: list[str] = []
    for line in [*lines, '']:
        if line.startswith('#') or not line.strip():
            if row:
                yield row
                row, comment = [], []
            comment = [*comment, line.strip('# ')] if line.strip() else []
            continue
        declaration, _, beside = line.partition('#')
        kind, name = declaration.split(maxsplit=1)
        name, equal, number = (part.strip() for part in name.partition('='))
        shown = f'`{name}`{f" {number}" if equal else ""}'
        if row and equal:
            comment = []
        meaning = ' '.join(comment) or beside.strip() or '-'
        if row and row[1:] == [kind, meaning]:
            row[0] += f', {shown}'
            continue
        if row:
            yield row
        row = [shown, kind, meaning]


def fault_page() -> str:
    """Return the page of all faults, with their codes and cures."""
    rows = [[int(one), one.name, one.status, one.text, one.cure] for one in Fault]
    heads = ['code', 'name', 'status', 'what is wrong', 'what to do']
    codes = (
        'Every status of `/diagnostics` has its code as the value `Code`; a number keeps its '
        'meaning for ever. If a status names several faults, the code is that of the first one. '
        '`REFUSED`, `GLITCHES` and `LOST` stay for ten seconds after the last such message. '
        'A code above 0 beside the level OK is a warning that is shelved or that '
        '`warning.policy` does not ask for, or a health that is not known.'
    )
    return page('Faults', 'ballscrew_monitor/core/fault_codes.py', codes, table(heads, rows))


def command_page() -> str:
    """Return the page of all commands with their options and exit codes."""
    parts = [table(['exit code', 'meaning'], cli.EXIT_CODES.items())]
    for words, text, parser in commands(cli.command_parser()):
        parts += [f'## {words}', f'{text[0].upper()}{text[1:]}.', parser.epilog or '']
        rows = [option_row(parser, action) for action in parser._actions]
        parts.append(table(['option', 'meaning'], filter(None, rows)))
    return page('Commands', 'ballscrew_monitor/options.py` and `surrogate/commands', *parts)


def commands(parser: argparse.ArgumentParser) -> Iterator[tuple[str, str, Any]]:
    """Yield words, help and parser of each command that does something."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            helps = {choice.dest: choice.help or '' for choice in action._choices_actions}
            for name, child in action.choices.items():
                below = list(commands(child))
                yield from below or [(child.prog, helps[name], child)]


def option_row(parser: argparse.ArgumentParser, action: argparse.Action) -> list[str]:
    if isinstance(action, argparse._HelpAction):
        return []
    value = parser._get_formatter()._format_args(action, str(action.metavar or action.dest))
    if action.option_strings and action.metavar is None and action.nargs != 0:
        value = '|'.join(map(str, action.choices or [action.dest.upper()]))
    words = ' '.join(filter(None, [', '.join(action.option_strings), value]))
    text = (action.help or '') % {'default': action.default, 'prog': parser.prog}
    return [f'`{words}`', text]


def json_page() -> str:
    """Return the page of the keys that commands print with `--json`."""
    records = {
        '`ballscrew point`, both tiers': record.KEYS,
        '`ballscrew point --tier full`, besides': full_record.KEYS,
        'Each of `contacts`': record.CONTACT_KEYS,
        'Each of `contacts`, full tier, besides': full_record.CONTACT_KEYS,
        '`ballscrew point --sensitivity`': sensitivity.KEYS,
        '`ballscrew contact`': contact_record.KEYS,
        '`ballscrew contact`, a roughness that rolls': contact_record.ROLLING_KEYS,
    }
    parts = ['Units are SI and part of the key. A number that is not known is `null`.']
    for title, keys in records.items():
        rows = [[f'`{key}`', meaning] for key, meaning in keys.items()]
        parts += [f'## {title}', table(['key', 'meaning'], rows)]
    return page('Keys of `--json`', 'surrogate/screw` and `surrogate/contact', *parts)


def map_page() -> str:
    """Return the page of the map of a table, and of the limits of files."""
    rows = [[f'`{place}`', map_allowed(place), text] for place, text in mapping.PLACES.items()]
    units = [[kind, ', '.join(names)] for kind, names in UNITS.items()]
    return page(
        'The map of a table',
        'ballscrew_monitor/recordings/tables/mapping.py',
        'A value stands in its place, or under `assumed` as '
        '`x.lead_mm: {value: 10.0, reason: ...}`, not in both. `AXIS` is a name below `axes`.',
        table(['place', 'allowed', 'meaning'], rows),
        '## Units',
        'A column is `{column: NAME, unit: UNIT, scale: 1.0, offset: 0.0}`; the unit is that '
        'after scale and offset.',
        table(['column', 'units'], units),
        '## Limits of files',
        'A file beyond a limit is refused in one sentence; a chunk or a message beyond its limit '
        'is left out and counted. A workbook, arrays, and a large text of signals are read by a '
        'process that may use `MEMORY`, and are refused if it ends before they are read. Declared '
        'in `surrogate/files/limits.py`.',
        table(['limit', 'value', 'meaning'], limit_rows()),
    )


def map_allowed(place: str) -> str:
    leaf = place.rpartition('.')[2]
    bounds = {**mapping.NUMBERS, **mapping.LINES}.get(leaf)
    return f'{bounds[0]:g} to {bounds[1]:g}' if bounds else ''


def limit_rows() -> Iterator[list[str]]:
    """Yield name, value and meaning of each limit, which stands below its value."""
    from surrogate.files import limits

    lines = ast.parse(Path(limits.__file__).read_text(encoding='utf-8')).body
    for line, text in zip(lines, lines[1:], strict=False):
        if isinstance(line, ast.Assign) and isinstance(text, ast.Expr):
            (target,) = line.targets
            assert isinstance(target, ast.Name)
            meaning = ' '.join(str(ast.literal_eval(text.value)).split())
            yield [f'`{target.id}`', limit_of(getattr(limits, target.id), meaning), meaning]


def limit_of(value: int, meaning: str) -> str:
    return f'{value / 1e6:g} MB' if '[byte]' in meaning else f'{value}'


def metrics_page() -> str:
    """Return the page of the numbers for Prometheus."""
    hub: Any = SimpleNamespace(axes={}, browsers=[], dropped=0, missed=0)
    endings = {'counter': '_total', 'gauge': ''}
    rows = [
        [f'`{one.name}{endings[one.type]}`', ', '.join(one._labelnames), one.documentation]
        for one in HubCollector(hub, lambda: 0).collect()
    ]
    return page(
        'Metrics of the live page',
        'ballscrew_monitor/page/metrics.py',
        '`/metrics` of `ballscrew page`, in OpenMetrics. A number that is not judged is NaN.',
        table(['name', 'labels', 'meaning'], rows),
    )


if __name__ == '__main__':
    sys.exit(main())
