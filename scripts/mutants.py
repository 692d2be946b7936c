# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Mutants of the sources: one operator or number of an expression changed, and a sample."""

import ast
from collections import Counter
from collections.abc import Iterator, Sequence
import dataclasses
import itertools
from pathlib import Path
import random

TREE = Path(__file__).resolve().parent.parent
PACKAGES = ('ballscrew_monitor', 'surrogate')
EQUIVALENT = TREE / 'test' / 'data' / 'equivalent_mutants.txt'
SWAPS: dict[type, type] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.And: ast.Or,
    ast.Or: ast.And,
}


@dataclasses.dataclass(frozen=True, order=True)
class Mutant:
    """A change of a file: where, what is there, what it becomes, and the line it begins in."""

    path: str
    function: str
    begin: int  # [B] of the file
    end: int
    before: str
    after: str
    line: str
    repeat: int = 1  # number of the like change in like lines of the function

    @property
    def name(self) -> str:
        """Return what names it in lists, wherever its line moves."""
        number = f' ({self.repeat})' if self.repeat > 1 else ''
        change = f'{self.before} -> {self.after} in {self.line}'
        return f'{self.path} {self.function}: {change}{number}'

    @property
    def room(self) -> str:
        """Return the folder of its file."""
        return str(Path(self.path).parent)


def changed(node: ast.AST) -> ast.AST | None:
    """Return what a node becomes, or None if it stays."""
    swap = SWAPS.get(type(getattr(node, 'op', None)))
    match node:
        case ast.BinOp(left, _, right) if swap:
            return ast.BinOp(left, swap(), right)
        case ast.BoolOp(_, values) if swap:
            return ast.BoolOp(swap(), values)
        case ast.Compare(left, [first, *rest], others) if type(first) in SWAPS:
            return ast.Compare(left, [SWAPS[type(first)](), *rest], others)
        case ast.UnaryOp(ast.USub() | ast.Not(), operand):
            return operand
        case ast.Constant(bool() as value):
            return ast.Constant(not value)
        case ast.Constant(int() | float() as value):
            return ast.Constant(value + 1 if isinstance(value, int) else 1.25 * value or 1.0)
    return None


def nodes(node: ast.AST, function: str = '') -> Iterator[tuple[str, ast.AST]]:
    """Yield what can be changed with its function: no annotation, decorator or assertion."""
    if isinstance(node, ast.Raise | ast.Assert | ast.JoinedStr):
        return
    if isinstance(node, ast.keyword) and node.arg == 'strict':  # of zip, an assertion too
        return
    if isinstance(node, ast.BinOp) and _is_text(node):
        return
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        function = f'{function}.{node.name}'.strip('.')
    yield function, node
    left_out = {'annotation', 'returns', 'decorator_list', 'type_params'}
    for field, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and field not in left_out:
                yield from nodes(child, function)


def _is_text(node: ast.BinOp) -> bool:
    """Return True if an operand of a sum is written as text, whose difference is an error."""
    return any(
        isinstance(operand, ast.JoinedStr)
        or (isinstance(operand, ast.Constant) and isinstance(operand.value, str))
        for operand in (node.left, node.right)
    )


def mutants(path: Path) -> Iterator[Mutant]:
    """Yield all mutants of a file."""
    content = path.read_bytes()
    lines = content.splitlines(keepends=True)
    starts = list(itertools.accumulate(map(len, lines), initial=0))
    repeats: Counter[tuple[str, ...]] = Counter()
    for function, node in nodes(ast.parse(content)):
        after = changed(node)
        if after is not None and isinstance(node, ast.expr):
            begin = starts[node.lineno - 1] + node.col_offset
            end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
            line = lines[node.lineno - 1].decode().strip()
            texts = ast.unparse(node), f'({ast.unparse(after)})', line
            repeats[(function, *texts)] += 1
            number = repeats[(function, *texts)]
            yield Mutant(str(path.relative_to(TREE)), function, begin, end, *texts, number)


def is_picture(path: Path) -> bool:
    """Return True if a file draws: no test reads how a picture looks."""
    content = path.read_text(encoding='utf-8')
    return 'import matplotlib' in content or 'from surrogate.plotting' in content


def sources(paths: Sequence[str] = PACKAGES) -> list[Path]:
    """Return the files of files and folders that have mutants to sample, in order."""
    folders = [TREE / path for path in paths]
    files = {
        path
        for folder in folders
        for path in ([folder] if folder.is_file() else folder.rglob('*.py'))
    }
    return sorted(path for path in files if not is_picture(path))


def sample(files: Sequence[Path], number: int, seed: int) -> list[Mutant]:
    """
    Return a seeded sample of the mutants of files, one of each stretch of equal length.

    So each room has its share, and so it does in the first half of them, whose order is random.
    The list of equivalents is left out.

    """
    lines = EQUIVALENT.read_text(encoding='utf-8').splitlines()
    equivalent = {line.partition('  # ')[0] for line in lines}
    everything = [mutant for path in files for mutant in mutants(path)]
    everything.sort(key=lambda mutant: (mutant.room, mutant))
    number, draw = min(number, len(everything)), random.Random(seed)
    bounds = [index * len(everything) // number for index in range(number + 1)]
    drawn = [everything[draw.randrange(*pair)] for pair in itertools.pairwise(bounds)]
    draw.shuffle(drawn)
    return [mutant for mutant in drawn if mutant.name not in equivalent]
