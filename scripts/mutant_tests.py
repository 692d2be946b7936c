# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tests that may notice a change of a source: those of the mirrored folder, and its importers."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

TREE = Path(__file__).resolve().parent.parent
ROOTS = ('', 'bags', 'test/golden')  # where imports are looked for
FAR = 3  # imports between a test and a source, one more from another folder


def candidates(source: str) -> list[str]:
    """Return the test files that may notice a change of a source, the nearest ones first."""
    mirror = Path('test', source)
    distances = {mirror.with_name(f'test_{mirror.name}'): 0}
    for test in tests():
        distance = imports_between(test).get(source, FAR)
        folder = test.parent == mirror.parent
        distances.setdefault(test, min(distance, FAR) if folder else distance + 1)
    near = [test for test in sorted(distances) if distances[test] <= FAR]
    return [str(test) for test in sorted(near, key=distances.__getitem__) if is_file(test)]


def is_file(path: Path) -> bool:
    """Return True if a path of the tree is a file."""
    return (TREE / path).is_file()


@cache
def tests() -> list[Path]:
    """Return all test files, from the root of the tree."""
    return [path.relative_to(TREE) for path in sorted((TREE / 'test').rglob('test_*.py'))]


@cache
def imports_between(test: Path) -> dict[str, int]:
    """Return the sources that a test file imports, with the number of imports on the way."""
    distances, waiting = {str(test): 0}, [str(test)]
    for path in waiting:  # which grows
        further = imported(path)
        if path == str(test):
            folders = [folder / 'conftest.py' for folder in test.parents]
            further = further | {str(one) for one in folders[:-2] if is_file(one)}
        for one in sorted(further - distances.keys()):
            distances[one] = distances[path] + 1
            waiting.append(one)
    return distances


@cache
def imported(path: str) -> frozenset[str]:
    """Return the files of the tree that a file imports somewhere, or names as modules."""
    content = ast.parse((TREE / path).read_bytes())
    names = (name for node in ast.walk(content) for name in _names(node))
    return frozenset(file for name in names for file in _files(name))


def _names(node: ast.AST) -> Iterator[str]:
    match node:
        case ast.Import(aliases):
            yield from (alias.name for alias in aliases)
        case ast.ImportFrom(str() as module, aliases, 0):
            yield from (f'{module}.{alias.name}' for alias in aliases)
        case ast.Constant(str() as text) if text.startswith(('ballscrew_monitor.', 'surrogate.')):
            yield text


@cache
def _files(name: str) -> tuple[str, ...]:
    """Return the file of a module, or of the module that a name is imported from, if any."""
    for module in (name, name.rpartition('.')[0]):
        path = Path(*module.split('.')) if module else Path('-')
        for root in ROOTS:
            for file in (root / path.with_suffix('.py'), root / path / '__init__.py'):
                if len(str(file)) < 200 and is_file(file):
                    return (str(file),)
    return ()
