# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Strips of a raceway that correct the law, and how a build tells them."""

from dataclasses import replace
import json
import math

import numpy as np
import pytest
from scipy.stats import studentized_range
from surrogate.asperities.law import FILM_BANDS
from surrogate.builder import tiers
from surrogate.builder.full import march
from surrogate.builder.full import tier as full_tier
from surrogate.builder.full.march import (
    doubtful_strips,
    FAILED,
    FINER,
    march_task,
    march_tasks,
    marched_film,
    WITHIN,
)
from surrogate.builder.full.settings import default_full_settings
from surrogate.files import InputError
from surrogate.raceway.stated import NINE_OF_TEN
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, with_raceway
from surrogate.surface import shipped_surface
from surrogate.surface.file import read
from surrogate.surface_tools.describe import march_lines

SHIPPED = read(shipped_surface(tier='full'))


def strip(onset=0.1, factor=0.91, failed=0.0):
    """Return what a strip gave; without an onset it did not touch."""
    return {
        'marched_m_s': onset,
        'film_factor': factor,
        'failed_share': failed if onset else None,
        'told_m_s': 0.12,
        'side': 'screw',
        'shortest_wave_m': 1e-5,
        'steps': 7,
        'status': 'well',
    }


NEVER = strip(None, None)
NEW = 'isotropic', 'new'


def test_a_strip_of_long_waves_begins_to_touch_near_what_the_law_tells(screw, oil, monkeypatch):
    """Within the 1.6 by which the law misses raceways without waves below 10 um."""
    tasks = march_tasks(screw, oil, waves=3.0, transits=6.0)
    assert [*tasks] == [FINER, 'strip 1', 'strip 2', 'strip 3']
    found = march_task(json.loads(json.dumps(tasks['strip 1'])))
    assert json.loads(json.dumps(found)) == found
    assert found['status'].startswith('Converged')
    assert 1 / 1.6 < found['marched_m_s'] / found['told_m_s'] < 1.6
    assert 1 / 1.3 < found['film_factor'] < 1.3
    assert found['failed_share'] == 0.0
    # The finer strip is the first one with a wave more.
    assert tasks[FINER] == tasks['strip 1'] | {'waves': 3.0 * screw.roughness.scale_ratio}
    # What is slower than the onset is not marched, and would hardly move it.
    monkeypatch.setattr(march, 'ENOUGH', math.inf)
    whole = march_task(tasks['strip 1'])
    assert found['steps'] < 0.8 * whole['steps']
    assert found['marched_m_s'] == pytest.approx(whole['marched_m_s'], rel=0.1)


def test_strips_lie_on_the_side_where_contact_begins_faster(screw, oil):
    """A groove that hugs the ball presses it less, and flattens less of the roughness."""
    for side, changes in (
        ('nut', {'conformity_nut': 0.51, 'conformity_screw': 0.56}),
        ('screw', {'conformity_nut': 0.56, 'conformity_screw': 0.51}),
    ):
        tasks = march_tasks(replace(screw, **changes), oil)
        assert {task['side'] for task in tasks.values()} == {side}


def test_a_smooth_raceway_is_not_marched(screw, oil):
    assert march_tasks(with_raceway(screw, rms=0.0), oil) == {}


def test_a_raceway_whose_sheet_says_where_contact_begins_is_not_marched(screw, oil, refused):
    refused('own_factor', march_tasks, with_raceway(screw, onset_factor=2.23), oil)


def test_strips_correct_the_law_as_normal_random_effects(monkeypatch):
    """
    By hand, with a law of deviation 0.5 and 0.3 within a raceway: 0.4 between raceways.

    Three strips of 0.2: the mean has the variance 0.03, the weight 0.16/0.19 and the posterior
    variance 0.16 * 0.03/0.19; a finer strip that is off by 0.1 makes 0.04 of 0.03.

    """
    monkeypatch.setitem(march.FILM_BANDS, 'transverse', math.exp(0.5 * NINE_OF_TEN))
    monkeypatch.setitem(march.WITHIN, ('transverse', 'new'), 0.3)
    alike = {f'strip {1 + place}': strip(factor=math.exp(0.2)) for place in range(3)}
    known = marched_film(alike, 'transverse', 'new')
    assert math.log(known['marched_film']) == pytest.approx(0.2 * 16 / 19)
    assert known['marched_error'] ** 2 == pytest.approx(0.16 * 0.03 / 0.19 + 0.09)
    # By their mean alone: a scatter that these few strips have by chance is not believed.
    apart = {f'strip {n}': strip(factor=math.exp(0.3 * n - 0.4)) for n in (1, 2, 3)}
    assert marched_film(apart, 'transverse', 'new') == pytest.approx(known)
    known = marched_film(alike | {FINER: strip(factor=math.exp(0.1))}, 'transverse', 'new')
    assert math.log(known['marched_film']) == pytest.approx(0.2 * 0.16 / 0.2)
    assert known['marched_error'] ** 2 == pytest.approx(0.16 * 0.04 / 0.2 + 0.09)


