# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mutation of the sources: a seeded sample of small changes, each of which some test has to notice.

A mutant is run by the tests that mirror its file and by those that import it, the nearest first,
up to the first failure, in a process forked for it. The tree is never touched. At least 92 % of
the sampled mutants must be caught. A change without an effect is listed with its reason in
test/data/equivalent_mutants.txt. Pictures are left out: no test reads how they look.

With --matrix, each mutant runs against all tests of the mirrored folder, and the summary names the
tests that are nowhere the only ones to notice. Results are kept in build/mutants, a line for each
mutant, and a second call goes on from there; --again runs those once more that nothing noticed.

"""

import argparse
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
import gc
from importlib.machinery import SourceFileLoader
import os
from pathlib import Path
import resource
import signal
import sys
import tempfile
import time
from typing import Any, NamedTuple, NoReturn

from mutant_tests import candidates
from mutants import Mutant, PACKAGES, sample, sources

TREE = Path(__file__).resolve().parent.parent
RESULTS = TREE / 'build' / 'mutants'
INTERPRETED = ('ballscrew_monitor/judge/', 'surrogate/formulas/', 'surrogate/surface/')
"""Rooms compiled wherever many rows wait: their mutants, as kernels, run with the compiler off."""
COMPILING = (
    'ballscrew_monitor/judge/many.py',
    'surrogate/surface/batch.py',
    'surrogate/surface/compiled.py',
)
"""Files of these rooms that have others compiled."""
ENOUGH = 0.92  # part of the mutants that must be caught
COST = 30.0  # [s] that the tests of a mutant take together, beside the mirroring ones
GROUP = 8.0  # [s] of them, after which the next ones run in a process of their own
PATIENCE = 30.0, 5.0  # [s] of processor for a run, and that many times what it takes otherwise
LONGEST = 60.0  # [s] of processor for a file of tests without a mutant
HANG = 2.0  # times the limit of processor time: a run hangs that has not ended by then
NONE_COLLECTED, BROKEN = 5, 70  # exit codes: of pytest, and of a run that ends before it
SURVIVED, CAUGHT, TOO_LONG = 'survived', 'caught', 'too long'


class Run(NamedTuple):
    """What tests said in a process: verdict, and seconds and failure of each."""

    verdict: str
    tests: list[tuple[str, float, bool]]

    @property
    def failed(self) -> list[str]:
        """Return the tests that failed."""
        return [name for name, _, failed in self.tests if failed]


class Recorder:
    """A plugin of pytest that writes each test with its seconds and whether it failed."""

    def __init__(self, path: str) -> None:
        self.file = Path(path).open('a', buffering=1, encoding='utf-8')
        self.start = time.monotonic()
        self.failed = False

    def pytest_collectreport(self, report: Any) -> None:
        """Write down a file that cannot be imported."""
        if report.failed:
            self._write(report.nodeid, True)

    def pytest_runtest_logstart(self) -> None:
        """Begin with a test."""
        self.start, self.failed = time.monotonic(), False

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Keep whether a part of the test failed."""
        self.failed = self.failed or report.failed

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        """Write down the test."""
        self._write(nodeid, self.failed)

    def _write(self, name: str, failed: bool) -> None:
        seconds = time.monotonic() - self.start
        print(f'{seconds:.3f}\t{"failed" if failed else "passed"}\t{name}', file=self.file)


class Lines:
    """Lines of fields in a file that grows."""

    def __init__(self, name: str) -> None:
        RESULTS.mkdir(parents=True, exist_ok=True)
        self.path = RESULTS / name
        self.path.touch()

    def read(self) -> list[list[str]]:
        """Return the fields of each whole line."""
        lines = self.path.read_text(encoding='utf-8').splitlines(keepends=True)
        return [line[:-1].split('\t') for line in lines if line.endswith('\n')]

    def add(self, *fields: str) -> None:
        """Write a line, after what a broken one has left."""
        content = self.path.read_text(encoding='utf-8')
        with self.path.open('a', encoding='utf-8') as file:
            file.write('\n' * (content[-1:] not in ('', '\n')) + '\t'.join(fields) + '\n')


