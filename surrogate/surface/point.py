# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Answer of a surface for one point; it needs no numpy."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import enum
import math

from surrogate.formulas import torque

FIELDS = (
    'friction_torque',
    'rcs',
    'asperity_share',
    'film_ratio',
    'central_film',
    'minimum_film',
    'friction_coefficient',
    'max_pressure',
)
"""Interpolated fields in table order."""
INDEX = {name: place for place, name in enumerate(FIELDS)}
"""Place of a field in a row of the table."""
MEASURED = FIELDS[:2]
"""Fields whose measured interpolation error a point tells, torque and RCS."""
LOGARITHMIC = ('film_ratio', 'central_film', 'minimum_film')
NOTHING = (math.nan,) * len(FIELDS)
NO_SPREADS = 2 * NOTHING


class Validity(enum.IntEnum):
    """Whether a point could be looked up; numbers as in ballscrew_msgs/PointResult."""

    UNKNOWN = 0
    VALID = 1
    SPEED_BELOW_RANGE = 2
    SPEED_ABOVE_RANGE = 3
    LOAD_OUT_OF_RANGE = 4
    TEMPERATURE_OUT_OF_RANGE = 5
    MASKED = 6


@dataclass(frozen=True, kw_only=True, slots=True)
class SurfacePoint:
    """
    What the surface says of one point; every number is NaN unless `validity` is VALID.

    Opposing load [N] and lead [m] belong to the question; `values` are in the order of `FIELDS`,
    `errors` the measured interpolation errors of the cell, of `MEASURED` in their units.
    `spreads` between strips are the standard deviations of the values and then the standard
    errors of their means, NaN where not known. `corrected`: a full solve near this point has
    pulled the numbers.

    """

    validity: Validity
    opposing_load: float
    lead: float
    values: Sequence[float] = NOTHING
    worst_contact: int = -1
    errors: Sequence[float] = NOTHING
    spreads: Sequence[float] = NO_SPREADS
    corrected: bool = False

    @property
    def friction_torque(self) -> float:
        """Torque lost to friction [N m]."""
        return self.values[INDEX['friction_torque']]

    @property
    def rcs(self) -> float:
        """RCS of the worst contact [-]; a patch may pass its corners by a hair, this may not."""
        return _share(self.values[INDEX['rcs']])

    @property
    def asperity_share(self) -> float:
        """Share of the load on asperities in the worst contact [-]."""
        return _share(self.values[INDEX['asperity_share']])

    @property
    def film_ratio(self) -> float:
        """Film ratio Lambda of the thinnest contact [-]."""
        return math.exp(self.values[INDEX['film_ratio']])

    @property
    def central_film(self) -> float:
        """Central film of the thinnest contact [m]."""
        return math.exp(self.values[INDEX['central_film']])

    @property
    def minimum_film(self) -> float:
        """Minimum film of the thinnest contact [m]."""
        return math.exp(self.values[INDEX['minimum_film']])

    @property
    def friction_coefficient(self) -> float:
        """Load-weighted mean coefficient of sliding friction [-]."""
        return self.values[INDEX['friction_coefficient']]

    @property
    def max_pressure(self) -> float:
        """Largest Hertz pressure [Pa]."""
        return self.values[INDEX['max_pressure']]

    @property
    def worst_nut(self) -> int:
        """Nut of the worst contact: 1 pressed by the load, 2 relieved, 0 unknown."""
        return self.worst_contact // 2 + 1

    @property
    def worst_side(self) -> int:
        """Side of the worst contact: 1 screw, 2 nut, 0 unknown."""
        return self.worst_contact % 2 + 1 if self.worst_contact >= 0 else 0

    @property
    def friction_torque_error(self) -> float:
        """Measured interpolation error of the torque in this cell [N m]."""
        return self.errors[INDEX['friction_torque']]

    @property
    def rcs_error(self) -> float:
        """Measured interpolation error of RCS in this cell [-]."""
        return self.errors[INDEX['rcs']]

    @property
    def rcs_std(self) -> float:
        """Return the standard deviation of RCS between strips of the raceway [-], or NaN."""
        return self.spreads[INDEX['rcs']]

    @property
    def rcs_stderr(self) -> float:
        """Return the standard error of the mean RCS [-], or NaN."""
        return self.spreads[len(FIELDS) + INDEX['rcs']]

    @property
    def friction_torque_std(self) -> float:
        """Return the standard deviation of the torque between strips [N m], or NaN."""
        return self.spreads[INDEX['friction_torque']]

    @property
    def friction_torque_stderr(self) -> float:
        """Return the standard error of the mean torque [N m], or NaN."""
        return self.spreads[len(FIELDS) + INDEX['friction_torque']]

    @property
    def efficiency_std(self) -> float:
        """Return the standard deviation of efficiency between strips [-], or NaN."""
        return self.spreads[INDEX['friction_torque']] * self._efficiency_slope()

    @property
    def efficiency_stderr(self) -> float:
        """Return the standard error of the mean efficiency [-], or NaN."""
        return self.spreads[len(FIELDS) + INDEX['friction_torque']] * self._efficiency_slope()

    def std(self, name: str) -> float:
        """Return the standard deviation between strips of one of `FIELDS`, in its unit."""
        return self.spreads[INDEX[name]]

    def stderr(self, name: str) -> float:
        """Return the standard error of the mean of one of `FIELDS`, in its unit."""
        return self.spreads[len(FIELDS) + INDEX[name]]

    @property
    def efficiency(self) -> float:
        """Transmission efficiency [-]; NaN unless valid."""
        if self.validity is not Validity.VALID:
            return math.nan
        return torque.efficiency(self.friction_torque, self.opposing_load, self.lead)

    @property
    def driving_torque(self) -> float:
        """Torque on the screw [N m], positive along the motion."""
        return float(torque.driving_torque(self.friction_torque, self.opposing_load, self.lead))

    @property
    def back_driving(self) -> bool:
        """Whether the load drives the screw and yields more than friction takes."""
        return torque.is_back_driving(self.friction_torque, self.opposing_load, self.lead)

    @property
    def efficiency_error(self) -> float:
        """Interpolation error of the efficiency [-], to first order in that of the torque."""
        return self.errors[INDEX['friction_torque']] * self._efficiency_slope()

    def _efficiency_slope(self) -> float:
        return torque.efficiency_slope(
            self.values[INDEX['friction_torque']], self.opposing_load, self.lead
        )


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
    return SurfacePoint(
        validity=Validity.VALID,
        opposing_load=opposing_load,
        lead=lead,
        values=[math.log(means[name]) if name in LOGARITHMIC else means[name] for name in FIELDS],
        worst_contact=worst_contact,
        spreads=[group[name] for group in (deviations, standard_errors) for name in FIELDS],
    )


def _share(value: float) -> float:
    """Return `value` between 0 and 1; NaN stays NaN."""
    return 0.0 if value < 0.0 else 1.0 if value > 1.0 else value
