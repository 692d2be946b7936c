# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tasks of the comparison with the published study, solved and kept.

Contacts are those of the screw side, with the study's entrainment w r_m / 2; the whole screw takes
the exact one. Every finished task is kept at once in a store beside the table of rows, so that an
interrupted study goes on where it stopped.

"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, replace
import math
from pathlib import Path
import time
from typing import Any

import numpy as np
from surrogate.asperities.law import VERSION
from surrogate.ehl import Condition, ContactSolution, Settings, solve_contact
from surrogate.ehl.domain import nodes_on_waves
from surrogate.ehl.friction import contact_friction
from surrogate.formulas.geometry import hertz
from surrogate.formulas.kinematics import entrainment_speed_paper
from surrogate.formulas.load_sharing import normal_force, nut_forces, UNLOADING_RATIO
from surrogate.parameters import load_lubricant, load_screw, Lubricant, OperatingPoint, Screw
from surrogate.raceway.fractal import fractal_surface, FractalSurface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window
from surrogate.raceway.short_waves import subgrid_floor, without_short_waves
from surrogate.screw.ball_motion import slip_floor
from surrogate.screw.contacts import oil_at, ScrewSettings
from surrogate.screw.nut import contact_slip, ScrewContact
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import solve_screw
from surrogate.studies.curves import inputs_hash, StudyRow
from surrogate.studies.tasks import OIL, RELIEVED, SCREW, SMOOTH, StudyTask
from surrogate.tasks.pool import Pool, run_tasks, TaskOutcome
from surrogate.tasks.store import TaskStore
from surrogate.tasks.table import read_table, write_table
from surrogate.units import RPM

TABLE = 'paper.csv'
"""Name of the table of rows in the output folder."""
WORK = 'surrogate.studies.solve 2'
"""Solver and version of the kept results."""
WINDOW_SHARE = 0.05
"""Least axial load whose Hertz rectangle is the window of the patch, over the rating [-]."""
PUBLISHED = PublishedRoughness()
"""Constants of the study."""
NX, NY = 129, 257
"""Nodes of a rough contact along and least across the track [-]."""
SHORTEST_ON_GRID = 16e-6
"""Waves below that raise the film floor [m]."""
ACROSS = 2.42
"""About the width of a rough domain over the semi-axis across (2.4 to 3.1) [-]."""
INNER = 0.5
"""Size of the inner ellipse whose film is averaged, over the Hertz ellipse [-]."""
Numbers = dict[str, float]


def run_study(
    folder: Path,
    wanted: Sequence[StudyTask],
    pool: Pool,
    report: Callable[[int, int], None] = lambda done, total: None,
) -> dict[str, StudyRow]:
    """
    Solve the tasks whose results `folder` does not keep yet; return all that were wanted by key.

    `report` is told after each solve how many are done and how many there are.

    """
    known = known_inputs()
    inputs = {task.key: asdict(task) | {'inputs': known[task.kind]} for task in wanted}
    left, done = len(wanted), 0

    def count(outcome: TaskOutcome) -> None:  # those that were kept come first
        nonlocal left, done
        left -= 1
        if not outcome.stored:
            done += 1
            report(done, done + left)

    with TaskStore(folder / TABLE, WORK) as store:
        outcomes = run_tasks(pool, solve_plain, inputs, store=store, report=count)
    rows = [
        StudyRow(**result)
        if (result := outcomes[task.key].result)
        else StudyRow(**inputs[task.key], status=outcomes[task.key].sentence)
        for task in wanted
    ]
    write_table(folder / TABLE, StudyRow, rows, digits=6)
    # As they stand in the table, so that a report is the same from either.
    return {row.key: row for row in read_table(folder / TABLE, StudyRow)}


def known_inputs() -> dict[str, str]:
    """Return `inputs` of the rows by their kind; the asperity law decides those of the screw."""
    screw, oil = load_screw(SCREW), load_lubricant(OIL)
    return {'screw': inputs_hash(screw, oil, VERSION), 'contact': inputs_hash(screw, oil)}


