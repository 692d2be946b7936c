# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Datasheets: checked, frozen, in SI units inside and in unit-suffixed keys on file.

Every quantity is declared once, with the key it has on file, the factor to SI and its allowed
range; loading, checking and error sentences all derive from that declaration.

"""

from dataclasses import dataclass, field, fields, MISSING
import math
from pathlib import Path
from typing import Any, TypeVar

import yaml

DATA = Path(__file__).parent / 'data'
ZERO_CELSIUS = 273.15

Sheet = TypeVar('Sheet')


class InputError(ValueError):
    """One sentence about an input: what, where, value, unit, allowed."""


def quantity(
    unit: str,
    factor: float,
    low: float,
    high: float,
    *,
    shift: float = 0.0,
    default: Any = MISSING,
) -> Any:
    """
    Declare a number: SI = (file + shift) * factor, allowed range in file units.

    The key on file is the name of the field with the unit as its suffix.

    """
    return field(
        default=default,
        metadata={'unit': unit, 'factor': factor, 'shift': shift, 'low': low, 'high': high},
    )


def count(low: int, high: int, *, default: Any = MISSING) -> Any:
    """Declare a whole number and its range."""
    return field(
        default=default,
        metadata={'unit': '', 'factor': 1, 'shift': 0, 'low': low, 'high': high, 'whole': True},
    )


def quantities(unit: str, factor: float, low: float, high: float) -> Any:
    """Declare a list of numbers, empty by default; one number alone is a list too."""
    return field(
        default=(),
        metadata={
            'unit': unit,
            'factor': factor,
            'shift': 0.0,
            'low': low,
            'high': high,
            'many': True,
        },
    )


def choice(*allowed: str, default: Any = MISSING) -> Any:
    """Declare a word out of those allowed."""
    return field(default=default, metadata={'choice': allowed})


def text(*, default: Any = MISSING) -> Any:
    """Declare a text that is not empty."""
    return field(default=default, metadata={'text': True})


def block(cls: type, *, default: Any = MISSING) -> Any:
    """Declare a nested block of quantities; a list of all its values in order will do too."""
    return field(default=default, metadata={'block': cls})


def _key(spec: Any) -> str:
    """Return the key on file of a declared field."""
    unit = spec.metadata.get('unit')
    return f'{spec.name}_{unit}' if unit else str(spec.name)


class Checked:
    """Base of all datasheets: every declared quantity is finite and inside its range."""

    __slots__ = ()

    def __post_init__(self) -> None:
        """Raise InputError for a number outside its declared range; None is absent."""
        for spec in fields(self):  # type: ignore[arg-type]
            value = getattr(self, spec.name)
            if 'low' in spec.metadata and value is not None:
                for number in value if 'many' in spec.metadata else (value,):
                    _check_range(
                        type(self).__name__.lower(),
                        spec,
                        number / spec.metadata['factor'] - spec.metadata['shift'],
                    )


@dataclass(frozen=True, kw_only=True, slots=True)
class Material(Checked):
    """Elastic solid: Young's modulus [Pa], Poisson's ratio [-], density [kg/m3]."""

    young_modulus: float = quantity('GPa', 1e9, 1.0, 1000.0)
    poisson_ratio: float = quantity('', 1.0, 0.0, 0.49)
    density: float = quantity('kg_m3', 1.0, 500.0, 20000.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Roughness(Checked):
    """
    Raceway roughness and what asperities do; the ball is smooth.

    Rq `rms` [m]; fractal dimension D [-] and fractal roughness G [m] of a Weierstrass-Mandelbrot
    surface with sample length, shortest wavelength [m], scale ratio and ridges [-]; film floor [m]
    below which a film counts as punctured; boundary friction coefficient [-].

    """

    rms: float = quantity('um', 1e-6, 0.001, 10.0)
    fractal_dimension: float = quantity('', 1.0, 2.01, 2.99)
    fractal_roughness: float = quantity('nm', 1e-9, 1e-6, 1e3)
    sample_length: float = quantity('mm', 1e-3, 0.01, 100.0)
    shortest_wavelength: float = quantity('um', 1e-6, 0.1, 1000.0)
    scale_ratio: float = quantity('', 1.0, 1.01, 10.0)
    ridges: int = count(1, 1000)
    film_floor: float = quantity('nm', 1e-9, 0.1, 100.0)
    asperity_friction: float = quantity('', 1.0, 0.0, 1.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Screw(Checked):
    """
    Preloaded double-nut ball screw with equal nuts.

    Lengths [m], angles [rad], forces [N], torques [N m]; conformities are groove radius over ball
    diameter [-]; `parasitic_torque` [N m] and `parasitic_torque_rate` [N m s/rad] stand for
    wipers, recirculation and ball-to-ball contact; `speed_limit` is D n [m rad/s] with D the pitch
    diameter.

    """

    name: str = text()
    source: str = text()
    pitch_radius: float = quantity('mm', 1e-3, 1.0, 500.0)
    lead: float = quantity('mm', 1e-3, 0.5, 200.0)
    ball_diameter: float = quantity('mm', 1e-3, 0.3, 100.0)
    contact_angle: float = quantity('deg', math.pi / 180, 20.0, 70.0)
    conformity_screw: float = quantity('', 1.0, 0.501, 0.7)
    conformity_nut: float = quantity('', 1.0, 0.501, 0.7)
    loaded_balls_per_nut: int = count(1, 10000)
    preload: float = quantity('N', 1.0, 0.0, 1e6)
    static_rating: float = quantity('kN', 1e3, 0.1, 1e5)
    speed_limit: float = quantity('m_rev_min', math.pi / 30, 1.0, 1000.0)
    parasitic_torque: float = quantity('Nm', 1.0, 0.0, 1e3, default=0.0)
    parasitic_torque_rate: float = quantity('Nm_s', 1.0, 0.0, 1e3, default=0.0)
    raceway: Material = block(Material)
    ball: Material = block(Material)
    roughness: Roughness = block(Roughness)

    def __post_init__(self) -> None:
        """Check every range and that the balls fit on the pitch circle."""
        # slots=True makes a new class, so the zero-argument super() is not available here.
        Checked.__post_init__(self)
        if self.ball_diameter >= self.pitch_radius:
            raise InputError(
                f'screw: ball_diameter_mm is {self.ball_diameter * 1e3:g} mm, allowed is less '
                f'than pitch_radius_mm ({self.pitch_radius * 1e3:g} mm)'
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class Lubricant(Checked):
    """
    Oil, anchored at its reference temperature.

    Viscosity [Pa s], pressure-viscosity [1/Pa] and density [kg/m3] hold at `reference_temperature`
    [K]; kinematic viscosities [m2/s] at 40 and 100 degC give the temperature law; `density_slope`
    [kg/m3/K] is the loss of density per kelvin; temperatures [K] bound the datasheet.

    """

    name: str = text()
    source: str = text()
    reference_temperature: float = quantity('degC', 1.0, -50.0, 200.0, shift=ZERO_CELSIUS)
    viscosity: float = quantity('Pa_s', 1.0, 1e-4, 100.0)
    pressure_viscosity: float = quantity('1_GPa', 1e-9, 1.0, 100.0)
    density: float = quantity('kg_m3', 1.0, 500.0, 2000.0)
    density_slope: float = quantity('kg_m3_K', 1.0, 0.0, 2.0)
    eyring_stress: float = quantity('MPa', 1e6, 0.1, 100.0)
    kinematic_viscosity_40: float = quantity('mm2_s', 1e-6, 2.0, 1e5)
    kinematic_viscosity_100: float = quantity('mm2_s', 1e-6, 1.0, 1e4)
    minimum_temperature: float = quantity('degC', 1.0, -60.0, 200.0, shift=ZERO_CELSIUS)
    maximum_temperature: float = quantity('degC', 1.0, -60.0, 250.0, shift=ZERO_CELSIUS)

    def __post_init__(self) -> None:
        """Check every range, that oil thins when warm, and that the range holds the reference."""
        Checked.__post_init__(self)
        if self.kinematic_viscosity_100 >= self.kinematic_viscosity_40:
            raise InputError(
                'lubricant: kinematic_viscosity_100_mm2_s is '
                f'{self.kinematic_viscosity_100 * 1e6:g} mm2/s, allowed is less than '
                f'kinematic_viscosity_40_mm2_s ({self.kinematic_viscosity_40 * 1e6:g} mm2/s)'
            )
        if not (
            self.minimum_temperature <= self.reference_temperature <= self.maximum_temperature
        ):
            raise InputError(
                'lubricant: reference_temperature_degC is '
                f'{self.reference_temperature - ZERO_CELSIUS:g} degC, allowed is '
                f'{self.minimum_temperature - ZERO_CELSIUS:g} to '
                f'{self.maximum_temperature - ZERO_CELSIUS:g} degC (the range of the sheet)'
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class OperatingPoint(Checked):
    """
    Where the screw runs: signed speed [rad/s], signed axial load [N], oil temperature [K].

    A positive load opposes a motion with positive speed, so equal signs mean that the screw works
    against the load. Speed zero stands for the limit of slow motion in the positive direction.

    """

    speed: float = quantity('rpm', math.pi / 30, -1e5, 1e5)
    load: float = quantity('N', 1.0, -1e7, 1e7)
    temperature: float = quantity('degC', 1.0, -60.0, 250.0, shift=ZERO_CELSIUS)

    @property
    def opposing_load(self) -> float:
        """Load [N], positive when it opposes the motion."""
        return -self.load if self.speed < 0 else self.load


def load_screw(name_or_path: str) -> Screw:
    """Load a screw by shipped name or file; raises InputError."""
    return read_sheet(Screw, find_sheet(name_or_path, 'screws'))


def load_lubricant(name_or_path: str) -> Lubricant:
    """Load an oil by shipped name or file; raises InputError."""
    return read_sheet(Lubricant, find_sheet(name_or_path, 'lubricants'))


def read_sheet(cls: type[Sheet], path: Path) -> Sheet:
    """Read a YAML file whose keys are those that `cls` declares; raises InputError."""
    try:
        content = yaml.safe_load(path.read_text(encoding='utf-8'))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = ' '.join(str(error).split())
        raise InputError(f'{path}: cannot be read as YAML, {reason}') from None
    return _from_mapping(cls, content, str(path))


def find_sheet(name_or_path: str, folder: str) -> Path:
    """Return the path of a shipped datasheet or of a file; raises InputError."""
    shipped = sorted(path.stem for path in (DATA / folder).glob('*.yaml'))
    if name_or_path in shipped:
        return DATA / folder / f'{name_or_path}.yaml'
    path = Path(name_or_path)
    if path.is_file():
        return path
    raise InputError(
        f'{folder}: {name_or_path!r} is neither a file nor one of the shipped '
        f'datasheets ({", ".join(shipped)})'
    )


def _from_mapping(cls: type[Sheet], content: Any, where: str) -> Sheet:
    if not isinstance(content, dict):
        raise InputError(
            f'{where}: must be a mapping of keys to values, got {type(content).__name__}'
        )
    specs = {_key(spec): spec for spec in fields(cls)}  # type: ignore[arg-type]
    _check_keys(specs, content, where)
    values = {specs[key].name: _value(specs[key], raw, where) for key, raw in content.items()}
    try:
        return cls(**values)
    except InputError as error:
        raise InputError(f'{where}: {error}') from None


def _check_keys(specs: dict[str, Any], content: dict[Any, Any], where: str) -> None:
    for key in content:
        if key not in specs:
            raise InputError(f'{where}: {_unknown_key(str(key), specs)}')
    missing = [
        key for key, spec in specs.items() if key not in content and spec.default is MISSING
    ]
    if missing:
        raise InputError(
            f'{where}: missing key {", ".join(missing)} (all of {", ".join(specs)} belong here)'
        )


def _unknown_key(key: str, specs: dict[str, Any]) -> str:
    """Tell a wrong unit suffix from an unknown name."""
    for known, spec in specs.items():
        if spec.metadata.get('unit') and (key == spec.name or key.startswith(f'{spec.name}_')):
            return f'{key} has a wrong unit, the key is {known}'
    return f'unknown key {key}, allowed are {", ".join(specs)}'


def _value(spec: Any, raw: Any, where: str) -> Any:
    key, rules = _key(spec), spec.metadata
    if 'block' in rules:
        keys = [_key(one) for one in fields(rules['block'])]
        if isinstance(raw, list) and len(raw) == len(keys):
            raw = dict(zip(keys, raw, strict=True))
        return _from_mapping(rules['block'], raw, f'{where}: {key}')
    if 'text' in rules:
        if not isinstance(raw, str) or not raw.strip():
            raise InputError(f'{where}: {key} is {raw!r}, allowed is a text that is not empty')
        return raw.strip()
    if 'choice' in rules:
        if raw not in rules['choice']:
            raise InputError(
                f'{where}: {key} is {raw!r}, allowed is {" or ".join(rules["choice"])}'
            )
        return raw
    if 'many' in rules:
        return tuple(
            _number(spec, one, where) for one in (raw if isinstance(raw, list) else [raw])
        )
    return _number(spec, raw, where)


def _number(spec: Any, raw: Any, where: str) -> Any:
    key, rules = _key(spec), spec.metadata
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        hint = ' (write 1.0e-8, not 1e-8)' if isinstance(raw, str) else ''
        raise InputError(
            f'{where}: {key} is {raw!r}, allowed is a number '
            f'from {rules["low"]:g} to {rules["high"]:g}{hint}'
        )
    _check_range(where, spec, raw)
    return raw if rules.get('whole') else (raw + rules['shift']) * rules['factor']


def _check_range(where: str, spec: Any, value: float) -> None:
    """Compare in file units; a rounding of the conversion must not refuse the limit itself."""
    rules = spec.metadata
    low, high, whole = rules['low'], rules['high'], rules.get('whole', False)
    slack = 1e-12 * max(abs(low), abs(high))
    inside = math.isfinite(value) and low - slack <= value <= high + slack
    if not inside or (whole and value != int(value)):
        kind = 'a whole number from ' if whole else ''
        raise InputError(
            f'{where}: {_key(spec)} is {value:g}, allowed is {kind}{low:g} to {high:g}'
        )
