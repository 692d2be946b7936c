# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Names and units of the fields of a surface, for pages, tables, files and pictures."""

from typing import NamedTuple

from surrogate.surface.fields import FIELDS


class FieldText(NamedTuple):
    """How a field is written out: key in records and tables, unit in SI (empty: none), words."""

    key: str
    unit: str
    words: str

    @property
    def label(self) -> str:
        """Return the words with the unit in brackets."""
        return f'{self.words} [{self.unit or "-"}]'


FIELD_TEXTS = {
    'friction_torque': FieldText('friction_torque_Nm', 'N m', 'torque lost to friction'),
    'rcs': FieldText('rcs', '', 'share of the load at punctured film, worst contact'),
    'asperity_share': FieldText(
        'asperity_share', '', 'share of the load on asperities, worst contact'
    ),
    'film_ratio': FieldText('film_ratio', '', 'film ratio Lambda of the thinnest contact'),
    'central_film': FieldText('central_film_m', 'm', 'central film of the thinnest contact'),
    'minimum_film': FieldText('minimum_film_m', 'm', 'minimum film of the thinnest contact'),
    'friction_coefficient': FieldText(
        'friction_coefficient', '', 'mean coefficient of sliding friction'
    ),
    'max_pressure': FieldText('max_pressure_Pa', 'Pa', 'largest contact pressure'),
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
