# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Onset of contact on a screw, and the zone that is left, by its sheet and that of the oil."""

import numpy as np
from surrogate.builder.closed_form import default_settings
from surrogate.formulas.torque import efficiency
from surrogate.parameters import Lubricant, Screw
from surrogate.screw import closed_form
from surrogate.screw.onset_bands import onset_bands
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point
from surrogate.surface.contact_onset import (
    contact_onset,
    ContactOnset,
    grid_of,
    usual_limits,
    ZoneLimits,
)

EFFICIENCY = np.vectorize(efficiency, otypes=[float])


def onset_of_sheets(screw: Screw, lubricant: Lubricant, temperature: float) -> ContactOnset:
    """
    Return what the sheets say of contact at a temperature [K], zones by the closed form.

    Raises InputError as `running_tiles` does.

    """
    settings, opened = default_settings(screw), Contacts.of(screw)
    slowest, fastest = settings.speed_range
    bands = onset_bands(screw, lubricant, 0.0, temperature)
    speeds, loads = grid_of((slowest, fastest), settings.load_range)

    def has(heat: float, limits: ZoneLimits) -> bool:
        points = closed_form.solve(opened, lubricant, speeds, loads, heat)
        shares = EFFICIENCY(points.friction_torque, loads, screw.lead)
        return limits.has_zone(points.rcs, shares, loads)

    limits = usual_limits(screw.preload)
    return contact_onset(
        onset=lambda heat: onset_point(opened, lubricant, 0.0, heat)['speed_rad_s'],
        has_zone=lambda heat: has(heat, limits),
        has_film=lambda heat: has(heat, limits.of_film),
        temperature=temperature,
        coldest=min(lubricant.minimum_temperature, temperature),
        reach=fastest,
        band=bands.whole,
        measure=bands.narrowed,
        fastest=fastest,
        oil=lubricant.name,
        viscosity=lubricant.kinematic_viscosity_40,
        rms=screw.roughness.rms,
        likely_rms=screw.roughness.likely_rms,
        calibrated=screw.roughness.onset_band is not None,
        marched=screw.roughness.marched_film is not None,
        lead=screw.lead,
    )
