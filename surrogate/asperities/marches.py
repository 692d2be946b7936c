# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Marches of strips from which the asperity law of a screw and its oil is made.

Each is a task of plain JSON: one strip, one draw of the roughness, a speed that falls or rises
through the onset.

"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
import math
from typing import Any

import numpy as np
from surrogate.asperities.acting import speed_at_ratio, stated_waves, Waves
from surrogate.asperities.law import ONSET_RCS
from surrogate.ehl import ContactLubricant
from surrogate.ehl.kernels.fft import good_length
from surrogate.ehl.moving import MarchSettings, ramp_strip, SpeedRamp, StripContact
from surrogate.files import InputError
from surrogate.formulas.geometry import screw_contact, Side
from surrogate.formulas.line import Line, line_at
from surrogate.formulas.load_sharing import normal_force, working_preload
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import Lubricant, Screw
from surrogate.raceway.ball import draw_stated
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.periodic import periodic_across
from surrogate.raceway.short_waves import without_short_waves
from surrogate.raceway.stated import BallRoughness, Roughness

WORK = 'asperity law 1'
"""Solver and version of what a march returns; part of the key under which it is kept."""
USUAL_RATIO, RATIO_POWER = 1.0, 0.36
"""Film over the acting rms near which marches with waves of a quarter of the half length look for
the onset, and how it rises as the shortest wave falls [-]."""
LENGTH = 5.2
"""Length of the domain over the half width of the Hertz zone that nodes are counted for [-]."""
TRIES = 3
"""How often a march whose speeds miss the onset is moved [-]."""
MISSED = 3.0
"""Factor on the speeds of such a march [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LawSettings:
    """
    How finely the marches of a law are made.

    Shortest wave over the half length of the contact under preload [-]; nodes along and across
    the track per shortest wave; transits; fastest and slowest speed over the expected onset [-];
    width of the strip over that half length [-].

    """

    shortest: float = 0.22
    along: float = 6.0
    across: float = 5.0
    transits: float = 32.0
    faster: float = 2.6
    slower: float = 0.26
    width: float = 2.0


MARCHED_IN_RATINGS = 0.02
"""Stands for the preload of a screw without one, over the static rating [-]: firmly pressed."""
COARSE = LawSettings()
"""Marches that show how contact grows, at many pressures and temperatures."""
FINE = LawSettings(shortest=0.06, along=5.0, across=4.0, transits=6.0, faster=1.8, slower=0.5)
"""Marches with all waves, or as short ones as some 400 nodes along have room for."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StripRun:
    """
    One march of a law: side, pressure over that under preload [-], oil temperature [K], draw.

    Every second speed rises, so that what lags behind it cancels.

    """

    name: str
    side: Side
    pressure: float
    temperature: float
    draw: int

    @property
    def rising(self) -> bool:
        """Whether the speed rises."""
        return self.draw % 2 == 1


