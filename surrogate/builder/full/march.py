# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Strips of the very raceway of a surface, marched while their speed falls, beside the law.

The law of contact stands on marches of other raceways. A strip is a tile of this one, cut as its
sheet says, in the middle of a contact with the screw under preload. Its short waves are left out
so that it takes minutes; the law tells the onset of the same tile.

"""

from collections.abc import Mapping
from dataclasses import asdict
import math
from typing import Any

from surrogate.asperities.running_in import TILES
from surrogate.asperities.strips import raceway_strips, TRANSITS, WAVES
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw, screw_and_oil
from surrogate.screw.contacts import oil_at


def march_tasks(
    screw: Screw, lubricant: Lubricant, *, waves: float = WAVES, transits: float = TRANSITS
) -> dict[str, dict[str, Any]]:
    """Return the tasks of the strips of a raceway, which `march_task` solves."""
    if not screw.roughness.rms and screw.ball_roughness is None:
        raise InputError('--march: raceway and ball are smooth, allowed is a rough one')
    sheets = {'screw': asdict(screw), 'lubricant': lubricant.stated()}
    work = {'waves': waves, 'transits': transits}
    return {f'strip {1 + draw}': {**sheets, **work, 'draw': draw} for draw in range(TILES)}


def march_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    March a strip on the side of the screw, at the temperature of the oil sheet.

    Returns onsets, marched and told by the law for this tile and these nodes [m/s], and the film
    at the marched one over that of the law [-], None where RCS did not pass 0.01; shortest wave
    [m]; how it ended.

    """
    screw, lubricant = screw_and_oil(inputs)
    oil = oil_at(lubricant, lubricant.reference_temperature)
    strip, *_ = raceway_strips(
        screw, 'screw', oil, lubricant.film_floor, draws=[inputs['draw']], waves=inputs['waves']
    )
    factor = screw.roughness.onset_factor
    told = factor * strip.told
    marched, ramp = strip.march(told, transits=inputs['transits'])
    known = not math.isnan(marched)
    return {
        'marched_m_s': marched if known else None,
        'film_factor': strip.film_factor(marched / factor) if known else None,
        'told_m_s': told,
        'shortest_wave_m': strip.shortest,
        'status': ramp.status.value,
    }
