# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
`ballscrew check`: from a folder of logs and a datasheet to one page.

Each table gets the map that is guessed, with the sheet in its place; a free run identifies the
friction beside the contacts; a surface that is missing is built; then all is judged and reported.
Maps, parameters, sheets and surfaces are written beside the page.

"""

import argparse
from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import dataclasses
from pathlib import Path
import re
import sys
from typing import Any, TypeVar

from ballscrew_monitor.core.interrupts import DONE, FAILED
from ballscrew_monitor.core.prerequisites import require
from ballscrew_monitor.recordings import log_facts
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.tables.guess import Guess, guess, names_motion
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.tables.sources import is_log
from ballscrew_monitor.recordings.words import counted, say
from ballscrew_monitor.report.check_page import (
    check_parts,
    Checked,
    next_steps,
    notes_of,
    without_motion,
)
from ballscrew_monitor.report.command import check_most_unjudged, is_bad
from ballscrew_monitor.report.free_run import FreeRun, identified
from ballscrew_monitor.report.logs import find_logs, folder_names, left_out
from ballscrew_monitor.report.many_logs import INDEX, LogToReport, report_each
from ballscrew_monitor.report.overview import LogEntry, overview_page
from ballscrew_monitor.report.parameters import parameters_for
from surrogate.datasheet import key_of, read_yaml
from surrogate.files import canonical_json, InputError, json_text, printable, replace_file
from surrogate.parameters import load_lubricant, load_screw, Lubricant, Screw
from surrogate.progress import Progress
from surrogate.surface import shipped_surface, Surface, SurfaceError
from surrogate.units import MILLI

MAPS, SURFACES, SHEETS = 'maps', 'surfaces', 'sheets'
BESIDE = '.map.yaml'
KEY = re.compile(r'^(\w+):', re.M)
Sheet = TypeVar('Sheet', Screw, Lubricant)
OIL = 'iso_vg_68'
UNCERTAINTY = 0.1  # [N m] of a torque whose map is guessed


@dataclasses.dataclass(slots=True)
class _Log:
    """A recording with its map or parameters, or why it cannot be judged."""

    path: Path
    folder: str
    is_free: bool = False
    guess: Guess | None = None
    mapping: Path | None = None
    params: Path | None = None
    bag: Bag | None = None
    values: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    failure: str = ''
    is_other: bool = False  # a short table of anything but a motion

    @property
    def used(self) -> Path | None:
        """Return the file that was written of it, of a map or of parameters."""
        return self.mapping or self.params


def check_command(args: argparse.Namespace, nominal: Path) -> int:
    """Do what the command line asks for; return the exit code."""
    if args.out.exists() and not args.out.is_dir():
        raise InputError(f'output {args.out} is a file, it must be a directory')
    if not args.folder.exists():
        raise InputError(f'folder {args.folder} does not exist, it must hold logs')
    check_most_unjudged(args.most_unjudged)
    require('numba')
    paths = find_logs([args.folder], tables=True, out=args.out, is_log=is_log)
    unread = left_out([args.folder], paths, args.out, tables=True)
    sheets = sheets_of(args.folder, args.screw, args.oil)
    with contextlib.redirect_stdout(sys.stderr if args.json else sys.stdout):
        entries, checked = _check(paths, sheets, args, nominal, unread)
        say(*unread)
        steps = next_steps(entries, checked)
        for entry in entries:
            for line in entry.result.lines if entry.result else ():
                normal = f' Normal? {line.normal}.' if line.normal else ''
                print(printable(f'{entry.name}:{normal} {line.verdict}'))
            if entry.result is None:
                say(f'{entry.name}: {entry.failure}')
        say(*notes_of(entries))
        if checked.others:
            say(without_motion(checked.others))
        for step in steps:
            print(printable(f'to do: {step}'))
        bad = sum(
            is_bad(entry, Path(entry.name), args)
            for entry in entries
            if entry.folder not in checked.free
        )
        print(f'{counted(len(entries), "recording")}, {bad} bad, page in {args.out / INDEX}')
    if args.json:
        print(json_text(_record(entries, checked, steps)))
    return FAILED if bad else DONE


def sheets_of(folder: Path, screw: str | None, oil: str | None) -> tuple[Screw, Lubricant] | None:
    """
    Return the sheets of screw and oil that are named, or lie in the folder; None without a screw.

    Raises InputError for a file of the folder that has a key of a sheet and cannot be read as one,
    and for several screws or oils.

    """
    files = sorted(folder.glob('*.yaml')) if folder.is_dir() else []
    screws = [load_screw(screw)] if screw else list(_sheets(files, Screw, load_screw))
    oils = [load_lubricant(oil)] if oil else list(_sheets(files, Lubricant, load_lubricant))
    for option, found in (('--screw', screws), ('--oil', oils)):
        if len(found) > 1:
            names = ', '.join(one.name for one in found)
            raise InputError(f'folder {folder} holds several sheets, {names}: {option} names one')
    if not screws:
        return None
    return screws[0], oils[0] if oils else load_lubricant(OIL)


def _sheets(
    files: Sequence[Path], kind: type[Sheet], load: Callable[[str], Sheet]
) -> Iterator[Sheet]:
    """Yield the sheets of a kind among files: those with a key that only this kind has."""
    other = Lubricant if kind is Screw else Screw
    own, others = ({key_of(spec) for spec in dataclasses.fields(of)} for of in (kind, other))
    own -= others
    for file in files:
        if not file.name.endswith(BESIDE) and own & _top_keys(file):
            yield load(str(file))


def _top_keys(file: Path) -> set[str]:
    """Return the keys of a YAML file, as they begin its lines where it is no YAML."""
    try:
        content = read_yaml(file)
    except InputError:
        return set(KEY.findall(file.read_text(encoding='utf-8', errors='replace')))
    return set(map(str, content)) if isinstance(content, dict) else set()


def _check(
    paths: Sequence[Path],
    sheets: tuple[Screw, Lubricant] | None,
    args: argparse.Namespace,
    nominal: Path,
    unread: Sequence[str],
) -> tuple[list[LogEntry], Checked]:
    """Do all that a check does with recordings; return their entries, and what these rest on."""
    opened = _opened(paths, sheets, args, nominal)
    logs = [log for log in opened if not log.is_other or _is_named(log, args)]
    _write_maps(logs, args.out)
    runs = list(_free_runs(logs, sheets, args.out)) if sheets else []
    surfaces = _give_surfaces(logs, sheets, runs, args) if sheets else {}
    entries = _entries(logs, args, nominal)
    checked = Checked(
        sheets=None if sheets is None else (sheets[0].name, sheets[1].name),
        is_oil_known=args.oil is not None or bool(sheets and sheets[1].name != OIL),
        free=frozenset(log.folder for log in logs if log.is_free and not log.failure),
        runs=tuple(runs),
        surfaces=surfaces,
        used={
            log.folder: str(log.used.relative_to(args.out)) for log in logs if log.used is not None
        },
        unread=tuple(unread),
        others=tuple(log.path.name for log in opened if log not in logs),
        unstated={log.path.name: log.guess.unstated for log in logs if log.guess},
    )
    title, parts = f'Check of {args.folder.resolve().name}', check_parts(entries, checked)
    replace_file(args.out / INDEX, overview_page(entries, title=title, parts=parts).encode())
    return entries, checked


def _opened(
    paths: Sequence[Path],
    sheets: tuple[Screw, Lubricant] | None,
    args: argparse.Namespace,
    nominal: Path,
) -> list[_Log]:
    """Return recordings with their guess or their bag; raises InputError if none is readable."""
    free = _free_paths(paths, args.free_run)
    logs = [
        _Log(path=path, folder=name, is_free=path in free)
        for path, name in zip(paths, folder_names(paths), strict=True)
    ]
    bar = Progress(len(logs), 'recordings opened')
    try:
        for number, log in enumerate(logs):
            bar.show(number, len(logs))
            _open(log, sheets, args, nominal)
    finally:
        bar.close()
    if all(log.failure and not log.guess for log in logs):
        more = f' (and {len(logs) - 1} more)' if len(logs) > 1 else ''
        raise InputError(f'nothing in {args.folder} can be read: {logs[0].failure}{more}')
    return logs


def _is_named(log: _Log, args: argparse.Namespace) -> bool:
    """Return True if somebody says that a file is a recording."""
    return log.is_free or log.path == args.folder


def _write_maps(logs: Sequence[_Log], out: Path) -> None:
    """Keep the map of each table that is judged, and of each that waits for a value."""
    for log in logs:
        text = log.guess.text if log.guess else ''
        if log.mapping and not log.failure:
            text = log.mapping.read_text(encoding='utf-8')
        if text:
            log.mapping = out / MAPS / f'{log.folder}.yaml'
            _write(log.mapping, text)
        elif log.failure:
            log.mapping = None


def _entries(logs: Sequence[_Log], args: argparse.Namespace, nominal: Path) -> list[LogEntry]:
    """Report what can be judged; return an entry of each recording."""
    readable = [
        LogToReport(log=log.path, folder=log.folder, params=log.params, mapping=log.mapping)
        for log in logs
        if not log.failure
    ]
    reported = []
    if readable:
        pool = {'workers': args.workers, 'dask': args.dask}
        reported = report_each(readable, args.out, nominal=nominal, **pool)
    found = {entry.folder: entry for entry in reported}
    return [
        found.get(log.folder)
        or LogEntry(name=log.path.name, folder=log.folder, failure=log.failure)
        for log in logs
    ]


def _free_paths(paths: Sequence[Path], names: Sequence[str]) -> list[Path]:
    """Return the recordings that are named as free runs; raises InputError for another name."""
    for name in names:
        if not any(path.name == name for path in paths):
            held = ', '.join(path.name for path in paths)
            raise InputError(f'--free-run is {name}, the folder holds {held}')
    return [path for path in paths if path.name in names]


def _open(
    log: _Log, sheets: tuple[Screw, Lubricant] | None, args: argparse.Namespace, nominal: Path
) -> None:
    """Open a recording; a table by the map that is given or guessed, if that says all."""
    try:
        table = log.path.is_file() and not is_bag(log.path)
        given = args.map or map_beside(log.path)
        if table and given is None:
            log.guess = _with_sheets(guess(log.path), sheets)
            if log.is_free:
                log.guess = _as_free_run(log.guess)
            if log.guess.unstated:
                log.failure = '; '.join(log.guess.unstated)
            return
        log.mapping = given if table else None
        if log.mapping:
            read_map(log.mapping)
        log.bag = opened_log(log.path, mapping=log.mapping)
        log.values = parameters_for(log.bag, args.params, nominal).values
    except (InputError, SurfaceError) as error:
        log.failure = str(error)
        log.is_other = log.mapping is None and not names_motion(log.path) and not is_log(log.path)


def map_beside(log: Path) -> Path | None:
    """
    Return the map that lies beside a table, None without.

    `feed.csv.map.yaml` is that of feed.csv; `feed.map.yaml` as well, but for feed.json beside it.

    """
    own, shared = log.with_name(f'{log.name}{BESIDE}'), log.with_suffix(BESIDE)
    if own.is_file():
        return own
    table = log.with_suffix('.csv')
    is_first = table == log or not table.is_file()
    return shared if is_first and shared.is_file() else None


def _with_sheets(first: Guess, sheets: tuple[Screw, Lubricant] | None) -> Guess:
    """Return a guessed map that states screw, oil and lead of the sheets."""
    if sheets is None:
        return first
    stated = {
        'screw': sheets[0].name,
        'oil': sheets[1].name,
        'lead_mm': float(f'{sheets[0].lead * MILLI:.6g}'),
    }
    axes = {name: one | stated for name, one in first.content['axes'].items()}
    gone = {f'{axis}.{key}' for axis in axes for key in stated}
    assumed = {key: one for key, one in first.content['assumed'].items() if key not in gone}
    return dataclasses.replace(first, content=first.content | {'axes': axes, 'assumed': assumed})


def _as_free_run(first: Guess) -> Guess:
    """Return a guessed map that takes no torque for a load: all of it is friction."""
    axes, assumed = {}, dict(first.content['assumed'])
    for name, one in first.content['axes'].items():
        axes[name] = one
        if 'torque' in one and 'load' not in one:
            axes[name] = one | {'load': {'from': 'motor_torque'}, 'always_free': True}
            for key in ('load.from', 'efficiency'):
                assumed.pop(f'{name}.{key}', None)
            why = 'no log says it; of a motor that tells its own torque'
            assumed[f'{name}.torque_uncertainty_Nm'] = {'value': UNCERTAINTY, 'reason': why}
    return dataclasses.replace(first, content=first.content | {'axes': axes, 'assumed': assumed})


def _free_runs(
    logs: Sequence[_Log], sheets: tuple[Screw, Lubricant], out: Path
) -> Iterator[FreeRun]:
    """Yield what free runs identify, of each axis the first that does; show how far that is."""
    bar, known = Progress(len(logs), 'recordings looked at for a free run'), set[str]()
    try:
        for number, log in enumerate(logs):
            bar.show(number, len(logs))
            if log.failure:
                continue
            try:
                bag = log.bag or opened_log(log.path, mapping=log.mapping)
                values = log.values or log_facts.parameters_of(bag) or {}
            except InputError as error:
                log.failure = str(error)
                continue
            for axis in values.get('axes', ()):
                if axis in known:
                    continue
                sheet = out / SHEETS / f'{sheets[0].name}_{axis}.yaml'
                with contextlib.suppress(InputError):
                    run = identified(bag, values, axis, sheets, sheet, is_free=log.is_free)
                    if run is not None:
                        known |= {axis} if run.sheet else set()
                        yield run
        bar.show(len(logs), len(logs))
    finally:
        bar.close()


def _give_surfaces(
    logs: Sequence[_Log],
    sheets: tuple[Screw, Lubricant],
    runs: Sequence[FreeRun],
    args: argparse.Namespace,
) -> dict[str, str]:
    """Let each recording be judged with the surface of its screw; return these by axis."""
    screws = {run.axis: load_screw(str(run.sheet)) for run in runs if run.sheet}
    found: dict[str, Path] = {}
    told: dict[str, str] = {}

    def place(axis: str) -> tuple[Screw, Path]:
        screw = screws.get(axis, sheets[0])
        if screw.name not in found:
            found[screw.name] = _surface(screw, sheets[1], args)
        told[axis] = str(found[screw.name])
        return screw, found[screw.name].resolve()

    for log in logs:
        if log.guess:
            axes = {}
            for axis, one in log.guess.content['axes'].items():
                screw, file = place(axis)
                axes[axis] = one | {'screw': screw.name, 'surface': str(file)}
            log.guess = dataclasses.replace(log.guess, content=log.guess.content | {'axes': axes})
            assert log.mapping is not None
            _write(log.mapping, log.guess.text)
        elif log.bag is not None and log.mapping is None:
            values, said = dict(log.values), set[str]()
            for axis in values['axes']:
                screw, file = place(axis)
                stated = {'surface': str(file), 'screw': screw.name, 'oil': sheets[1].name}
                values |= {f'{axis}.{key}': one for key, one in stated.items()}
                said |= {f'{axis}.{key}' for key in stated}
            log.params = args.out / MAPS / f'{log.folder}.params.yaml'
            _write(log.params, log_facts.parameters_text(values, said))
    return told


def _surface(screw: Screw, oil: Lubricant, args: argparse.Namespace) -> Path:
    """Return a surface of just these sheets: the shipped one, one that was built, a new one."""
    from surrogate.builder.tiers import build_surface, default_settings, spreads
    from surrogate.surface.file import write
    from surrogate.tasks.workers import open_pool

    inputs = canonical_json({'screw': screw.stated(), 'lubricant': oil.stated()})
    built = args.out / SURFACES / f'{screw.name}_{oil.name}_{args.tier}.npz'
    with contextlib.suppress(SurfaceError):
        shipped = shipped_surface(screw.name, oil.name, args.tier)
        if canonical_json(Surface.load(shipped).header['inputs']) == inputs:
            return shipped
    with contextlib.suppress(SurfaceError):
        if canonical_json(Surface.load(built).header['inputs']) == inputs:
            return built
    built.parent.mkdir(parents=True, exist_ok=True)
    settings, bar = default_settings(args.tier, screw, {}), Progress(0, 'slices of the surface')
    with contextlib.ExitStack() as stack:
        stack.callback(bar.close)
        pool = None
        if spreads(args.tier):
            pool = stack.enter_context(open_pool(args.workers, args.dask))
        data = build_surface(
            args.tier, screw, oil, settings, progress=bar.show, pool=pool, out=built
        )
    write(built, data)
    return built


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, text.encode())


def _record(entries: Sequence[LogEntry], checked: Checked, steps: Sequence[str]) -> dict[str, Any]:
    """Return what the page says as plain data."""
    return {
        'recordings': {
            entry.name: {
                'failure': entry.failure,
                'map': checked.used.get(entry.folder, ''),
                'axes': {
                    line.axis: {
                        'normal': line.normal,
                        'standing': line.standing,
                        'verdict': line.verdict,
                        'expected': line.expected,
                        'judged': line.judged,
                        'losses': line.losses,
                    }
                    for line in (entry.result.lines if entry.result else ())
                },
            }
            for entry in entries
        },
        'identified': {run.axis: run.text for run in checked.runs},
        'surfaces': dict(checked.surfaces),
        'no_recordings': list(checked.others),
        'left_out': list(checked.unread),
        'notes': notes_of(entries),
        'what_to_do': list(steps),
    }
