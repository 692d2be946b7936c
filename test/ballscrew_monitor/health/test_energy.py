# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Energy lost, against a baseline of known ratio."""

import math

from ballscrew_monitor.health.energy import (
    DAY,
    energy_quantities,
    FEWEST_DAYS,
    ratio_of,
    student,
    within,
)
from ballscrew_monitor.health.records import Baseline, SpectrumBin
from hypothesis import given
from hypothesis import strategies as st
import pytest
from scipy import stats
from surrogate.units import KILOWATT_HOUR

TODAY = 20_000
FIRST = TODAY - 200
BASELINE = Baseline(begin=FIRST * DAY, end=(FIRST + 9) * DAY, reason='learned')


def lost(day, ratio, *, energy=KILOWATT_HOUR, **changes):
    """Return a bin of a day that lost a multiple of what the model expects [J]."""
    values = {'load_band': 0, 'axial_load': 0.0, 'angle': 1e6, 'speed': 50.0, 'time': 2e4}
    sums = {'energy_lost': energy, 'energy_expected': energy, 'energy_measured': energy * ratio}
    return SpectrumBin(first_day=day, **values | sums | changes)


def days(first, count, ratio, **changes):
    """Return days one after the other, with a small scatter that cancels."""
    return [lost(first + day, ratio * (1 + 0.02 * (-1) ** day), **changes) for day in range(count)]


def told(bins, baseline=BASELINE):
    """Return the quantities by name."""
    return {one.name: one for one in energy_quantities(bins, baseline, TODAY)}


@pytest.mark.parametrize('freedom', [2, 3, 5, 10, 100])
def test_the_factor_of_student(freedom):
    """Within 3 % for two degrees of freedom, and near at once."""
    expected = stats.t.ppf(0.975, freedom)
    assert student(freedom) == pytest.approx(expected, rel=0.035 if freedom < 3 else 0.012)


def test_energy_at_equal_motion():
    """A tenth more than the baseline is 1 kWh of 11, whatever the programme was."""
    bins = [*days(FIRST, 10, 1.0, energy=5 * KILOWATT_HOUR), *days(TODAY - 9, 10, 1.1)]
    found = told(bins)
    assert found['energy lost'].value == pytest.approx(11.0)
    assert found['energy against the baseline'].value == pytest.approx(1.1)
    assert found['energy beyond the baseline'].value == pytest.approx(1.0)
    assert found['energy against the baseline'].low > 1.05
    for one in found.values():
        assert one.low <= one.value <= one.high
        assert one.evidence


def test_time_without_a_torque_costs_as_much_as_that_with():
    """The model is scaled by what was measured beside it."""
    blind = {'energy_measured': math.nan, 'energy_expected': math.nan}
    bins = [*days(TODAY - 9, 10, 1.2), *days(TODAY - 9, 10, 1.0, **blind)]
    assert told(bins)['energy lost'].value == pytest.approx(24.0)


@given(st.lists(st.floats(0.5, 2.0), min_size=3, max_size=8), st.floats(1e3, 1e9))
def test_the_ratio_lies_among_those_of_its_days(ratios, energy):
    """A weighted mean, with the floor of the scatter."""
    bins = [lost(TODAY + at, ratio, energy=energy) for at, ratio in enumerate(ratios)]
    value, half_width, count = ratio_of(bins)
    assert min(ratios) * (1 - 1e-9) <= value <= max(ratios) * (1 + 1e-9)
    assert half_width >= 0.0195 * value / math.sqrt(len(ratios))
    assert count == len(ratios)


def test_bins_of_a_baseline():
    """By its days; a merged week counts where it meets them."""
    inside, outside = lost(FIRST, 1.0), lost(FIRST + 10, 1.0)
    week = lost(FIRST - 5, 1.0, days=7)
    assert within([inside, outside, week], BASELINE) == [inside, week]


@pytest.mark.parametrize(
    ('bins', 'baseline', 'key'),
    [
        ([], BASELINE, 'no_day'),
        (days(TODAY - 9, 10, 1.0), None, 'no_baseline'),
        (days(TODAY - 9, 10, 1.0), BASELINE, 'baseline_days'),
        ([*days(FIRST, 9, 1.0), *days(TODAY, FEWEST_DAYS - 1, 1.0)], BASELINE, 'few_days'),
        ([*days(FIRST, 9, 1.0), *days(TODAY - 9, 10, -0.5)], BASELINE, 'less_than_ideal'),
        (
            [*days(FIRST, 9, 1.0), *(lost(TODAY - at, 5.0 * (-1) ** at + 0.1) for at in range(4))],
            BASELINE,
            'scatter',
        ),
    ],
)
def test_what_is_not_known_says_why(bins, baseline, key, says):
    found = told(bins, baseline)['energy against the baseline']
    assert not found.is_known
    assert found.reason == says(key)
