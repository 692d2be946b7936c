# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Strips of the very raceway of a surface, marched while their speed falls, correct the law.

The law of contact stands on marches of other raceways. A strip is a tile of this one, cut as its
sheet says, in the middle of a contact with the screw under preload, on the side where contact
begins faster. Its short waves are left out so that it takes a minute; the law tells the onset of
the same tile. The film at the marched onsets over that of the law corrects the law, and one finer
strip shows how far that depends on the waves that are left out.

"""

from collections.abc import Iterator, Mapping
import math
from typing import Any

from surrogate.asperities.law import FILM_BANDS, ONSET_RCS
from surrogate.asperities.running_in import RunningContact, TILES
from surrogate.asperities.strips import raceway_strips, TRANSITS, TURN, WAVES
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw, screw_and_oil
from surrogate.raceway.fractal import Lay
from surrogate.raceway.stated import FILM_FACTORS, NINE_OF_TEN, State
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_side

ENOUGH = 2 * ONSET_RCS
"""RCS at which a march ends [-]: slower speeds do not tell the onset."""
Strips = Mapping[str, Mapping[str, Any]]
"""What `march_task` returns of each strip, by its name."""
FINER = 'finer strip'
"""Name of the strip with one wave more."""
WITHIN: Mapping[tuple[Lay, State], float] = {
    ('isotropic', 'new'): 0.071,
    ('isotropic', 'run_in'): 0.038,
    ('longitudinal', 'new'): 0.114,
    ('longitudinal', 'run_in'): 0.114,
    ('transverse', 'new'): 0.136,
    ('transverse', 'run_in'): 0.136,
}
"""Standard deviation of the logarithm of the film factor between strips of one raceway by its lay
and state [-], pooled by `studies/own_strips.py: within`: 28 and 32 isotropic strips, 36 along the
track, 16 across it. New isotropic ones scatter more than those that ran in (one-sided F, 0.2 %),
others do not show it. Isotropic ones are 0.068 and 0.037 times Student's t over the normal
quantile, 1.72/1.645 and 1.71/1.645, of 21 and 24 degrees of freedom."""
FAILED = 0.02
"""Share of the steps about the onset that may fail in a strip that corrects the law [-]: five of
some 260, the share that leaves a whole march in no doubt. With ten times the RCS of their
neighbours they move the film at the onset by 0.18/6.5, 3 %, less than strips scatter."""
FEWEST = 2
"""Strips with an onset that correct the law, at least [-]."""
FAR_APART = 4.12
"""Range of three normal numbers over their deviation that one of a hundred exceeds [-]: Pearson
and Hartley, Biometrika Tables for Statisticians, volume 1, 3rd edition 1966, table 22."""


def march_tasks(
    screw: Screw,
    lubricant: Lubricant,
    *,
    waves: float = WAVES,
    transits: float = TRANSITS,
    draws: int = TILES,
) -> dict[str, dict[str, Any]]:
    """
    Return the tasks of the strips of a raceway, which `march_task` solves, the longest first.

    None where raceway and ball are smooth. Raises InputError as `running_tiles` does, and for a
    sheet that says itself where contact begins.

    """
    if screw.roughness.has_own_factor:
        raise InputError(
            f'roughness: onset_factor is {screw.roughness.onset_factor:g} and says where contact '
            'begins, a raceway is marched without onset_factor, onset_band and calibrated alone'
        )
    if not screw.composite_rms:
        return {}
    oil = oil_at(lubricant, lubricant.reference_temperature)
    _, side = onset_side(Contacts.of(screw), oil, lubricant.film_floor, 0.0)
    sheets = {'screw': screw.stated(), 'lubricant': lubricant.stated()}
    work = {'side': side, 'transits': transits}
    running = RunningContact.of(screw, side)
    shortest = running.wave_above(running.half_length / waves)
    finer = running.wave_above(running.half_length / (waves * screw.roughness.scale_ratio))
    strips = {f'strip {1 + draw}': (draw, waves) for draw in range(draws)}
    if finer < shortest:
        strips = {FINER: (0, waves * screw.roughness.scale_ratio), **strips}
    return {
        name: {**sheets, **work, 'draw': draw, 'waves': most}
        for name, (draw, most) in strips.items()
    }


def march_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    March a strip at the temperature of the oil sheet until it clearly touches.

    Returns onsets, marched and told by the law for this tile and these nodes [m/s], the film at
    the marched one over that of the law and the share of the steps about it that failed [-], None
    where RCS did not pass 0.01; side; shortest wave [m]; steps; how it ended.

    """
    screw, lubricant = screw_and_oil(inputs)
    oil = oil_at(lubricant, lubricant.reference_temperature)
    strip, *_ = raceway_strips(
        screw,
        inputs['side'],
        oil,
        lubricant.film_floor,
        draws=[inputs['draw']],
        waves=inputs['waves'],
    )
    marched, ramp = strip.march(strip.told, transits=inputs['transits'], enough=ENOUGH)
    known = not math.isnan(marched)
    return {
        'marched_m_s': marched if known else None,
        'film_factor': strip.film_factor(marched) if known else None,
        'failed_share': ramp.failed_share(marched, TURN) if known else None,
        'told_m_s': strip.told,
        'side': inputs['side'],
        'shortest_wave_m': strip.shortest,
        'steps': ramp.steps,
        'status': ramp.status.value,
    }


