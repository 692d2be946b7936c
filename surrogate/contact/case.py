# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One contact as a file: what to solve, in unit-suffixed keys, and its result as a record.

A case names two radii, a modulus, a load, a speed and an oil; roughness, grid and domain are
optional.

"""

from dataclasses import dataclass, replace

from surrogate.datasheet import (
    block,
    Checked,
    choice,
    count,
    find_sheet,
    quantities,
    quantity,
    read_sheet,
    text,
)
from surrogate.ehl import Condition, ContactLubricant
from surrogate.ehl.interface import LARGEST_GRID, Law
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact
from surrogate.raceway.fractal import Lay
from surrogate.raceway.measured import Outside
from surrogate.raceway.patch import Patch

CONSTANTS = (
    'fractal_dimension',
    'fractal_roughness',
    'sample_length',
    'shortest_wavelength',
    'scale_ratio',
    'ridges',
)
"""Constants of a generated surface; what a case does not state is that of the nominal screw."""
GENERATED = ('seed', 'lay', 'position_x', 'position_y', 'grid_wavelength') + tuple(
    name for name in CONSTANTS if name != 'shortest_wavelength'
)
"""What only a generated surface has."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseRoughness(Checked):
    """
    Raceway of a case: a fractal surface from a seed, or a measured one from a file.

    Rq `rms` [m]; a generated surface has dimension D [-], G [m], sample length, shortest
    wavelength [m], scale ratio and ridges [-], lay and the place [m] that comes to the contact
    centre; waves shorter than `grid_wavelength` [m] act as a higher film floor. A `file` is
    filtered at `shortest_wavelength` [m] when that is given. The `patch` is rescaled to the rms or
    cut, levelled over a window with sides `window_x`, `window_y` [m], by default the Hertz
    rectangle of the case: state it in a series over loads. Boundary friction coefficient [-].

    """

    rms: float | None = quantity('um', 1e-6, 0.0, 10.0, default=None)
    file: str | None = text(default=None)
    outside: Outside = choice('refuse', 'mirror', default='refuse')
    seed: int | None = count(0, 2**32 - 1, default=None)
    patch: Patch | None = choice('rescaled', 'cut', default=None)
    lay: Lay | None = choice('isotropic', 'longitudinal', 'transverse', default=None)
    shortest_wavelength: float | None = quantity('um', 1e-6, 0.1, 1000.0, default=None)
    grid_wavelength: float | None = quantity('um', 1e-6, 0.1, 1000.0, default=None)
    fractal_dimension: float | None = quantity('', 1.0, 2.01, 2.99, default=None)
    fractal_roughness: float | None = quantity('nm', 1e-9, 1e-6, 1e3, default=None)
    sample_length: float | None = quantity('mm', 1e-3, 0.01, 100.0, default=None)
    scale_ratio: float | None = quantity('', 1.0, 1.01, 10.0, default=None)
    ridges: int | None = count(1, 1000, default=None)
    position_x: float | None = quantity('mm', 1e-3, -1e3, 1e3, default=None)
    position_y: float | None = quantity('mm', 1e-3, -1e3, 1e3, default=None)
    window_x: float | None = quantity('mm', 1e-3, 1e-3, 100.0, default=None)
    window_y: float | None = quantity('mm', 1e-3, 1e-3, 100.0, default=None)
    asperity_friction: float = quantity('', 1.0, 0.0, 1.0, default=0.1)

    def __post_init__(self) -> None:
        """Check ranges, and that the keys of a file and of a generated surface do not mix."""
        Checked.__post_init__(self)
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

    nx: int = count(17, LARGEST_GRID)
    ny: int = count(17, LARGEST_GRID)

    def __post_init__(self) -> None:
        """Check that both are odd, so that a node lies on the centre line."""
        Checked.__post_init__(self)
        for name in ('nx', 'ny'):
            if getattr(self, name) % 2 == 0:
                raise InputError(f'{name} is {getattr(self, name)}, allowed is an odd number')


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseDomain(Checked):
    """Inlet and outlet along x over the semi-axis a [-], half width along y over b [-]."""

    inlet: float = quantity('', 1.0, -50.0, -1.1)
    outlet: float = quantity('', 1.0, 1.1, 20.0)
    side: float = quantity('', 1.0, 1.05, 20.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactCase(Checked):
    """
    One contact to solve.

    Radii of relative curvature [m], E' [Pa], load [N], entrainment speed [m/s] (0 is the dry
    contact), ambient viscosity [Pa s], pressure-viscosity [1/Pa], Eyring stress [Pa], slide-roll
    ratios |u1 - u2| / entrainment speed [-], film floor [m].

    """

    radius_x: float = quantity('mm', 1e-3, 1e-3, 1e6)
    radius_y: float = quantity('mm', 1e-3, 1e-3, 1e6)
    reduced_modulus: float = quantity('GPa', 1e9, 1e-4, 1e4)
    load: float = quantity('N', 1.0, 1e-3, 1e6)
    entrainment_speed: float = quantity('m_s', 1.0, 0.0, 1e3)
    viscosity: float = quantity('Pa_s', 1.0, 1e-4, 100.0)
    pressure_viscosity: float = quantity('1_GPa', 1e-9, 0.1, 100.0)
    fluid: Law = choice('roelands_dh', 'barus_incompressible', default='roelands_dh')
    eyring_stress: float = quantity('MPa', 1e6, 0.01, 1000.0, default=5e6)
    slide_roll_ratio: tuple[float, ...] = quantities('', 1.0, 0.0, 1000.0)
    roughness: CaseRoughness | None = block(CaseRoughness, default=None)
    film_floor: float = quantity('nm', 1e-9, 1e-3, 1e3, default=3e-9)
    grid: CaseGrid | None = block(CaseGrid, default=None)
    domain: CaseDomain | None = block(CaseDomain, default=None)

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
