# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The law of made-up marches whose curve and ratio are known."""

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.special import expit, logit
from surrogate.asperities.acting import speed_at_ratio
from surrogate.asperities.build import build_law, fit_law, Marched, NODES, TWINS
from surrogate.asperities.law import ONSET_RCS
from surrogate.asperities.marches import COARSE, FINE, inputs_from_json, strip_inputs, strip_runs
from surrogate.parameters import load_lubricant, load_screw

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
RUNS = strip_runs(SCREW, OIL)
CURVES = {
    'rcs': lambda x: expit(logit(ONSET_RCS) - 3.0 * x),
    'asperity_share': lambda x: expit(logit(0.8 * ONSET_RCS) - 3.0 * x),
    'loss_factor': lambda x: 1.3 - 0.1 * x,
}


def answer(given, ratio, shift=0.0, ends=(-1.5, 1.0)):
    """Return what a march returns whose onset has a film over the acting rms [-]."""
    onset = float(speed_at_ratio(given.waves, given.line, given.oil, np.array(ratio)))
    x = np.linspace(*ends, 40)
    onset *= math.exp(shift)
    columns = {name: curve(x).tolist() for name, curve in CURVES.items()}
    speed = (onset * np.exp(x)).tolist()
    return {'status': 'CONVERGED', 'onset': onset, 'speed': speed, **columns}


def marched(settings, ratio, runs=RUNS, **known):
    """Return made-up marches by the name of their run."""
    given = {run.name: strip_inputs(SCREW, OIL, run, settings) for run in runs}
    at = ratio if callable(ratio) else lambda pressure: ratio
    return {
        name: Marched(given=one, found=answer(one, at(one.strip.max_pressure), **known))
        for name, one in given.items()
    }


def test_curve_and_ratio_are_found_again():
    """Whatever the pressure; no scatter."""
    law = fit_law(marched(COARSE, 1.2), {}, 'made up')
    assert law.onset_ratio == pytest.approx(1.2, rel=1e-3)
    assert law.log_speed == pytest.approx(NODES)
    for name, curve in CURVES.items():
        assert getattr(law, name) == pytest.approx(curve(NODES), rel=0.02)
    assert float(law.at(np.array(0.0))['rcs']) == pytest.approx(ONSET_RCS, rel=1e-3)
    assert law.deviation == pytest.approx(0.0, abs=2e-3)
    assert law.pressure_power == pytest.approx(0.0, abs=2e-3)
    assert law.marches == len(RUNS)
    assert law.film_floor == OIL.film_floor
    assert law.source == 'made up'


def test_all_waves_move_the_onset_by_their_twins():
    """By the ratio of both on the same places, and the shortest wave is theirs."""
    coarse, fine = marched(COARSE, 1.2), marched(FINE, 1.8, RUNS[:TWINS])
    law = fit_law(coarse, fine, 'made up')
    assert law.onset_ratio == pytest.approx(1.8, rel=1e-3)
    assert law.marches == len(RUNS) + TWINS
    assert law.shortest_wave == fine['screw'].given.shortest < coarse['screw'].given.shortest
    alone = fit_law({'light': coarse['light']}, fine, 'made up')
    assert alone.onset_ratio == pytest.approx(1.2, rel=1e-3)
    assert alone.pressure_power == 0.0


def test_a_power_of_the_pressure_is_found_again():
    """With the ratio at the pressure of the first march."""
    first = strip_inputs(SCREW, OIL, RUNS[0], COARSE).strip.max_pressure
    law = fit_law(marched(COARSE, lambda pressure: 1.2 * (pressure / first) ** -0.5), {}, 'any')
    assert law.pressure == first
    assert law.pressure_power == pytest.approx(-0.5, abs=2e-3)
    assert law.onset_ratio == pytest.approx(1.2, rel=2e-3)
    assert law.deviation == pytest.approx(0.0, abs=2e-3)


def test_scatter_of_the_onsets_is_that_of_their_logarithms():
    """Two marches a tenth faster and slower than the mean."""
    slow, fast = (marched(COARSE, 1.2, RUNS[:1], shift=by) for by in (-0.1, 0.1))
    law = fit_law({'slow': slow['screw'], 'fast': fast['screw']}, {}, 'made up')
    assert law.deviation == pytest.approx(math.sqrt(0.02), rel=0.02)
    assert law.onset_ratio == pytest.approx(1.2, rel=0.01)


def test_curves_go_on_where_no_march_was():
    """As the fit through the speeds that were marched does."""
    short = fit_law(marched(COARSE, 1.2, ends=(-0.6, 0.4)), {}, 'made up')
    for name, curve in CURVES.items():
        assert getattr(short, name) == pytest.approx(curve(NODES), rel=0.02)


def test_curves_that_rise_here_and_there_are_made_to_fall():
    """RCS and share, whatever the scatter."""
    coarse = marched(COARSE, 1.2)
    scatter = np.random.default_rng(3).uniform(0.3, 3.0, 40)
    for one in coarse.values():
        for name in ('rcs', 'asperity_share', 'loss_factor'):
            one.found[name] = (scatter * np.array(one.found[name])).tolist()
    law = fit_law(coarse, {}, 'made up')
    for values in (law.rcs, law.asperity_share):
        assert (np.diff(values) <= 0).all()
        assert 0 < values[-1] < values[0] < 1


def solver(ratio, failed=()):
    """Return a `solve` of made-up marches; those that failed by what their name holds."""

    def solve(tasks):
        return {
            name: next((found for word, found in failed if word in name), None)
            if any(word in name for word, _ in failed)
            else answer(inputs_from_json(one), ratio)
            for name, one in tasks.items()
        }

    return solve


def test_a_law_is_built_from_all_runs_and_the_twins():
    """Coarse marches at all runs, the first ones again with all waves."""
    seen = []

    def solve(tasks):
        seen.extend(tasks)
        return solver(1.4)(tasks)

    law = build_law(SCREW, OIL, solve)
    assert len(seen) == len(RUNS) + TWINS
    assert law.onset_ratio == pytest.approx(1.4, rel=1e-3)
    assert law.marches == len(RUNS) + TWINS
    assert law.source == f'{SCREW.name}, {OIL.name}'


def test_marches_without_an_onset_are_left_out():
    """Those that failed or stalled, and those that never passed the onset."""
    unknown = {'status': 'CONVERGED', 'onset': math.nan, 'speed': [], 'rcs': []}
    stalled = {'status': 'STALLED', 'onset': 1.0, 'speed': [], 'rcs': []}
    failed = (('light', unknown), ('heavy', None), ('cold', stalled))
    law = build_law(SCREW, OIL, solver(1.4, failed))
    assert law.marches == len(RUNS) + TWINS - 4
    assert law.onset_ratio == pytest.approx(1.4, rel=1e-3)


def test_no_march_and_no_roughness_are_one_sentence(refused):
    """Nothing is made up."""
    refused('asperity_law_0', build_law, SCREW, OIL, lambda tasks: dict.fromkeys(tasks))
    smooth = replace(SCREW, roughness=replace(SCREW.roughness, rms=0.0))
    refused('flattened_before_touches', build_law, smooth, OIL, solver(1.4))
