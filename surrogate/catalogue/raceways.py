# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Typical raceways by the process that makes them.

What no published number was found for is named as assumed.

"""

from collections.abc import Iterator
from dataclasses import dataclass, fields

from surrogate.catalogue.noted import derived, Noted, stated, typical
from surrogate.catalogue.words import CatalogueScrew
from surrogate.raceway.fractal import Lay
from surrogate.raceway.standards import RA_OVER_RQ
from surrogate.raceway.stated import Roughness
from surrogate.units import MICRO, RPM, TURN


@dataclass(frozen=True, kw_only=True, slots=True)
class Process:
    """Raceway of a process: Ra [m], lay, D n [m rad/s], the first two with range and source."""

    ra: float
    ra_range: tuple[float, float]
    ra_words: str
    lay: Lay
    lay_words: str
    dn: float


PROCESSES = {
    'ground': Process(
        ra=0.16e-6,
        ra_range=(0.1e-6, 0.4e-6),
        ra_words='0.16, 0.1 to 0.4; a maker: below 0.2; a published study: 0.1',
        lay='longitudinal',
        lay_words='the wheel leaves ridges along the thread',
        dn=90 * RPM,
    ),
    'rolled': Process(
        ra=0.3e-6,
        ra_range=(0.1e-6, 0.8e-6),
        ra_words='0.3, 0.1 to 0.8, assumed',
        lay='longitudinal',
        lay_words='assumed: ground dies print their ridges along the thread',
        dn=70 * RPM,
    ),
    'whirled': Process(
        ra=0.3e-6,
        ra_range=(0.2e-6, 0.8e-6),
        ra_words='0.3, 0.2 to 0.8, assumed',
        lay='transverse',
        lay_words='assumed: edges between successive cuts lie across the thread',
        dn=90 * RPM,
    ),
}
"""D n by HIWIN Ballscrews BS-08-2-EN-1704-K, section 3.7.6, where whirled screws are peeled."""
USUAL = {
    'cutoff_short': 'ISO 3274',
    'hardness': '6.5 to 7.5: 58 to 62 HRC',
    'run_in_pressure': '2 to 5',
    'run_in_low': 'lowest likely',
    'run_in_high': 'highest likely',
    'state': 'after weeks of operation; new before',
    'traced': 'before running in',
    'scale_ratio': '1.2 to 2: generator of waves',
    'ridges': '5 to 20: generator of waves',
    'onset_factor': '1 until ballscrew identify --onset gives it',
}
"""Range or source of the values that a sheet of a raceway has by default."""
ROLLED = ('7', '10')
"""Accuracy classes of rolled screws, unless the process is given."""


def process_of(given: CatalogueScrew) -> str:
    """Return the process, by the accuracy class where it is not given."""
    return given.process or ('rolled' if given.accuracy in ROLLED else 'ground')


def typical_roughness(given: CatalogueScrew) -> Iterator[str]:
    """Yield in a sentence that the Ra is a typical one, where none is given."""
    process = process_of(given)
    if given.ra is None:
        low, high = PROCESSES[process].ra_range
        yield (
            f'roughness: Ra {MICRO * PROCESSES[process].ra:g} um is typical of {process} raceways '
            f'({MICRO * low:g} to {MICRO * high:g}) and not measured; the onset of contact '
            'follows it, and its band holds this range: --ra-um narrows it'
        )


def raceway_of(given: CatalogueScrew) -> dict[str, Noted]:
    """Return the roughness of a raceway, its long cut-off always stated."""
    process = PROCESSES[process_of(given)]
    ra = stated(given.ra, typical(process.ra, process.ra_words))
    likely = {
        name: derived(end / RA_OVER_RQ, f'1.25 Ra, {words} likely')
        for name, end, words in zip(Roughness.LIKELY, process.ra_range, ('lowest', 'highest'))
        if given.ra is None
    }
    return {
        'rms': derived(ra.value / RA_OVER_RQ, f'1.25 Ra, {ra.note}'),
        **likely,
        'cutoff_long': stated(
            given.cutoff_long, typical(0.25e-3, '0.08 to 0.8: as Ra was measured')
        ),
        'fractal_dimension': typical(2.5, '2.3 to 2.7'),
        'lay': typical(process.lay, process.lay_words),
        'fan_angle': typical(TURN / 36, '0 to 20'),
        'asperity_friction': typical(0.1, '0.08 to 0.12: mineral oil on steel'),
        **{
            spec.name: typical(spec.default, USUAL[spec.name])
            for spec in fields(Roughness)
            if spec.name in USUAL
        },
    }
