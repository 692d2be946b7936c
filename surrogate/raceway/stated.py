# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Roughness of raceway and ball as a datasheet of a screw states it, by the standard."""

from dataclasses import dataclass, fields
import math
from typing import ClassVar, Literal

from surrogate.files import InputError
from surrogate.files.datasheet import check_likely, Checked, choice, quantity, text
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.standards import BALL_RA, ball_rms
from surrogate.units import GIGA

State = Literal['run_in', 'new']
HARDNESS = 7e9
"""Hardness of rolling bearing steel of 60 HRC [Pa]."""
ONSET_FACTORS = 0.05, 20.0
"""Least and largest onset speed over that which the topography tells [-]."""
NINE_OF_TEN = 1.645
"""Standard deviations on either side within which nine of ten lie [-]."""
FILM_FACTORS = 0.2, 5.0
"""Least and largest film at the onset of marched strips over that which the law tells [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Roughness(RoughnessSpectrum):
    """
    Raceway roughness by the standard, its state, and the friction of its asperities.

    `state` says whether the raceway is new or has run in, and `traced` in which of the two the
    profile was traced. No summit carries more than the `hardness` [Pa]; `run_in_pressure` [Pa]
    stands for yield and mild wear of running in together, with its lowest and highest likely
    value. Boundary friction coefficient [-]. Rq lies between `rms_low` and `rms_high` [m] where it
    was not measured.

    `onset_factor` is the onset speed of contact over that which the topography tells [-]. One that
    was fitted on the machine has the day, `calibrated`, and the factor within which nine of ten
    lie, `onset_band` [-].

    `marched_film` is the film at the onset of marched strips of this raceway over that which the
    law tells [-], `marched_error` the standard error of its logarithm for one more strip [-].

    """

    LIKELY: ClassVar[tuple[str, ...]] = ('rms_low', 'rms_high')
    MARCHED: ClassVar[tuple[str, ...]] = ('marched_film', 'marched_error')

    state: State = choice(
        'run_in',
        'new',
        default='run_in',
        means='`run_in`: the raceway has run in; `new`: it has made its first passes only',
    )
    traced: State = choice(
        'new',
        'run_in',
        default='new',
        means='when the profile was traced; one of `run_in` is not cut again',
    )
    hardness: float = quantity(
        'GPa',
        1e9,
        1.0,
        20.0,
        default=HARDNESS,
        means='pressure that no summit exceeds; 7 is steel of 60 HRC',
    )
    run_in_pressure: float = quantity(
        'GPa',
        1e9,
        0.5,
        20.0,
        default=3e9,
        means='stands for yield and mild wear of running in together; the least certain '
        'number of the sheet: 2 and 5 move the onset by 0.7 and 1.4',
    )
    run_in_low: float = quantity(
        'GPa',
        1e9,
        0.5,
        20.0,
        default=2e9,
        means='its lowest likely value; draws the broken lines beside the limit alone',
    )
    run_in_high: float = quantity(
        'GPa', 1e9, 0.5, 20.0, default=5e9, means='its highest likely value, likewise'
    )
    rms_low: float | None = quantity(
        'um',
        1e-6,
        0.0,
        10.0,
        default=None,
        means='lowest likely Rq where none was measured, for the band of the onset alone; with '
        '`rms_high_um`',
    )
    rms_high: float | None = quantity(
        'um', 1e-6, 0.0, 10.0, default=None, means='highest likely Rq, likewise'
    )
    asperity_friction: float = quantity(
        '', 1.0, 0.0, 1.0, means='boundary friction coefficient, 0.1 for mineral oil on steel'
    )
    onset_factor: float = quantity(
        '',
        1.0,
        *ONSET_FACTORS,
        default=1.0,
        means='speed at which contact begins over that by the topography, fitted by '
        '`identify --onset`',
    )
    onset_band: float | None = quantity(
        '',
        1.0,
        1.0,
        100.0,
        default=None,
        means='factor within which nine of ten lie, of a fitted `onset_factor`',
    )
    calibrated: str | None = text(
        r'\d{4}-\d\d-\d\d',
        "a day in quotes, '2026-11-24'",
        default=None,
        means='day of the fit; with `onset_band`',
    )
    marched_film: float | None = quantity(
        '',
        1.0,
        *FILM_FACTORS,
        default=None,
        means='film at which contact begins over that of the law, marched on this raceway in its '
        'state by `surface build`',
    )
    marched_error: float | None = quantity(
        '',
        1.0,
        0.0,
        5.0,
        default=None,
        means='standard error of the logarithm of `marched_film`, as one more strip has it',
    )

    def __post_init__(self) -> None:
        """Check every range, and what is stated together."""
        RoughnessSpectrum.__post_init__(self)
        given = self.run_in_low, self.run_in_pressure, self.run_in_high, self.hardness
        if list(given) != sorted(given):
            low, middle, high, most = (f'{GIGA * one:g}' for one in given)
            raise InputError(
                f'roughness: run_in_pressure_GPa is {middle} GPa between run_in_low_GPa ({low}) '
                f'and run_in_high_GPa ({high}), allowed are rising numbers up to the hardness '
                f'({most} GPa)'
            )
        if (self.state, self.traced) == ('new', 'run_in'):
            raise InputError(
                'roughness: traced is run_in and state is new, allowed is state: run_in for a '
                'profile that was traced after running in'
            )
        check_likely(self, 'roughness', 'rms_low', 'rms', 'rms_high')
        for pair in (('calibrated', 'onset_band'), self.MARCHED):
            stated = [name for name in pair if getattr(self, name) is not None]
            if len(stated) == 1:
                raise InputError(
                    f'roughness: {stated[0]} is given alone, allowed are both of {pair[0]} and '
                    f'{pair[1]} or neither'
                )

    @property
    def spectrum(self) -> RoughnessSpectrum:
        """Return the profile alone, by which waves are known."""
        names = [spec.name for spec in fields(RoughnessSpectrum)]
        return RoughnessSpectrum(**{name: getattr(self, name) for name in names})

    @property
    def likely_rms(self) -> tuple[float | None, float | None]:
        """Lowest and highest likely Rq [m], None where it was measured."""
        return self.rms_low, self.rms_high

    @property
    def calibration(self) -> str:
        """Say by what the onset is corrected, empty where the topography alone tells it."""
        if self.calibrated is not None:
            return f'onset calibrated on {self.calibrated} within {self.onset_band:.3g}'
        if self.marched_film is None or self.marched_error is None:
            return ''
        band = math.exp(NINE_OF_TEN * self.marched_error)
        return (
            f'film at the onset {self.marched_film:.2f} times that by the topography, marched on '
            f'this raceway within {band:.2f}'
        )

    @property
    def measured(self) -> bool:
        """Return True if a factor, a calibration or marches of this raceway correct the law."""
        return self.has_own_factor or self.marched_film is not None

    @property
    def has_own_factor(self) -> bool:
        """Return True if the sheet says by how much contact begins faster than by the law."""
        return self.calibrated is not None or self.onset_factor != 1.0

    @property
    def cutting_pressure(self) -> float:
        """Pressure at which the summits of the traced profile are cut [Pa]."""
        if self.state == 'new' or self.traced == 'run_in':
            return self.hardness
        return self.run_in_pressure


@dataclass(frozen=True, kw_only=True, slots=True)
class BallRoughness(Checked):
    """Roughness of the balls: Rq `rms` [m], or the grade of ISO 3290 whose largest Rq it is."""

    rms: float | None = quantity(
        'um', 1e-6, 0.0, 10.0, default=None, means='Rq of the balls; this or `grade`'
    )
    grade: str | None = choice(
        *BALL_RA, default=None, means='grade of ISO 3290, whose largest Rq holds'
    )

    def __post_init__(self) -> None:
        """Check the range, and that one of the two is given."""
        Checked.__post_init__(self)
        if (self.rms is None) == (self.grade is None):
            given = 'neither rms_um nor grade is' if self.rms is None else 'rms_um and grade are'
            raise InputError(f'ball_roughness: {given} given, allowed is one of the two')

    @property
    def height(self) -> float:
        """Rq [m], stated or by the grade."""
        return ball_rms(self.grade) if self.grade is not None else self.rms or 0.0
