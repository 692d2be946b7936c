# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tasks of the comparison with the published study, solved and kept.

Contacts are those of the screw side, with the study's entrainment w r_m / 2; the whole screw takes
the exact one. Every finished task is kept at once in a store beside the table of rows, so that an
interrupted study goes on where it stopped.

"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
import math
from pathlib import Path
import time
from typing import Any

import numpy as np
from surrogate.asperities.law import VERSION
from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.ehl.domain import nodes_on_waves
from surrogate.ehl.friction import contact_friction, ContactFriction
from surrogate.formulas.film import asperity_share_aihara_1987
from surrogate.formulas.geometry import hertz
from surrogate.formulas.kinematics import entrainment_speed_paper
from surrogate.formulas.load_sharing import normal_force, nut_forces, UNLOADING_RATIO
from surrogate.parameters import load_lubricant, load_screw, Lubricant, OperatingPoint, Screw
from surrogate.raceway.fractal import fractal_surface, FractalSurface, PublishedRoughness
from surrogate.raceway.patch import take_patch, Window
from surrogate.raceway.short_waves import subgrid_floor, without_short_waves
from surrogate.screw import closed_form
from surrogate.screw.ball_motion import slip_floor
from surrogate.screw.contacts import ACROSS, Kinematics, ScrewSettings
from surrogate.screw.nut import contact_slip, ScrewContact
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import solve_screw
from surrogate.studies.curves import inputs_hash, StudyRow
from surrogate.studies.tasks import (
    OIL,
    RELIEVED,
    SCREW,
    SHORT,
    SHORT_INLET,
    SHORT_VISCOSITY,
    SMOOTH,
    STANDING,
    StudyTask,
)
from surrogate.tasks.pool import Pool, run_tasks, TaskOutcome
from surrogate.tasks.store import TaskStore
from surrogate.tasks.table import read_table, write_table
from surrogate.units import RPM

TABLE = 'paper.csv'
"""Name of the table of rows in the output folder."""
WORK = 'surrogate.studies.solve 1'
"""Solver and version of the kept results."""
WINDOW_SHARE = 0.05
"""Least axial load whose Hertz rectangle is the window of the patch, over the rating [-]."""
PUBLISHED = PublishedRoughness()
"""Constants of the study."""
NX, NY = 129, 257
"""Nodes of a rough contact along and least across the track [-]."""
SHORTEST_ON_GRID = 16e-6
"""Waves below that raise the film floor [m]."""
OUTLET, SIDE = 1.5, 1.5
"""Edges of a domain with a short inlet over the semi-axes [-]."""
INNER = 0.5
"""Size of the inner ellipse whose film is averaged, over the Hertz ellipse [-]."""
Fields = dict[str, Any]
"""What a picture of a contact needs, SI units: x, y, semi-axes, pressures, film and heights."""
Numbers = dict[str, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Study:
    """Rows of the asked tasks by key, in their order, and the fields of those that keep them."""

    rows: dict[str, StudyRow]
    fields: dict[str, Fields]


def run_study(
    folder: Path,
    wanted: Sequence[StudyTask],
    pool: Pool,
    report: Callable[[int, int], None] = lambda done, total: None,
) -> Study:
    """
    Solve the tasks whose results `folder` does not keep yet; return all that were wanted.

    `report` is told after each solve how many are done and how many there are.

    """
    known = known_inputs()
    inputs = {task.key: asdict(task) | {'inputs': known[task.rolls]} for task in wanted}
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
        StudyRow(**result['row'])
        if (result := outcomes[task.key].result)
        else StudyRow(**inputs[task.key], status=outcomes[task.key].sentence)
        for task in wanted
    ]
    write_table(folder / TABLE, StudyRow, rows, digits=6)
    return Study(
        # As they stand in the table, so that a report is the same from either.
        rows={row.key: row for row in read_table(folder / TABLE, StudyRow)},
        fields={key: kept.result['fields'] for key, kept in outcomes.items() if kept.result},
    )


def known_inputs() -> dict[bool, str]:
    """Return `inputs` of the rows that the asperity law decides, and of those it does not."""
    screw, oil = load_screw(SCREW), load_lubricant(OIL)
    return {True: inputs_hash(screw, oil, VERSION), False: inputs_hash(screw, oil)}


