# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One task of the comparison with the published study, solved.

Contacts are those of the screw side, with the study's entrainment w r_m / 2; the whole screw takes
the exact one.

"""

from dataclasses import replace
import math
import time
from typing import Any

import numpy as np
from surrogate.asperities.law import AsperityContact
from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.ehl.domain import nodes_on_waves
from surrogate.ehl.friction import contact_friction, ContactFriction
from surrogate.formulas.film import asperity_share_aihara_1987
from surrogate.formulas.geometry import hertz
from surrogate.formulas.kinematics import entrainment_speed_paper
from surrogate.formulas.load_sharing import normal_force, nut_forces
from surrogate.paper.cases import CASES, SMOOTH, STANDING, StudyTask
from surrogate.paper.raceway import published_patch
from surrogate.paper.rows import ContactFields, empty_row, StudyRow
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.short_waves import subgrid_floor, without_short_waves
from surrogate.screw import closed_form
from surrogate.screw.ball_motion import slip_floor
from surrogate.screw.contacts import ACROSS, Kinematics, ScrewSettings
from surrogate.screw.nut import contact_slip, ScrewContact
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import ScrewSolution, solve_screw
from surrogate.units import RPM

NX, NY = 129, 257
"""Nodes of a rough contact along and least across the track [-]."""
SHORTEST_ON_GRID = 16e-6
"""Waves below that raise the film floor [m]."""
OUTLET, SIDE = 1.5, 1.5
"""Edges of a domain with a short inlet over the semi-axes [-]."""
INNER = 0.5
"""Size of the inner ellipse whose film is averaged, over the Hertz ellipse [-]."""


def solve_task(
    screw: Screw, lubricant: Lubricant, task: StudyTask, inputs: str
) -> tuple[StudyRow, ContactFields | None]:
    """Solve one task; return its row and, for a contact that keeps them, its fields."""
    began = time.process_time()
    speed = float(entrainment_speed_paper(screw, task.rpm * RPM))
    row = replace(empty_row(task, inputs), entrainment_speed=speed)
    kept = None
    if task.kind == 'contact':
        row, kept = _contact(screw, lubricant, task, row)
    elif task.kind == 'screw':
        row = _screw(screw, lubricant, task, row)
    else:
        row = _formulas(screw, lubricant, task, row)
    return replace(row, seconds=time.process_time() - began), kept


def _contact(
    screw: Screw, lubricant: Lubricant, task: StudyTask, row: StudyRow
) -> tuple[StudyRow, ContactFields | None]:
    forces = nut_forces(task.load, screw.preload)
    force = float(normal_force(screw, forces[CASES[task.case].nut == 'relieved']))
    solution, surface = solve_patch(screw, lubricant, task, force, row.entrainment_speed)
    row = replace(row, status=solution.status.name, normal_force=force)
    if not solution.converged:
        return row, None
    middle = float(np.mean(solution.film[solution.distance < INNER]))
    smooth = task.draw == SMOOTH and not math.isnan(solution.extrapolated_film)
    row = replace(
        row,
        central_film=solution.extrapolated_film if smooth else solution.central_film,
        mean_film=middle,
        minimum_film=solution.minimum_film,
        max_pressure=solution.max_pressure,
        rcs=solution.rcs,
        asperity_share=solution.asperity_share,
        asperity_distance=asperity_distance(solution),
    )
    return row, _fields(solution, surface, task.fields) if task.fields else None


def solve_patch(
    screw: Screw, lubricant: Lubricant, task: StudyTask, force: float, speed: float
) -> tuple[ContactSolution, FractalSurface | None]:
    """
    Solve the contact of a task under a normal `force` [N] at an entrainment `speed` [m/s].

    Waves of the draw that are too short for the grid raise the film floor, as where the roughness
    of a screw stands still.

    """
    case, contact = CASES[task.case], Contacts.of(screw).geometry['screw']
    oil = ContactLubricant(
        viscosity=case.viscosity or lubricant.viscosity,
        pressure_viscosity=lubricant.pressure_viscosity,
        eyring_stress=lubricant.eyring_stress,
    )
    settings = Settings(film_floor=lubricant.film_floor)
    if case.inlet is not None:
        domain = (-case.inlet, OUTLET, SIDE)
        settings = replace(settings, domain=domain, open_inlet=False)
    condition, surface = Condition(load=force, entrainment_speed=speed), None
    if task.draw == SMOOTH:
        return solve_contact(contact, oil, condition, settings=settings), None
    surface = published_patch(screw, task.draw)
    raised = subgrid_floor(surface, SHORTEST_ON_GRID)
    surface = without_short_waves(surface, SHORTEST_ON_GRID)
    width = ACROSS * float(hertz(contact, force).semi_axis_y)
    settings = replace(
        settings,
        nx=NX,
        ny=max(NY, nodes_on_waves(width, surface.shortest_wavelength)),
        film_floor=settings.film_floor + raised,
        error_estimate=False,
    )
    found = solve_contact(contact, oil, condition, roughness=surface.heights, settings=settings)
    return found, surface


def asperity_distance(solution: ContactSolution) -> float:
    """
    Return the mean distance of the asperity load from the centre over the semi-axes [-].

    NaN without asperity load; 2/3 for an even load over the ellipse, 0.589 for Hertz's.

    """
    carried = solution.asperity_pressure
    if not carried.any():
        return math.nan
    return float(np.sum(carried * solution.distance) / np.sum(carried))


def _fields(solution: ContactSolution, surface: FractalSurface | None, kind: str) -> ContactFields:
    """Return all nodes, or those of the centre line."""
    middle = int(np.argmin(np.abs(solution.y)))
    columns = slice(None) if kind == 'map' else slice(middle, middle + 1)
    y = solution.y[columns]
    heights = np.zeros((len(solution.x), len(y)))
    return ContactFields(
        x=solution.x,
        y=y,
        semi_axis_x=solution.semi_axis_x,
        semi_axis_y=solution.semi_axis_y,
        hertz_pressure=solution.hertz_pressure,
        film_pressure=solution.film_pressure[:, columns],
        asperity_pressure=solution.asperity_pressure[:, columns],
        film=solution.film[:, columns],
        heights=heights if surface is None else surface.heights(solution.x, y),
    )


def _screw(screw: Screw, lubricant: Lubricant, task: StudyTask, row: StudyRow) -> StudyRow:
    """Solve the whole screw in the full tier."""
    point = OperatingPoint(
        speed=task.rpm * RPM, load=task.load, temperature=lubricant.reference_temperature
    )
    # The published study is isothermal.
    kinematics: Kinematics = 'standing' if task.case == STANDING else 'rolling'
    settings = ScrewSettings(kinematics=kinematics, inlet_heating=False)
    found = solve_screw(screw, lubricant, point, settings=settings)
    row = replace(row, status='CONVERGED' if found.converged else found.status)
    if not found.converged:
        return row
    row = replace(
        row,
        normal_force=found.normal_forces[0],
        central_film=found.central_film,
        minimum_film=found.minimum_film,
        rcs=found.rcs,
        asperity_share=found.asperity_share,
        rcs_deviation=found.rcs_deviation,
        rcs_loaded=max(one.rcs for one in _touching(found, 'loaded')),
        rcs_relieved=max((one.rcs for one in _touching(found, 'relieved')), default=0.0),
        friction_torque=found.friction_torque,
    )
    return _with_friction(screw, found, row)


def _touching(found: ScrewSolution, nut: str) -> list[AsperityContact]:
    """Return what asperities do in the contacts of a nut that carry load."""
    return [
        contact.solved.asperities
        for contact in found.contacts
        if contact.solved is not None and nut == contact.nut
    ]


def _with_friction(screw: Screw, found: ScrewSolution, row: StudyRow) -> StudyRow:
    """Add the parts of torque and friction coefficient, and both other ways to a torque."""
    pressed = [contact for contact in found.contacts if contact.motion is not None]
    local = [_friction(screw, contact, 'local') for contact in pressed]
    central = [_friction(screw, contact, 'central') for contact in pressed]
    forces = np.array([contact.ball.normal_force for contact in pressed])
    balls, speed = screw.loaded_balls_per_nut, row.rpm * RPM
    film, asperity, mean = (
        float(np.sum(forces * [getattr(one, name) for one in local]) / forces.sum())
        for name in ('film_coefficient', 'asperity_coefficient', 'coefficient')
    )
    on_screw = [
        force * one.coefficient
        for force, one, contact in zip(forces, local, pressed, strict=True)
        if contact.side == 'screw'
    ]
    return replace(
        row,
        sliding_torque=balls * sum(one.ball.slip_power for one in pressed) / speed,
        rolling_torque=balls * sum(one.ball.rolling_power for one in pressed) / speed,
        central_film_torque=balls * sum(one.power for one in central) / speed,
        track_torque=balls * screw.pitch_radius * float(sum(on_screw)),
        friction_coefficient=mean,
        film_coefficient=film,
        asperity_coefficient=asperity,
    )


def _friction(screw: Screw, contact: ScrewContact, film: Any) -> ContactFriction:
    """Return the friction of a balanced contact, Eyring's law with the local or central film."""
    assert contact.solved is not None
    assert contact.motion is not None
    pressed = contact.solved.pressed
    slip_x, slip_y = contact_slip(screw, pressed, contact.side, contact.motion)
    return contact_friction(
        pressed,
        slip_x=slip_x,
        slip_y=slip_y,
        asperity_friction=screw.roughness.asperity_friction,
        asperity_share=contact.solved.friction_share,
        film=film,
        slip_floor=slip_floor(screw, contact.motion.screw_speed),
    )