@pytest.mark.parametrize(('lay', 'state'), WITHIN)
def test_the_law_is_narrowed_by_strips_and_never_widened(lay, state):
    """Many strips leave their mean and the scatter in a raceway, a bad one leaves the law."""
    by_law = math.log(FILM_BANDS[lay]) / NINE_OF_TEN
    many = {f'strip {place}': strip(factor=0.9 + 0.2 * (place % 2)) for place in range(2000)}
    known = marched_film(many, lay, state)
    assert known['marched_film'] == pytest.approx(math.sqrt(0.9 * 1.1), abs=1e-3)
    assert known['marched_error'] == pytest.approx(WITHIN[lay, state], rel=1e-2)
    three = {name: many[f'strip {name[-1]}'] for name in ('strip 1', 'strip 2', 'strip 3')}
    assert WITHIN[lay, state] < marched_film(three, lay, state)['marched_error'] < by_law
    nothing = marched_film(three | {FINER: strip(factor=5.0)}, lay, state)
    assert nothing['marched_film'] == pytest.approx(1.0, abs=0.01)
    assert nothing['marched_error'] == pytest.approx(by_law, rel=0.01)


def test_a_drawn_raceway_has_its_next_strip_inside_nine_times_of_ten():
    """Raceways and strips drawn from the two deviations, three strips and one more of each."""
    generator, kind = np.random.default_rng(46), ('isotropic', 'new')
    between = math.sqrt((math.log(FILM_BANDS[kind[0]]) / NINE_OF_TEN) ** 2 - WITHIN[kind] ** 2)
    inside = []
    for mean in between * generator.standard_normal(1000):
        films = np.exp(mean + WITHIN[kind] * generator.standard_normal(4)).tolist()
        known = marched_film({f'strip {n}': strip(factor=films[n]) for n in (1, 2, 3)}, *kind)
        off = math.log(films[0] / known['marched_film'])
        inside.append(abs(off) <= NINE_OF_TEN * known['marched_error'])
    assert 0.88 < np.mean(inside) < 0.92


def test_strips_that_lie_too_far_apart_are_told(built, capsys):
    """By the range of three normal numbers that one of a hundred exceeds; finer ones apart."""
    assert march.FAR_APART == pytest.approx(studentized_range.ppf(0.99, 3, math.inf), abs=0.005)
    usual = math.exp(march.FAR_APART * WITHIN['isotropic', 'new'])
    near = {name: strip(factor=usual**part) for name, part in (('strip 1', 0), ('strip 2', 0.99))}
    isotropic = {'lay': 'isotropic', 'state': 'new'}
    assert [*doubtful_strips(near | {FINER: strip(factor=2.0)}, isotropic)] == []
    assert [*doubtful_strips({'strip 1': NEVER}, isotropic)] == []
    built({0: strip(factor=0.7), 1: strip(factor=1.4)})
    assert 'raceway differ by a factor of 2.00' in capsys.readouterr().err


def test_a_strip_whose_steps_failed_about_the_onset_corrects_nothing(built, capsys):
    """It has a status and a sentence; the others correct the law as if it were not there."""
    good = {'strip 1': strip(factor=0.95), 'strip 2': strip(factor=1.05, failed=FAILED)}
    alone = marched_film(good, 'isotropic', 'new')
    bad = good | {'strip 3': strip(factor=1.2, failed=0.3)}
    assert marched_film(bad, 'isotropic', 'new') == alone
    data, sheet = built({0: strip(failed=0.3), 1: strip(failed=0.5), 2: strip()})
    assert sheet.roughness.marched_film is None
    err = capsys.readouterr().err
    assert 'strip 2: 50 % of the steps about the onset did not converge' in err
    assert 'too few strips show where contact begins' in err
    told = {line.partition(',')[0]: line for line in march_lines(data.header['march'])}
    assert told['strip 2'].endswith('; well Of the steps about the onset 50 % failed.')
    assert told['strip 3'].endswith('; well')


@pytest.mark.parametrize(
    ('wrong', 'words'),
    [
        ({'failed_share': None}, 'it is not stated how many of the steps about the onset failed'),
        ({'film_factor': 6.1}, 'to touch with 6.1 times the film of the law, allowed is 0.2 to 5'),
        ({'film_factor': 0.1}, 'to touch with 0.1 times the film of the law, allowed is 0.2 to 5'),
    ],
)
def test_a_strip_that_corrects_nothing_is_told(wrong, words):
    """An unknown share of failed steps is not none."""
    good = {'strip 1': strip(factor=0.95), 'strip 2': strip(factor=1.05)}
    bad = {**good, 'strip 3': strip() | wrong}
    assert marched_film(bad, *NEW) == marched_film(good, *NEW)
    (told,) = doubtful_strips(bad, {'lay': 'isotropic', 'state': 'new'})
    assert told.startswith('strip 3: ')
    assert words in told
    assert told.endswith('it does not correct the law')


def test_a_header_without_the_share_of_failed_steps_says_that_it_is_unknown():
    old = {name: value for name, value in strip().items() if name != 'failed_share'}
    (line,) = march_lines({'strip 1': old})
    assert line.endswith('; well Of the steps about the onset an unknown share failed.')


