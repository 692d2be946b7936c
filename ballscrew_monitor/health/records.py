# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Records of health: stretches of motion, summaries of logs, baselines, and what is said of them.

Rows of the judgement become stretches of steady motion, and stretches of one log and one place
become a cell. The cells of a log are its summary, a few kB, which is all that is assessed. Torques
and loads are in the machine frame, as measured at the screw.

"""

from collections.abc import Iterable, Sequence
import dataclasses
import enum
import math
from typing import NamedTuple

from ballscrew_monitor.core.judgement import Code
from surrogate.files.store import MAY_BE_NAN
from surrogate.surface.records import dtype_of

NAN = math.nan
TOLERANCE = 0.03  # change of the friction that counts as normal [-]


class LoadSource(enum.IntEnum):
    """Where the axial load of a stretch comes from."""

    MEASURED = 0
    DERIVED = 1  # out of the motor torque, which then says nothing of the friction
    FREE = 2  # recognised or declared free of process force


@dataclasses.dataclass(kw_only=True, slots=True)
class Stretch:
    """
    A stretch of steady motion or of rest: means over its samples, a record of numbers.

    start [ns], duration [s]; speed [rad/s], signed, 0 at rest; axial_load [N]; temperature [K],
    measured or assumed; motor_torque [N m]; `load_source` is the number of a LoadSource.

    """

    start: int = 0
    duration: float = 0.0
    samples: int = 0
    speed: float = NAN
    axial_load: float = NAN
    temperature: float = NAN
    motor_torque: float = NAN
    load_source: int = int(LoadSource.MEASURED)
    temperature_measured: bool = True


class CellKind(enum.IntEnum):
    """What a cell of a summary holds; the values never change."""

    MOTION = 0  # steady motion in one band of speed and load, in one direction
    STANDSTILL = 1  # torque and load at rest
    STROKE = 2  # free motion in one tenth of the stroke, numbered by `speed_band`
    REVERSAL = 3  # lost motion at reversals, `backlash`
    NOTHING = 4  # no motion that counts, for the reason `missing`


class Missing(enum.IntEnum):
    """Why a log has no steady motion that tells of friction; the values never change."""

    NONE = 0
    TORQUE = 1  # no torque was measured while the axis moved
    STEADY = 2  # motion with a measured torque, none of it steady
    MOTION = 3  # the axis did not move
    CLOCK = 4  # the clock was not set, or leapt
    LOAD = 5  # the torque was measured, but it was taken for the load


@dataclasses.dataclass(kw_only=True, slots=True)
class Cell:
    """
    A cell of the summary of a log: its stretches in one place, numbers alone.

    `start` [ns] is that of the log and tells logs apart; a node has one log a day. `first_day`
    counts days since 1970 (UTC); older logs are merged to periods of 7 or 28 `days`. The place is
    the bands of speed |w| and of load and the direction of motion, 1 or -1. `load_source` is the
    number of a LoadSource. Means over the `duration` [s]: speed [rad/s], signed; axial_load [N];
    temperature [K], assumed where it was not `temperature_measured`; motor_torque [N m].
    `backlash` [m].

    """

    start: int = 0
    first_day: int = 0
    days: int = 1
    kind: int = int(CellKind.MOTION)
    speed_band: int = 0
    load_band: int = 0
    direction: int = 0
    load_source: int = int(LoadSource.MEASURED)
    temperature_measured: bool = True
    missing: int = int(Missing.NONE)
    stretches: int = 0
    duration: float = 0.0
    speed: float = NAN
    axial_load: float = NAN
    temperature: float = NAN
    motor_torque: float = NAN
    backlash: float = NAN


CELL = dtype_of(Cell)
"""Type of an array of cells: each column of a file of summaries is one of its fields."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Baseline:
    """
    The motion that counts as normal, from `begin` to `end` [ns], and the reason it was chosen.

    `named_at` [ns] is when it was named, 0 for one that was learned over the first logs. With an
    `end` of 0 it is learned from `begin` on, after a motion of `left_out` [s]: a service event.
    `screw` is the datasheet of the surface then in use.

    """

    begin: int
    end: int
    reason: str
    named_at: int = 0
    screw: str = ''
    left_out: float = 0.0


class Condition(enum.IntEnum):
    """Condition of an axis against its baseline; the values never change."""

    UNKNOWN = 0
    NORMAL = 1  # the interval of the drag holds zero, and is narrow
    WORSE = 2  # it excludes the tolerance
    SLIGHTLY_CHANGED = 3  # it excludes zero, but not the tolerance


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
        """Return True if there is an interval."""
        return math.isfinite(self.low) and math.isfinite(self.high)


def quantity(name: str, unit: str, ends: Iterable[float], evidence: str = '') -> Quantity:
    """Return a quantity by its value and the low and high end of its interval."""
    value, low, high = ends
    return Quantity(name=name, unit=unit, value=value, low=low, high=high, evidence=evidence)


def unknown(name: str, unit: str, reason: str) -> Quantity:
    """Return a quantity that is not known, and why."""
    return Quantity(name=name, unit=unit, reason=reason)


class CauseCode(enum.IntEnum):
    """Cause of a change; the values never change."""

    PRELOAD_LOST = 1
    OIL_THINNER = 2
    OIL_THICKER = 3
    FILM_STARVED = 4
    WIPER = 5
    TORQUE_CONSTANT = 6


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
    All that is kept of one axis: cells of its logs, spectrum, and baselines in order.

    `notes` say what could not be read.

    """

    cells: Sequence[Cell] = ()
    spectrum: Sequence[SpectrumBin] = ()
    baselines: Sequence[Baseline] = ()
    notes: tuple[str, ...] = ()


class UsualWarning(NamedTuple):
    """Criterion that is broken, and the place: bands of speed and axial load, and direction."""

    code: Code
    speed_band: int
    load_band: int
    direction: int


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Health:
    """
    What is said of an axis at the time `stamp` [ns].

    `since` [ns] is the date of the change that is latched, 0 for none. `quantities` by name;
    causes in the order of their weight, the excluded ones last; `verdict` is one sentence,
    `advice` what to do, empty for nothing; `notes` tell what is not known, and why. `usual`: the
    axis runs as much at the boundary as it did in its baseline, which is its normal;
    `usual_warnings` are those that its baseline already had. `doubt` [-] is the probability that
    nothing lasting has come.

    """

    axis: str
    stamp: int
    condition: Condition
    verdict: str
    since: int = 0
    advice: str = ''
    quantities: Sequence[Quantity] = ()
    causes: Sequence[Cause] = ()
    baseline: Baseline | None = None
    notes: Sequence[str] = ()
    usual: bool = False
    usual_warnings: tuple[UsualWarning, ...] = ()
    doubt: float = 1.0

    @property
    def unknown(self) -> dict[str, list[str]]:
        """Return the names of what is not known, by the reason."""
        names: dict[str, list[str]] = {}
        for each in self.quantities:
            if not each.is_known:
                names.setdefault(each.reason, []).append(each.name)
        return names

    def quantity(self, name: str) -> Quantity:
        """Return the quantity of a name."""
        return next(each for each in self.quantities if each.name == name)
