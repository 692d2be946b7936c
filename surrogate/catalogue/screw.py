# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sheet of a ball screw out of a catalogue."""

from collections.abc import Iterator
from dataclasses import replace
import math
from typing import Any

from surrogate.asperities.running_in import working_load
from surrogate.catalogue.noted import derived, Noted, noted_sheet, stated, typical
from surrogate.catalogue.raceways import process_of, PROCESSES, raceway_of
from surrogate.catalogue.words import CatalogueScrew
from surrogate.formulas.geometry import helix_angle
from surrogate.formulas.plausibility import check_plausible, rated_pressure, rating_by_hertz
from surrogate.formulas.torque import drag_torque_catalogue
from surrogate.parameters import Screw
from surrogate.units import GIGA, MILLI

OVER_NOMINAL = 0.2
"""Ball circle less nominal diameter, over the ball diameter [-]."""
BALL_OVER_LEAD, BALL_OVER_DIAMETER = 0.635, 0.2
"""Usual ball diameter over lead, and the largest over the nominal diameter [-]."""
PRELOAD_SHARE = 0.05
"""Usual preload over C [-]."""
OVERSIZE_SHARE = 0.05
"""Largest preload over C of oversize balls, by makers [-]."""
MEASURED = typical(0.0, '0 until ballscrew identify gives it')
DRAG_SHARES = 0.13, 0.7, 1.76
"""Parasitic torque over the drag of catalogues, least, typical and largest [-]: the range of
JIS B 1192, 0.63 to 1.88 of it, less the 12 to 50 % of it that the contacts of such screws are."""
STEEL = {
    'young_modulus': typical(206e9, '200 to 212: bearing steel'),
    'poisson_ratio': typical(0.3, '0.28 to 0.30'),
    'density': typical(7850.0, '7800 to 7850'),
}


def screw_of(given: CatalogueScrew) -> tuple[Screw, dict[str, str]]:
    """
    Return the sheet of a screw, and what is given, derived or typical by the keys on file.

    Raises InputError for numbers that no screw has.

    """
    values = _values(given)
    if given.static_rating is None:
        # The load that presses a ball by a given pressure follows from any rating.
        draft, _ = noted_sheet(Screw, values | {'static_rating': Noted(1e6, '')})
        rating = derived(
            rating_by_hertz(draft), 'presses each ball by 4.2 GPa, ISO 76; makers 0.7 to 1.1 of it'
        )
    else:
        rating = Noted(given.static_rating, 'given')
    screw, notes = noted_sheet(Screw, values | {'static_rating': rating})
    check_plausible(screw)
    notes['static_rating_kN'] += (
        f'; {GIGA * rated_pressure(screw):.2f} GPa on a ball, usual 4.0 to 4.5'
    )
    words = '2.83 preloads, which unload the relieved nut'
    if screw.nut == 'oversize':
        words = '2.83 preloads, which unload one pair of flanks'
    if not screw.preload:
        words = '2.83 % of C0, without preload: state the largest axial load'
    load = derived(working_load(screw), words)
    changes, notes['working_load_N'] = {'working_load': load.value}, load.note
    texts = 'lowest likely', 'of the drag torque of JIS B 1192', 'highest likely'
    drags = zip(Screw.LIKELY, DRAG_SHARES, typical_drag(screw), texts, strict=True)
    for name, share, drag, text in drags if screw.preload else ():
        # Without preload no typical drag is known.
        changes[name] = float(f'{drag:.3g}')
        notes[f'{name}_Nm'] = f'typical ({share:g} {text})'
    return replace(screw, **changes), notes


def typical_drag(screw: Screw) -> tuple[float, float, float]:
    """Return the least, typical and largest drag of a preloaded nut beside its contacts [N m]."""
    catalogue = drag_torque_catalogue(screw.preload, screw.lead, helix_angle(screw))
    low, middle, high = (share * catalogue for share in DRAG_SHARES)
    return low, middle, high