def test_a_finer_strip_that_moves_the_onset_is_told():
    """The shipped 40 x 10: 0.95 becomes 1.11 with finer waves, which the range holds."""
    raceway = {'lay': 'longitudinal', 'state': 'run_in'}
    for finer, words in ((1.11, 'holds both'), (1.9, 'does not hold both'), (1.05, None)):
        strips = {FINER: strip(factor=finer), 'strip 1': strip(factor=0.95)}
        strips |= {'strip 2': strip(factor=1.06), 'strip 3': strip(factor=0.99)}
        known = raceway | marched_film(strips, 'longitudinal', 'run_in')
        told = [*doubtful_strips(strips, known)]
        if words is None:
            assert told == []
            continue
        assert f'with {finer:.2f} times the film of the law, the first one with 0.95' in told[-1]
        assert f'a factor of {finer / 0.95:.2f}, where such strips scatter by 1.12' in told[-1]
        assert told[-1].endswith(words)
        reach = NINE_OF_TEN * known['marched_error']
        off = max(abs(math.log(one / known['marched_film'])) for one in (0.95, finer))
        assert (off <= reach) is (words == 'holds both')


def test_one_strip_alone_corrects_nothing():
    assert marched_film({'strip 1': strip(), 'strip 2': NEVER, FINER: strip()}, *NEW) == {}
    assert marched_film({}, *NEW) == {}
    assert marched_film({'strip 1': NEVER, 'strip 2': strip(), 'strip 3': strip()}, *NEW)


def test_a_marched_raceway_needs_its_film_and_has_its_band(screw, oil):
    """Film goes with the power 0.67 of the speed over a law that falls: 1.1 is 1.1^(1/0.6)."""
    place = oil, 0.0, oil.reference_temperature
    by_law = onset_point(Contacts.of(screw), *place)
    sheet = with_raceway(screw, marched_film=1.1, marched_error=0.05)
    marched = onset_point(Contacts.of(sheet), *place)
    faster = math.log(marched['speed_rad_s'] / by_law['speed_rad_s']) / math.log(1.1)
    assert 1 / 0.75 < faster < 1 / 0.5
    assert Contacts.of(sheet).law.deviation == 0.05
    usual = math.log(FILM_BANDS['isotropic']) / NINE_OF_TEN
    assert Contacts.of(screw).law.deviation == pytest.approx(usual)
    # It holds in the state that was marched.
    other = with_raceway(sheet, state='run_in')
    assert other == with_raceway(screw, state='run_in')
    assert with_raceway(sheet, state='new') == sheet


@pytest.fixture
def built(screw, oil, tmp_path, monkeypatch, here):
    """Return a build whose strips are given by draw, and the screws that were built."""
    seen = []

    def build_full(sheet, lubricant, settings, run):
        seen.append(sheet)
        return replace(SHIPPED, header={**SHIPPED.header, 'inputs': inputs_of(sheet)})

    def inputs_of(sheet):
        return {'screw': sheet.stated(), 'lubricant': oil.stated()}

    def build(strips):
        def marched(inputs):
            if inputs['draw'] not in strips:
                raise InputError('no luck')
            return strips[inputs['draw']]

        monkeypatch.setattr(march, 'march_task', marched)  # where workers find it
        settings = default_full_settings(screw)
        known = {'pool': here(), 'out': tmp_path / 'a.npz'}
        return tiers.build_surface('full', screw, oil, settings, march=True, **known), seen[-1]

    monkeypatch.setattr(full_tier, 'build_full', build_full)
    return build


def test_a_build_corrects_the_law_by_its_strips_and_tells_them(built, capsys):
    """A strip that failed is said on stderr and left out."""
    data, sheet = built({0: strip(), 1: strip(factor=1.0)})
    assert list(data.header['march']) == [FINER, 'strip 1', 'strip 2']
    assert 'strip, strip 3: ' in capsys.readouterr().err
    known = marched_film({**data.header['march']}, *NEW)
    assert sheet.roughness.marched_film == known['marched_film']
    # A build that goes on marches what was kept no more, and what failed again.
    assert built({2: NEVER})[0].header['march'] == data.header['march'] | {'strip 3': NEVER}
    finer, begins, _ = march_lines(data.header['march'])
    assert finer.startswith('finer strip, waves down to 10 um: contact begins')
    assert 'strip 1, waves down to 10 um: contact begins at 0.1 m/s' in begins
    assert 'with 0.91 times the film of the law, told over marched 1.20' in begins


def test_strips_that_do_not_touch_leave_the_law_alone(built, capsys, screw):
    """With its wider band, a status for each strip, and a sentence."""
    data, sheet = built({0: NEVER, 1: strip()})
    assert sheet == screw
    err = capsys.readouterr().err
    assert 'too few strips show where contact begins: the law alone tells it' in err
    assert 'contact does not begin, told 0.12 m/s; well' in [*march_lines(data.header['march'])][0]
    assert 'march' not in SHIPPED.header
