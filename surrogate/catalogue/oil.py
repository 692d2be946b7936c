# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sheet of an oil, or of a grease by its base oil, out of a few values of a data sheet."""

from dataclasses import dataclass

from surrogate.catalogue.noted import derived, Noted, noted_sheet, stated, typical
from surrogate.catalogue.words import CatalogueOil
from surrogate.formulas.inlet import SPEED_EXPONENT
from surrogate.formulas.lubricant import pressure_viscosity_gold_2001
from surrogate.formulas.viscosity_index import viscosity_at_100_astm_d2270
from surrogate.parameters import Lubricant
from surrogate.units import MICRO, ZERO_CELSIUS

DENSITY_SLOPE = 0.64
"""Usual loss of density of an oil [kg/m3/K]."""
GREASE_FACTOR, WORST_FACTOR = 0.7, 0.5
"""Usual and thin film of a grease over that of its base oil in plenty [-], assumed."""


@dataclass(frozen=True, slots=True)
class Base:
    """Base oil: pressure-viscosity at 1 mm2/s [1/Pa], density at 15 degC [kg/m3], index [-]."""

    pressure_viscosity: float
    density: Noted
    index: Noted


BASES = {
    'mineral': Base(9.904e-9, typical(885.0, '865 to 905'), typical(95.0, '90 to 105')),
    'pao': Base(7.382e-9, typical(840.0, '825 to 855'), typical(140.0, '130 to 150')),
    'ester': Base(6.605e-9, typical(930.0, '900 to 970'), typical(150.0, '130 to 190')),
}
"""Pressure-viscosity by Gold et al. 2001, with the exponent of mineral oils for all of them."""


def oil_of(given: CatalogueOil) -> tuple[Lubricant, dict[str, str]]:
    """
    Return the sheet of an oil, and what is given, derived or typical by the keys on file.

    Raises InputError for an index that no oil has, and for what contradicts itself.

    """
    kinematic, base = given.iso_vg, BASES[given.base or 'mineral']
    kind = 'grease' if given.kind == 'grease' else given.base or 'mineral'
    warm = stated(given.density_15, base.density)
    density = derived(
        warm.value - 25 * DENSITY_SLOPE, f'from {warm.value:g} at 15 degC, {warm.note}'
    )
    alpha = float(pressure_viscosity_gold_2001(base.pressure_viscosity, MICRO * kinematic))
    if given.viscosity_100 is None:
        index = stated(given.viscosity_index, base.index)
        hot = derived(
            viscosity_at_100_astm_d2270(kinematic, index.value),
            f'ASTM D2270 for the index {index.value:g}, {index.note}',
        )
    else:
        hot = Noted(given.viscosity_100, 'given')
    if given.kind == 'grease':  # whose film starves below that of its base oil
        stated_factor = stated(given.film_factor, typical(GREASE_FACTOR, '0.5 to 1'))
        shares = stated_factor.value, WORST_FACTOR
        now, worst = (share ** (-1 / SPEED_EXPONENT) for share in shares)
        words = f'the onset is {now:.1f} times as fast, {worst:.1f} times with {WORST_FACTOR:g}'
        factor = Noted(stated_factor.value, f'{stated_factor.note}; {words}')
    else:
        factor = stated(given.film_factor, typical(1.0, 'oil in plenty'))
    return noted_sheet(
        Lubricant,
        {
            'name': given.name or f'{kind}_vg_{MICRO * kinematic:g}',
            'source': given.source or 'Values of a data sheet, completed by ballscrew oil new.',
            'reference_temperature': Noted(40 + ZERO_CELSIUS, 'given, that of ISO VG'),
            'viscosity': derived(kinematic * density.value, 'kinematic viscosity times density'),
            'pressure_viscosity': derived(alpha, 'Gold et al. 2001, within 20 %'),
            'density': density,
            'density_slope': typical(DENSITY_SLOPE, '0.6 to 0.7'),
            'eyring_stress': typical(5e6, '2 to 10'),
            'kinematic_viscosity_40': Noted(kinematic, 'given'),
            'kinematic_viscosity_100': hot,
            'minimum_temperature': typical(ZERO_CELSIUS, '-20 to 10'),
            'maximum_temperature': typical(100 + ZERO_CELSIUS, '80 to 120'),
            'thermal_conductivity': typical(0.14, '0.12 to 0.16'),
            'film_floor': typical(3e-9, '2 to 5 with anti-wear additives, 0.5 to 2 without'),
            'film_floor_low': typical(1e-9, 'a few molecules of base oil'),
            'film_floor_high': typical(5e-9, 'a thick boundary film'),
            'film_factor': factor,
        },
    )
