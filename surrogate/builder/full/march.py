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

from surrogate.asperities.running_in import running_tiles, TILES
from surrogate.asperities.topography import acting_roughness
from surrogate.asperities.topography_onset import LAG_FACTOR, NODE_FACTOR, TopographyOnset
from surrogate.ehl.kernels.fft import good_length
from surrogate.ehl.moving import MarchSettings, ramp_strip, strip_at
from surrogate.files import InputError
from surrogate.formulas.load_sharing import normal_force, working_preload
from surrogate.parameters import Lubricant, Screw, screw_and_oil
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts

SHORTEST = 0.25
"""Shortest wave that is marched over the half length of the contact [-]."""
ALONG, ACROSS = 5.0, 4.0
"""Nodes in the shortest wave along and across the track [-]."""
TRANSITS, TURN = 12.0, 2.0
"""Transits of the contact of a march, and those that a mean is taken over [-]."""
DOMAIN = 5.2
"""Length of the grid over the half length of the contact [-]."""
SPEEDS = 2.2, 0.3
"""Entrainment speeds at which a march begins and ends over the onset that is told [-]."""
TIME_CAP = 3600.0
"""Longest time of a march [s]."""
BIASED = NODE_FACTOR * LAG_FACTOR
"""Onset of the law over that of a march on such nodes under a falling speed [-]."""


def march_tasks(
    screw: Screw, lubricant: Lubricant, *, shortest: float = SHORTEST, transits: float = TRANSITS
) -> dict[str, dict[str, Any]]:
    """Return the tasks of the strips of a raceway, which `march_task` solves."""
    if not screw.roughness.rms and screw.ball_roughness is None:
        raise InputError('--march: raceway and ball are smooth, allowed is a rough one')
    sheets = {'screw': asdict(screw), 'lubricant': lubricant.stated()}
    work = {'shortest': shortest, 'transits': transits}
    return {f'strip {1 + draw}': {**sheets, **work, 'draw': draw} for draw in range(TILES)}


def march_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    March a strip at the temperature of the oil sheet.

    Returns onsets, marched and told by the law for this tile and these nodes [m/s], None where RCS
    did not pass 0.01; shortest wave [m]; how it ended.

    """
    screw, lubricant = screw_and_oil(inputs)
    opened, oil = Contacts.of(screw), oil_at(lubricant, lubricant.reference_temperature)
    contact, running = opened.geometry['screw'], opened.running['screw']
    load = float(normal_force(screw, working_preload(screw)))
    half = running.half_length
    shortest = max(running.shortest_wave, inputs['shortest'] * half)
    tile = running_tiles(running, shortest=shortest)[inputs['draw']]
    columns = good_length(math.ceil(ACROSS * tile.width / shortest))
    strip = strip_at(contact, load, 0.0, tile.width, columns)
    acting = acting_roughness([tile], 0.5 * contact.reduced_modulus, shortest)
    topography = TopographyOnset(acting=acting, factor=screw.roughness.onset_factor / BIASED)
    onset = float(topography.speeds(strip.line, oil, lubricant.film_floor))
    ramp = ramp_strip(
        strip,
        oil,
        (SPEEDS[0] * onset, SPEEDS[1] * onset),
        tile.height_at,
        transits=inputs['transits'],
        settings=MarchSettings(
            nx=2 * math.ceil(0.5 * ALONG * DOMAIN * half / shortest) + 1,
            places=1,
            film_floor=lubricant.film_floor,
            time_cap=TIME_CAP,
        ),
    )
    marched = ramp.onset(transits=TURN) if ramp.speeds.size else math.nan
    return {
        'marched_m_s': None if math.isnan(marched) else marched,
        'told_m_s': onset,
        'shortest_wave_m': shortest,
        'status': ramp.status.value,
    }
