# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Names and units of the fields of a surface, for pages, tables, files and pictures."""

from dataclasses import dataclass

from surrogate.surface.fields import FIELDS


@dataclass(frozen=True, kw_only=True, slots=True)
class FieldText:
    """How a field is written out: key in records and tables, unit in SI (empty: none), words."""

    key: str
    unit: str
    words: str

    @property
    def label(self) -> str:
        """Return the words with the unit in brackets."""
        return f'{self.words} [{self.unit or "-"}]'


FIELD_TEXTS = {
    'friction_torque': FieldText(
        key='friction_torque_Nm', unit='N m', words='torque lost to friction'
    ),
    'rcs': FieldText(
        key='rcs', unit='', words='share of the load at punctured film, worst contact'
    ),
    'asperity_share': FieldText(
        key='asperity_share', unit='', words='share of the load on asperities, worst contact'
    ),
    'film_ratio': FieldText(
        key='film_ratio', unit='', words='film ratio Lambda of the thinnest contact'
    ),
    'central_film': FieldText(
        key='central_film_m', unit='m', words='central film of the thinnest contact'
    ),
    'minimum_film': FieldText(
        key='minimum_film_m', unit='m', words='minimum film of the thinnest contact'
    ),
    'friction_coefficient': FieldText(
        key='friction_coefficient', unit='', words='mean coefficient of sliding friction'
    ),
    'max_pressure': FieldText(key='max_pressure_Pa', unit='Pa', words='largest contact pressure'),
}
assert tuple(FIELD_TEXTS) == FIELDS

WORST_CONTACTS = (
    'loaded nut, screw',
    'loaded nut, nut',
    'relieved nut, screw',
    'relieved nut, nut',
)
"""The contacts by their numbers on file."""


def derived_key(name: str, kind: str) -> str:
    """Return the key of an `error`, `std` or `stderr` of a field, which has the field's unit."""
    key, unit = FIELD_TEXTS[name].key, FIELD_TEXTS[name].unit.replace(' ', '')
    return f'{name}_{kind}_{unit}' if unit else f'{key}_{kind}'
