# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Closed-form tier: the whole chain by published formulas, for one point or many at once.

A first guess and a cross-check of the full model, labelled `closed_form` wherever it is shown.
What asperities do follows from the same topography as there. Ball inertia, the tilt of the contact
lines and elastic hysteresis are left to the full model. An oversize ball turns about an axis
parallel to the screw's under any load, which is too much friction near and beyond unloading.

"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.film import (
    central_film_hamrock_dowson_1977,
    film_ratio,
    groups,
    minimum_film_hamrock_dowson_1977,
    rolling_force_biboulet_houpert_2010,
)
from surrogate.formulas.geometry import hertz, Side, SIDES
from surrogate.formulas.inlet import inlet_speed
from surrogate.formulas.load_sharing import normal_force, nut_forces, NutName
from surrogate.formulas.lubricant import lubricant_state, LubricantState
from surrogate.formulas.sliding import sliding_friction
from surrogate.parameters import Lubricant
from surrogate.screw.ball_motion import four_point_motion, relative_motion
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts
from surrogate.screw.point import PointContact, ScrewPoint

Array = NDArray[np.float64]
Touching = tuple[Array, Array, Array]
"""RCS, asperity share and rolling loss over that of a smooth contact [-]."""
TIER = 'closed_form'
THIRD_FLANK = 0.05
"""Least force of the lighter pair of flanks over that of the other [-]: friction across the track
wedges an oversize ball against it. Solves find 0.03 to 0.1."""
STATUS = 'closed form: published formulas, asperity contact by the topography'


def solve(
    opened: Contacts,
    lubricant: Lubricant,
    speed: ArrayLike,
    load: ArrayLike,
    temperature: ArrayLike,
    *,
    share_of: Callable[[Array], Array] | None = None,
    inlet_heating: bool = True,
) -> ScrewPoint[Array]:
    """
    Solve the chain at `speed` [rad/s], at least 0, `load` [N] of any sign, `temperature` [K].

    The screw is opened by `Contacts.of`; the other arguments broadcast against each other.
    Friction does not depend on the sign of the load, which only picks the nut that is loaded.
    What asperities do follows from the topography; with `share_of` RCS and their share follow
    from the film ratio instead, without more loss. Shear heats the oil in the inlet, unless
    `inlet_heating` is off.

    """
    speed, load, temperature = np.broadcast_arrays(
        *(np.asarray(value, dtype=float) for value in (speed, load, temperature))
    )
    screw, oil = opened.sheet, lubricant_state(lubricant, temperature)
    entrained = opened.rates.entrainment * speed
    forces = nut_forces(load, screw.preload)
    if screw.nut == 'oversize':
        forces = forces[0], np.maximum(forces[1], THIRD_FLANK * forces[0])
    nuts: tuple[tuple[NutName, Array], ...] = (('loaded', forces[0]), ('relieved', forces[1]))

    def inlet(side: Side, force: Array) -> Array:
        return inlet_speed(
            screw, lubricant, side, force, entrained, temperature, heated=inlet_heating
        )

    def touching(side: Side, force: Array, slow: Array, ratio: Array) -> Touching:
        if share_of is None:
            return asperities_at(opened, lubricant, side, force, temperature, slow)
        share = np.where(force > 0, share_of(ratio), 0.0)
        return share, share, np.ones_like(share)

    contacts = tuple(
        _solve_contact(opened, nut, side, normal_force(screw, force), oil, speed, inlet, touching)
        for nut, force in nuts
        for side in SIDES
    )
    return _combine(opened, contacts, speed)


