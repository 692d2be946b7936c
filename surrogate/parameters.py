# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Screw, oil and operating point: checked, frozen, SI inside, unit-suffixed keys on file.

Temperatures are kelvin inside and degC on file.

"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, MISSING
import math
from typing import Any, ClassVar, TypeVar

from surrogate.files import InputError
from surrogate.files.datasheet import (
    block,
    check_likely,
    Checked,
    choice,
    count,
    DATA,
    find_sheet,
    quantity,
    read_sheet,
    text,
)
from surrogate.files.limits import COLDEST, HOTTEST, LOAD, SPEED
from surrogate.raceway.standards import long_cutoff_iso_21920, RA_OVER_RQ
from surrogate.raceway.stated import BallRoughness, Roughness
from surrogate.units import RPM, ZERO_CELSIUS

__all__ = [
    'BallRoughness',
    'DATA',
    'is_shipped',
    'load_lubricant',
    'load_screw',
    'Lubricant',
    'Material',
    'OperatingPoint',
    'Roughness',
    'Screw',
    'screw_and_oil',
]

Sheet = TypeVar('Sheet', 'Screw', 'Lubricant')
NAME = (r'[A-Za-z0-9][A-Za-z0-9_.-]*', 'letters, digits and _ . - (it becomes a file name)')
NUTS = ('double', 'offset', 'oversize', 'plain')
"""Nuts of catalogues, by what preloads them."""
SUPPORTS = ('fixed_fixed', 'fixed_supported', 'supported_supported', 'fixed_free')
"""How the bearings of a screw hold its ends."""
VISCOSITY_MISMATCH = 2.0
"""Largest factor between the dynamic viscosity and kinematic viscosity times density [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Material(Checked):
    """Elastic solid: Young's modulus [Pa], Poisson's ratio [-], density [kg/m3]."""

    young_modulus: float = quantity('GPa', 1e9, 1.0, 1000.0, means="Young's modulus")
    poisson_ratio: float = quantity('', 1.0, 0.0, 0.49, means="Poisson's ratio")
    density: float = quantity('kg_m3', 1.0, 500.0, 20000.0, means='density')


@dataclass(frozen=True, kw_only=True, slots=True)
class Screw(Checked):
    """
    Preloaded double-nut ball screw with equal nuts.

    Lengths [m], angles [rad], forces [N], torques [N m]; conformities are groove radius over ball
    diameter [-]; `parasitic_torque` [N m] and `parasitic_torque_rate` [N m s/rad] stand for
    wipers, recirculation and ball-to-ball contact; `speed_limit` is D n [m rad/s] with D the pitch
    diameter; `hysteresis_loss` is the share of the elastic work of rolling that steel does not
    give back [-]; `flank_clearance` [m] between an unloaded ball and the flanks of its groove,
    None where not known; `working_load`, the largest axial load in operation [N], None where that
    which unloads the relieved nut stands for it; without `ball_roughness` the balls are smooth.

    `typical_drag` [N m] is what such nuts have as a parasitic torque, with its likely range; it
    stands beside the solves, None where the parasitic torque was identified. `dynamic_rating` of
    one nut [N], `free_length` of the screw between its bearings [m] and how they `support` it are
    None where not stated. No contact depends on these three.

    """

    SERVICE: ClassVar[tuple[str, ...]] = ('dynamic_rating', 'free_length', 'support')
    LIKELY: ClassVar[tuple[str, ...]] = ('typical_drag_low', 'typical_drag', 'typical_drag_high')

    name: str = text(
        *NAME,
        means='part of file names; a node accepts a surface only for the name that it states',
    )
    source: str = text(means='where the numbers come from')
    nut: str = choice(
        *NUTS,
        default='double',
        means='double (two nuts against each other), offset (one nut, its halves shifted), '
        'oversize (one nut, balls that press both flanks) or plain (no preload)',
    )
    pitch_radius: float = quantity(
        'mm', 1e-3, 1.0, 500.0, means='radius of the circle of the ball centres'
    )
    lead: float = quantity('mm', 1e-3, 0.5, 200.0, means='travel of the nut per turn')
    ball_diameter: float = quantity('mm', 1e-3, 0.3, 100.0, means='diameter of a ball')
    contact_angle: float = quantity(
        'deg', math.pi / 180, 20.0, 70.0, means='45 for most gothic grooves'
    )
    conformity_screw: float = quantity(
        '',
        1.0,
        0.501,
        0.7,
        means='groove radius over ball diameter, 0.515 to 0.555; ask the maker, 0.54 if unknown',
    )
    conformity_nut: float = quantity('', 1.0, 0.501, 0.7, means='the same of the nut')
    loaded_balls_per_nut: int = count(
        1, 10000, means='turns times balls per turn of one nut, of an offset nut of one half'
    )
    preload: float = quantity(
        'N',
        1.0,
        0.0,
        1e6,
        means='force between the two nuts; from the drag torque if the catalogue states only that',
    )
    static_rating: float = quantity(
        'kN',
        1e3,
        0.1,
        1e5,
        means='C0 of one nut; refused where it presses a ball by less than 2 or more than 8 GPa',
    )
    dynamic_rating: float | None = quantity(
        'kN', 1e3, 0.1, 1e5, default=None, means='C of one nut; without it no life is stated'
    )
    speed_limit: float = quantity(
        'm_rev_min',
        RPM,
        1.0,
        1000.0,
        means='D n of the catalogue, pitch diameter times speed; used for warnings',
    )
    parasitic_torque: float = quantity(
        'Nm',
        1.0,
        0.0,
        1e3,
        default=0.0,
        means='constant torque of wipers, recirculation and balls that touch each other, '
        'from `ballscrew identify`',
    )
    parasitic_torque_rate: float = quantity(
        'Nm_s', 1.0, 0.0, 1e3, default=0.0, means='the same in proportion to the speed'
    )
    typical_drag: float | None = quantity(
        'Nm',
        1.0,
        0.0,
        1e3,
        default=None,
        means='torque of seals, recirculation and balls that touch each other on typical nuts, '
        'for the band of torque and efficiency alone; gone once it is identified',
    )
    typical_drag_low: float | None = quantity(
        'Nm', 1.0, 0.0, 1e3, default=None, means='its lowest likely value'
    )
    typical_drag_high: float | None = quantity(
        'Nm', 1.0, 0.0, 1e3, default=None, means='its highest likely value'
    )
    hysteresis_loss: float = quantity(
        '',
        1.0,
        0.0,
        0.1,
        default=0.0,
        means='share of the elastic work of rolling that the steel does not give back',
    )
    flank_clearance: float | None = quantity(
        'um',
        1e-6,
        0.0,
        1000.0,
        default=None,
        means='gap between an unloaded ball and the flanks of its groove',
    )
    working_load: float | None = quantity(
        'N',
        1.0,
        0.0,
        1e6,
        default=None,
        means='largest axial load in operation, under which summits yield; without it the '
        'load that unloads the relieved nut, 2.83 preloads (without preload 2.83 % '
        'of C0)',
    )
    free_length: float | None = quantity(
        'mm',
        1e-3,
        10.0,
        20000.0,
        default=None,
        means='length between the bearings, for critical speed and buckling; with `support`',
    )
    support: str | None = choice(
        *SUPPORTS, default=None, means='how the bearings hold the ends; with `free_length_mm`'
    )
    raceway: Material = block(Material, means='steel of screw and nut')
    ball: Material = block(Material, means='material of the balls')
    roughness: Roughness = block(Roughness, means='roughness of the raceways')
    ball_roughness: BallRoughness | None = block(
        BallRoughness,
        default=None,
        means='roughness of the balls, with the dimension of the raceway; without it smooth',
    )

    def __post_init__(self) -> None:
        # slots=True makes a new class, so the zero-argument super() is not available here.
        Checked.__post_init__(self)
        if self.ball_diameter >= self.pitch_radius:
            raise InputError(
                f'screw: ball_diameter_mm is {self.ball_diameter * 1e3:g} mm, allowed is less '
                f'than pitch_radius_mm ({self.pitch_radius * 1e3:g} mm)'
            )
        if (self.preload == 0) != (self.nut == 'plain') and self.nut in ('plain', 'oversize'):
            allowed = '0 N' if self.nut == 'plain' else 'more than 0 N'
            raise InputError(
                f'screw: preload_N is {self.preload:g} N with nut {self.nut}, allowed is {allowed}'
            )
        if self.preload > self.static_rating:
            raise InputError(
                f'screw: preload_N is {self.preload:g} N, allowed is up to static_rating_kN '
                f'({self.static_rating * 1e-3:g} kN)'
            )
        largest = self.static_rating / 2**1.5
        if self.nut == 'oversize' and self.preload > largest:
            raise InputError(
                f'screw: preload_N is {self.preload:g} N with nut oversize, allowed is up to '
                f'{largest:.4g} N: one pair of flanks carries 2.83 preloads as the other is '
                f'relieved, and static_rating_kN is {self.static_rating * 1e-3:g} kN'
            )
        self._check_drag()
        if (self.free_length is None) != (self.support is None):
            given, other = 'free_length_mm', 'support'
            if self.free_length is None:
                given, other = other, given
            raise InputError(
                f'screw: {given} is given without {other}, allowed is both or neither'
            )
        if self._ball_rms:
            if not (self.roughness.fractal_dimension or self.roughness.rms_slope):
                raise InputError(
                    'screw: ball_roughness is given without fractal_dimension or rms_slope_deg in '
                    'roughness, allowed is a raceway with one of them, which the balls share'
                )
            short = self.roughness.cutoff_short
            long = long_cutoff_iso_21920(RA_OVER_RQ * self._ball_rms)
            if short >= long:
                raise InputError(
                    f'screw: cutoff_short_um of roughness is {short * 1e6:g} um, allowed is less '
                    f'than the long cut-off of the balls, {long * 1e6:g} um by the table for '
                    f'their Rq of {self._ball_rms * 1e6:.3g} um'
                )

    def _check_drag(self) -> None:
        """Refuse a typical drag without its range, or beside one that was identified."""
        given = [getattr(self, name) is not None for name in self.LIKELY]
        if any(given) and not all(given):
            raise InputError(
                'screw: typical_drag_Nm, typical_drag_low_Nm and typical_drag_high_Nm are given '
                'in part, allowed are all three or none'
            )
        check_likely(self, 'screw', *self.LIKELY)
        if any(given) and (self.parasitic_torque or self.parasitic_torque_rate):
            key = 'parasitic_torque_Nm' if self.parasitic_torque else 'parasitic_torque_rate'
            raise InputError(
                f'screw: typical_drag_Nm is given with an identified torque, by {key}, which '
                'takes its place: allowed is one of the two'
            )

    def stated(self) -> dict[str, Any]:
        """
        Return the values by name on which a solve depends.

        Of nuts, oversize balls alone have other contacts; a likely range that is absent leaves no
        trace, nor do marches.

        """
        values = asdict(self)
        if self.nut != 'oversize':
            del values['nut']
        raceway = values['roughness'], (*Roughness.LIKELY, *Roughness.MARCHED)
        for part, names in ((values, self.LIKELY), raceway):
            for name in names:
                if part[name] is None:
                    del part[name]
        return {name: value for name, value in values.items() if name not in self.SERVICE}

    def service(self) -> dict[str, Any]:
        """Return the values by name that are stated for life, critical speed and buckling."""
        values = {name: getattr(self, name) for name in self.SERVICE}
        return {name: value for name, value in values.items() if value is not None}

    @property
    def likely_drag(self) -> tuple[float, float, float] | None:
        """Least, typical and largest drag of such nuts [N m], None where it is identified."""
        low, middle, high = (getattr(self, name) for name in self.LIKELY)
        return None if middle is None else (low, middle, high)

    @property
    def _ball_rms(self) -> float:
        """Rq of the balls [m], 0 when they are smooth."""
        return self.ball_roughness.height if self.ball_roughness is not None else 0.0

    @property
    def fastest_speed(self) -> float:
        """Screw speed at the limit of D n [rad/s]."""
        return self.speed_limit / (2 * self.pitch_radius)

    @property
    def composite_rms(self) -> float:
        """Rq of raceway and ball together [m], 0 when both are smooth."""
        return math.hypot(self.roughness.rms, self._ball_rms)


@dataclass(frozen=True, kw_only=True, slots=True)
class Lubricant(Checked):
    """
    Oil, anchored at its reference temperature.

    Viscosity [Pa s], pressure-viscosity [1/Pa] and density [kg/m3] hold at `reference_temperature`
    [K]; kinematic viscosities [m2/s] at 40 and 100 degC give the temperature law; `density_slope`
    [kg/m3/K] is the loss of density per kelvin; temperatures [K] bound the datasheet; thermal
    conductivity [W/m/K], by default a usual one of mineral oils, serves inlet heating alone.

    `film_floor` [m] is the film below which a node counts as punctured, by default the 3 nm of a
    boundary film of an oil with anti-wear additives, with its lowest and highest likely value;
    `film_factor` [-] is the share of the fully flooded film that starvation or grease leaves;
    `limiting_shear_share` [-] the largest shear stress of the oil over the pressure, None without
    such a limit.

    """

    name: str = text(
        *NAME,
        means='part of file names; a node accepts a surface only for the name that it states',
    )
    source: str = text(means='where the numbers come from')
    reference_temperature: float = quantity(
        'degC', 1.0, -50.0, 200.0, shift=ZERO_CELSIUS, means='temperature of the next three'
    )
    viscosity: float = quantity(
        'Pa_s',
        1.0,
        1e-4,
        100.0,
        means='dynamic viscosity; within a factor of two of the kinematic one times the density',
    )
    pressure_viscosity: float = quantity(
        '1_GPa', 1e-9, 1.0, 100.0, means='pressure-viscosity coefficient'
    )
    density: float = quantity('kg_m3', 1.0, 500.0, 2000.0, means='density')
    density_slope: float = quantity('kg_m3_K', 1.0, 0.0, 2.0, means='loss of density per kelvin')
    eyring_stress: float = quantity('MPa', 1e6, 0.1, 100.0, means='5 for mineral oil')
    kinematic_viscosity_40: float = quantity(
        'mm2_s', 1e-6, 2.0, 1e5, means='at 40 degC, from the data sheet'
    )
    kinematic_viscosity_100: float = quantity('mm2_s', 1e-6, 1.0, 1e4, means='at 100 degC')
    minimum_temperature: float = quantity(
        'degC', 1.0, -60.0, 200.0, shift=ZERO_CELSIUS, means='coldest oil of the sheet'
    )
    maximum_temperature: float = quantity(
        'degC', 1.0, -60.0, 250.0, shift=ZERO_CELSIUS, means='warmest oil of the sheet'
    )
    thermal_conductivity: float = quantity(
        'W_m_K', 1.0, 0.01, 1.0, default=0.14, means='for the heating of the inlet alone'
    )
    film_floor: float = quantity(
        'nm',
        1e-9,
        0.1,
        100.0,
        default=3e-9,
        means='boundary film below which a node counts as punctured, which moves the '
        'onset: 3 with anti-wear additives (literature 2 to 5), 1 of base oil (0.5 '
        'to 2)',
    )
    film_floor_low: float = quantity(
        'nm',
        1e-9,
        0.1,
        100.0,
        default=1e-9,
        means='least likely film floor; draws the broken lines beside the limit alone',
    )
    film_floor_high: float = quantity(
        'nm', 1e-9, 0.1, 100.0, default=5e-9, means='largest likely film floor, likewise'
    )
    film_factor: float = quantity(
        '',
        1.0,
        0.05,
        1.0,
        default=1.0,
        means='share of the fully flooded film that starvation or grease leaves',
    )
    limiting_shear_share: float | None = quantity(
        '',
        1.0,
        0.01,
        0.2,
        default=None,
        means='largest shear stress of the oil over the pressure, 0.05 to 0.08 of mineral '
        'oil; without it no limit',
    )

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.kinematic_viscosity_100 >= self.kinematic_viscosity_40:
            raise InputError(
                'lubricant: kinematic_viscosity_100_mm2_s is '
                f'{self.kinematic_viscosity_100 * 1e6:g} mm2/s, allowed is less than '
                f'kinematic_viscosity_40_mm2_s ({self.kinematic_viscosity_40 * 1e6:g} mm2/s)'
            )
        anchors = {
            40 + ZERO_CELSIUS: self.kinematic_viscosity_40,
            100 + ZERO_CELSIUS: self.kinematic_viscosity_100,
        }
        kinematic = anchors.get(self.reference_temperature)
        expected = self.viscosity if kinematic is None else kinematic * self.density
        if max(self.viscosity / expected, expected / self.viscosity) > VISCOSITY_MISMATCH:
            # The commonest slip, mPa s typed as Pa s, where the sheet itself shows it.
            raise InputError(
                f'lubricant: viscosity_Pa_s is {self.viscosity:g} Pa s, allowed is '
                f'{expected / VISCOSITY_MISMATCH:.3g} to {expected * VISCOSITY_MISMATCH:.3g} Pa s '
                '(kinematic viscosity times density of this sheet, within a factor of two)'
            )
        check_likely(self, 'lubricant', 'film_floor_low', 'film_floor', 'film_floor_high')
        if not (
            self.minimum_temperature <= self.reference_temperature <= self.maximum_temperature
        ):
            raise InputError(
                'lubricant: reference_temperature_degC is '
                f'{self.reference_temperature - ZERO_CELSIUS:g} degC, allowed is '
                f'{self.minimum_temperature - ZERO_CELSIUS:g} to '
                f'{self.maximum_temperature - ZERO_CELSIUS:g} degC (the range of the sheet)'
            )

    def stated(self) -> dict[str, Any]:
        """Return the values by name; an option that is absent leaves no trace."""
        return {name: value for name, value in asdict(self).items() if value is not None}


@dataclass(frozen=True, kw_only=True, slots=True)
class OperatingPoint(Checked):
    """
    Where the screw runs: signed speed [rad/s], signed axial load [N], oil temperature [K].

    A positive load opposes a motion with positive speed, so equal signs mean that the screw works
    against the load. Speed zero stands for the limit of slow motion in the positive direction.

    """

    speed: float = quantity('rpm', RPM, -SPEED, SPEED)
    load: float = quantity('N', 1.0, -LOAD, LOAD)
    temperature: float = quantity('degC', 1.0, COLDEST, HOTTEST, shift=ZERO_CELSIUS)

    @property
    def opposing_load(self) -> float:
        """Load [N], positive when it opposes the motion."""
        return -self.load if self.speed < 0 else self.load


def screw_and_oil(inputs: Mapping[str, Any]) -> tuple[Screw, Lubricant]:
    """
    Rebuild the datasheets from the `inputs` of a header, so that a file needs no other.

    Raises InputError if these are not all values of both.

    """
    try:
        screw, lubricant = (dict(inputs[kind]) for kind in ('screw', 'lubricant'))
        for spec in fields(Screw):
            if 'block' in spec.metadata and screw.get(spec.name) is not None:
                screw[spec.name] = spec.metadata['block'](**screw[spec.name])
        return _whole(Screw, 'screw', screw), _whole(Lubricant, 'oil', lubricant)
    except (KeyError, TypeError, AttributeError, OverflowError) as error:
        raise InputError(
            f'the header of the surface states no whole screw and oil ({error}): build the '
            'surface again'
        ) from None


def _whole(sheet: type[Sheet], name: str, values: Mapping[str, Any]) -> Sheet:
    """Return the sheet of all of these values; raises TypeError naming those that lack."""
    needed = {spec.name for spec in fields(sheet) if spec.default is MISSING}
    if lacking := sorted(needed - {*values}):
        raise TypeError(f"the {name} lacks '{', '.join(lacking)}'")
    return sheet(**values)


def load_screw(name_or_path: str) -> Screw:
    """Load a screw by shipped name or file; raises InputError."""
    path = find_sheet(name_or_path, 'screws')
    screw = read_sheet(Screw, path)
    check_waves(screw.roughness, str(path))
    return screw


def is_shipped(screw: Screw) -> bool:
    """Return True if the sheet of a screw is one of those that come with the package."""
    path = DATA / 'screws' / f'{screw.name}.yaml'
    return path.is_file() and read_sheet(Screw, path) == screw


def check_waves(roughness: Roughness, where: str) -> None:
    """Raise InputError, which says `where`, if no waves have the stated slope."""
    if roughness.rms_slope is None:
        return
    # Only a stated slope is worth the time that scipy takes to load.
    from surrogate.raceway.scaling import scale_spectrum

    try:
        scale_spectrum(roughness)
    except InputError as error:
        name = f'{where.rpartition(": ")[2].split()[0]}: '
        raise InputError(f'{where}: {str(error).removeprefix(name)}') from None


def load_lubricant(name_or_path: str) -> Lubricant:
    """Load an oil by shipped name or file; raises InputError."""
    return read_sheet(Lubricant, find_sheet(name_or_path, 'lubricants'))
