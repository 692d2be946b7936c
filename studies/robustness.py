# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Robustness of the contact solver: a fixed list of 2000 cold cases and how each of them ended.

Usage: python studies/robustness.py [--out FILE] [--every N] [--workers N]
[--report]. The list comes from numpy's PCG64 with the seed 2026 and is the same everywhere: loads,
speeds and viscosities uniform in their logarithm, one case in sixteen at rest, both contacts of
the nominal screw. Smooth cases run with the production settings, rough ones on 65 x 129 nodes
within 30 s. Finished cases are kept in FILE.store, so an interrupted run goes on where it stopped.
A result belongs to the solver that made it: remove the store after a change of the solver.
`--every` takes each N-th case, `--report` prints what is there and solves nothing.

"""

import argparse
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
import hashlib
import math
from pathlib import Path
import time
from typing import Any

import numpy as np
from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.formulas.film import groups, minimum_film_hamrock_dowson_1977
from surrogate.formulas.geometry import Contact, hertz, screw_contact
from surrogate.parameters import load_lubricant, load_screw
from surrogate.raceway.fractal import fractal_surface, FractalSurface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window
from surrogate.tasks.kept import run_kept
from surrogate.tasks.table import read_table, write_table

WORK = 'studies/robustness.py 1'
"""Solver and version of the kept results."""
SEED, COUNT = 2026, 2000
ROUGH_SHARE, RESTING_SHARE = 0.35, 1 / 16
"""Shares of the cases with roughness and at speed 0 [-]."""
LOADS = {'smooth': (0.1, 500.0), 'mixed': (10.0, 500.0)}
"""Ranges of the load by kind [N]."""
SPEEDS = (0.002, 3.0)
"""Range of the entrainment speed of a case that is not at rest [m/s]."""
VISCOSITIES = (0.005, 0.5)
"""Range of the viscosity at the temperature of the contact [Pa s]."""
ROUGHNESSES = (0.02, 0.4)
"""Range of the rms height over the window [um]."""
DRAWS = 5
SHORTEST_WAVELENGTH = 16e-6
"""Shortest wavelength of the rough cases, whatever the case [m]."""
WINDOW_LOAD = 100.0
"""Load whose Hertz rectangle is the window of a patch [N]."""
SETTINGS = {'smooth': Settings(), 'mixed': Settings(nx=65, ny=129, time_cap=30.0)}
TOUCHING = 1.001
"""Minimum film over the floor up to which a smooth contact counts as touching [-]."""
GROUPS = (
    'smooth, film above the floor',
    'smooth, film at the floor',
    'smooth, dry',
    'mixed',
    'rough, dry',
)
AIMS = {GROUPS[0]: 0.999, GROUPS[3]: 0.99}
"""Shares that shall converge [-]; every other case shall say by its status that it did not."""
DECADES = (0.0, 1e-4, 1e-3, 1e-2, 1e-1, 0.5, math.inf)
"""Upper ends of the classes of RCS [-]."""
OVERRUN = 1.5
"""Wall time over the time cap from which a case counts as one that hangs [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ColdCase:
    """Number in the list, kind, contact; load [N], speed [m/s], viscosity [Pa s], rms [um]."""

    number: int
    kind: str
    side: str
    load: float
    speed: float
    viscosity: float
    rms: float
    draw: int

    @property
    def key(self) -> str:
        """Return the number and a hash of all numbers: a row of another list does not count."""
        text = repr(asdict(self))
        return f'{self.number}-{hashlib.sha256(text.encode()).hexdigest()[:8]}'

    @property
    def settings(self) -> Settings:
        """Return how the case is solved."""
        return SETTINGS[self.kind]


@dataclass(frozen=True, kw_only=True, slots=True)
class Ending:
    """
    One finished case.

    Units as in `ColdCase`; RCS and asperity share [-], films [nm], smooth minimum film over the
    floor [-] (solved if the case is smooth and converged, else by formula), wall time [s].
    `finite` tells whether all numbers and fields are; the status of a case that raised is the
    exception.

    """

    key: str
    kind: str
    side: str
    load: float
    speed: float
    viscosity: float
    rms: float
    draw: int
    status: str
    converged: bool
    finite: bool
    rcs: float
    asperity_share: float
    central_film: float
    minimum_film: float
    film_over_floor: float
    newton: int
    krylov: int
    seconds: float

    @property
    def group(self) -> str:
        """Return the group that the case is counted in."""
        if self.kind == 'mixed':
            return 'mixed' if self.speed else 'rough, dry'
        if not self.speed:
            return 'smooth, dry'
        return GROUPS[0] if self.film_over_floor > TOUCHING else GROUPS[1]

    @property
    def defect(self) -> bool:
        """Tell whether the solver broke its word: raised, hung, or called a NaN a result."""
        raised = not self.newton and ':' in self.status
        hung = self.seconds > OVERRUN * SETTINGS[self.kind].time_cap
        return raised or hung or (self.converged and not self.finite)


def case_list() -> list[ColdCase]:
    """Return the list, both kinds mixed so that any part of it is a fair sample."""
    drawn = np.random.default_rng(SEED).random((COUNT, 8))
    return [make_case(number, *map(float, row)) for number, row in enumerate(drawn)]


def make_case(
    number: int,
    kind: float,
    side: float,
    load: float,
    rest: float,
    speed: float,
    viscosity: float,
    rms: float,
    draw: float,
) -> ColdCase:
    """Return the case of eight places between 0 and 1: loads [N], speeds [m/s]."""
    rough = kind < ROUGH_SHARE
    name = 'mixed' if rough else 'smooth'
    return ColdCase(
        number=number,
        kind=name,
        side='screw' if side < 0.5 else 'nut',
        load=between(*LOADS[name], load),
        speed=0.0 if rest < RESTING_SHARE else between(*SPEEDS, speed),
        viscosity=between(*VISCOSITIES, viscosity),
        rms=between(*ROUGHNESSES, rms) if rough else 0.0,
        draw=int(DRAWS * draw) if rough else 0,
    )


def between(low: float, high: float, place: float) -> float:
    """Return a number between two others, logarithmic, to four digits as the table shows it."""
    return float(f'{low * (high / low) ** place:.4g}')


def solve(case: ColdCase) -> Ending:
    """Solve one case from cold; an exception becomes a row."""
    contact, oil = screw_contact(load_screw('nominal'), case.side), load_lubricant('iso_vg_68')
    lubricant = ContactLubricant(
        viscosity=case.viscosity, pressure_viscosity=oil.pressure_viscosity
    )
    over_floor = film_by_formula(case, contact, lubricant) / case.settings.film_floor
    began = time.perf_counter()
    try:
        found = solve_contact(
            contact,
            lubricant,
            Condition(load=case.load, entrainment_speed=case.speed),
            roughness=heights(contact, case) if case.rms else None,
            settings=case.settings,
        )
    except Exception as error:  # whatever it is, it is what the table is there to show
        text = f'{type(error).__name__}: {error}'
        return failed(case, text, time.perf_counter() - began, over_floor)
    if found.converged and not case.rms:
        over_floor = found.minimum_film / case.settings.film_floor
    return finished(case, found, over_floor)


def heights(contact: Contact, case: ColdCase) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Return the roughness of a case as a function of places [m]."""
    ellipse = hertz(contact, WINDOW_LOAD)
    window = Window(
        length_x=2 * float(ellipse.semi_axis_x), length_y=2 * float(ellipse.semi_axis_y)
    )
    surface = take_patch(surface_of(case.draw), 'rescaled', window, case.rms * 1e-6)
    return lambda x, y: surface.heights(x[:, 0], y[0])


@lru_cache(maxsize=DRAWS)
def surface_of(draw: int) -> FractalSurface:
    """Return one draw of the nominal raceway with the waves of this study."""
    return fractal_surface(PublishedRoughness(shortest_wavelength=SHORTEST_WAVELENGTH), draw)


def film_by_formula(case: ColdCase, contact: Contact, lubricant: ContactLubricant) -> float:
    """Return the smooth minimum film [m]."""
    if not case.speed:
        return 0.0
    g = groups(contact, case.load, case.speed, lubricant.viscosity, lubricant.pressure_viscosity)
    return float(minimum_film_hamrock_dowson_1977(contact, g))


def finished(case: ColdCase, found: ContactSolution, over_floor: float) -> Ending:
    """Return the row of a case that gave a result."""
    return Ending(
        **numbers(case),
        status=found.status.name,
        converged=found.converged,
        finite=is_finite(found),
        rcs=rounded(found.rcs),
        asperity_share=rounded(found.asperity_share),
        central_film=rounded(1e9 * found.central_film),
        minimum_film=rounded(1e9 * found.minimum_film),
        film_over_floor=rounded(over_floor),
        newton=found.newton_iterations,
        krylov=found.krylov_iterations,
        seconds=rounded(found.wall_time),
    )


def failed(case: ColdCase, status: str, seconds: float, over_floor: float) -> Ending:
    """Return the row of a case that raised after some time [s]."""
    names = ('rcs', 'asperity_share', 'central_film', 'minimum_film')
    return Ending(
        **numbers(case),
        **dict.fromkeys(names, math.nan),
        status=status,
        converged=False,
        finite=False,
        film_over_floor=rounded(over_floor),
        newton=0,
        krylov=0,
        seconds=rounded(seconds),
    )


def numbers(case: ColdCase) -> dict[str, object]:
    """Return the columns that a row takes from its case."""
    columns = asdict(case)
    del columns['number']
    return {'key': case.key, **columns}


def rounded(value: float) -> float:
    """Return a number to five digits."""
    return float(f'{value:.5g}')


def is_finite(found: ContactSolution) -> bool:
    """Tell whether fields are finite, and sums if converged; error estimates may be missing."""
    names = 'film_pressure asperity_pressure film approach load_error residual gap_error'
    if found.converged:
        names += ' central_film minimum_film max_pressure rcs asperity_share rolling_force'
    return all(bool(np.isfinite(getattr(found, name)).all()) for name in names.split())


def read_rows(path: Path) -> dict[str, Ending]:
    """Return the finished rows of a table by their keys."""
    return {row.key: row for row in read_table(path, Ending)}


def write_rows(path: Path, rows: Iterable[Ending]) -> None:
    """Write the table as a whole."""
    write_table(path, Ending, rows)


def solve_plain(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Solve a case in plain JSON."""
    return asdict(solve(ColdCase(**inputs)))


def run(cases: list[ColdCase], path: Path, workers: int) -> dict[str, Ending]:
    """Solve what the store beside the table does not keep; return all rows by their keys."""
    tasks = {case.key: asdict(case) for case in cases}
    found = run_kept(path, WORK, solve_plain, tasks, workers=workers, unit='cases')
    return {key: Ending(**result) for key, result in found.items()}


def print_report(rows: list[Ending]) -> None:
    """Print how the cases ended, by group and by RCS, and each one that did not converge."""
    print_groups(rows)
    print_decades(rows)
    print_times(rows)
    print_cases('not converged', [row for row in rows if not row.converged])
    print_cases('DEFECT', [row for row in rows if row.defect])


def print_groups(rows: list[Ending]) -> None:
    """Print the counts by group."""
    print('| group | cases | converged | flagged | share | aim | not finite | defects |')
    print('|---|---|---|---|---|---|---|---|')
    for name in GROUPS:
        here = [row for row in rows if row.group == name]
        good = sum(row.converged for row in here)
        aim = f'{100 * AIMS[name]:g} %' if name in AIMS else '-'
        print(
            f'| {name} | {len(here)} | {good} | {len(here) - good} | '
            f'{100 * good / max(len(here), 1):.2f} % | {aim} | '
            f'{sum(not row.finite for row in here)} | {sum(row.defect for row in here)} |'
        )


def print_decades(rows: list[Ending]) -> None:
    """Print the counts by class of RCS, which is unknown for a case that did not converge."""
    print('\n| RCS | smooth | rough |\n|---|---|---|')
    for low, high in zip((-1.0, *DECADES[:-1]), DECADES):
        name = '0' if high == 0 else f'to {high:g}' if high < 1 else f'above {low:g}'
        here = [row for row in rows if row.converged and low < row.rcs <= high]
        print_kinds(name, here)
    print_kinds('unknown', [row for row in rows if not row.converged])


def print_kinds(name: str, rows: list[Ending]) -> None:
    """Print how many rows are smooth and rough."""
    smooth = sum(row.kind == 'smooth' for row in rows)
    print(f'| {name} | {smooth} | {len(rows) - smooth} |')


def print_times(rows: list[Ending]) -> None:
    """Print percentiles of the wall time [s] by group, and the slowest case."""
    print('\n| wall time [s] | 50 % | 90 % | 99 % | all |\n|---|---|---|---|---|')
    for name in GROUPS:
        times = [row.seconds for row in rows if row.group == name]
        if times:
            shown = (f'{value:.2f}' for value in np.percentile(times, (50, 90, 99, 100)))
            print(f'| {name} | ' + ' | '.join(shown) + ' |')
    if rows:
        print_cases('slowest', [max(rows, key=lambda row: row.seconds)])


def print_cases(title: str, rows: Iterable[Ending]) -> None:
    """Print cases, one a line."""
    shown = sorted(rows, key=lambda row: (row.group, row.status, row.film_over_floor))
    print(f'\n{title}: {len(shown)}')
    for row in shown:
        print(
            f'  {row.key:13} {row.group}, {row.side}: {row.load:g} N, {row.speed:g} m/s, '
            f'{row.viscosity:g} Pa s, Rq {row.rms:g} um draw {row.draw}: {row.status}, '
            f'film/floor {row.film_over_floor:.2f}, RCS {row.rcs:.3g}, newton {row.newton}, '
            f'{row.seconds:.2f} s'
        )


def main() -> None:
    """Solve what is missing and print the report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--out', type=Path, default=Path('studies/results/robustness.csv'))
    parser.add_argument('--every', type=int, default=1, help='each N-th case only')
    parser.add_argument('--workers', type=int, default=1, help='processes')
    parser.add_argument('--report', action='store_true', help='only print')
    args = parser.parse_args()
    cases, done = case_list()[:: args.every], read_rows(args.out)
    if not args.report:
        done |= run(cases, args.out, args.workers)
        write_rows(args.out, done.values())
    print_report([done[case.key] for case in cases if case.key in done])


if __name__ == '__main__':
    main()
