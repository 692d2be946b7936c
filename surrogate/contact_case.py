# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One contact as a file: what to solve, in unit-suffixed keys, and its result as a record.

A case names two radii, a modulus, a load, a speed and an oil; roughness, grid and domain are
optional.

"""

from dataclasses import dataclass, replace
import logging
import math

from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.ehl.case import make_case
from surrogate.ehl.model import Law
from surrogate.geometry import Contact, ellipticity, hertz
from surrogate.measured_surface import MeasuredSurface, Outside
from surrogate.parameters import (
    block,
    Checked,
    choice,
    count,
    find_sheet,
    InputError,
    load_screw,
    quantities,
    quantity,
    read_sheet,
    text,
)
from surrogate.profile_import import read_surface
from surrogate.roughness import (
    fractal_surface,
    FractalSurface,
    Lay,
    Patch,
    shifted,
    Surface,
    take_patch,
    Window,
)

LARGEST_GRID = 2049
SLENDER, WIDE_NY = 2.5, 257
"""Nodes across a contact with an axis ratio below that [-]: its least film lies at its sides."""
FILM_ERROR, FINE_NX, FINE_NY = 0.005, 513, 129
"""Estimated relative error of the film above which a smooth case is refined, and to what [-]."""
NODES_PER_WAVE = 4
"""Nodes per shortest wavelength of a rough grid that the case does not state [-]."""
ROUGH_NX, LARGEST_DEFAULT_GRID = 129, 513
"""Fewest nodes along x, and most along a side, of such a grid [-]."""
LOG = logging.getLogger(__name__)
CONSTANTS = (
    'fractal_dimension',
    'fractal_roughness',
    'sample_length',
    'shortest_wavelength',
    'scale_ratio',
    'ridges',
)
"""Constants of a generated surface; what a case does not state is that of the nominal screw."""
GENERATED = ('seed', 'lay', 'position_x', 'position_y') + tuple(
    name for name in CONSTANTS if name != 'shortest_wavelength'
)
"""What only a generated surface has."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseRoughness(Checked):
    """
    Raceway of a case: a fractal surface from a seed, or a measured one from a file.

    Rq `rms` [m]; a generated surface has dimension D [-], G [m], sample length, shortest
    wavelength [m], scale ratio and ridges [-], lay and the place [m] that comes to the contact
    centre. A `file` is filtered at `shortest_wavelength` [m] when that is given. The `patch` is
    rescaled to the rms or cut, levelled over a window with sides `window_x`, `window_y` [m], by
    default the Hertz rectangle of the case: state it in a series over loads. Boundary friction
    coefficient [-].

    """

    rms: float | None = quantity('um', 1e-6, 0.0, 10.0, default=None)
    file: str | None = text(default=None)
    outside: Outside = choice('refuse', 'mirror', default='refuse')
    seed: int | None = count(0, 2**32 - 1, default=None)
    patch: Patch | None = choice('rescaled', 'cut', default=None)
    lay: Lay | None = choice('isotropic', 'longitudinal', 'transverse', default=None)
    shortest_wavelength: float | None = quantity('um', 1e-6, 0.1, 1000.0, default=None)
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


def solve_case(case: ContactCase) -> tuple[ContactSolution, Surface | None]:
    """
    Solve a case; return the solution and the rough surface as the contact saw it, None if smooth.

    A smooth case without a stated grid is solved again on a finer one when its estimated error is
    larger than `FILM_ERROR`. Raises InputError for inputs that no contact has; anything else is a
    status of the solution.

    """
    surface = case_surface(case)
    settings = case_settings(case, surface)
    solution = _solve(case, surface, settings)
    if surface is None and case.grid is None and solution.film_error > FILM_ERROR:
        fine = replace(settings, nx=FINE_NX, ny=max(settings.ny, FINE_NY))
        finer = _solve(case, surface, fine)
        if finer.converged:
            counts = ('newton_iterations', 'krylov_iterations', 'wall_time')
            both = {name: getattr(solution, name) + getattr(finer, name) for name in counts}
            return replace(finer, **both), None
    return solution, surface


