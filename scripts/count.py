# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Count of the sources: size and granularity of both packages and of their rooms.

A code line is neither blank nor a comment nor part of a docstring. The body of a function is
counted without its docstring. A record type is a dataclass or a NamedTuple. A private function
is named once if one function of both packages has its name, and one other place names it. The
lines of tests of a room are those of the folder that mirrors it; tests of no package are in the
total.

"""

import argparse
import ast
from collections import Counter
from pathlib import Path
import tokenize
from typing import NamedTuple

TREE = Path(__file__).resolve().parent.parent
PACKAGES = 'ballscrew_monitor', 'surrogate'
NO_CODE = {
    *(tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT),
    *(tokenize.ENCODING, tokenize.ENDMARKER),
}
FUNCTIONS = ast.FunctionDef, ast.AsyncFunctionDef
HEADS = 'lines', 'code', 'functions', 'p90 of a body', 'records', 'named once', 'test lines'


class Source(NamedTuple):
    """Counts of one file, with the names of its private functions and the names that it uses."""

    room: str
    lines: int
    code: int
    bodies: list[int]
    records: int
    private: list[str]
    used: Counter[str]


def main() -> int:
    """Print a table of the rooms, or two lines on the whole."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').strip().partition('\n')[0])
    parser.add_argument('--tree', type=Path, default=TREE, help='folder of the packages')
    parser.add_argument('--summary', action='store_true', help='print two lines alone')
    arguments = parser.parse_args()
    rows = table(arguments.tree)
    if arguments.summary:
        print('\n'.join(summary(rows)))
        return 0
    print(f'{"":32}', *(f'{head:>13}' for head in HEADS))
    for room, counts in rows.items():
        print(f'{room:32}', *(f'{count:13}' for count in counts))
    return 0


def table(tree: Path) -> dict[str, tuple[int, ...]]:
    """Return the counts of HEADS for each room, each package and both together, 'total'."""
    sources = [
        source_of(path, room_of(path.relative_to(tree)))
        for package in PACKAGES
        for path in sorted((tree / package).rglob('*.py'))
    ]
    defined = Counter(name for source in sources for name in source.private)
    used = sum((source.used for source in sources), Counter[str]())
    once = {name for name in defined if defined[name] == used[name] == 1}
    rows = {}
    for package in PACKAGES:
        inside = [source for source in sources if source.room.partition('/')[0] == package]
        for room in sorted({source.room for source in inside} - {package}):
            in_room = [source for source in inside if source.room == room]
            rows[room] = _counts(in_room, once, tree, room)
        rows[package] = _counts(inside, once, tree, package)
    rows['total'] = _counts(sources, once, tree, '')
    return rows


def _counts(sources: list[Source], once: set[str], tree: Path, room: str) -> tuple[int, ...]:
    bodies = sorted(length for source in sources for length in source.bodies)
    tests = (tree / 'test' / room).rglob('*.py')
    return (
        sum(source.lines for source in sources),
        sum(source.code for source in sources),
        len(bodies),
        bodies[len(bodies) * 9 // 10] if bodies else 0,
        sum(source.records for source in sources),
        sum(name in once for source in sources for name in source.private),
        sum(len(path.read_text(encoding='utf-8').splitlines()) for path in tests),
    )


def room_of(path: Path) -> str:
    """Return the folder of a package that holds a file, or the package itself."""
    return '/'.join(path.parts[:2] if len(path.parts) > 2 else path.parts[:1])


def source_of(path: Path, room: str) -> Source:
    """Return the counts of a file of a room."""
    text = path.read_text(encoding='utf-8')
    nodes = [*ast.walk(ast.parse(text))]
    functions = [node for node in nodes if isinstance(node, FUNCTIONS)]
    names = [node.name for node in functions]
    return Source(
        room,
        lines=len(text.splitlines()),
        code=len(_code_lines(path) - _docstring_lines(nodes)),
        bodies=[_body_length(function) for function in functions],
        records=sum(isinstance(node, ast.ClassDef) and _is_record(node) for node in nodes),
        private=[name for name in names if name.startswith('_') and not name.startswith('__')],
        used=Counter(name for node in nodes if (name := _name(node))),
    )


def _code_lines(path: Path) -> set[int]:
    with tokenize.open(path) as file:
        tokens = list(tokenize.generate_tokens(file.readline))
    spans = [(token.start[0], token.end[0]) for token in tokens if token.type not in NO_CODE]
    return {line for begin, end in spans for line in range(begin, end + 1)}


def _docstring_lines(nodes: list[ast.AST]) -> set[int]:
    owners = [node for node in nodes if isinstance(node, (ast.Module, ast.ClassDef, *FUNCTIONS))]
    texts = [node.body[0] for node in owners if ast.get_docstring(node) is not None]
    return {line for text in texts for line in range(text.lineno, (text.end_lineno or 0) + 1)}


def _body_length(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    begin = 0 if ast.get_docstring(function) is None else 1
    body = function.body[begin:]
    return (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0


def _is_record(node: ast.ClassDef) -> bool:
    words = [ast.unparse(part) for part in (*node.decorator_list, *node.bases)]
    names = {word.partition('(')[0].rpartition('.')[2] for word in words}
    return not names.isdisjoint({'dataclass', 'NamedTuple'})


def _name(node: ast.AST) -> str | None:
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name) | ast.alias(name=name):
            return name.rpartition('.')[2]
    return None


def summary(rows: dict[str, tuple[int, ...]]) -> list[str]:
    """Return two lines on both packages together."""
    lines, code, functions, length, records, once, tests = rows['total']
    return [
        f'{lines} lines, {code} of code, in {functions} functions with bodies of at most '
        f'{length} lines in nine of ten;',
        f'{records} record types, {once} private functions named once; {tests} lines of tests',
    ]


if __name__ == '__main__':
    raise SystemExit(main())
