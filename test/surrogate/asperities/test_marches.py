# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Marches of a law: what they are given, one on a coarse grid, speeds that miss the onset."""

from dataclasses import replace
import json
import math

import numpy as np
import pytest
from surrogate.asperities import marches
from surrogate.asperities.acting import stated_waves
from surrogate.asperities.marches import (
    inputs_from_json,
    inputs_to_json,
    LawSettings,
    MISSED,
    shortest_marched,
    solve_march,
    strip_inputs,
    strip_runs,
    TRIES,
)
from surrogate.ehl.moving import MarchStatus, SpeedRamp
from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.formulas.load_sharing import normal_force
from surrogate.parameters import BallRoughness, load_lubricant, load_screw

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
FEW = LawSettings(shortest=0.35, along=5.0, across=4.0, transits=8.0)
RUNS = strip_runs(SCREW, OIL)
GIVEN = strip_inputs(SCREW, OIL, RUNS[0], FEW)


def test_runs_cover_pressures_sides_temperatures_and_senses():
    """No two share a draw; half of them rise; temperatures are those of the oil."""
    assert {run.side for run in RUNS} == {'screw', 'nut'}
    assert len({run.draw for run in RUNS}) == len({run.name for run in RUNS}) == len(RUNS)
    assert sum(run.rising for run in RUNS) == len(RUNS) / 2
    assert min(run.pressure for run in RUNS) < 1 < max(run.pressure for run in RUNS)
    heats = sorted({run.temperature for run in RUNS})
    assert len(heats) == 3
    assert OIL.minimum_temperature < heats[0] < OIL.reference_temperature == heats[1]
    assert heats[1] < heats[2] < OIL.maximum_temperature


def test_inputs_are_those_of_the_screw_under_preload():
    """Pressure of the preload times that of the run, a grid on the shortest wave, both senses."""
    force = float(normal_force(SCREW, SCREW.preload))
    preloaded = float(hertz(screw_contact(SCREW, 'screw'), force).max_pressure)
    for run in RUNS:
        given = strip_inputs(SCREW, OIL, run, FEW)
        first, last = given.speeds
        assert (last > first) == run.rising
        assert max(first, last) / min(first, last) == pytest.approx(FEW.faster / FEW.slower)
        cell = 5.2 * given.strip.semi_axis / (given.nx - 1)
        assert given.shortest / cell == pytest.approx(FEW.along, rel=0.05)
        assert given.strip.columns * given.shortest >= FEW.across * given.strip.width
        if run.side == 'screw':
            assert given.strip.max_pressure == pytest.approx(run.pressure * preloaded)
        assert given.shortest == GIVEN.shortest
        assert given.waves.length.min() == pytest.approx(given.shortest)
        assert float(given.line.semi_axis) == pytest.approx(given.strip.semi_axis)


def test_a_screw_without_preload_has_marches():
    """A share of its rating stands in."""
    free = strip_inputs(replace(SCREW, preload=0.0), OIL, RUNS[0], FEW)
    assert 0.1 < free.strip.max_pressure / GIVEN.strip.max_pressure < 10


def test_the_shortest_marched_wave_is_one_of_the_roughness():
    """The next one that fits; the longest where none does."""
    waves = stated_waves(SCREW.roughness, None)
    found = shortest_marched(waves, 7e-6)
    assert found in waves.length
    assert found >= 7e-6 > waves.length[waves.length < found].max()
    assert shortest_marched(waves, float(waves.length.min())) == waves.length.min()
    assert shortest_marched(waves, 1.0) == waves.length.max()


def test_inputs_survive_json():
    """With and without a ball."""
    rolling = replace(SCREW, ball_roughness=BallRoughness(grade='G10'))
    for screw in (SCREW, rolling):
        given = strip_inputs(screw, OIL, RUNS[1], FEW)
        assert inputs_from_json(json.loads(json.dumps(inputs_to_json(given)))) == given


def test_a_coarse_march_finds_an_onset():
    """RCS falls with the speed, the share is no more, rolling loses more than when smooth."""
    found = solve_march(json.loads(json.dumps(inputs_to_json(GIVEN))))
    assert found['status'] == MarchStatus.CONVERGED.name
    assert found['failed'] == 0
    speed, rcs = np.array(found['speed']), np.array(found['rcs'])
    assert speed.min() < found['onset'] < speed.max()
    fast = speed > found['onset']
    assert rcs[fast].mean() < 0.01 < rcs[~fast].mean()
    assert rcs[-1] > rcs[0]
    assert (np.array(found['asperity_share']) <= rcs + 1e-12).all()
    assert np.mean(found['loss_factor']) > 1


@pytest.mark.parametrize(
    ('over', 'tried'), [(1.0, 1), (0.15, 2), (5.0, 2), (1e-4, TRIES), (1e4, TRIES)]
)
def test_speeds_that_miss_the_onset_are_moved(monkeypatch, over, tried):
    """Towards it, `TRIES` times at most; then the onset is unknown."""
    onset, seen = over * math.sqrt(GIVEN.speeds[0] * GIVEN.speeds[1]), []

    def ramp(strip, oil, speeds, heights, **known):
        seen.append(speeds)
        u = np.geomspace(*speeds, 160)
        rcs = 0.01 * np.minimum((onset / u) ** 6, 100.0)
        ones = np.ones_like(u)
        return SpeedRamp(
            status=MarchStatus.CONVERGED,
            speeds=u,
            rcs=rcs,
            asperity_share=rcs,
            loss_factor=ones,
            transit=10.0,
        )

    monkeypatch.setattr(marches, 'ramp_strip', ramp)
    found = solve_march(inputs_to_json(GIVEN))
    assert len(seen) == tried
    if tried < TRIES:
        assert found['onset'] == pytest.approx(onset, rel=0.05)
    else:
        assert math.isnan(found['onset'])
    step = MISSED if over > 1 else 1 / MISSED
    assert seen[-1][0] == pytest.approx(GIVEN.speeds[0] * step ** (tried - 1))


def test_a_march_that_ends_at_once_has_no_onset(monkeypatch):
    """Nor columns, and is not tried again."""
    seen = []

    def ramp(*given, **known):
        seen.append(given)
        return SpeedRamp(status=MarchStatus.STALLED, steps=3, steps_failed=3)

    monkeypatch.setattr(marches, 'ramp_strip', ramp)
    found = solve_march(inputs_to_json(GIVEN))
    assert len(seen) == 1
    assert math.isnan(found['onset'])
    assert found['speed'] == found['rcs'] == []


@pytest.mark.parametrize('rms', [0.0, 1e-11])
def test_roughness_that_never_touches_is_one_sentence(rms, refused):
    """Smooth, or flattened by any film."""
    fine = replace(SCREW, roughness=replace(SCREW.roughness, rms=rms))
    refused('roughness_rq_um', strip_inputs, fine, OIL, RUNS[0], FEW)