class Baseline:
    """Tests without a mutant, measured once: their seconds, and those that fail anyway."""

    def __init__(self) -> None:
        self.lines = Lines('baseline.tsv')
        self.seconds: dict[tuple[str, str], dict[str, float]] = defaultdict(dict)
        self.failing: set[tuple[str, str]] = set()
        for compiler, file, name, seconds, outcome in self.lines.read():
            self._keep(compiler, file, name, float(seconds), outcome == 'failed')

    def _keep(self, compiler: str, file: str, name: str, seconds: float, failed: bool) -> None:
        self.seconds[compiler, file][name] = seconds
        if failed:
            self.failing.add((compiler, name))

    def cost(self, compiler: str, file: str) -> float:
        """Return the seconds that a file of tests takes, measured on first need."""
        if (compiler, file) not in self.seconds:
            run = run_tests([file], None, compiler, LONGEST)
            tests = run.tests or [(file, 0.0, False)]
            if run.verdict == TOO_LONG:
                tests.append((file, LONGEST, True))
            for name, seconds, failed in tests:
                if failed:
                    print(f'{name} fails without any mutant (compiler {compiler})')
                self._keep(compiler, file, name, seconds, failed)
                outcome = 'failed' if failed else 'passed'
                self.lines.add(compiler, file, name, f'{seconds:.3f}', outcome)
        return sum(self.seconds[compiler, file].values())


def compiler_of(path: str) -> str:
    """Return how the tests of a source compile: off, into a fresh cache, or from the kept one."""
    if path in COMPILING:
        return 'fresh'
    text = (TREE / path).read_text(encoding='utf-8')
    compiles = any(word in text for word in ('@njit', 'surrogate.surface.compiled'))
    return 'off' if compiles or path.startswith(INTERPRETED) else 'kept'


def groups_of(path: str, baseline: Baseline, number: int) -> Iterator[list[str]]:
    """Yield the nearest test files of a source in groups, the mirroring one alone."""
    compiler = compiler_of(path)
    files = candidates(path)[:number]
    if is_mirror(files[0], path):
        yield [files.pop(0)]
    group: list[str] = []
    left, cost = COST, 0.0
    while files and left > 0:
        file = files.pop(0)
        seconds = baseline.cost(compiler, file)
        if seconds < left:
            group.append(file)
            left, cost = left - seconds, cost + seconds
        if cost > GROUP:
            yield group
            group, cost = [], 0.0
    if group:
        yield group


def is_mirror(test: str, path: str) -> bool:
    """Return True if a file of tests mirrors a source."""
    mirror = Path('test', path)
    return Path(test) == mirror.with_name(f'test_{mirror.name}')


def run_tests(
    files: Sequence[str],
    mutant: Mutant | None,
    compiler: str,
    limit: float,
    *,
    every: bool = True,
    leave_out: Sequence[str] = (),
) -> Run:
    """Run test files in a process of their own within `limit` [s] of processor."""
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder, 'tests')
        record.touch()
        options = ['-q', '-p', 'no:cacheprovider', '-p', 'no:xdist', '-p', 'no:randomly']
        options += [] if every else ['-x']
        options += ['-k', 'not test_compiled_'] if compiler == 'off' else []
        options += [f'--deselect={name}' for name in leave_out]
        process = os.fork()
        if process == 0:
            try:
                _enter(limit, folder, compiler)
                if mutant:
                    substitute(mutant)
                _leave(options + [str(TREE / file) for file in files], str(record))
            except BaseException:  # nothing of the other process may be cleaned up in this one
                os._exit(BROKEN)
        try:
            status = os.waitpid(process, 0)[1]
        finally:
            _end(process)
        rows = [line.split('\t', 2) for line in record.read_text(encoding='utf-8').splitlines()]
        tests = [(name, float(seconds), outcome == 'failed') for seconds, outcome, name in rows]
    code = os.waitstatus_to_exitcode(status)
    if code == BROKEN:
        raise RuntimeError(f'pytest cannot be run on {", ".join(files)}')
    verdict = TOO_LONG if code < 0 else SURVIVED if code in (0, NONE_COLLECTED) else CAUGHT
    return Run(verdict, tests)


def _end(group: int) -> None:
    """End what a run has left of its group of processes."""
    try:
        os.killpg(group, signal.SIGKILL)
    except ProcessLookupError:
        pass


def _enter(limit: float, folder: str, compiler: str) -> None:
    """Bound a forked process, silence it and set its compiler."""
    import numba

    os.setsid()
    gc.freeze()  # what the other process has left is not to be destroyed in this one
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.alarm(round(HANG * limit))
    resource.setrlimit(resource.RLIMIT_CPU, (round(limit), round(limit) + 5))
    for stream in (1, 2):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
    if compiler == 'fresh':
        os.environ['NUMBA_CACHE_DIR'] = folder
    elif compiler == 'off':
        os.environ['NUMBA_DISABLE_JIT'] = '1'
    numba.config.reload_config()


def _leave(arguments: list[str], record: str) -> NoReturn:
    import pytest

    os._exit(int(pytest.main(arguments, plugins=[Recorder(record)])))


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


