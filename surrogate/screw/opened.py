# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A screw opened for its solvers: what they need of the sheet, worked out once."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

from surrogate.asperities.law import AsperityLaw, law_of
from surrogate.asperities.running_in import RunningContact
from surrogate.formulas.geometry import Contact, screw_contact, Side, SIDES
from surrogate.formulas.kinematics import no_slip_rates, Rates
from surrogate.parameters import Screw


@dataclass(frozen=True, kw_only=True)
class Contacts:
    """
    Contacts of a screw by their side, with its sheet.

    Radii and modulus of a ball on the raceway, raceway and ball as they run, and the rates of a
    ball that rolls without gross slip, the same on both sides.

    """

    sheet: Screw
    geometry: Mapping[Side, Contact]
    running: Mapping[Side, RunningContact]
    rates: Rates

    @staticmethod
    @lru_cache(maxsize=64)
    def of(screw: Screw) -> 'Contacts':
        """Open a screw."""
        return Contacts(
            sheet=screw,
            geometry={side: screw_contact(screw, side) for side in SIDES},
            running={side: RunningContact.of(screw, side) for side in SIDES},
            rates=no_slip_rates(screw),
        )

    @cached_property
    def law(self) -> AsperityLaw:
        """Law of asperity contact; raises InputError as `running_tiles` does."""
        return law_of(self.running, self.sheet.roughness)

    def with_law(self, law: AsperityLaw) -> 'Contacts':
        """Return the same contacts under another law."""
        other = replace(self)
        vars(other)['law'] = law
        return other

    def on_side(self, side: Side) -> 'Contacts':
        """Return the same contacts with the raceway, and so the law, of one side alone."""
        return replace(self, running={side: self.running[side]})

    @property
    def working_load(self) -> float:
        """Largest working load [N], that which unloads a nut if not stated."""
        return next(iter(self.running.values())).working_load

    @property
    def working_pressure(self) -> float:
        """Hertz pressure under the largest working load, on the side that is pressed more [Pa]."""
        return max(contact.working_pressure for contact in self.running.values())
