# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Records of health: stretches of motion, comparable points, baselines, and what is said of them.

Rows of the judgement become stretches of steady motion, stretches of one day and one place become
a comparable point, points before and after become a change with an interval. Torques and loads are
in the machine frame, as measured at the screw.

"""

from collections.abc import Sequence
import dataclasses
import enum
import math
from typing import NamedTuple

from surrogate.store import MAY_BE_NAN

NAN = math.nan
TOLERANCE = 0.03
"""Change of the drag, or loss of preload, that counts as normal [-]."""


class LoadSource(enum.IntEnum):
    """Where the axial load of a stretch comes from."""

    MEASURED = 0
    DERIVED = 1  # out of the motor torque, which then says nothing of the friction
    FREE = 2  # recognised or declared free of process force


class Place(NamedTuple):
    """Bands of speed |w|, axial load and temperature, and the direction of motion, 1 or -1."""

    speed: int
    load: int
    temperature: int
    direction: int


@dataclasses.dataclass(kw_only=True, slots=True)
class Stretch:
    """
    A stretch of steady motion: means over its samples, a record of numbers.

    start [ns], duration [s]; speed [rad/s], signed; axial_load [N]; temperature [K], measured or
    assumed; motor_torque [N m]; `load_source` is the number of a LoadSource.

    """

    start: int = 0
    duration: float = 0.0
    samples: int = 0
    speed: float = NAN
    axial_load: float = NAN
    temperature: float = NAN
    motor_torque: float = NAN
    load_source: int = LoadSource.MEASURED
    temperature_measured: bool = True


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class ComparablePoint:
    """
    The stretches of one place and one period of days under one surface.

    Means over `stretches`, each counted once: speed [rad/s], signed; axial_load [N];
    temperature [K]; motor_torque [N m], and `residual` [N m], what it exceeds the torque of that
    surface by. `torque_squares` [N2 m2] is the sum of the squared deviations of the residual from
    its mean. `first_day` counts days since 1970 (UTC); a period has 1, 7 or 28 `days`. `duration`
    [s] is the sum; `surface` begins the hash of the surface.

    """

    first_day: int
    days: int = 1
    place: Place
    surface: str
    stretches: int
    duration: float
    speed: float
    axial_load: float
    temperature: float
    motor_torque: float
    residual: float = NAN
    torque_squares: float = 0.0
    load_source: LoadSource = LoadSource.MEASURED
    temperature_measured: bool = True


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Baseline:
    """
    What normal is: the stretches from `begin` to `end` [ns], and why they were chosen.

    `named_at` [ns] is when it was named, 0 for one that was learned over the first hours in
    motion. `points` are kept with it, so that merging of older days leaves it as it is. `screw`
    is the datasheet of the surface in use. With an `end` of 0 it is still to be learned from
    `begin` on, after a motion of `left_out` [s].

    """

    begin: int
    end: int
    reason: str
    named_at: int = 0
    screw: str = ''
    left_out: float = 0.0
    points: tuple[ComparablePoint, ...] = ()


class Condition(enum.IntEnum):
    """Normal or worse, against the baseline."""

    UNKNOWN = 0
    NORMAL = 1
    WORSE = 2


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Quantity:
    """
    A number with the interval that holds it with a `confidence` [-].

    value, low and high in `unit`; all NaN where it is not known yet, and `reason` says why.
    `evidence` says what it rests on.

    """

    name: str
    unit: str = '-'
    value: float = NAN
    low: float = NAN
    high: float = NAN
    confidence: float = 0.95
    evidence: str = ''
    reason: str = ''

    @property
    def is_known(self) -> bool:
        """Tell whether there is an interval."""
        return math.isfinite(self.low) and math.isfinite(self.high)


class CauseCode(enum.IntEnum):
    """What may have changed; the values never change."""

    PRELOAD_LOST = 1
    OIL_THINNER = 2
    OIL_THICKER = 3
    WARMER_THAN_MEASURED = 4
    FILM_STARVED = 5
    WIPER = 6
    CHURNING = 7
    LOAD_SIGN_OR_UNIT = 8
    TORQUE_CONSTANT = 9
    SENSOR_OFFSET = 10


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Cause:
    """
    A cause that may explain the change, and how well.

    `size` is its amount with an interval; `weight` [-] is its share among all causes; one that
    does not fit is `excluded`, and `text` says why.

    """

    code: CauseCode
    size: Quantity
    weight: float
    excluded: bool
    text: str


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class SpectrumBin:
    """
    Motion in one band of axial load and one period of days.

    `axial_load` [N] is the mean opposing load, positive against the motion; `angle` [rad] of
    motion counted up; `speed` [rad/s] its mean; `time` in motion [s]; `wear_time` [s] by class of
    severity; energies lost by the model and as measured [J]. `energy_expected` [J] is what the
    model says of the time that was measured; it and `energy_measured` are NaN without such a time.

    """

    first_day: int
    days: int = 1
    load_band: int
    axial_load: float = dataclasses.field(metadata=MAY_BE_NAN)
    angle: float
    speed: float
    time: float
    wear_time: tuple[float, ...] = ()
    energy_lost: float = 0.0
    energy_measured: float = NAN
    energy_expected: float = NAN


class KeptHealth(NamedTuple):
    """
    What is kept of one axis.

    The baseline in force is the last one; `notes` say what could not be read.

    """

    points: tuple[ComparablePoint, ...] = ()
    spectrum: tuple[SpectrumBin, ...] = ()
    baselines: tuple[Baseline, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def baseline(self) -> Baseline | None:
        """Return the baseline in force."""
        return self.baselines[-1] if self.baselines else None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Health:
    """
    What is said of an axis at the time `stamp` [ns].

    `quantities` by name; causes in the order of their weight, the excluded ones last; `verdict`
    is one sentence, `advice` what to do, empty for nothing; `notes` tell what is not known, why.
    `usual`: the axis runs as much at the boundary as it did in its baseline, which is its normal.

    """

    axis: str
    stamp: int
    condition: Condition
    verdict: str
    advice: str = ''
    quantities: Sequence[Quantity] = ()
    causes: Sequence[Cause] = ()
    baseline: Baseline | None = None
    notes: Sequence[str] = ()
    usual: bool = False

    def quantity(self, name: str) -> Quantity:
        """Return the quantity of a name."""
        return next(one for one in self.quantities if one.name == name)
