# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Result of a point of the screw and of its contacts, whatever the tier."""

from dataclasses import dataclass, fields
import math
from typing import Any, Generic

from surrogate.formulas.film import Groups
from surrogate.formulas.geometry import Side
from surrogate.formulas.load_sharing import NutName
from surrogate.results import number
from surrogate.surface.fields import FIELDS
from surrogate.surface.solved import Number, SolvedPoint


@dataclass(frozen=True, kw_only=True, slots=True)
class PointContact(Generic[Number]):
    """
    One of the four contacts of the screw; films are NaN where it carries no load.

    Normal force per ball [N]; semi-axes [m] and pressure [Pa] of the Hertz ellipse; central and
    minimum film [m], film ratio [-]; RCS and asperity share [-]; friction coefficient [-]; rolling
    force on each surface [N]; friction torque of all balls of the nut on this side [N m], sliding
    and rolling; groups of the film formulas [-], None where the contact was solved.

    """

    nut: NutName
    side: Side
    normal_force: Number = number('N')
    semi_axis_x: Number = number('m')
    semi_axis_y: Number = number('m')
    hertz_pressure: Number = number('Pa')
    central_film: Number = number('m')
    minimum_film: Number = number('m')
    film_ratio: Number = number()
    rcs: Number = number()
    asperity_share: Number = number()
    friction_coefficient: Number = number()
    rolling_force: Number = number('N')
    sliding_torque: Number = number('Nm')
    rolling_torque: Number = number('Nm')
    film_groups: Groups | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewPoint(SolvedPoint[Number], Generic[Number]):
    """
    The screw at one point, or at many as arrays of one shape.

    Beyond what a surface keeps of it: contacts, those of the loaded nut first; entrainment speed
    [m/s]; normal forces of a ball of the loaded and of the relieved nut without friction [N]. The
    friction torque holds the parasitic part.

    """

    contacts: tuple[PointContact[Number], ...]
    entrainment_speed: Number = number('m_s')
    normal_forces: tuple[Number, Number]


def kept_point(point: ScrewPoint[Any]) -> SolvedPoint[float]:
    """
    Return what a surface keeps of one point, whatever its tier.

    It has not converged where a number is not finite, such as a film without a load.

    """
    kept = {spec.name: getattr(point, spec.name) for spec in fields(SolvedPoint)}
    numbers = {name: float(kept[name]) for name in FIELDS}
    kept |= {
        **numbers,
        'converged': point.converged and all(map(math.isfinite, numbers.values())),
        'worst_contact': int(point.worst_contact),
    }
    return SolvedPoint(**kept)
