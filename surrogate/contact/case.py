# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One contact as a file: what to solve, in unit-suffixed keys, and its result as a record.

A case names two radii, a modulus, a load, a speed and an oil; roughness, grid and domain are
optional. The roughness stands still in the contact, or rolls through it.

"""

from dataclasses import dataclass, replace
from typing import Literal

from surrogate.ehl import Condition, ContactLubricant
from surrogate.ehl.interface import LARGEST_GRID, Law
from surrogate.files import InputError
from surrogate.files.datasheet import (
    block,
    Checked,
    choice,
    count,
    find_sheet,
    quantities,
    quantity,
    read_sheet,
    same,
    text,
)
from surrogate.formulas.geometry import Contact
from surrogate.raceway.fractal import Lay, PublishedRoughness
from surrogate.raceway.measured import Outside
from surrogate.raceway.patch import Patch
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.stated import BallRoughness, Roughness

CONSTANTS = (
    'fractal_dimension',
    'fractal_roughness',
    'sample_length',
    'shortest_wavelength',
    'scale_ratio',
    'ridges',
)
"""Constants of a generated surface; what a case does not state is as published."""
GENERATED = ('seed', 'lay', 'position_x', 'position_y', 'grid_wavelength') + tuple(
    name for name in CONSTANTS if name != 'shortest_wavelength'
)
"""What only a generated surface has."""
STANDARD = ('cutoff_long', 'cutoff_short', 'rms_slope', 'fan_angle', 'ball_rms', 'ball_grade')
"""What only a surface by the standard has."""
NOT_STANDARD = (
    'file',
    'fractal_roughness',
    'sample_length',
    'grid_wavelength',
    'window_x',
    'window_y',
)
"""What a surface by the standard does not have."""
ROLLING = ('transits', 'places', 'strip')
"""What only a contact has whose roughness rolls."""
Kinematics = Literal['standing', 'rolling']


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseRoughness(Checked):
    """
    Raceway of a case: a surface from a seed, by formula or by the standard, or one from a file.

    Rq `rms` [m]; a generated surface has dimension D [-], G [m], sample length, shortest
    wavelength [m], scale ratio and ridges [-], lay and the place [m] that comes to the contact
    centre; waves shorter than `grid_wavelength` [m] act as a higher film floor. A `file` is
    filtered at `shortest_wavelength` [m] when that is given. The `patch` is rescaled to the rms or
    cut, levelled over a window with sides `window_x`, `window_y` [m], by default the Hertz
    rectangle of the case: state it in a series over loads. Boundary friction coefficient [-].

    `standard` is the surface whose expected profile between `cutoff_short` and `cutoff_long` [m]
    has the rms, with a fractal dimension [-] or an rms slope [rad], a lay that fans over an angle
    [rad], and a ball with an Rq [m] or a grade; waves shorter than `shortest_wavelength` are left
    out of it.

    """

    rms: float | None = same(
        RoughnessSpectrum, 'rms', means='Rq; 0 is smooth; mandatory without `file`'
    )
    file: str | None = text(
        default=None,
        means='measured profile or height map, sought beside the case; `cut` unless '
        '`rms_um` is given',
    )
    outside: Outside = choice(
        'refuse',
        'mirror',
        default='refuse',
        means='beyond a measured map: an error, or its mirror image',
    )
    seed: int | None = count(0, 2**32 - 1, default=None, means='draw of the generated raceway (0)')
    patch: Patch | Literal['standard'] | None = choice(
        'rescaled',
        'cut',
        'standard',
        default=None,
        means='`rescaled` (default): scaled once to `rms_um` over the window; `cut`: at '
        'the height of formula or file; `standard`: by the standard, as a drawing '
        'means Rq',
    )
    lay: Lay | None = same(RoughnessSpectrum, 'lay', means='direction of the ridges (isotropic)')
    shortest_wavelength: float | None = same(
        PublishedRoughness,
        'shortest_wavelength',
        means='shortest wave of the raceway (8); with `file` the cut-off of a Gaussian '
        'filter; with `patch: standard` shorter waves are left out',
    )
    grid_wavelength: float | None = quantity(
        'um',
        1e-6,
        0.1,
        1000.0,
        default=None,
        means='shorter waves are not on the grid and raise the film floor by 0.05 of their rms',
    )
    fractal_dimension: float | None = same(
        RoughnessSpectrum,
        'fractal_dimension',
        means='D (2.68); with `patch: standard` this or `rms_slope_deg`, without a default',
    )
    fractal_roughness: float | None = same(
        PublishedRoughness, 'fractal_roughness', means='G (0.97)'
    )
    sample_length: float | None = same(
        PublishedRoughness, 'sample_length', means='L of the generator (4)'
    )
    scale_ratio: float | None = same(
        RoughnessSpectrum, 'scale_ratio', means='ratio of neighbouring wavelengths (1.5)'
    )
    ridges: int | None = same(RoughnessSpectrum, 'ridges', means='ridges (10)')
    position_x: float | None = quantity(
        'mm', 1e-3, -1e3, 1e3, default=None, means='place of the raceway at the contact centre (0)'
    )
    position_y: float | None = quantity('mm', 1e-3, -1e3, 1e3, default=None, means='likewise')
    window_x: float | None = quantity(
        'mm',
        1e-3,
        1e-3,
        100.0,
        default=None,
        means='side of the window in which the patch is levelled and scaled (Hertz '
        'rectangle); state one in a series over loads',
    )
    window_y: float | None = quantity('mm', 1e-3, 1e-3, 100.0, default=None, means='likewise')
    cutoff_long: float | None = same(
        RoughnessSpectrum,
        'cutoff_long',
        means='standard: long cut-off (by the table for Ra = 0.8 Rq)',
    )
    cutoff_short: float | None = same(
        RoughnessSpectrum, 'cutoff_short', means='standard: short cut-off and shortest wave (2.5)'
    )
    rms_slope: float | None = same(
        RoughnessSpectrum, 'rms_slope', means='standard: Rdq of the profile'
    )
    fan_angle: float | None = same(
        RoughnessSpectrum, 'fan_angle', means='standard: angle over which waves of a lay fan'
    )
    ball_rms: float | None = same(
        BallRoughness, 'rms', means='standard: Rq of the ball; this or `ball_grade`'
    )
    ball_grade: str | None = same(BallRoughness, 'grade', means='standard: grade of the ball')
    asperity_friction: float = same(
        Roughness, 'asperity_friction', default=0.1, means='boundary friction coefficient'
    )

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        other = NOT_STANDARD if self.patch == 'standard' else STANDARD
        mixed = [name for name in other if getattr(self, name) is not None]
        if mixed:
            raise InputError(
                f'{mixed[0]} does not belong to patch {self.patch or "rescaled"}, allowed is it '
                f'with {"another patch" if self.patch == "standard" else "patch: standard"}'
            )
        if self.ball_rms is not None and self.ball_grade is not None:
            raise InputError('ball_rms and ball_grade are given, allowed is one of the two')
        if self.file is None and self.rms is None:
            raise InputError('missing key rms_um, or file for a measured surface')
        stated = [name for name in GENERATED if getattr(self, name) is not None]
        if self.file is not None and stated:
            raise InputError(f'{stated[0]} belongs to a generated surface, a file has none')
        if self.file is not None and self.patch == 'rescaled' and not self.rms:
            raise InputError('patch is rescaled, which needs rms_um above 0')


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseGrid(Checked):
    """Nodes along and across the track, both odd [-]."""

    nx: int = count(17, LARGEST_GRID, means='nodes along the track, odd')
    ny: int = count(17, LARGEST_GRID, means='nodes across it, odd')

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        for name in ('nx', 'ny'):
            if getattr(self, name) % 2 == 0:
                raise InputError(f'{name} is {getattr(self, name)}, allowed is an odd number')


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseDomain(Checked):
    """Inlet and outlet along x over the semi-axis a [-], half width along y over b [-]."""

    inlet: float = quantity('', 1.0, -50.0, -1.1, means='inlet over the semi-axis a')
    outlet: float = quantity('', 1.0, 1.1, 20.0, means='outlet over a')
    side: float = quantity('', 1.0, 1.05, 20.0, means='half width over b')


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseStrip(Checked):
    """Strip across the contact: its place over b [-], its width [m] and columns of nodes [-]."""

    place: float = quantity(
        '', 1.0, -0.99, 0.99, default=0.0, means='place across, over the semi-axis b'
    )
    width: float = quantity('um', 1e-6, 0.1, 1e5, means='width of the strip')
    columns: int = count(4, LARGEST_GRID, means='columns of nodes, 3^n 2^k with k at least 2')


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactCase(Checked):
    """
    One contact to solve.

    Radii of relative curvature [m], E' [Pa], load [N], entrainment speed [m/s] (0 is the dry
    contact), ambient viscosity [Pa s], pressure-viscosity [1/Pa], Eyring stress [Pa], slide-roll
    ratios |u1 - u2| / entrainment speed [-], film floor [m]. Roughness that is `rolling` is
    marched through the whole contact or a strip of it, over transits [-] shared by some places.

    """

    radius_x: float = quantity(
        'mm',
        1e-3,
        1e-3,
        1e6,
        means='radius of relative curvature along the track, the direction of entrainment',
    )
    radius_y: float = quantity('mm', 1e-3, 1e-3, 1e6, means='the same across it')
    reduced_modulus: float = quantity(
        'GPa',
        1e9,
        1e-4,
        1e4,
        means="E' with 2/E' = (1 - nu1²)/E1 + (1 - nu2²)/E2; 226 for steel on steel",
    )
    load: float = quantity('N', 1.0, 1e-3, 1e6, means='normal force')
    entrainment_speed: float = quantity(
        'm_s', 1.0, 0.0, 1e3, means='mean of both surface speeds; 0 is the dry contact'
    )
    viscosity: float = quantity(
        'Pa_s', 1.0, 1e-4, 100.0, means='ambient viscosity at the temperature of the contact'
    )
    pressure_viscosity: float = quantity(
        '1_GPa', 1e-9, 0.1, 100.0, means='pressure-viscosity coefficient'
    )
    fluid: Law = choice(
        'roelands_dh',
        'barus_incompressible',
        default='roelands_dh',
        means='Roelands viscosity with Dowson-Higginson density, or Barus without compression',
    )
    eyring_stress: float = quantity(
        'MPa', 1e6, 0.01, 1000.0, default=5e6, means='Eyring stress of the friction'
    )
    slide_roll_ratio: tuple[float, ...] = quantities(
        '',
        1.0,
        0.0,
        1000.0,
        means='slip along x over the entrainment speed, one or a list; each gets a '
        'friction coefficient; one alone where the roughness rolls (0.019)',
    )
    roughness: CaseRoughness | None = block(
        CaseRoughness, default=None, means='without it the contact is smooth'
    )
    film_floor: float = quantity(
        'nm',
        1e-9,
        1e-3,
        1e3,
        default=3e-9,
        means='film at which a node counts as punctured and asperities carry',
    )
    grid: CaseGrid | None = block(
        CaseGrid,
        default=None,
        means='nodes; without it by shape, error and shortest wavelength, at most 513 '
        'along a side',
    )
    domain: CaseDomain | None = block(
        CaseDomain,
        default=None,
        means='edges over the Hertz semi-axes, such as -4.5, 1.5, 3; without it by the film',
    )
    kinematics: Kinematics = choice(
        'standing',
        'rolling',
        default='standing',
        means='`rolling`: the roughness rolls through the contact, in steps of time',
    )
    transits: float | None = quantity(
        '',
        1.0,
        1.0,
        1e5,
        default=None,
        means='contact lengths that roll through it after a run-in (8)',
    )
    places: int | None = count(
        1,
        1000,
        default=None,
        means='tracks side by side that share the transits (4); two or more give standard errors',
    )
    strip: CaseStrip | None = block(
        CaseStrip,
        default=None,
        means='march a strip alone, for waves too short for a grid of the complete contact',
    )

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        stated = [name for name in ROLLING if getattr(self, name) is not None]
        if self.kinematics == 'standing' and stated:
            raise InputError(f'{stated[0]} belongs to kinematics rolling, stated is standing')
        if self.kinematics == 'rolling':
            self._check_rolling()

    def _check_rolling(self) -> None:
        rough = self.roughness
        if rough is not None and rough.file is not None:
            raise InputError(
                'kinematics is rolling, roughness is a measured file, allowed is a generated '
                'surface: a measured one has an end'
            )
        if rough is None or not rough.rms:
            raise InputError('kinematics is rolling, which needs roughness with rms_um above 0')
        if rough.grid_wavelength is not None:
            raise InputError(
                'grid_wavelength belongs to kinematics standing: by how much waves off the grid '
                'raise the floor is known for roughness that stands'
            )
        if self.entrainment_speed == 0.0:
            raise InputError(
                'entrainment_speed_m_s is 0, allowed is above 0 where roughness rolls'
            )
        if len(self.slide_roll_ratio) > 1:
            raise InputError(
                f'slide_roll_ratio has {len(self.slide_roll_ratio)} values, allowed is one where '
                'roughness rolls'
            )

    @property
    def contact(self) -> Contact:
        """Radii and modulus of the bodies."""
        return Contact(
            radius_x=self.radius_x, radius_y=self.radius_y, reduced_modulus=self.reduced_modulus
        )

    @property
    def lubricant(self) -> ContactLubricant:
        """Oil at the temperature of the contact."""
        return ContactLubricant(
            viscosity=self.viscosity,
            pressure_viscosity=self.pressure_viscosity,
            eyring_stress=self.eyring_stress,
            law=self.fluid,
        )

    @property
    def condition(self) -> Condition:
        """Load and speed."""
        return Condition(load=self.load, entrainment_speed=self.entrainment_speed)


def load_case(name_or_path: str) -> ContactCase:
    """Load a case by shipped name or file; a roughness file is sought beside it; InputError."""
    path = find_sheet(name_or_path, 'cases')
    case = read_sheet(ContactCase, path)
    if case.roughness is None or case.roughness.file is None:
        return case
    beside = str(path.parent / case.roughness.file)
    return replace(case, roughness=replace(case.roughness, file=beside))