def _formulas(screw: Screw, lubricant: Lubricant, task: StudyTask, row: StudyRow) -> StudyRow:
    """Take the screw by published formulas, asperities by a statistical share."""
    found = closed_form.solve(
        screw,
        lubricant,
        task.rpm * RPM,
        task.load,
        lubricant.reference_temperature,
        share_of=asperity_share_aihara_1987,
        inlet_heating=False,
    )
    loaded = found.contacts[0]
    on_screw = [contact for contact in found.contacts if contact.side == 'screw']
    drag = sum(float(one.friction_coefficient * one.normal_force) for one in on_screw)
    return replace(
        row,
        status='CONVERGED',
        normal_force=float(loaded.normal_force),
        central_film=float(loaded.central_film),
        minimum_film=float(loaded.minimum_film),
        rcs=float(found.rcs),
        asperity_share=float(found.asperity_share),
        rcs_loaded=float(loaded.asperity_share),
        rcs_relieved=float(found.contacts[2].asperity_share),
        friction_torque=float(found.friction_torque),
        sliding_torque=sum(float(contact.sliding_torque) for contact in found.contacts),
        rolling_torque=sum(float(contact.rolling_torque) for contact in found.contacts),
        track_torque=screw.loaded_balls_per_nut * screw.pitch_radius * drag,
        friction_coefficient=float(found.friction_coefficient),
    )