def _solve(case: ContactCase, surface: Surface | None, settings: Settings) -> ContactSolution:
    return solve_contact(
        case.contact,
        case.lubricant,
        case.condition,
        roughness=surface.heights if surface else None,
        settings=settings,
    )


def case_surface(case: ContactCase) -> Surface | None:
    """Return the rough surface of a case as a patch, None when it is smooth."""
    rough = case.roughness
    if rough is None or (rough.file is None and not rough.rms):
        return None
    ellipse = hertz(case.contact, case.load)
    window = Window(
        length_x=rough.window_x or 2 * float(ellipse.semi_axis_x),
        length_y=rough.window_y or 2 * float(ellipse.semi_axis_y),
    )
    if rough.file is None:
        return take_patch(_generated(rough), rough.patch or 'rescaled', window, rough.rms or 0.0)
    kind = rough.patch or ('rescaled' if rough.rms else 'cut')
    return take_patch(_measured(rough, rough.file), kind, window, rough.rms or 0.0)


def _generated(rough: CaseRoughness) -> FractalSurface:
    stated = {name: getattr(rough, name) for name in CONSTANTS if getattr(rough, name) is not None}
    constants = replace(load_screw('nominal').roughness, **stated)
    draw = fractal_surface(constants, rough.seed or 0, lay=rough.lay or 'isotropic')
    return shifted(draw, rough.position_x or 0.0, rough.position_y or 0.0)


def _measured(rough: CaseRoughness, file: str) -> MeasuredSurface:
    return read_surface(file, shortest_wavelength=rough.shortest_wavelength, outside=rough.outside)


def case_settings(case: ContactCase, surface: Surface | None) -> Settings:
    """
    Return how to solve a case.

    On a stated domain the rolling force is that of the domain, without the tail to the meniscus.

    """
    settings = Settings(film_floor=case.film_floor)
    if case.domain is not None:
        domain = (case.domain.inlet, case.domain.outlet, case.domain.side)
        settings = replace(settings, domain=domain, meniscus_length=0.0)
    if case.grid is not None:
        settings = replace(settings, nx=case.grid.nx, ny=case.grid.ny)
    elif surface is not None:
        settings = _rough_grid(case, settings, surface.shortest_wavelength)
    elif ellipticity(case.contact) < SLENDER:
        settings = replace(settings, ny=WIDE_NY)
    if surface is not None:
        _check_resolution(case, settings, surface.shortest_wavelength)
    return settings


def _sides(case: ContactCase, settings: Settings) -> tuple[float, float]:
    """Return the sides of the domain [m]."""
    scaled = make_case(case.contact, case.lubricant, case.condition, settings, None)
    inlet, outlet, side = scaled.domain
    return (outlet - inlet) * scaled.semi_axis_x, 2 * side * scaled.semi_axis_x


def _rough_grid(case: ContactCase, settings: Settings, wave: float) -> Settings:
    """Return settings with the grid that the shortest wavelength [m] asks for, within bounds."""
    along, across = (
        min(2 * math.ceil(NODES_PER_WAVE * side / wave / 2) + 1, LARGEST_DEFAULT_GRID)
        for side in _sides(case, settings)
    )
    return replace(settings, nx=max(along, ROUGH_NX), ny=max(across, settings.ny))


def _check_resolution(case: ContactCase, settings: Settings, wave: float) -> None:
    """Warn when the grid sees less than two nodes of the shortest wavelength [m]."""
    for name, side in zip('xy', _sides(case, settings), strict=True):
        distance = side / (getattr(settings, f'n{name}') - 1)
        if distance > 0.5 * wave:
            LOG.warning(
                'the nodes are %.3g um apart along %s, the shortest wavelength is %.3g um: '
                'asperity contact is not resolved',
                1e6 * distance,
                name,
                1e6 * wave,
            )
