# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Strips of a raceway: where contact begins on them, found by a march beside the law.

A strip in the middle of a contact rolls over a tile of the raceway, with waves down to a coarse
one, while its speed falls. The tile comes round once in two transits.

"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
import math

from surrogate.asperities.law import ONSET_RCS
from surrogate.asperities.running_in import running_tiles, RunningContact
from surrogate.asperities.topography import acting_roughness
from surrogate.asperities.topography_onset import COARSE_FILM, TopographyOnset
from surrogate.ehl import ContactLubricant
from surrogate.ehl.kernels.fft import good_length
from surrogate.ehl.moving import (
    MarchSettings,
    MarchStatus,
    ramp_strip,
    SpeedRamp,
    strip_at,
    StripContact,
)
from surrogate.formulas.geometry import screw_contact, Side
from surrogate.formulas.load_sharing import normal_force, working_preload
from surrogate.parameters import Screw
from surrogate.raceway.tile import Tile

WAVES = 6.5
"""Half length of the contact over the shortest wave of a coarse strip, at most [-]; the processor
time of a march goes with its cube."""
ALONG, ACROSS = 5.0, 4.0
"""Nodes in the shortest wave along and across the track [-]."""
DOMAIN = 5.2
"""Length of the grid over the half length of the contact [-]."""
TRANSITS, TURN = 12.0, 2.0
"""Transits of a march, and those of a turn of the tile, over which a mean is taken [-]."""
SPAN = 2.2, 0.2
"""First and last speed of a march over that at which contact is expected [-]."""
MOVED, MOVES = 4.0, 3
"""Factor by which a span that does not hold the onset is moved, and how often at most [-]."""
MARCHED = MarchStatus.CONVERGED, MarchStatus.SOME_STEPS
"""How a march ends that made all its transits."""


@dataclass(frozen=True, kw_only=True)
class RacewayStrip:
    """A strip, its oil, the tile that rolls through it, its shortest wave and film floor [m]."""

    strip: StripContact
    oil: ContactLubricant
    tile: Tile
    shortest: float
    film_floor: float

    @property
    def settings(self) -> MarchSettings:
        """Return the settings of a march."""
        rows = math.ceil(0.5 * ALONG * DOMAIN * self.strip.semi_axis / self.shortest)
        return MarchSettings(nx=2 * rows + 1, places=1, film_floor=self.film_floor)

    @cached_property
    def law(self) -> TopographyOnset:
        """Law of this very tile, biased as marches are."""
        acting = acting_roughness([self.tile], 0.5 * self.strip.reduced_modulus, self.shortest)
        return TopographyOnset(acting=acting, film_factor=1 / COARSE_FILM)

    @property
    def told(self) -> float:
        """Onset speed by the law [m/s]."""
        return float(self.law.speeds(self.strip.line, self.oil, self.film_floor))

    def film_factor(self, onset: float) -> float:
        """Return the film at a marched onset [m/s] over that of the law [-]."""
        film = self.law.film_over_law(self.strip.line, onset, self.oil, self.film_floor)
        return float(film)

    def march(
        self, expected: float, *, transits: float = TRANSITS, enough: float = math.inf
    ) -> tuple[float, SpeedRamp]:
        """
        Return the onset speed [m/s], NaN where none was found, and the march that has it.

        The speed falls about the `expected` one [m/s], until RCS is `enough` [-]. A span without
        the onset is moved: up where the strip touches at its first speed, or too thin a film
        stalls the march before.

        """
        for _ in range(1 + MOVES):
            speeds = SPAN[0] * expected, SPAN[1] * expected
            ramp = ramp_strip(
                self.strip,
                self.oil,
                speeds,
                self.tile.height_at,
                transits=transits,
                settings=self.settings,
                enough=enough,
                turn=TURN,
            )
            onset = ramp.onset(transits=TURN) if ramp.speeds.size else math.nan
            touches = not ramp.speeds.size or ramp.means(TURN)[1][0] >= ONSET_RCS
            if not math.isnan(onset) or not (touches or ramp.status in MARCHED):
                break
            expected *= MOVED if touches else 1 / MOVED
        return onset, ramp


def raceway_strips(
    screw: Screw,
    side: Side,
    oil: ContactLubricant,
    film_floor: float,
    *,
    draws: Sequence[int],
    waves: float = WAVES,
) -> list[RacewayStrip]:
    """
    Return strips in the middle of a contact under preload, one a draw of its raceway.

    The half length is at most `waves` times the shortest wave; film floor [m]. Raises InputError
    as `running_tiles` does.

    """
    contact, running = screw_contact(screw, side), RunningContact.of(screw, side)
    shortest = running.wave_above(running.half_length / waves)
    tiles = running_tiles(running, shortest=shortest, draws=draws)
    load = float(normal_force(screw, working_preload(screw)))
    return [
        RacewayStrip(
            strip=strip_at(
                contact,
                load,
                0.0,
                tile.width,
                good_length(math.ceil(ACROSS * tile.width / shortest)),
            ),
            oil=oil,
            tile=tile,
            shortest=shortest,
            film_floor=film_floor,
        )
        for tile in tiles
    ]
