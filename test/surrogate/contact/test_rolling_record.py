# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records of rolling contacts: keys, what they stand for, null without a reason to know, page."""

from dataclasses import replace
import json

import numpy as np
import pytest
from surrogate.contact.rolling_record import KEYS, rolling_page, rolling_record
from surrogate.ehl.moving import MarchStatus, MovingSolution
from surrogate.files import json_text

AVERAGED = (
    *'rcs asperity_share mean_film_m film_rms_m least_film_m max_pressure_Pa hard_share'.split(),
    *'film_traction rolling_force_N smooth_rolling_force_N central_film_m film_ratio'.split(),
    *'memory_length_m'.split(),
)


def strict(record):
    """Return a record as it is read from its JSON."""
    return json.loads(json_text(record))


def test_the_record_is_strict_json_of_the_march(rolling_case, marched, says):
    """Lambda is the smooth central film over the whole Rq; shares are in order."""
    record = rolling_record(rolling_case, *marched)
    averages = {key for key in record if '_standard_error' not in key}
    assert averages == KEYS.keys()
    assert {'rcs_standard_error', 'mean_film_standard_error_m'} <= record.keys()
    assert strict(record)['strip_width_m'] is None
    assert record['kinematics'] == 'rolling'
    assert record['grid'] == [65, 33]
    assert record['converged'] is True
    solution, surface = marched
    record = rolling_record(rolling_case, solution, surface)
    assert record['film_ratio'] == pytest.approx(solution.central_film / 0.1e-6)
    expected = solution.memory * solution.x_nodes[-1] / solution.x[-1]
    assert record['memory_length_m'] == pytest.approx(expected, rel=1e-6)
    assert record['thin_film_m'] == [1e-9, 3e-9, 5e-9, 10e-9]
    assert np.all(np.diff(record['thin_share']) >= 0)
    assert record['rcs'] >= record['asperity_share'] > 0
    assert record['rcs_standard_error'] > 0
    rough = record['roughness']
    assert rough['sentence'].startswith(says('rq_0_1'))
    assert rough['sentence'].endswith('are left out')
    assert rough['cutoff_by_table'] is False
    assert rough['fractal_roughness_m'] > 0
    assert rough['shortest_wavelength_m'] >= 20e-6


def test_the_ball_counts_in_the_film_ratio_and_one_place_has_no_error(rolling_case, marched):
    rough = replace(rolling_case.roughness, ball_rms=0.05e-6)
    record = rolling_record(replace(rolling_case, roughness=rough), *marched)
    assert record['roughness']['rms_m'] == pytest.approx(np.hypot(0.1e-6, 0.05e-6))
    assert 'ball Rq 0.05 um' in record['roughness']['sentence']
    solution, surface = marched
    rcs = replace(solution.rcs, error=float('nan'))
    one = replace(solution, rcs=rcs)
    record = rolling_record(rolling_case, one, surface)
    assert strict(record)['rcs_standard_error'] is None
    (line,) = [
        line
        for line in rolling_page(record, rolling_case, one).splitlines()
        if line.startswith('  RCS')
    ]
    assert '+-' not in line


def test_what_was_not_averaged_is_null_and_the_page_says_all_a_person_asks(
    rolling_case, marched, says
):
    """A march without a smooth film has a status and no numbers; the page has workshop units."""
    solution, surface = marched
    inputs = {
        one: getattr(solution, one) for one in ('contact', 'lubricant', 'condition', 'settings')
    }
    bare = MovingSolution(**inputs, status=MarchStatus.NO_SMOOTH_FILM)
    record = strict(rolling_record(rolling_case, bare, surface))
    assert record['converged'] is False
    assert record['status'] == MarchStatus.NO_SMOOTH_FILM.value
    assert [record[key] for key in AVERAGED] == [None] * len(AVERAGED)
    assert record['thin_share'] == [None] * 4
    record = rolling_record(rolling_case, solution, surface)
    lines = rolling_page(record, rolling_case, solution).splitlines()
    assert lines[0].startswith(says('rolling_contact_10'))
    assert lines[-1] == f'  status: {solution.status.value}'
    names = [line[2:25].strip() for line in lines[1:-1]]
    assert names[-1] == 'march'
    assert {'smooth central film', 'RCS', 'asperity share', 'zone below 10 nm'} < set(names)
    assert 'nan' not in '\n'.join(lines)
