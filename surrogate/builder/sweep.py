# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A catalogue of screws, oils and roughness, and a surface of each combination.

The full tier spreads its own solves and is built here, one surface after another; a surface of
formulas is one task.

"""

import base64
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
import math
from pathlib import Path
import re
import time
from typing import Any

from surrogate.builder.closed_form import build_closed_form, SurfaceSettings
from surrogate.builder.tiers import build_surface, check_tier, default_settings, spreads
from surrogate.files import InputError
from surrogate.files.datasheet import changed_sheet, read_yaml
from surrogate.parameters import (
    check_waves,
    load_lubricant,
    load_screw,
    Lubricant,
    NAME,
    Screw,
    screw_and_oil,
)
from surrogate.surface.file import from_bytes, SurfaceData, SurfaceError, to_bytes, write
from surrogate.tasks.pool import Pool, run_tasks, TaskOutcome
from surrogate.tasks.worker import describe_failure, worker_name
from surrogate.units import RPM, ZERO_CELSIUS

RANGES = {
    'speed_range_rpm': ('speed_range', RPM, 0.0),
    'load_range_N': ('load_range', 1.0, 0.0),
    'temperature_range_degC': ('temperature_range', 1.0, ZERO_CELSIUS),
}
"""Keys of ranges on file: their name, factor and shift to SI."""
KEYS = ('tier', 'screws', 'oils', 'roughness', *RANGES)


@dataclass(frozen=True, kw_only=True, slots=True)
class Item:
    """One surface of a sweep: tier, datasheets, name of the roughness, ranges in SI."""

    tier: str
    screw: Screw
    lubricant: Lubricant
    roughness: str
    ranges: Mapping[str, tuple[float, float]]

    @property
    def name(self) -> str:
        """Return the name of the file without its ending."""
        return f'{self.screw.name}_{self.lubricant.name}'


@dataclass(frozen=True, kw_only=True, slots=True)
class Built:
    """
    What became of an item: the surface that was written, or a sentence.

    `outcome` tells by which worker, which were lost at it, and the time [s].

    """

    item: Item
    outcome: TaskOutcome
    file: Path | None = None
    data: SurfaceData | None = None


def load_catalogue(path: Path) -> list[Item]:
    """
    Return the items of a catalogue (YAML), screws times oils times roughness.

    Screws and oils are shipped names or files, beside the catalogue. A roughness has a name and
    keys of a datasheet that it changes; its screws are named SCREW-ROUGHNESS, so that a surface is
    not taken for that of the screw as its datasheet has it. Raises InputError.

    """
    content = read_yaml(path)
    if not isinstance(content, dict):
        raise InputError(f'{path}: must be a mapping of keys to values')
    for key in content:
        if key not in KEYS:
            raise InputError(f'{path}: unknown key {key}, allowed are {", ".join(KEYS)}')
    tier = content.get('tier', 'closed_form')
    check_tier(str(tier))
    ranges = {}
    for key, (name, factor, shift) in RANGES.items():
        if key not in content:
            continue
        ends = content[key]
        sound = isinstance(ends, list) and len(ends) == 2
        if not sound or not all(isinstance(end, int | float) for end in ends):
            raise InputError(f'{path}: {key} is {ends!r}, allowed is [low, high]')
        low, high = ((end + shift) * factor for end in ends)
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise InputError(f'{path}: {key} is {ends}, allowed is the low end first')
        ranges[name] = (low, high)
    screws = [load_screw(_place(path, name)) for name in _names(path, content, 'screws')]
    oils = [load_lubricant(_place(path, name)) for name in _names(path, content, 'oils')]
    items = [
        Item(tier=str(tier), screw=changed, lubricant=oil, roughness=variant, ranges=ranges)
        for screw in screws
        for variant, changed in _variants(path, content.get('roughness'), screw)
        for oil in oils
    ]
    names = [item.name for item in items]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f'{path}: two surfaces would be named {name}.npz')
    return items


def _names(path: Path, content: Mapping[str, Any], key: str) -> list[str]:
    names = content.get(key)
    if (
        not isinstance(names, list)
        or not names
        or not all(isinstance(name, str) for name in names)
    ):
        raise InputError(f'{path}: {key} must be a list of names or files, got {names!r}')
    return names


def _place(path: Path, name: str) -> str:
    """Return a file beside the catalogue, or the name as it is."""
    beside = path.parent / name
    return str(beside) if beside.is_file() else name


def _variants(path: Path, content: Any, screw: Screw) -> list[tuple[str, Screw]]:
    """Return names of roughness and the screw with each; as on its datasheet without any."""
    if content is None:
        return [('', screw)]
    if not isinstance(content, list) or not content:
        raise InputError(f'{path}: roughness must be a list of mappings, each with a name')
    variants = []
    for entry in content:
        if not isinstance(entry, dict) or not isinstance(entry.get('name'), str):
            raise InputError(f'{path}: roughness: {entry!r} must be a mapping with a name')
        name, variant = entry['name'], screw
        where = f'{path}: roughness {name}'
        if not re.fullmatch(NAME[0], name):
            raise InputError(f'{where}: name must be {NAME[1]}')
        if changes := {key: value for key, value in entry.items() if key != 'name'}:
            sheet = replace(screw.roughness, marched_film=None, marched_error=None)
            if 'rms_um' in changes:  # a stated Rq, not a typical one
                sheet = replace(sheet, rms_low=None, rms_high=None)
            roughness = changed_sheet(sheet, changes, where)
            check_waves(roughness, where)
            variant = replace(screw, name=f'{screw.name}-{name}', roughness=roughness)
        variants.append((name, variant))
    return variants


def sweep(
    items: list[Item], out: Path, pool: Pool, report: Callable[[Built], None]
) -> list[Built]:
    """
    Build and write a surface per item to the directory `out`; return what became of each.

    A failed item is a sentence and never stops the rest. `report` receives each as it comes.

    """
    surfaces: dict[str, Built] = {}

    def take(built: Built) -> None:
        surfaces[built.item.name] = built
        report(built)

    named = {item.name: item for item in items}
    tasks = {name: _inputs(item) for name, item in named.items() if not spreads(item.tier)}
    run_tasks(
        pool,
        build_item,
        tasks,
        report=lambda outcome: take(_written(named[outcome.name], outcome, out)),
    )
    for item in items:
        if not spreads(item.tier):
            continue
        # The builder itself gives its solves to the workers.
        file, began = out / f'{item.name}.npz', time.perf_counter()
        outcome = TaskOutcome(name=item.name, result=None, worker=worker_name())
        try:
            settings = default_settings(item.tier, item.screw, item.ranges)
            inputs = item.tier, item.screw, item.lubricant, settings
            data = build_surface(*inputs, pool=pool, out=file)
            write(file, data)
        except Exception as error:  # whatever it is, it is this item's alone
            failed = replace(outcome, sentence=describe_failure(error))
            take(Built(item=item, outcome=failed))
            continue
        outcome = replace(outcome, seconds=time.perf_counter() - began)
        take(Built(item=item, outcome=outcome, file=file, data=data))
    return [surfaces[item.name] for item in items]


def _inputs(item: Item) -> dict[str, Any]:
    """Return what a worker needs: it may be on another machine and has none of the files."""
    return {
        'screw': asdict(item.screw),
        'lubricant': item.lubricant.stated(),
        'settings': asdict(default_settings(item.tier, item.screw, item.ranges)),
    }


def build_item(inputs: Mapping[str, Any]) -> dict[str, str]:
    """Build a surface of formulas in a worker; the result is the content of the file as text."""
    settings = SurfaceSettings(**inputs['settings'])
    data = build_closed_form(*screw_and_oil(inputs), settings)
    return {'file': base64.b64encode(to_bytes(data)).decode()}


def _written(item: Item, outcome: TaskOutcome, out: Path) -> Built:
    """Verify and write what a worker has built."""
    if outcome.result is None:
        return Built(item=item, outcome=outcome)
    file = out / f'{item.name}.npz'
    try:
        data = from_bytes(file, base64.b64decode(outcome.result['file']))
        write(file, data)
    except SurfaceError as error:
        return Built(item=item, outcome=replace(outcome, result=None, sentence=str(error)))
    return Built(item=item, outcome=outcome, file=file, data=data)