def solve_plain(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Solve a task in plain JSON; return its row."""
    words = dict(inputs)
    known = words.pop('inputs')
    opened = Contacts.of(load_screw(SCREW))
    return asdict(solve_task(opened, load_lubricant(OIL), StudyTask(**words), known))


def solve_task(opened: Contacts, lubricant: Lubricant, task: StudyTask, inputs: str) -> StudyRow:
    """Solve one task; return its row."""
    began = time.process_time()
    solve = _contact if task.kind == 'contact' else _screw
    status, numbers = solve(opened, lubricant, task)
    seconds = time.process_time() - began
    return StudyRow(**asdict(task) | numbers, inputs=inputs, status=status, seconds=seconds)


def _taken(result: Any, names: str) -> Numbers:
    return {name: float(getattr(result, name)) for name in names.split()}


def _contact(opened: Contacts, lubricant: Lubricant, task: StudyTask) -> tuple[str, Numbers]:
    screw = opened.sheet
    speed = float(entrainment_speed_paper(screw, task.rpm * RPM))
    force = float(normal_force(screw, nut_forces(task.load, screw.preload)[task.nut == RELIEVED]))
    solution = solve_patch(opened, lubricant, task, force, speed)
    numbers: Numbers = {'normal_force': force}
    if not solution.converged:
        return solution.status.name, numbers
    numbers |= _taken(solution, 'central_film rcs asperity_share')
    if task.draw == SMOOTH and not math.isnan(solution.extrapolated_film):
        numbers['central_film'] = solution.extrapolated_film
    numbers['mean_film'] = float(np.mean(solution.film[solution.distance < INNER]))
    carried = solution.asperity_pressure
    if carried.any():
        distance = np.sum(carried * solution.distance) / np.sum(carried)
        numbers['asperity_distance'] = float(distance)
    return solution.status.name, numbers


def published_patch(opened: Contacts, draw: int) -> FractalSurface:
    """
    Return one draw of the published raceway, rescaled once over a window that no load moves.

    The window is the Hertz rectangle on the screw side under the load that relieves the other nut,
    or under `WINDOW_SHARE` of the static rating where that is larger.

    """
    screw = opened.sheet
    force = max(UNLOADING_RATIO * screw.preload, WINDOW_SHARE * screw.static_rating)
    ellipse = hertz(opened.geometry['screw'], float(normal_force(screw, force)))
    x, y = (2 * float(axis) for axis in (ellipse.semi_axis_x, ellipse.semi_axis_y))
    window = Window(length_x=x, length_y=y)
    return take_patch(fractal_surface(PUBLISHED, draw), 'rescaled', window, PUBLISHED.rms)


def solve_patch(
    opened: Contacts, lubricant: Lubricant, task: StudyTask, force: float, speed: float
) -> ContactSolution:
    """
    Solve the contact of a task under a normal `force` [N] at an entrainment `speed` [m/s].

    Waves of the draw that are too short for the grid raise the film floor.

    """
    contact, oil = opened.geometry['screw'], oil_at(lubricant, lubricant.reference_temperature)
    settings = Settings(film_floor=lubricant.film_floor)
    condition = Condition(load=force, entrainment_speed=speed)
    if task.draw == SMOOTH:
        return solve_contact(contact, oil, condition, settings=settings)
    whole = published_patch(opened, task.draw)
    surface = without_short_waves(whole, SHORTEST_ON_GRID)
    width = ACROSS * float(hertz(contact, force).semi_axis_y)
    settings = replace(
        settings,
        nx=NX,
        ny=max(NY, nodes_on_waves(width, surface.shortest_wavelength)),
        film_floor=settings.film_floor + subgrid_floor(whole, SHORTEST_ON_GRID),
        error_estimate=False,
    )
    return solve_contact(contact, oil, condition, roughness=surface.heights, settings=settings)


def _screw(opened: Contacts, lubricant: Lubricant, task: StudyTask) -> tuple[str, Numbers]:
    """Solve the whole screw in the full tier; the published study is isothermal."""
    temperature, screw = lubricant.reference_temperature, opened.sheet
    point = OperatingPoint(speed=task.rpm * RPM, load=task.load, temperature=temperature)
    settings = ScrewSettings(inlet_heating=False)
    solution = solve_screw(opened, lubricant, point, settings=settings)
    if not solution.converged:
        return solution.status, {}
    pressed = [contact for contact in solution.contacts if contact.motion is not None]
    numbers = _taken(solution, 'central_film rcs asperity_share friction_torque')
    numbers['normal_force'] = solution.normal_forces[0]
    for nut in ('loaded', 'relieved'):
        shares = [contact.rcs for contact in pressed if contact.nut == nut]
        numbers[f'rcs_{nut}'] = max(shares, default=0.0)
    for part, power in (('sliding', 'slip_power'), ('rolling', 'rolling_power')):
        lost = sum(getattr(contact.ball, power) for contact in pressed)
        numbers[f'{part}_torque'] = screw.loaded_balls_per_nut * lost / point.speed
    return 'CONVERGED', numbers | _frictions(screw, pressed)


def _frictions(screw: Screw, pressed: Sequence[ScrewContact]) -> Numbers:
    """Return the friction coefficient of all contacts and its parts [-]."""
    frictions = []
    for contact in pressed:
        assert contact.solved is not None
        assert contact.motion is not None
        slip_x, slip_y = contact_slip(screw, contact.solved.pressed, contact.side, contact.motion)
        frictions.append(
            contact_friction(
                contact.solved.pressed,
                slip_x=slip_x,
                slip_y=slip_y,
                asperity_friction=screw.roughness.asperity_friction,
                asperity_share=contact.solved.friction_share,
                slip_floor=slip_floor(screw, contact.motion.screw_speed),
            )
        )
    forces = np.array([contact.ball.normal_force for contact in pressed])
    return {
        f'{column}coefficient': float(
            np.average([getattr(part, f'{name}coefficient') for part in frictions], weights=forces)
        )
        for name, column in (('', 'friction_'), ('film_', 'film_'), ('asperity_', 'asperity_'))
    }