def run_mutant(mutant: Mutant, baseline: Baseline, *, matrix: bool, number: int) -> Run:
    """Run a mutant against its tests until one fails; for a matrix against all of its folder."""
    path, compiler = mutant.path, compiler_of(mutant.path)
    folder = [test for test in candidates(path) if Path(test).parent == Path('test', path).parent]
    for files in [folder] if matrix else groups_of(path, baseline, number):
        cost = sum(baseline.cost(compiler, file) for file in files)
        failing = [name for kind, name in sorted(baseline.failing) if kind == compiler]
        limit = PATIENCE[0] + PATIENCE[1] * cost
        run = run_tests(files, mutant, compiler, limit, every=matrix, leave_out=failing)
        if run.verdict != SURVIVED:
            return run
    return Run(SURVIVED, [])


def summary(results: dict[Mutant, list[str]]) -> int:
    """Print the mutants caught of each room; return 0 if enough of them are."""
    rooms = Counter(mutant.room for mutant in results)
    caught = Counter(
        mutant.room for mutant, (verdict, _) in results.items() if verdict != SURVIVED
    )
    for room in sorted(rooms):
        print(f'{caught[room]:4} of {rooms[room]:4} {room}')
    print(f'{caught.total()} of {len(results)} mutants caught')
    return 0 if caught.total() >= ENOUGH * len(results) else 1


def matrix_summary(results: dict[Mutant, list[str]], baseline: Baseline) -> int:
    """Write for each test how many mutants it notices, and how many alone; return 0."""
    notices: Counter[str] = Counter()
    alone: Counter[str] = Counter()
    for _, names in results.values():
        functions = {name.partition('[')[0] for name in names.split()}
        notices.update(functions)
        alone.update(functions if len(functions) == 1 else ())
    folders = {str(Path('test', mutant.room)) for mutant in results}
    seconds: dict[str, float] = defaultdict(float)
    for (_, file), tests in baseline.seconds.items():
        for name, duration in tests.items() if str(Path(file).parent) in folders else ():
            seconds[name.partition('[')[0]] += duration
    path = RESULTS / 'tests.tsv'
    order = sorted(seconds, key=lambda name: (alone[name] > 0, notices[name] > 0, -seconds[name]))
    rows = [f'{alone[name]}\t{notices[name]}\t{seconds[name]:.3f}\t{name}\n' for name in order]
    path.write_text('alone\tnotices\tseconds\ttest\n' + ''.join(rows), encoding='utf-8')
    print(f'{len(results)} mutants; what each test notices stands in {path}')
    return 0


def main() -> int:
    """Run a sample of mutants; return 0 if enough of them are caught."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').strip().splitlines()[0])
    parser.add_argument('paths', nargs='*', default=PACKAGES, help='files or folders')
    parser.add_argument('--without', nargs='*', default=(), help='files or folders left out')
    parser.add_argument('--sample', type=int, default=100, help='how many mutants')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--files', type=int, default=10, help='of tests for a mutant, at most')
    parser.add_argument('--minutes', type=float, default=float('inf'), help='after which to stop')
    parser.add_argument('--matrix', action='store_true', help='all tests of the mirrored folder')
    parser.add_argument('--again', action='store_true', help='run survivors once more')
    asked = parser.parse_args()
    os.environ['HYPOTHESIS_PROFILE'] = 'mutate'
    import numba  # noqa: F401  once, and not in each process
    import scipy.optimize  # noqa: F401

    sys.path.insert(0, str(TREE))
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    left_out = set(sources(asked.without))
    files = [path for path in sources(asked.paths) if path not in left_out]
    chosen, baseline = sample(files, asked.sample, asked.seed), Baseline()
    kept = Lines('matrix.tsv' if asked.matrix else 'sample.tsv')
    known = {name: rest for name, *rest in kept.read() if len(rest) == 2}
    if asked.again:
        known = {name: rest for name, rest in known.items() if rest[0] != SURVIVED}
    results: dict[Mutant, list[str]] = {}
    start = time.monotonic()
    try:
        for number, mutant in enumerate(chosen, start=1):
            minutes = (time.monotonic() - start) / 60
            if mutant.name not in known:
                if minutes > asked.minutes:
                    continue
                run = run_mutant(mutant, baseline, matrix=asked.matrix, number=asked.files)
                known[mutant.name] = [run.verdict, ' '.join(run.failed)]
                kept.add(mutant.name, *known[mutant.name])
                print(
                    f'{number} of {len(chosen)}, {minutes:.0f} min, {run.verdict}: {mutant.name}',
                    flush=True,
                )
            results[mutant] = known[mutant.name]
    except KeyboardInterrupt:
        print('interrupted; a second call goes on')
    return matrix_summary(results, baseline) if asked.matrix else summary(results)


if __name__ == '__main__':
    sys.exit(main())