def strip_runs(screw: Screw, lubricant: Lubricant) -> tuple[StripRun, ...]:
    """Return the marches of a law: pressures, sides and temperatures that the screw may have."""
    middle = lubricant.reference_temperature
    low, high = lubricant.minimum_temperature, lubricant.maximum_temperature
    cold, hot = middle + 0.4 * (low - middle), middle + 0.5 * (high - middle)
    places: tuple[tuple[str, Side, float, float], ...] = (
        ('screw', 'screw', 1.0, middle),
        ('screw again', 'screw', 1.0, middle),
        ('light', 'screw', 0.6, middle),
        ('light again', 'nut', 0.6, middle),
        ('heavy', 'screw', 1.35, middle),
        ('nut', 'nut', 1.0, middle),
        ('cold', 'screw', 1.0, cold),
        ('hot', 'screw', 1.0, hot),
    )
    return tuple(
        StripRun(name=name, side=side, pressure=pressure, temperature=heat, draw=draw)
        for draw, (name, side, pressure, heat) in enumerate(places)
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class StripInputs:
    """
    All that a march knows, SI: strip, oil, roughness of raceway and ball, draw, floor, grid.

    `shortest` is the shortest wave on the grid [m]; entrainment speeds, first and last [m/s].

    """

    strip: StripContact
    oil: ContactLubricant
    roughness: Roughness
    ball_roughness: BallRoughness | None
    draw: int
    shortest: float
    film_floor: float
    speeds: tuple[float, float]
    transits: float
    nx: int

    @property
    def waves(self) -> Waves:
        """Return the waves that are on the grid."""
        return stated_waves(self.roughness, self.ball_roughness).longer_than(self.shortest)

    @property
    def line(self) -> Line:
        """Return the strip as a line contact."""
        return Line(
            radius=self.strip.radius,
            reduced_modulus=self.strip.reduced_modulus,
            max_pressure=np.asarray(self.strip.max_pressure),
        )


def strip_inputs(
    screw: Screw, lubricant: Lubricant, run: StripRun, settings: LawSettings
) -> StripInputs:
    """
    Return the inputs of a march of a screw and its oil.

    Raises InputError for a raceway so fine that no contact is expected.

    """
    contact = screw_contact(screw, run.side)
    force = float(normal_force(screw, working_preload(screw, MARCHED_IN_RATINGS)))
    middle = line_at(contact, force, 0.0)
    waves = stated_waves(screw.roughness, screw.ball_roughness)
    # The same waves on either side, so that all marches of a law are alike.
    on_screw = line_at(screw_contact(screw, 'screw'), force, 0.0)
    shortest = shortest_marched(waves, settings.shortest * float(on_screw.semi_axis))
    pressure = run.pressure * float(middle.max_pressure)
    width = settings.width * float(middle.semi_axis)
    strip = StripContact(
        radius=middle.radius,
        reduced_modulus=contact.reduced_modulus,
        max_pressure=pressure,
        width=width,
        columns=good_length(math.ceil(settings.across * width / shortest)),
    )
    state = lubricant_state(lubricant, run.temperature)
    oil = ContactLubricant(
        viscosity=float(state.viscosity), pressure_viscosity=float(state.pressure_viscosity)
    )
    line = replace(middle, max_pressure=np.asarray(pressure))
    usual = USUAL_RATIO * (0.25 * float(middle.semi_axis) / shortest) ** RATIO_POWER
    onset = float(speed_at_ratio(waves.longer_than(shortest), line, oil, np.array(usual)))
    if not onset:
        raise InputError(
            f'roughness: Rq {1e6 * screw.composite_rms:g} um is flattened before it touches, '
            'allowed is so much that contact begins above the film floor'
        )
    ends = (settings.faster * onset, settings.slower * onset)
    return StripInputs(
        strip=strip,
        oil=oil,
        roughness=screw.roughness,
        ball_roughness=screw.ball_roughness,
        draw=run.draw,
        shortest=shortest,
        film_floor=lubricant.film_floor,
        speeds=(ends[1], ends[0]) if run.rising else ends,
        transits=settings.transits,
        nx=2 * math.ceil(0.5 * settings.along * LENGTH * strip.semi_axis / shortest) + 1,
    )


def shortest_marched(waves: Waves, wanted: float) -> float:
    """Return the length of the shortest wave not shorter than `wanted` [m], else the longest."""
    fits = waves.length[waves.length >= wanted * (1 - 1e-9)]
    return float(fits.min()) if fits.size else float(waves.length.max())


def solve_march(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    March a strip in plain JSON; speeds that miss the onset are moved, `TRIES` times at most.

    Returns means over a transit each of speed [m/s], RCS, share and loss factor [-], the speed of
    the onset [m/s] and the status.

    """
    given = inputs_from_json(inputs)
    raceway = _raceway(given)
    speeds = given.speeds
    for _ in range(TRIES):
        ramp = _march(given, raceway, speeds)
        onset = ramp.onset() if ramp.speeds.size else math.nan
        if not math.isnan(onset) or not ramp.speeds.size:
            break
        factor = 1 / MISSED if ramp.rcs.mean() < ONSET_RCS else MISSED
        speeds = (factor * speeds[0], factor * speeds[1])
    return _result(ramp, onset)


def _march(given: StripInputs, raceway: FractalSurface, speeds: tuple[float, float]) -> SpeedRamp:
    settings = MarchSettings(nx=given.nx, places=1, film_floor=given.film_floor)
    return ramp_strip(
        given.strip, given.oil, speeds, raceway.heights, transits=given.transits, settings=settings
    )


def _result(ramp: SpeedRamp, onset: float) -> dict[str, Any]:
    empty = not ramp.speeds.size
    names = ('rcs', 'asperity_share', 'loss_factor')
    return {
        'status': ramp.status.name,
        'steps': ramp.steps,
        'failed': ramp.steps_failed,
        'onset': onset,
        'speed': [] if empty else ramp.means(1.0)[0].tolist(),
        **{name: [] if empty else ramp.means(1.0, name)[1].tolist() for name in names},
    }


def _raceway(given: StripInputs) -> FractalSurface:
    """Return the draw of raceway and ball on the grid, repeating with the width of the strip."""
    whole = draw_stated(given.roughness, given.ball_roughness, given.draw)
    assert whole is not None
    kept = without_short_waves(whole, given.shortest)
    return periodic_across(kept, given.strip.width).surface


def inputs_to_json(given: StripInputs) -> dict[str, Any]:
    """Return the inputs of a march as plain JSON types, which `solve_march` reads."""
    return asdict(given) | {'speeds': list(given.speeds)}


def inputs_from_json(content: Mapping[str, Any]) -> StripInputs:
    """Return the inputs that `inputs_to_json` wrote."""
    ball = content['ball_roughness']
    return StripInputs(
        **{
            **content,
            'strip': StripContact(**content['strip']),
            'oil': ContactLubricant(**content['oil']),
            'roughness': Roughness(**content['roughness']),
            'ball_roughness': BallRoughness(**ball) if ball else None,
            'speeds': tuple(content['speeds']),
        }
    )
