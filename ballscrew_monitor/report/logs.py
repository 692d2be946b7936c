# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Recordings that are meant, bags, files, and folders that hold some; and folders of reports."""

from collections.abc import Callable, Iterable, Iterator, Sequence
import contextlib
from pathlib import Path
import re

from ballscrew_monitor.recordings.bag_files import ACTIVE, ENDINGS, is_bag, is_table, TABLES
from surrogate.files import InputError

_PART = re.compile(r'(.*)_(\d+)')  # file of a bag that was split
PAGE, STATES, EVENTS, JUDGED = 'report.html', 'states.parquet', 'events.csv', 'judged'
SUMMARY, PICTURE = 'summary.json', 'cycle.png'
PRODUCTS = (JUDGED, STATES, EVENTS)
"""How a folder with a report is known, and what is no recording in it."""
SETTINGS = ('.yaml', '.yml', '.toml')
NO_LOGS = (*SETTINGS, '.md', '.html', '.py', '.pdf', '.png', '.npz', '.active')
"""Endings of what may lie beside recordings; settings are named nowhere."""
BESIDE_SQLITE = ('.db3-wal', '.db3-shm', '.db3-journal')
"""Endings of what is read with the file of SQLite beside it."""
MOST_NAMED = 5  # files that are left out, for one reason
OF_ROS_1 = ('.bag',)
_UNSAFE = re.compile(r'[^\w.-]+')


def find_logs(
    paths: Iterable[Path],
    *,
    tables: bool = False,
    out: Path | None = None,
    is_log: Callable[[Path], bool] | None = None,
) -> list[Path]:
    """
    Return the recordings that paths name, those in a folder in the order of their names.

    A path that is a bag or a file stands for itself, whatever is in it; `tables` tells whether
    those in a folder count too, and `is_log` which files of other endings are among them. Products
    of reports do not, nor does the folder `out` of reports to come. Raises InputError for a folder
    without any recording.

    """
    logs: dict[Path, Path] = {}  # links to one file are one recording
    for path in paths:
        held = _recordings(path, tables, out, is_log)
        if not held:
            endings, there = (*ENDINGS, *TABLES) if tables else ENDINGS, _files(path, TABLES)
            hint = '--guess > map.yaml, then --map map.yaml'
            raise InputError(
                f'folder {path} holds no recording, it must hold bags or files of '
                f'{" or ".join(endings)}'
                + (f'; for its tables: ballscrew import {there[0]} {hint}' if there else '')
            )
        for log in held:
            logs.setdefault(log.resolve(), log)
    return [*logs.values()]


def _recordings(
    path: Path, tables: bool, out: Path | None, is_log: Callable[[Path], bool] | None
) -> list[Path]:
    """Return a path that is one recording, else those in a folder and in the ones below it."""
    if not path.is_dir() or is_one_bag(path, tables=tables, out=out):
        return [path]
    below = [
        recording
        for child in _folders(path, out)
        for recording in _recordings(child, tables, out, is_log)
    ]
    held = _files(path, (*ENDINGS, *TABLES) if tables else ENDINGS)
    held += filter(is_bag, _files(path, OF_ROS_1))  # which say how they are converted
    if is_log is not None:
        held += [
            file
            for file in _held(path)
            if file.is_file()
            and file not in held
            and not file.name.startswith('.')
            and file.suffix.lower() not in NO_LOGS
            and is_log(file)
        ]
    return sorted(held) + below


def logs_of(paths: Iterable[Path], mapping: Path | None, out: Path | None = None) -> list[Path]:
    """Return the recordings that paths name, with a map also tables of any ending."""
    if mapping is None:
        return find_logs(paths, out=out)
    from ballscrew_monitor.recordings.tables.sources import is_log

    return find_logs(paths, tables=True, out=out, is_log=is_log)


def left_out(
    paths: Iterable[Path], logs: Sequence[Path], out: Path | None = None, *, tables: bool = False
) -> list[str]:
    """
    Return in a sentence which files in folders are not among the recordings, and why.

    With `tables` files of any ending were looked into.

    """
    reasons: dict[str, list[str]] = {}
    for folder in paths:
        for file in _others(folder, logs, out):
            why = 'their ending is none of a bag, and tables are judged by a --map'
            if not file.stat().st_size:
                why = 'they are empty'
            elif file.suffix.lower() in NO_LOGS:
                why = 'their ending is that of no recording'
            elif is_table(file):
                why = 'tables are judged by a --map'
            elif tables:
                why = 'they hold neither messages nor rows of numbers'
            reasons.setdefault(why, []).append(str(file))
    parts = []
    for why, names in reasons.items():
        more = f' and {len(names) - MOST_NAMED} more' if len(names) > MOST_NAMED else ''
        parts.append(f'as {why}: {", ".join(names[:MOST_NAMED])}{more}')
    return [f'left out, {"; ".join(parts)}'] if parts else []