def marched_film(strips: Strips, lay: Lay, state: State) -> dict[str, float]:
    """
    Return the correction of the law by strips of a raceway, as a sheet states it; empty if by few.

    Normal model of random effects (Gelman and others, Bayesian Data Analysis, 3rd edition 2013,
    section 2.5): over the law the logarithm of the film at the onset is mu + e, with mu ~ N(0,
    tau^2) between raceways, e ~ N(0, `WITHIN`^2) in one, and both variances together that of the
    law. The mean of the strips is also off by the change from the first to the finer strip.
    `marched_film` is exp of the posterior mean of mu [-], `marched_error` the deviation of the
    posterior prediction of one more strip [-]. So no strips would leave the law, many their mean.

    """
    logs = log_factors(strips)
    finer = logs.pop(FINER, math.nan)
    if len(logs) < FEWEST:
        return {}
    change = finer - logs.get('strip 1', math.nan)
    within = WITHIN[lay, state] ** 2
    between = (math.log(FILM_BANDS[lay]) / NINE_OF_TEN) ** 2 - within
    mean_error = within / len(logs) + (0.0 if math.isnan(change) else change**2)
    weight = between / (between + mean_error)
    return {
        'marched_film': math.exp(weight * sum(logs.values()) / len(logs)),
        'marched_error': math.sqrt(weight * mean_error + within),
    }


def log_factors(strips: Strips) -> dict[str, float]:
    """Return logarithms of the film factors of strips that can correct the law [-], by name."""
    least, most = FILM_FACTORS
    return {
        name: math.log(strip['film_factor'])
        for name, strip in strips.items()
        if strip['film_factor'] is not None
        and least <= strip['film_factor'] <= most
        and failed_share(strip) <= FAILED
    }


def failed_share(strip: Mapping[str, Any]) -> float:
    """Return the share of the steps about the onset that failed [-]; NaN if it is not stated."""
    share = strip.get('failed_share')
    return math.nan if share is None else float(share)


def doubtful_strips(strips: Strips, raceway: Mapping[str, Any]) -> Iterator[str]:
    """Yield sentences on strips of a raceway, as stated, that are left out or differ unusually."""
    least, most = FILM_FACTORS
    for name, strip in strips.items():
        film, share = strip['film_factor'], failed_share(strip)
        if film is None:
            continue
        reason = None
        if math.isnan(share):
            reason = 'it is not stated how many of the steps about the onset failed'
        elif share > FAILED:
            reason = (
                f'{100 * share:.0f} % of the steps about the onset did not converge, allowed are '
                f'{100 * FAILED:g} %'
            )
        elif not least <= film <= most:
            reason = (
                f'it begins to touch with {film:.3g} times the film of the law, allowed is '
                f'{least:g} to {most:g}'
            )
        if reason:
            yield f'{name}: {reason}: it does not correct the law'
    logs, within = log_factors(strips), WITHIN[raceway['lay'], raceway['state']]
    finer = logs.pop(FINER, math.nan)
    apart = max(logs.values(), default=0.0) - min(logs.values(), default=0.0)
    if apart > (usual := FAR_APART * within):
        yield (
            f'films of the strips of this raceway differ by a factor of {math.exp(apart):.2f}, '
            f'those of 99 in 100 such raceways by {math.exp(usual):.2f} at most: the stated range '
            'of the onset may be too narrow'
        )
    first, film = logs.get('strip 1', math.nan), raceway.get('marched_film')
    if film is not None and abs(finer - first) > within:
        reach = NINE_OF_TEN * raceway['marched_error']
        held = all(abs(log - math.log(film)) <= reach for log in (first, finer))
        yield (
            f'the finer strip begins to touch with {math.exp(finer):.2f} times the film of the '
            f'law, the first one with {math.exp(first):.2f}: a factor of '
            f'{math.exp(finer - first):.2f}, where such strips scatter by {math.exp(within):.2f}; '
            f'the stated range of the onset {"holds" if held else "does not hold"} both'
        )
