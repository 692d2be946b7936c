# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Closed-form tier: the whole chain by published formulas, for one point or many at once.

An instant first guess and a cross-check of the full model. Its asperity share is a fit to an
average-flow model, moved to the onset of the full model, so it is labelled `closed_form` wherever
it is shown.
RCS and asperity share are the same number here. Ball inertia, the tilt of the contact lines and
elastic hysteresis are left to the full model.

"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.film import (
    asperity_share_aihara_1987,
    central_film_hamrock_dowson_1977,
    film_ratio,
    Groups,
    groups,
    minimum_film_hamrock_dowson_1977,
    rolling_force_biboulet_houpert_2010,
)
from surrogate.formulas.geometry import Hertz, hertz, screw_contact, Side, SIDES
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.load_sharing import normal_force, nut_forces, NutName
from surrogate.formulas.lubricant import lubricant_state, LubricantState
from surrogate.formulas.sliding import sliding_friction
from surrogate.formulas.starvation import starved_speed
from surrogate.parameters import Lubricant, Screw

Array = NDArray[np.float64]
TIER = 'closed_form'
FILM_SCALE = 2.7
"""Film ratio that the fit of asperity shares is read at over that of the screw [-], by which RCS
passes 0.01 where solved contacts under a rolling raceway do."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactResult:
    """
    One of the four contacts of the screw, at many points; films are NaN where it carries no load.

    Normal force per ball [N], Hertz ellipse, film groups [-], central and minimum film [m], film
    ratio [-], asperity share [-], friction coefficient [-], rolling force per surface [N],
    friction torque of all balls of the nut on this side [N m], sliding and rolling.

    """

    nut: NutName
    side: Side
    normal_force: Array
    ellipse: Hertz
    film_groups: Groups
    central_film: Array
    minimum_film: Array
    film_ratio: Array
    asperity_share: Array
    friction_coefficient: Array
    rolling_force: Array
    sliding_torque: Array
    rolling_torque: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewResult:
    """
    The screw at many points, arrays of one shape.

    Friction torque [N m] with the parasitic part; RCS and asperity share [-] of the worst contact;
    film ratio [-], central and minimum film [m] of the thinnest; load-weighted friction
    coefficient [-]; largest Hertz pressure [Pa]; index of the worst contact in `contacts`;
    entrainment speed [m/s].

    """

    friction_torque: Array
    rcs: Array
    asperity_share: Array
    film_ratio: Array
    central_film: Array
    minimum_film: Array
    friction_coefficient: Array
    max_pressure: Array
    worst_contact: NDArray[np.int64]
    entrainment_speed: Array
    contacts: tuple[ContactResult, ...]


def solve(
    screw: Screw, lubricant: Lubricant, speed: ArrayLike, load: ArrayLike, temperature: ArrayLike
) -> ScrewResult:
    """
    Solve the chain at `speed` [rad/s], at least 0, `load` [N] of any sign, `temperature` [K].

    The arguments broadcast against each other. Friction does not depend on the sign of the load,
    which only picks the nut that is loaded.

    """
    speed, load, temperature = np.broadcast_arrays(
        *(np.asarray(value, dtype=float) for value in (speed, load, temperature))
    )
    oil = lubricant_state(lubricant, temperature)
    inlet_speed = starved_speed(lubricant, speed)
    forces = nut_forces(load, screw.preload)
    nuts: tuple[tuple[NutName, Array], ...] = (('loaded', forces[0]), ('relieved', forces[1]))
    contacts = tuple(
        _solve_contact(screw, nut, side, normal_force(screw, force), oil, speed, inlet_speed)
        for nut, force in nuts
        for side in SIDES
    )
    return _combine(screw, contacts, speed)


def _solve_contact(
    screw: Screw,
    nut: NutName,
    side: Side,
    force: Array,
    oil: LubricantState,
    speed: Array,
    inlet_speed: Array,
) -> ContactResult:
    contact, balls = screw_contact(screw, side), screw.loaded_balls_per_nut
    arm = no_slip_rates(screw).entrainment
    ellipse = hertz(contact, force)
    pressed = np.where(force > 0, force, np.nan)
    g = groups(contact, pressed, arm * inlet_speed, oil.viscosity, oil.pressure_viscosity)
    film = central_film_hamrock_dowson_1977(contact, g)
    ratio = film_ratio(film, screw.composite_rms)
    share = np.where(force > 0, asperity_share_aihara_1987(FILM_SCALE * ratio), 0.0)
    sliding = sliding_friction(screw, side, ellipse, np.nan_to_num(film), share, oil, speed)
    rolling = np.nan_to_num(rolling_force_biboulet_houpert_2010(contact, g))
    return ContactResult(
        nut=nut,
        side=side,
        normal_force=force,
        ellipse=ellipse,
        film_groups=g,
        central_film=film,
        minimum_film=minimum_film_hamrock_dowson_1977(contact, g),
        film_ratio=ratio,
        asperity_share=share,
        friction_coefficient=sliding.friction_coefficient,
        rolling_force=rolling,
        sliding_torque=balls * sliding.torque,
        rolling_torque=2 * balls * rolling * arm,
    )


def _combine(screw: Screw, contacts: tuple[ContactResult, ...], speed: Array) -> ScrewResult:
    ratio = np.stack([contact.film_ratio for contact in contacts])
    # An unpressed contact is never the worst; with nothing pressed at all the first one answers.
    worst = np.argmin(np.where(np.isnan(ratio), np.inf, ratio), axis=0)

    def at_worst(name: str) -> Array:
        values = np.stack([getattr(contact, name) for contact in contacts])
        return np.asarray(np.take_along_axis(values, worst[None], axis=0)[0])

    normal = np.stack([contact.normal_force for contact in contacts])
    coefficient = np.stack([contact.friction_coefficient for contact in contacts])
    total = normal.sum(axis=0)
    loss = sum(contact.sliding_torque + contact.rolling_torque for contact in contacts)
    share = at_worst('asperity_share')
    return ScrewResult(
        friction_torque=np.asarray(
            loss + screw.parasitic_torque + screw.parasitic_torque_rate * speed
        ),
        rcs=share,
        asperity_share=share,
        film_ratio=at_worst('film_ratio'),
        central_film=at_worst('central_film'),
        minimum_film=at_worst('minimum_film'),
        friction_coefficient=np.divide(
            (coefficient * normal).sum(axis=0), total, out=np.zeros_like(total), where=total > 0
        ),
        max_pressure=np.max([contact.ellipse.max_pressure for contact in contacts], axis=0),
        worst_contact=worst,
        entrainment_speed=no_slip_rates(screw).entrainment * speed,
        contacts=contacts,
    )