def _others(folder: Path, logs: Sequence[Path], out: Path | None) -> Iterator[Path]:
    """Yield the files below a folder that are no recordings, nor settings of any."""
    if not folder.is_dir():
        return
    found = {log.resolve() for log in logs}
    is_log = folder.resolve() in found
    own = (*SETTINGS, *ENDINGS, *BESIDE_SQLITE, ACTIVE) if is_log else SETTINGS
    for file in _files(folder, ('',)):
        is_own = file.name.startswith('.') or file.name.lower().endswith(own)
        if not is_own and file.resolve() not in found:
            yield file
    for child in _folders(folder, out):
        yield from _others(child, logs, out)


def map_for(log: Path, mapping: Path | None, *, alone: bool) -> Path | None:
    """Return the map of a recording: one of several has it if it is no bag, one alone always."""
    return mapping if alone or not is_bag(log) else None


def is_one_bag(folder: Path, *, tables: bool = False, out: Path | None = None) -> bool:
    """
    Return True if a folder is one bag: with metadata, or no more than the parts of one.

    Parts are numbered from 0 without a gap. Tables beside them count if `tables`; `out` does not.

    """
    if (folder / 'metadata.yaml').is_file():
        return True
    if tables and _files(folder, TABLES):
        return False
    if any(is_one_bag(child, tables=tables, out=out) for child in _folders(folder, out)):
        return False
    files = _files(folder, (*ENDINGS, ACTIVE))
    parts = [_PART.fullmatch(_stem(file.name)) for file in files]
    known = [(part[1], int(part[2])) for part in parts if part is not None]
    numbers = sorted(number for _, number in known)
    are_parts = len({stem for stem, _ in known}) == 1 and numbers == list(range(len(files)))
    return len(files) == 1 or are_parts


def bears_name_of_bag(folder: Path) -> bool:
    """Return True if a folder is one bag and bears the name of its files, finished or not."""
    stems = [_stem(file.name) for file in _files(folder, (*ENDINGS, ACTIVE))]
    parts = [part[1] for part in map(_PART.fullmatch, stems) if part is not None]
    return folder.name in (*stems, *parts) and is_one_bag(folder, tables=True)


def _stem(name: str) -> str:
    """Return the name of a file without its ending; points before that belong to the name."""
    endings = (ending for ending in (*ENDINGS, ACTIVE, *TABLES) if name.endswith(ending))
    return name.removesuffix(next(endings, ''))


def _folders(folder: Path, out: Path | None) -> list[Path]:
    """
    Return the folders in a folder that are not hidden, nor `out`.

    A link to what is in the folder, or to a folder that it is in, leads to nothing else.

    """
    real = folder.resolve()
    left = {real, *real.parents, *map(Path.resolve, folder.parents)}
    left |= set() if out is None else {out.resolve()}
    return [
        path
        for path in _held(folder)
        if path.is_dir()
        and not path.name.startswith('.')
        and path.resolve() not in left
        and not (path.is_symlink() and path.resolve().is_relative_to(real))
    ]


def _files(folder: Path, endings: tuple[str, ...]) -> list[Path]:
    return [path for path in _held(folder) if path.is_file() and path.name.endswith(endings)]


def _held(folder: Path) -> list[Path]:
    products = PRODUCTS if (folder / PAGE).is_file() else ()
    return sorted(path for path in folder.iterdir() if path.name not in products)


def folder_names(logs: Sequence[Path]) -> list[str]:
    """Return a name for the directory of each recording, each another one and harmless."""
    taken: dict[str, int] = {}
    names = []
    for log in logs:
        name = _UNSAFE.sub('_', _stem(log.absolute().name)).strip('.') or 'log'
        taken[name] = taken.get(name, 0) + 1
        names.append(name if taken[name] == 1 else f'{name}-{taken[name]}')
    return (
        names if len(set(names)) == len(names) else [f'{i + 1}-{n}' for i, n in enumerate(names)]
    )


def check_output(out: Path) -> None:
    """Raise InputError for a folder with files that a report would replace, and no report."""
    if (out / PAGE).is_file() or not out.is_dir():
        return
    for name in (*PRODUCTS, SUMMARY, PICTURE):
        if (out / name).exists():
            raise InputError(
                f'output {out} holds {name} and no {PAGE}: it is not of a report and would be '
                'overwritten, another directory must be given'
            )


def replace_report(report: Path, out: Path) -> None:
    """
    Let the page and the products in `report` take the place of those in `out`.

    Products without a page look like recordings: the old ones go before the page is replaced, the
    new ones come after it. So whatever stops it, none is beside a page that is not its own.

    """
    products = {path.relative_to(report) for path in report.rglob('*') if path.is_file()} - {
        Path(PAGE)
    }
    stale = {Path(PICTURE)} if (out / PICTURE).exists() else set()
    for name in products | stale:
        (out / name).unlink(missing_ok=True)
    (report / PAGE).replace(out / PAGE)
    for name in products:
        (out / name).parent.mkdir(exist_ok=True)
        (report / name).replace(out / name)


def remove_report(out: Path) -> None:
    """Remove a report from `out`, its page last."""
    judged = (f'{JUDGED}/{JUDGED}.mcap', f'{JUDGED}/metadata.yaml')
    for name in judged:
        (out / name).unlink(missing_ok=True)
    with contextlib.suppress(OSError):  # files of others stay in it
        (out / JUDGED).rmdir()
    for name in (STATES, EVENTS, SUMMARY, PICTURE, PAGE):
        (out / name).unlink(missing_ok=True)
