# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The onset of contact: by formula, moved smoothly to where solves have it."""

import numpy as np
import pytest
from surrogate.builder.full.loads import LoadPieces, signed_loads
from surrogate.builder.full.onset import find_loads, find_onset, Profiles, smooth_shifts
from surrogate.builder.full.settings import default_full_settings


@pytest.fixture(name='profiles')
def make_profiles(screw, oil, stand_in):
    """Return profiles of the stand-in."""
    settings = default_full_settings(screw)
    return Profiles(screw=screw, lubricant=oil, settings=settings, run=stand_in.run)


def test_onset_is_where_the_share_is_one_percent(profiles, screw, stand_in):
    """Within what two draws scatter and a straight line leaves, at every load and temperature."""
    heats = np.array([283.15, 313.15, 353.15])
    pieces, known = find_loads(profiles, 313.15)
    loads, _ = signed_loads(screw, profiles.settings, pieces)
    onset = find_onset(profiles, pieces, known, loads, heats, heats)
    assert onset.shape == (len(loads), 3)
    assert np.array_equal(onset, onset[::-1])
    for j, k in ((len(loads) // 2, 0), (len(loads) - 1, 1), (0, 2)):
        chains = {
            str(draw): profiles._chain(abs(loads[j]), heats[k], draw)
            | {'speeds': [float(np.exp(onset[j, k]))]}
            for draw in (0, 1)
        }
        solved = stand_in.run('', chains).values()
        share = np.mean([chain.opposing[0].rcs for chain in solved])
        assert 0.007 < share < 0.014


def test_shifts_are_smooth_over_the_load():
    """A line below the idle load, a level above; what is not known is filled, nothing is zero."""
    pieces = LoadPieces(np.array([0.0, 1.0, 2.0, 4.0]), np.array([5.0, 8.0]))
    shifts = {0.0: 0.1, 1.0: 0.2, 2.0: np.nan, 4.0: 0.5, 5.0: 0.0, 8.0: 0.2}
    smooth = smooth_shifts(pieces, pieces, shifts)
    expected = {0.0: 0.1, 1.0: 0.2, 2.0: 0.3, 4.0: 0.5, 5.0: 0.1, 8.0: 0.1}
    assert smooth == pytest.approx(expected)
    unknown = dict.fromkeys(shifts, np.nan)
    assert set(smooth_shifts(pieces, pieces, unknown).values()) == {0.0}