def solve_plain(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Solve a task in plain JSON; return its row and, where they are kept, its fields."""
    words = dict(inputs)
    known = words.pop('inputs')
    row, fields = solve_task(
        Contacts.of(load_screw(SCREW)), load_lubricant(OIL), StudyTask(**words), known
    )
    plain = {name: np.asarray(value).tolist() for name, value in fields.items()}
    return {'row': asdict(row), 'fields': plain}


def solve_task(
    opened: Contacts, lubricant: Lubricant, task: StudyTask, inputs: str
) -> tuple[StudyRow, Fields]:
    """Solve one task; return its row and, for a contact that keeps them, its fields."""
    began = time.process_time()
    speed = float(entrainment_speed_paper(opened.sheet, task.rpm * RPM))
    status = 'CONVERGED'
    fields: Fields = {}
    if task.kind == 'contact':
        status, numbers, fields = _contact(opened, lubricant, task, speed)
    elif task.kind == 'screw':
        status, numbers = _screw(opened, lubricant, task)
    else:
        numbers = _formulas(opened, lubricant, task)
    seconds = time.process_time() - began
    whole = asdict(task) | numbers | {'entrainment_speed': speed, 'seconds': seconds}
    return StudyRow(**whole, inputs=inputs, status=status), fields


def _taken(result: Any, names: str) -> Numbers:
    return {name: float(getattr(result, name)) for name in names.split()}


def _contact(
    opened: Contacts, lubricant: Lubricant, task: StudyTask, speed: float
) -> tuple[str, Numbers, Fields]:
    screw = opened.sheet
    forces = nut_forces(task.load, screw.preload)
    force = float(normal_force(screw, forces[task.case == RELIEVED]))
    solution, surface = solve_patch(opened, lubricant, task, force, speed)
    numbers: Numbers = {'normal_force': force}
    if not solution.converged:
        return solution.status.name, numbers, {}
    numbers |= _taken(solution, 'central_film minimum_film max_pressure rcs asperity_share')
    if task.draw == SMOOTH and not math.isnan(solution.extrapolated_film):
        numbers['central_film'] = solution.extrapolated_film
    numbers['mean_film'] = float(np.mean(solution.film[solution.distance < INNER]))
    carried = solution.asperity_pressure
    if carried.any():
        distance = np.sum(carried * solution.distance) / np.sum(carried)
        numbers['asperity_distance'] = float(distance)
    return solution.status.name, numbers, _fields(solution, surface, task.fields)


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
) -> tuple[ContactSolution, FractalSurface | None]:
    """
    Solve the contact of a task under a normal `force` [N] at an entrainment `speed` [m/s].

    Waves of the draw that are too short for the grid raise the film floor, as where the roughness
    of a screw stands still.

    """
    short, contact = task.case == SHORT, opened.geometry['screw']
    oil = ContactLubricant(
        viscosity=SHORT_VISCOSITY if short else lubricant.viscosity,
        pressure_viscosity=lubricant.pressure_viscosity,
        eyring_stress=lubricant.eyring_stress,
    )
    settings = Settings(film_floor=lubricant.film_floor)
    if short:
        settings = replace(settings, domain=(-SHORT_INLET, OUTLET, SIDE), open_inlet=False)
    condition = Condition(load=force, entrainment_speed=speed)
    if task.draw == SMOOTH:
        return solve_contact(contact, oil, condition, settings=settings), None
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
    rough = solve_contact(contact, oil, condition, roughness=surface.heights, settings=settings)
    return rough, surface


def _fields(solution: ContactSolution, surface: FractalSurface | None, kind: str) -> Fields:
    if not kind:
        return {}
    middle = int(np.argmin(np.abs(solution.y)))
    columns = slice(None) if kind == 'map' else slice(middle, middle + 1)
    x, y = solution.x, solution.y[columns]
    heights = np.zeros((len(x), len(y))) if surface is None else surface.heights(x, y)
    arrays = {
        name: getattr(solution, name)[:, columns]
        for name in ('film_pressure', 'asperity_pressure', 'film')
    }
    sizes = _taken(solution, 'semi_axis_x semi_axis_y hertz_pressure')
    return {'x': x, 'y': y, 'heights': heights} | arrays | sizes


def _screw(opened: Contacts, lubricant: Lubricant, task: StudyTask) -> tuple[str, Numbers]:
    """Solve the whole screw in the full tier; the published study is isothermal."""
    temperature = lubricant.reference_temperature
    point = OperatingPoint(speed=task.rpm * RPM, load=task.load, temperature=temperature)
    kinematics: Kinematics = 'standing' if task.case == STANDING else 'rolling'
    settings = ScrewSettings(kinematics=kinematics, inlet_heating=False)
    solution = solve_screw(opened, lubricant, point, settings=settings)
    if not solution.converged:
        return solution.status, {}
    pressed = [contact for contact in solution.contacts if contact.motion is not None]
    loaded, relieved = (
        max((contact.rcs for contact in pressed if contact.nut == nut), default=0.0)
        for nut in ('loaded', 'relieved')
    )
    names = 'central_film minimum_film rcs asperity_share rcs_deviation friction_torque'
    return 'CONVERGED', {
        **_taken(solution, names),
        **_frictions(opened.sheet, pressed, point.speed),
        'normal_force': solution.normal_forces[0],
        'rcs_loaded': loaded,
        'rcs_relieved': relieved,
    }


def _frictions(screw: Screw, pressed: Sequence[ScrewContact], speed: float) -> Numbers:
    """Return the parts of torque and friction coefficient, and both other ways to a torque."""
    local, central = (
        [_friction(screw, contact, film) for contact in pressed] for film in ('local', 'central')
    )
    forces = np.array([contact.ball.normal_force for contact in pressed])
    film, asperity, mean = (
        float(np.sum(forces * [getattr(friction, name) for friction in local]) / forces.sum())
        for name in ('film_coefficient', 'asperity_coefficient', 'coefficient')
    )
    on_screw = [
        force * friction.coefficient
        for force, friction, contact in zip(forces, local, pressed, strict=True)
        if contact.side == 'screw'
    ]
    balls = screw.loaded_balls_per_nut
    return {
        'sliding_torque': balls * sum(contact.ball.slip_power for contact in pressed) / speed,
        'rolling_torque': balls * sum(contact.ball.rolling_power for contact in pressed) / speed,
        'central_film_torque': balls * sum(friction.power for friction in central) / speed,
        'track_torque': balls * screw.pitch_radius * float(sum(on_screw)),
        'friction_coefficient': mean,
        'film_coefficient': film,
        'asperity_coefficient': asperity,
    }


def _friction(screw: Screw, contact: ScrewContact, film: Any) -> ContactFriction:
    """Return the friction of a balanced contact, Eyring's law with the local or central film."""
    assert contact.solved is not None
    assert contact.motion is not None
    slip_x, slip_y = contact_slip(screw, contact.solved.pressed, contact.side, contact.motion)
    return contact_friction(
        contact.solved.pressed,
        slip_x=slip_x,
        slip_y=slip_y,
        asperity_friction=screw.roughness.asperity_friction,
        asperity_share=contact.solved.friction_share,
        film=film,
        slip_floor=slip_floor(screw, contact.motion.screw_speed),
    )


def _formulas(opened: Contacts, lubricant: Lubricant, task: StudyTask) -> Numbers:
    """Take the screw by published formulas, asperities by a statistical share."""
    screw = opened.sheet
    place = task.rpm * RPM, task.load, lubricant.reference_temperature
    point = closed_form.solve(
        opened, lubricant, *place, share_of=asperity_share_aihara_1987, inlet_heating=False
    )
    drag = sum(
        float(contact.friction_coefficient * contact.normal_force)
        for contact in point.contacts
        if contact.side == 'screw'
    )
    return {
        **_taken(point, 'rcs asperity_share friction_torque friction_coefficient'),
        **_taken(point.contacts[0], 'normal_force central_film minimum_film'),
        'rcs_loaded': float(point.contacts[0].asperity_share),
        'rcs_relieved': float(point.contacts[2].asperity_share),
        'sliding_torque': sum(float(contact.sliding_torque) for contact in point.contacts),
        'rolling_torque': sum(float(contact.rolling_torque) for contact in point.contacts),
        'track_torque': screw.loaded_balls_per_nut * screw.pitch_radius * drag,
    }