def _solve_contact(
    opened: Contacts,
    nut: NutName,
    side: Side,
    force: Array,
    oil: LubricantState,
    speed: Array,
    inlet: Callable[[Side, Array], Array],
    touching: Callable[[Side, Array, Array, Array], Touching],
) -> PointContact[Array]:
    screw, contact = opened.sheet, opened.geometry[side]
    balls, arm = screw.loaded_balls_per_nut, opened.rates.entrainment
    ellipse = hertz(contact, force)
    pressed = np.where(force > 0, force, np.nan)
    slow = inlet(side, force)
    g = groups(contact, pressed, slow, oil.viscosity, oil.pressure_viscosity)
    film = central_film_hamrock_dowson_1977(contact, g)
    ratio = film_ratio(film, screw.composite_rms)
    rcs, share, loss = touching(side, force, slow, ratio)
    slip = {}
    if screw.nut == 'oversize':  # the spin of a flank per screw speed
        motion = four_point_motion(screw, 1.0)
        *_, spin, _ = relative_motion(
            screw,
            side,
            angle=screw.contact_angle,
            flank=1 if nut == 'loaded' else -1,
            speed=1.0,
            orbit=motion.orbit_rate,
            rotation=motion.rotation,
        )
        slip['spin'] = abs(float(spin))
    thickness = np.nan_to_num(film)
    torque, coefficient = sliding_friction(
        screw, side, ellipse, thickness, share, oil, speed, **slip
    )
    rolling = loss * np.nan_to_num(rolling_force_biboulet_houpert_2010(contact, g))
    return PointContact(
        nut=nut,
        side=side,
        normal_force=force,
        semi_axis_x=ellipse.semi_axis_x,
        semi_axis_y=ellipse.semi_axis_y,
        hertz_pressure=ellipse.max_pressure,
        film_groups=g,
        central_film=film,
        minimum_film=minimum_film_hamrock_dowson_1977(contact, g),
        film_ratio=ratio,
        rcs=rcs,
        asperity_share=share,
        friction_coefficient=coefficient,
        rolling_force=rolling,
        sliding_torque=balls * torque,
        rolling_torque=2 * balls * rolling * arm,
    )


def asperities_at(
    opened: Contacts,
    lubricant: Lubricant,
    side: Side,
    force: Array,
    temperature: Array,
    speed: Array,
) -> Touching:
    """Return what asperities do at entrainment speeds [m/s]; nothing without load."""
    law, contact = opened.law, opened.geometry[side]
    rcs, share, loss = np.zeros(force.shape), np.zeros(force.shape), np.ones(force.shape)
    for load, heat in np.unique(np.stack([force.ravel(), temperature.ravel()], axis=1), axis=0):
        here = (force == load) & (temperature == heat)
        if load > 0:
            place = side, contact, float(load), oil_at(lubricant, float(heat))
            shares = law.touching(*place, lubricant.film_floor, speed[here])
            rcs[here], share[here], loss[here] = shares
    return rcs, share, loss


def _combine(
    opened: Contacts, contacts: tuple[PointContact[Array], ...], speed: Array
) -> ScrewPoint[Array]:
    screw = opened.sheet
    ratio = np.stack([contact.film_ratio for contact in contacts])
    # The thinnest film where none touches. An unpressed contact is never the worst; with nothing
    # pressed at all the first one answers.
    thin = np.where(np.isnan(ratio), np.inf, ratio).argmin(axis=0)
    rcs = np.stack([contact.rcs for contact in contacts])
    touching = np.where(np.isnan(ratio), -1.0, rcs)
    worst = np.where(rcs.any(axis=0), touching.argmax(axis=0), thin)

    def of(place: NDArray[np.int64], name: str) -> Array:
        values = np.stack([getattr(contact, name) for contact in contacts])
        return np.asarray(np.take_along_axis(values, place[None], axis=0)[0])

    normal = np.stack([contact.normal_force for contact in contacts])
    coefficient = np.stack([contact.friction_coefficient for contact in contacts])
    total = normal.sum(axis=0)
    loss = sum(contact.sliding_torque + contact.rolling_torque for contact in contacts)
    return ScrewPoint(
        converged=True,
        status=STATUS,
        friction_torque=np.asarray(
            loss + screw.parasitic_torque + screw.parasitic_torque_rate * speed
        ),
        rcs=of(worst, 'rcs'),
        asperity_share=of(worst, 'asperity_share'),
        film_ratio=of(thin, 'film_ratio'),
        central_film=of(thin, 'central_film'),
        minimum_film=of(thin, 'minimum_film'),
        friction_coefficient=np.divide(
            (coefficient * normal).sum(axis=0), total, out=np.zeros_like(total), where=total > 0
        ),
        max_pressure=np.max([contact.hertz_pressure for contact in contacts], axis=0),
        worst_contact=worst,
        entrainment_speed=opened.rates.entrainment * speed,
        contacts=contacts,
        normal_forces=(contacts[0].normal_force, contacts[2].normal_force),
    )