def _values(given: CatalogueScrew) -> dict[str, Any]:
    """Return all values but the static rating and the working load."""
    nominal = given.nominal_diameter or given.pitch_diameter or math.nan
    usual = min(BALL_OVER_LEAD * given.lead, BALL_OVER_DIAMETER * nominal)
    ball = stated(given.ball_diameter, derived(usual, '0.635 leads, 0.2 diameters at most'))
    if given.pitch_diameter is None:
        circle = nominal + OVER_NOMINAL * ball.value
        diameter = derived(circle, 'half of nominal and 0.2 (0 to 0.3) ball diameters')
    else:
        diameter = Noted(given.pitch_diameter, 'given, as a diameter')
    nominal = MILLI * (given.nominal_diameter or diameter.value)
    side, process = typical(0.54, '0.515 to 0.555'), process_of(given)
    rating = given.dynamic_rating
    return {
        'name': given.name or f'screw_{nominal:g}x{MILLI * given.lead:g}',
        'source': given.source or 'Values of a catalogue, completed by ballscrew screw new.',
        'pitch_radius': Noted(0.5 * diameter.value, diameter.note),
        'nut': Noted(given.nut, 'given'),
        'lead': Noted(given.lead, 'given'),
        'ball_diameter': ball,
        'contact_angle': typical(math.pi / 4, '40 to 50'),
        'conformity_screw': side,
        'conformity_nut': side,
        'loaded_balls_per_nut': _balls(given, diameter.value, ball.value),
        'preload': _preload(given),
        'dynamic_rating': Noted(rating, 'given') if rating is not None else None,
        'speed_limit': typical(PROCESSES[process].dn, f'50 to 180: {process}'),
        'parasitic_torque': MEASURED,
        'parasitic_torque_rate': MEASURED,
        'hysteresis_loss': typical(0.0, '0 to 0.01'),
        'raceway': STEEL,
        'ball': STEEL,
        'roughness': raceway_of(given),
    }


def _balls(given: CatalogueScrew, diameter: float, ball: float) -> Noted:
    """
    Return the balls that fill the turns on a ball circle [m] with balls of a diameter [m].

    Those of one nut; of an offset nut its halves stand for both nuts.

    """
    halved, spaced = given.nut == 'offset', given.spacers == 'yes'
    if given.balls is not None:
        if halved:
            return Noted(given.balls // 2, f'derived (half of the {given.balls} balls of the nut)')
        return Noted(given.balls, 'given')
    circle = math.hypot(math.pi * diameter, given.lead)
    turns = (given.turns or math.nan) / (2 if halved else 1)
    nuts = ' in each of two nuts' if given.nut == 'double' else ''
    half = f', half of the {given.turns:g} of the nut' if halved else nuts
    spacers = ', every second ball a spacer' if spaced else ''
    balls = int(turns * circle / ball / (2 if spaced else 1))
    return Noted(balls, f'derived ({turns:g} turns{half}{spacers})')


def equal_halves(given: CatalogueScrew) -> Iterator[str]:
    """Yield in a sentence that an offset nut that need not have equal halves is given them."""
    whole = given.turns if given.balls is None else given.balls
    if given.nut == 'offset' and whole is not None and whole % 2:
        unit = 'turns' if given.balls is None else 'balls'
        yield (
            f'nut: {whole:g} {unit} of an offset nut are taken as two equal halves, and unequal '
            'halves are not modelled'
        )


def heavy_preload(screw: Screw) -> Iterator[str]:
    """Yield in a sentence that oversize balls are preloaded by more than makers allow."""
    rating = screw.dynamic_rating
    if screw.nut == 'oversize' and rating and screw.preload > OVERSIZE_SHARE * rating:
        yield (
            f'preload_N: {screw.preload:g} N is {100 * screw.preload / rating:.2g} % of C, and '
            f'makers preload oversize balls by at most {100 * OVERSIZE_SHARE:g} %'
        )


def _preload(given: CatalogueScrew) -> Noted:
    """Return the preload, as a force or as a share of C."""
    if given.nut == 'plain' and given.preload is None and given.preload_share is None:
        return derived(0.0, 'a plain nut has none')
    if given.preload is not None or given.dynamic_rating is None:
        return Noted(given.preload, 'given')
    share, rating = given.preload_share, given.dynamic_rating
    words = 'given' if share is not None else 'usual 2 to 10 %'
    share = PRELOAD_SHARE if share is None else share
    return derived(share * rating, f'{100 * share:g} % of C {rating / MILLI:g} kN, {words}')
