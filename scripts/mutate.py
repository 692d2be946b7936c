# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mutation of the sources: a seeded sample of small changes, each of which some test has to notice.

A mutant is run by the tests that mirror its file and that COVERED names, up to the first failure,
in a process forked for it. The compiler is off unless the tests need it and the file has no
kernel; the tree is never touched. At least 90 % of the sampled mutants must be caught. What
changes nothing that can be seen is listed with its reason in test/data/equivalent_mutants.txt.
Pictures are left out: no test reads how they look.

"""

import argparse
import ast
from collections.abc import Iterator
import gc
from importlib.machinery import SourceFileLoader
import itertools
import os
from pathlib import Path
import random
import signal
import sys
import tempfile
import time
from typing import Any, NamedTuple, NoReturn

TREE = Path(__file__).resolve().parent.parent
ROOMS = ('ballscrew_monitor/judge', 'surrogate/surface', 'surrogate/screw')
EQUIVALENT = TREE / 'test' / 'data' / 'equivalent_mutants.txt'
COVERED = {
    'ballscrew_monitor/judge/derived_load.py': 'point golden',
    'ballscrew_monitor/judge/inputs.py': 'step monitor golden',
    'ballscrew_monitor/judge/monitor.py': 'step point snapshot golden',
    'ballscrew_monitor/judge/point.py': 'step golden',
    'ballscrew_monitor/judge/records.py': 'snapshot inputs zone point monitor step',
    'ballscrew_monitor/judge/slopes.py': 'point step',
    'ballscrew_monitor/judge/step.py': 'monitor golden',
    'ballscrew_monitor/judge/views.py': 'inputs zone monitor step golden',
    'ballscrew_monitor/judge/zone.py': 'monitor step golden',
    'surrogate/surface/correction.py': 'interpolate',
    'surrogate/surface/fields.py': 'solved file',
    'surrogate/surface/hermite.py': 'interpolate lookup',
    'surrogate/surface/interpolate.py': 'load_scan tables lookup correction',
    'surrogate/surface/load_scan.py': 'correction',
    'surrogate/surface/lookup.py': 'tables correction',
    'surrogate/surface/point.py': 'solved lookup',
    'surrogate/surface/tables.py': 'load_scan lookup correction',
    'surrogate/screw/ball_equations.py': 'ball_balance',
    'surrogate/screw/ball_motion.py': 'ball_traction ball_balance',
    'surrogate/screw/ball_result.py': 'ball_balance',
    'surrogate/screw/ball_sums.py': 'ball_traction',
    'surrogate/screw/ball_traction.py': 'ball_balance',
    'surrogate/screw/closed_form_record.py': 'full_record',
    'surrogate/screw/contacts.py': 'solve full_record',
    'surrogate/screw/nut.py': 'solve full_record',
    'surrogate/screw/record.py': 'closed_form_record full_record',
    'surrogate/screw/screw_onset.py': 'sensitivity',
    'surrogate/screw/solve.py': 'full_record',
    'surrogate/screw/uncertain_inputs.py': 'sensitivity',
}
"""Tests of a file beside the one that mirrors it, in the same folder; quick ones first."""
PICTURES = ('surrogate/screw/figures.py',)
KERNELS = 'surrogate/screw/ball_sums.py'
"""What is compiled wherever it runs, and so is only changed with the compiler off."""
COMPILING = (
    'ballscrew_monitor/judge/many.py',
    'surrogate/surface/batch.py',
    'surrogate/surface/compiled.py',
)
"""Files that have others compiled: each mutant begins with an empty cache."""
ENOUGH = 0.9  # part of the mutants that must be caught
PATIENCE = 30.0, 5.0  # [s] for a run, and that many times what the tests take without a mutant
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


class Mutant(NamedTuple):
    """A change of a file: where, what is there, what it becomes, and the line it begins in."""

    path: str
    function: str
    begin: int  # [B] of the file
    end: int
    before: str
    after: str
    line: str

    @property
    def name(self) -> str:
        """Return what names it in the list of equivalents, wherever its line moves."""
        return f'{self.path} {self.function}: {self.before} -> {self.after} in {self.line}'


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
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        function = f'{function}.{node.name}'.strip('.')
    yield function, node
    left_out = {'annotation', 'returns', 'decorator_list', 'type_params'}
    for field, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and field not in left_out:
                yield from nodes(child, function)


def mutants(path: Path) -> Iterator[Mutant]:
    """Yield all mutants of a file."""
    content = path.read_bytes()
    lines = content.splitlines(keepends=True)
    starts = list(itertools.accumulate(map(len, lines), initial=0))
    for function, node in nodes(ast.parse(content)):
        after = changed(node)
        if after is not None and isinstance(node, ast.expr):
            begin = starts[node.lineno - 1] + node.col_offset
            end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
            line = lines[node.lineno - 1].decode().strip()
            texts = ast.unparse(node), f'({ast.unparse(after)})', line
            yield Mutant(str(path.relative_to(TREE)), function, begin, end, *texts)


def tests_of(path: str) -> tuple[str, ...]:
    """Return the files of the tests of a source."""
    folder, names = Path('test', path).parent, [Path(path).stem, *COVERED.get(path, '').split()]
    found = (folder / f'test_{name}.py' for name in names)
    return tuple(str(one) for one in found if (TREE / one).exists())


def set_compiler(path: str, cache: str) -> None:
    """Let the tests of a source compile, where it matters into a `cache`, or switch that off."""
    import numba

    if path in COMPILING:
        os.environ['NUMBA_CACHE_DIR'] = cache
    elif path == KERNELS or not path.startswith(ROOMS[2]):
        os.environ['NUMBA_DISABLE_JIT'] = '1'
    numba.config.reload_config()


def substitute(mutant: Mutant) -> None:
    """Have the file of a mutant imported as it is with the change, whatever is cached of it."""
    target = TREE / mutant.path
    before = target.read_bytes()
    head, tail = before[: mutant.begin], before[slice(mutant.end, None)]
    content = head + mutant.after.encode() + tail
    original = SourceFileLoader.get_code

    def get_code(loader: SourceFileLoader, name: str) -> Any:
        if Path(loader.path) == target:
            return compile(content, str(target), 'exec', dont_inherit=True)
        return original(loader, name)

    SourceFileLoader.get_code = get_code  # type: ignore[assignment, method-assign]


def passes(path: str, mutant: Mutant | None, limit: float) -> bool:
    """Tell whether the tests of a source pass within `limit` [s] in a process of their own."""
    with tempfile.TemporaryDirectory() as cache:
        process = os.fork()
        if process == 0:
            run(path, mutant, limit, cache)
        return os.waitpid(process, 0)[1] == 0


def run(path: str, mutant: Mutant | None, limit: float, cache: str) -> NoReturn:
    """Run the tests of a source and leave the process, with 0 if they pass."""
    import pytest

    gc.freeze()  # what the other process has left is not to be destroyed in this one
    signal.alarm(round(limit))  # which kills
    for stream in (1, 2):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
    set_compiler(path, cache)
    if mutant:
        substitute(mutant)
    options = ['-x', '-q', '-p', 'no:cacheprovider', '-p', 'no:xdist', '-p', 'no:randomly']
    if 'NUMBA_DISABLE_JIT' in os.environ:
        options += ['-k', 'not test_compiled_']
    os._exit(int(pytest.main([*options, *(str(TREE / one) for one in tests_of(path))])))


def main() -> int:
    """Run a sample of mutants; return 0 if enough of them are caught."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').strip().splitlines()[0])
    parser.add_argument('paths', nargs='*', default=ROOMS, help='files or folders')
    parser.add_argument('--sample', type=int, default=100, help='how many mutants')
    parser.add_argument('--seed', type=int, default=1)
    asked = parser.parse_args()
    os.environ['HYPOTHESIS_PROFILE'] = 'mutate'
    import numba  # noqa: F401  once, and not in each process
    import scipy.optimize  # noqa: F401

    sys.path.insert(0, str(TREE))
    folders = [TREE / path for path in asked.paths]
    files = [path for one in folders for path in ([one] if one.is_file() else one.glob('*.py'))]
    lines = EQUIVALENT.read_text().splitlines()
    equivalent = {line.partition('  # ')[0] for line in lines}
    found = [one for path in sorted(files) for one in mutants(path)]
    found = [one for one in found if one.path not in PICTURES]
    if untested := sorted({one.path for one in found if not tests_of(one.path)}):
        print(f'no test mirrors {", ".join(untested)}, and COVERED names none', file=sys.stderr)
        return 2
    sample = random.Random(asked.seed).sample(found, min(asked.sample, len(found)))
    chosen = [one for one in sample if one.name not in equivalent]
    limits: dict[str, float] = {}
    caught, start = 0, time.monotonic()
    for number, mutant in enumerate(sorted(chosen), start=1):
        if mutant.path not in limits:
            begin = time.monotonic()
            if not passes(mutant.path, None, 3600.0):
                print(f'tests of {mutant.path} fail without any mutant', file=sys.stderr)
                return 2
            limits[mutant.path] = PATIENCE[0] + PATIENCE[1] * (time.monotonic() - begin)
        survives = passes(mutant.path, mutant, limits[mutant.path])
        caught += not survives
        minutes = (time.monotonic() - start) / 60
        what = 'nothing notices' if survives else 'caught'
        print(f'{number} of {len(chosen)}, {minutes:.0f} min, {what}: {mutant.name}', flush=True)
    print(f'{caught} of {len(chosen)} mutants caught, out of {len(found)} (seed {asked.seed})')
    return 0 if caught >= ENOUGH * len(chosen) else 1


if __name__ == '__main__':
    sys.exit(main())
