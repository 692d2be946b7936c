# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Values of a catalogue and of an oil's data sheet, as a person is asked for them."""

from dataclasses import dataclass, field, fields
from typing import Any, ClassVar

from surrogate.files import InputError
from surrogate.files.datasheet import Checked, choice, count, key_of, quantity, text
from surrogate.parameters import NAME, NUTS
from surrogate.units import MILLI

ACCURACY = ('0', '1', '2', '3', '4', '5', '7', '10')
"""Classes of ISO 3408-3 and JIS B 1192."""
PITCH_OVER_NOMINAL = (0.9, 1.15)
"""Ball circle over nominal diameter [-] beyond which one of them is another number."""


def _asked(words: str, spec: Any) -> Any:
    """Declare a value with the words in which a person is asked for it."""
    return field(default=None, metadata={**spec.metadata, 'words': words})


def _number(words: str, unit: str, factor: float, low: float, high: float) -> Any:
    return _asked(words, quantity(unit, factor, low, high))


def flag_of(spec: Any) -> str:
    """Return the option that gives a declared value."""
    return f'--{key_of(spec).replace("_", "-")}'


@dataclass(frozen=True, kw_only=True, slots=True)
class CatalogueScrew(Checked):
    """
    Ball screw in the words of a catalogue; None is derived or typical.

    Lengths and Ra [m], ratings and preload [N], its share of C and turns [-].

    """

    NEEDED: ClassVar[tuple[tuple[str, ...], ...]] = (
        ('nominal_diameter', 'pitch_diameter'),
        ('lead',),
        ('nut',),
        ('turns', 'balls'),
        ('preload', 'dynamic_rating'),
    )

    name: str | None = _asked('name (default screw_DIAMETERxLEAD)', text(*NAME))
    source: str | None = _asked('where the numbers come from', text())
    nominal_diameter: float | None = _number('nominal diameter', 'mm', 1e-3, 2.0, 1000.0)
    pitch_diameter: float | None = _number(
        'diameter of the ball circle (default: by the nominal diameter)', 'mm', 1e-3, 2.0, 1000.0
    )
    lead: float = _number('lead', 'mm', 1e-3, 0.5, 200.0)
    ball_diameter: float | None = _number(
        'ball diameter (default 0.635 leads, 0.2 diameters at most)', 'mm', 1e-3, 0.3, 100.0
    )
    nut: str = _asked(
        'nut: double (two nuts), offset (one nut, its halves shifted), oversize (one nut, its '
        'balls preload it) or plain (no preload)',
        choice(*NUTS),
    )
    turns: float | None = _number('loaded turns of one nut, all circuits', '', 1.0, 0.5, 100.0)
    balls: int | None = _asked('loaded balls of one nut (default by turns)', count(1, 10000))
    spacers: str | None = _asked(
        'is every second ball a smaller spacer: yes or no (default)', choice('yes', 'no')
    )
    dynamic_rating: float | None = _number(
        'dynamic load rating C of one nut, of half an offset one', 'kN', 1e3, 0.1, 1e5
    )
    static_rating: float | None = _number(
        'static load rating C0, likewise (default presses a ball by 4.2 GPa)', 'kN', 1e3, 0.1, 1e5
    )
    preload: float | None = _number('preload (default a share of C)', 'N', 1.0, 0.0, 1e6)
    preload_share: float | None = _number('preload over C (default 0.05)', '', 1.0, 0.0, 0.3)
    accuracy: str | None = _asked(
        'accuracy class, 7 of C7 or T7; 7 and 10 are rolled', choice(*ACCURACY)
    )
    process: str | None = _asked(
        'ground (default), rolled or whirled', choice('ground', 'rolled', 'whirled')
    )
    ra: float | None = _number('Ra across the track (default typical)', 'um', 1e-6, 0.0, 10.0)
    cutoff_long: float | None = _number(
        'long cut-off of Ra (default 0.25)', 'mm', 1e-3, 0.001, 100.0
    )

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        _check_needed(self, self.NEEDED[:-1] if self.nut == 'plain' else self.NEEDED)
        if self.nut == 'offset' and self.balls is None and (self.turns or 0.0) < 2:
            raise InputError(
                f'turns is {self.turns:g} with nut offset, allowed is 2 or more: each half of the '
                'nut has a turn'
            )
        if self.nominal_diameter is None or self.pitch_diameter is None:
            return
        low, high = (share * MILLI * self.nominal_diameter for share in PITCH_OVER_NOMINAL)
        if not low <= MILLI * self.pitch_diameter <= high:
            raise InputError(
                f'pitch_diameter_mm is {MILLI * self.pitch_diameter:g} mm, allowed is {low:.4g} '
                f'to {high:.4g} mm with nominal_diameter_mm {MILLI * self.nominal_diameter:g}: '
                'both are diameters'
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class CatalogueOil(Checked):
    """
    Oil, or grease by its base oil, in the words of a data sheet; None is derived or typical.

    Kinematic viscosities [m2/s], density [kg/m3], film factor [-].

    """

    NEEDED: ClassVar[tuple[tuple[str, ...], ...]] = (('iso_vg',),)

    name: str | None = _asked('name (default such as mineral_vg_46)', text(*NAME))
    source: str | None = _asked('where the numbers come from', text())
    iso_vg: float = _number('ISO VG, of a grease that of its base oil', '', 1e-6, 2.0, 1e4)
    viscosity_index: float | None = _number(
        'viscosity index (default by the base)', '', 1.0, -50.0, 400.0
    )
    viscosity_100: float | None = _number(
        'kinematic viscosity at 100 degC (default by the index)', 'mm2_s', 1e-6, 1.0, 1e4
    )
    base: str | None = _asked('mineral (default), pao or ester', choice('mineral', 'pao', 'ester'))
    kind: str | None = _asked('oil (default) or grease', choice('oil', 'grease'))
    density_15: float | None = _number(
        'density at 15 degC (default by the base)', 'kg_m3', 1.0, 500.0, 2000.0
    )
    film_factor: float | None = _number(
        'film over that of oil in plenty (default 1, of grease 0.7)', '', 1.0, 0.05, 1.0
    )

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        _check_needed(self, self.NEEDED)


def _check_needed(
    values: CatalogueScrew | CatalogueOil, needed: tuple[tuple[str, ...], ...]
) -> None:
    """Raise InputError for what cannot be derived, with the words among which to choose."""
    specs = {spec.name: spec for spec in fields(values)}
    for names in needed:
        if all(getattr(values, name) is None for name in names):
            words = [word for name in names for word in specs[name].metadata.get('choice', ())]
            allowed = f': {" or ".join(words)}' * bool(words)
            flags = ' or '.join(flag_of(specs[name]) for name in names)
            raise InputError(f'{flags} is missing{allowed}')
