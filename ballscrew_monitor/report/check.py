# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
`ballscrew check`: from a folder of logs and a datasheet to one page.

Each table gets the map that is guessed, with the sheet in its place; a free run identifies the
friction beside the contacts; a surface that is missing is built; then all is judged and reported.
Maps, parameters, sheets and surfaces are written beside the page.

"""

import argparse
from collections.abc import Callable, Iterator, Sequence
import contextlib
import dataclasses
from pathlib import Path
import re
import sys
from typing import Any, TypeVar

from ballscrew_monitor.core.interrupts import DONE, FAILED
from ballscrew_monitor.core.prerequisites import require
from ballscrew_monitor.recordings import log_facts
from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.tables.guess import Guess, guess, names_motion
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.recordings.tables.sources import is_log
from ballscrew_monitor.recordings.words import counted, say
from ballscrew_monitor.report.check_page import (
    check_parts,
    CheckedLog,
    next_steps,
    notes_of,
    without_motion,
)
from ballscrew_monitor.report.command import check_most_unjudged, is_bad
from ballscrew_monitor.report.free_run import FreeRun, identified
from ballscrew_monitor.report.logs import find_logs, folder_names, left_out
from ballscrew_monitor.report.many_logs import Given, INDEX, report_each, Workers
from ballscrew_monitor.report.overview import overview_page, with_usual
from ballscrew_monitor.report.parameters import parameters_for
from surrogate.files import canonical_json, InputError, json_text, printable, replace_file
from surrogate.files.datasheet import key_of, read_yaml
from surrogate.parameters import load_lubricant, load_screw, Lubricant, Screw
from surrogate.surface import shipped_surface, Surface, SurfaceError
from surrogate.tasks.progress import Progress
from surrogate.units import MILLI

MAPS, SURFACES, SHEETS = 'maps', 'surfaces', 'sheets'
BESIDE = '.map.yaml'
KEY = re.compile(r'^(\w+):', re.M)
Sheet = TypeVar('Sheet', Screw, Lubricant)
Sheets = tuple[Screw, Lubricant]
OIL = 'iso_vg_68'
UNCERTAINTY = 0.1  # [N m] of a torque whose map is guessed
SAME_LEAD = 0.01  # part by which the lead that a log states may miss that of the sheet


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
        opened = _opened(paths, sheets, args, nominal)
        logs, others = (
            [log for log in opened if log.is_other is other] for other in (False, True)
        )
        asides = [*unread, *([without_motion(others)] if others else [])]
        runs = _free_runs(logs, sheets, args.out) if sheets else []
        surfaces = _give_surfaces(logs, sheets, runs, args) if sheets else {}
        _report(logs, args, nominal)
        assumed_oil = OIL if args.oil is None and sheets and sheets[1].name == OIL else ''
        screw = sheets[0].name if sheets else ''
        steps = next_steps(logs, runs, screw=screw, of_screw=[*surfaces], assumed_oil=assumed_oil)
        parts = check_parts(logs, asides, runs, surfaces, steps)
        results, title = [log.result for log in logs], f'Check of {args.folder.resolve().name}'
        replace_file(args.out / INDEX, overview_page(results, title=title, parts=parts).encode())
        bad = _print(logs, asides, steps, args)
    if args.json:
        record = {
            'recordings': {log.path.name: _record(log) for log in logs},
            'identified': {run.axis: run.text for run in runs},
            'surfaces': surfaces,
            'no_recordings': [log.path.name for log in others],
            'left_out': unread,
            'notes': notes_of(logs),
            'what_to_do': steps,
        }
        print(json_text(record))
    return FAILED if bad else DONE


def _print(
    logs: Sequence[CheckedLog],
    asides: Sequence[str],
    steps: Sequence[str],
    args: argparse.Namespace,
) -> int:
    """Print what recordings come to, with sentences aside, and what to do; count the bad."""
    for result in (log.result for log in logs):
        for line in result.lines:
            normal = f' Normal? {line.normal}.' if line.normal else ''
            print(printable(f'{result.name}:{normal} {line.told}'))
        if result.failure:
            say(f'{result.name}: {result.failure}')
    say(*notes_of(logs), *asides)
    for step in steps:
        print(printable(f'to do: {step}'))
    judged = [log for log in logs if not log.is_free_run]
    bad = sum(is_bad(log.result, Path(log.path.name), args) for log in judged)
    print(f'{counted(len(logs), "recording")}, {bad} bad, page in {args.out / INDEX}')
    return bad


def _record(log: CheckedLog) -> dict[str, Any]:
    """Return what the page says of a recording as plain data."""
    names = 'normal', 'standing', 'expected', 'judged', 'losses'
    return {
        'failure': log.result.failure,
        'map': log.used,
        'axes': {
            line.axis: {'verdict': line.told} | {name: getattr(line, name) for name in names}
            for line in log.result.lines
        },
    }


def sheets_of(folder: Path, screw: str | None, oil: str | None) -> Sheets | None:
    """
    Return the sheets of screw and oil that are named, or lie in the folder; None without a screw.

    Raises InputError for a file of the folder that has a key of a sheet and cannot be read as one,
    and for several screws or oils.

    """
    files = sorted(folder.glob('*.yaml')) if folder.is_dir() else []
    screws = [load_screw(screw)] if screw else list(_sheets(files, Screw, load_screw))
    oils = [load_lubricant(oil)] if oil else list(_sheets(files, Lubricant, load_lubricant))
    for option, held in (('--screw', screws), ('--oil', oils)):
        if len(held) > 1:
            names = ', '.join(sheet.name for sheet in held)
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
        if file.name.endswith(BESIDE):
            continue
        try:
            content = read_yaml(file)
            keys = set(map(str, content)) if isinstance(content, dict) else set()
        except InputError:  # then the keys are those that begin its lines
            keys = set(KEY.findall(file.read_text(encoding='utf-8', errors='replace')))
        if own & keys:
            yield load(str(file))


def _opened(
    paths: Sequence[Path], sheets: Sheets | None, args: argparse.Namespace, nominal: Path
) -> list[CheckedLog]:
    """
    Return recordings with their guess or their bag; maps that are used are written.

    Raises InputError if none is readable, and for the name of a free run that is not among them.

    """
    for name in args.free_run:
        if not any(path.name == name for path in paths):
            held = ', '.join(path.name for path in paths)
            raise InputError(f'--free-run is {name}, the folder holds {held}')
    logs = [
        CheckedLog(path=path, folder=name, out=args.out, is_free=path.name in args.free_run)
        for path, name in zip(paths, folder_names(paths), strict=True)
    ]
    with contextlib.closing(Progress(len(logs), 'recordings opened')) as bar:
        for number, log in enumerate(logs):
            bar.show(number, len(logs))
            _open(log, sheets, args, nominal)
            text = log.guess.text if log.guess else ''
            if log.mapping and not log.failure:
                text = log.mapping.read_text(encoding='utf-8')
            if text:
                log.mapping = _written(args.out / MAPS / f'{log.folder}.yaml', text)
            elif log.failure:
                log.mapping = None
    if all(log.failure and not log.guess for log in logs):
        more = f' (and {len(logs) - 1} more)' if len(logs) > 1 else ''
        raise InputError(f'nothing in {args.folder} can be read: {logs[0].failure}{more}')
    return logs


def _open(log: CheckedLog, sheets: Sheets | None, args: argparse.Namespace, nominal: Path) -> None:
    """Open a recording; a table by the map that is given or guessed, if that says all."""
    try:
        table = log.path.is_file() and not is_bag(log.path)
        given = args.map or map_beside(log.path)
        if table and given is None:
            log.guess = _of_machine(guess(log.path), sheets, is_free=log.is_free)
            log.failure = '; '.join(log.guess.unstated)
            return
        log.mapping = given if table else None
        if log.mapping:
            read_map(log.mapping)
        log.bag = opened_log(log.path, mapping=log.mapping)
        log.values = parameters_for(log.bag, args.params, nominal).values
    except (InputError, SurfaceError) as error:
        log.failure = str(error)
        is_named = log.is_free or log.path == args.folder  # somebody says that it is a recording
        tells_nothing = not names_motion(log.path) and not is_log(log.path)
        log.is_other = log.mapping is None and tells_nothing and not is_named


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


def _of_machine(first: Guess, sheets: Sheets | None, *, is_free: bool) -> Guess:
    """
    Return a guessed map that states screw, oil and lead of the sheets.

    The map asks for a lead of which the log says another. That of a free run takes no torque for a
    load: all of it is friction.

    """
    stated: dict[str, Any] = {}
    unstated = [*first.unstated]
    if sheets is not None:
        lead = float(f'{sheets[0].lead * MILLI:.6g}')
        stated = {'screw': sheets[0].name, 'oil': sheets[1].name, 'lead_mm': lead}
        if abs(first.lead_mm / lead - 1.0) > SAME_LEAD:
            stated['lead_mm'] = None
            unstated += [
                f'state axes.{name}.lead_mm in the map: the log says {first.lead_mm:g} mm, the '
                f'sheet {sheets[0].name} {lead:g} mm'
                for name in first.content['axes']
            ]
    axes, assumed = {}, dict(first.content['assumed'])
    for name, columns in first.content['axes'].items():
        axes[name], known = columns | stated, [*stated]
        if is_free and 'torque' in columns and 'load' not in columns:
            axes[name] |= {'load': {'from': 'motor_torque'}, 'always_free': True}
            known += ['load.from', 'efficiency']
            why = 'no log says it; of a motor that tells its own torque'
            uncertainty = {'value': UNCERTAINTY, 'reason': why}
            assumed[f'{name}.torque_uncertainty_Nm'] = uncertainty
        for key in known:
            assumed.pop(f'{name}.{key}', None)
    content = first.content | {'axes': axes, 'assumed': assumed}
    return dataclasses.replace(first, content=content, unstated=tuple(unstated))


def _free_runs(logs: Sequence[CheckedLog], sheets: Sheets, out: Path) -> list[FreeRun]:
    """Return what free runs identify, of each axis the first that does; show how far that is."""
    runs: list[FreeRun] = []
    with contextlib.closing(Progress(len(logs), 'recordings looked at for a free run')) as bar:
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
                if any(run.axis == axis and run.sheet for run in runs):
                    continue
                sheet = out / SHEETS / f'{sheets[0].name}_{axis}.yaml'
                with contextlib.suppress(InputError):
                    run = identified(bag, values, axis, sheets, sheet, is_free=log.is_free)
                    runs += [] if run is None else [run]
        bar.show(len(logs), len(logs))
    return runs


def _give_surfaces(
    logs: Sequence[CheckedLog], sheets: Sheets, runs: Sequence[FreeRun], args: argparse.Namespace
) -> dict[str, str]:
    """Let each recording be judged with the surface of its screw; return these by axis."""
    screws = {run.axis: load_screw(str(run.sheet)) for run in runs if run.sheet}
    files: dict[str, Path] = {}
    surfaces: dict[str, str] = {}

    def place(axis: str) -> tuple[Screw, Path]:
        screw = screws.get(axis, sheets[0])
        if screw.name not in files:
            files[screw.name] = _surface(screw, sheets[1], args)
        surfaces[axis] = str(files[screw.name])
        return screw, files[screw.name].resolve()

    for log in logs:
        if log.guess:
            axes = {}
            for axis, columns in log.guess.content['axes'].items():
                screw, file = place(axis)
                axes[axis] = columns | {'screw': screw.name, 'surface': str(file)}
            log.guess = dataclasses.replace(log.guess, content=log.guess.content | {'axes': axes})
            assert log.mapping is not None
            _written(log.mapping, log.guess.text)
        elif log.bag is not None and log.mapping is None:
            values, stated = dict(log.values), set[str]()
            for axis in values['axes']:
                screw, file = place(axis)
                of_sheets = {'surface': str(file), 'screw': screw.name, 'oil': sheets[1].name}
                values |= {f'{axis}.{key}': value for key, value in of_sheets.items()}
                stated |= {f'{axis}.{key}' for key in of_sheets}
            text = log_facts.parameters_text(values, stated)
            log.params = _written(args.out / MAPS / f'{log.folder}.params.yaml', text)
    return surfaces


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
    settings = default_settings(args.tier, screw, {})
    with contextlib.ExitStack() as stack:
        bar = stack.enter_context(contextlib.closing(Progress(0, 'slices of the surface')))
        pool = None
        if spreads(args.tier):
            pool = stack.enter_context(open_pool(args.workers, args.dask))
        data = build_surface(
            args.tier, screw, oil, settings, progress=bar.show, pool=pool, out=built
        )
    write(built, data)
    return built


def _report(logs: Sequence[CheckedLog], args: argparse.Namespace, nominal: Path) -> None:
    """Report the recordings that can be judged."""
    readable = {
        log.folder: (log.path, Given(log.params, log.mapping, nominal))
        for log in logs
        if not log.failure
    }
    workers = Workers(args.workers, args.dask)
    reported = with_usual(report_each(readable, args.out, workers)) if readable else []
    results = {result.folder: result for result in reported}
    for log in logs:
        log.reported = results.get(log.folder)


def _written(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, text.encode())
    return path
