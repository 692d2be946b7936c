# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Looked-up or solved point as the rest of the product reads it."""

from collections.abc import Mapping
import dataclasses
import enum

from surrogate.formulas.torque import efficiency_slope, is_back_driving
from surrogate.surface.fields import FIELDS, MEASURED, SHARES
from surrogate.surface.interpolate import fill_torques, Found, share


class Validity(enum.IntEnum):
    """Whether a point could be looked up; numbers as in ballscrew_msgs/PointResult."""

    UNKNOWN = 0
    VALID = 1
    SPEED_BELOW_RANGE = 2
    SPEED_ABOVE_RANGE = 3
    LOAD_OUT_OF_RANGE = 4
    TEMPERATURE_OUT_OF_RANGE = 5
    MASKED = 6


VALIDITIES = tuple(Validity)


@dataclasses.dataclass(slots=True)
class SurfacePoint(Found):
    """What the surface says of one point; every number is NaN unless `validity` is VALID."""

    validity: Validity = Validity.UNKNOWN


def solved_point(
    means: Mapping[str, float],
    deviations: Mapping[str, float],
    standard_errors: Mapping[str, float],
    *,
    worst_contact: int,
    opposing_load: float,
    lead: float,
) -> SurfacePoint:
    """
    Return a solved point in the form of one that was looked up: no interpolation, so no error.

    Means, deviations and standard errors of `FIELDS` [SI], NaN where unknown; opposing
    load [N], lead [m]; the contact by its number on file.

    """
    point = SurfacePoint(validity=Validity.VALID, worst_contact=worst_contact)
    for name in FIELDS:
        setattr(point, name, share(means[name]) if name in SHARES else means[name])
    slope = efficiency_slope(point.friction_torque, opposing_load, lead)
    for kind, group in (('std', deviations), ('stderr', standard_errors)):
        for name in MEASURED:
            setattr(point, f'{name}_{kind}', group[name])
        setattr(point, f'efficiency_{kind}', group['friction_torque'] * slope)
    fill_torques(point, opposing_load, lead)
    point.back_driving = is_back_driving(point.friction_torque, opposing_load, lead)
    return point
