# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Onset of contact of years of known truth, and notes on their motion as if without process force.

For the notes all motion of a year counts as free of process force, as on an axis that always is;
days are merged as in the store.

"""

from collections.abc import Iterator, Sequence
import dataclasses

from ballscrew_monitor.core.conversions import TIME_UNITS
from ballscrew_monitor.health.assess import compare, held_points, SURE, TOLERANCE
from ballscrew_monitor.health.baseline import learned
from ballscrew_monitor.health.calibration import calibrated
from ballscrew_monitor.health.detector import note_on_runs
from ballscrew_monitor.health.model import FILM_EXPONENT, Model
from ballscrew_monitor.health.onset import onset_note, onset_of
from ballscrew_monitor.health.points import aged
from ballscrew_monitor.health.records import ComparablePoint, LoadSource, Quantity
from health_parts.machine import Ground, OIL, SCREW
from health_parts.programmes import DAYS
from health_parts.years import draw_year, FIRST_DAY, Kind, LOSSES, Truth, Year
import numpy as np
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point

LOOKS = 140, 200, 364
"""Days on which the onset is asked."""
PERIOD = 14
"""Days between two looks for a note."""
OTHER_OILS = {Truth.OIL_THINNER: 'iso_vg_32', Truth.OIL_THICKER: 'iso_vg_100'}


def onset_row(ground: Ground, truth: Truth, seeds: range) -> str:
    """Return the row of a change in the table of the onset."""
    found = [
        one
        for seed in seeds
        for one in _onsets(ground, draw_year(ground, Kind(truth=truth), seed))
    ]
    known = [(true, one) for true, one in found if one.is_known]
    counts = (
        f'{len(known)} of {len(found)}',
        sum(one.low <= true <= one.high for true, one in known),
        sum(one.low > 1.0 for _, one in known),
        sum(onset_note(one, TOLERANCE, SURE) != '' for _, one in known),
    )
    medians = [np.median(part) for part in zip(*((t, q.high / q.low) for t, q in known))]
    cells = truth.name, *map(str, counts), *(f'{one:.2f}' for one in medians)
    return f'| {" | ".join(cells)} |'


def note_row(ground: Ground, truth: Truth, seeds: range) -> str:
    """Return the row of a change in the table of notes on motion that is free of force."""
    firsts = [_first_note(ground, draw_year(ground, Kind(truth=truth), seed)) for seed in seeds]
    sizes = [one for one in firsts if one is not None]
    told = [abs(one) for one in sizes if one != 0.0]
    size = f'{100 * np.median(told):.0f} %' if told else ''
    return f'| {truth.name} | {len(sizes)} of {len(firsts)} | {len(sizes) - len(told)} | {size} |'


def _onsets(ground: Ground, year: Year) -> Iterator[tuple[float, Quantity]]:
    """Yield the true onset over that of the baseline, and the quantity that health tells."""
    baseline = learned(year.points)
    if isinstance(baseline, str):
        return
    for day in LOOKS:
        today, points = FIRST_DAY + day, _until(year.points, day)
        found = compare(baseline, points, today, ground.surfaces[1.0], '')
        held = held_points(baseline, points, today)
        yield _true_onset(year, day), onset_of(found.month, *held, found.model, found.reason)


def _true_onset(year: Year, day: int) -> float:
    """Return the mean onset of 28 days over that without a change [-]."""
    days, truth = np.arange(day - 27, day + 1), year.kind.truth
    size = float(year.size[days].mean())
    if truth is Truth.FILM_STARVED:
        return float((1.0 - size) ** (-1.0 / FILM_EXPONENT))
    screw, oil = load_screw(SCREW), load_lubricant(OIL)
    changed = load_lubricant(OTHER_OILS.get(truth, OIL))
    loaded = (
        dataclasses.replace(screw, preload=screw.preload * (1.0 - size))
        if truth in LOSSES
        else screw
    )
    heat = oil.reference_temperature
    now, before = (
        onset_point(Contacts.of(sheet), lubricant, 0.0, heat)['speed_rad_s']
        for sheet, lubricant in ((loaded, changed), (screw, oil))
    )
    part = size if truth in OTHER_OILS else 1.0
    return 1.0 + part * (now / before - 1.0)


def _first_note(ground: Ground, year: Year) -> float | None:
    """Return the size of the change at the first note [-], None without one."""
    baseline, surface = learned(year.points), ground.surfaces[1.0]
    assert not isinstance(baseline, str)
    model = Model(surface, None, calibrated(baseline.points, surface))
    free = [dataclasses.replace(one, load_source=LoadSource.FREE) for one in year.points]
    motion = {FIRST_DAY + day: 8.0 * TIME_UNITS['h'] for day in range(DAYS)}
    for day in range(PERIOD, DAYS, PERIOD):
        kept = aged(_until(free, day), FIRST_DAY + day).points
        if note_on_runs(kept, motion, model, always_free=True):
            return float(year.size[day])
    return None


def _until(points: Sequence[ComparablePoint], day: int) -> list[ComparablePoint]:
    return [one for one in points if one.first_day <= FIRST_DAY + day]
