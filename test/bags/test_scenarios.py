# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Every scenario is judged as its closed form says."""

from functools import cache
import math
from pathlib import Path
import re

from ballscrew_monitor.core.conversions import kelvin, SECOND
from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.report.balance import Balance
from ballscrew_monitor.report.judging import judge_log, RCS
from ballscrew_monitor.report.parameters import LogParameters, parameters_for
from ballscrew_monitor.report.printed import log_lines
from ballscrew_monitor.settings.axis import load_surface
from ballscrew_monitor.settings.parameters import read_file
import pytest
from recording import BEGIN
from scenario import generate, PARAMETERS, PERIOD
from scenarios import main, SCENARIOS
from surrogate.units import RPM

ROOT = Path(__file__).resolve().parents[2]
TINY = 1e-9
ADVICE = r'at this load run at [\d.]+ rev/min'


@cache
def scenario(name):
    """Return a scenario, which is solved for once and not while the tests are collected."""
    return SCENARIOS[name]()


@pytest.fixture(scope='module')
def judged(judge, tmp_path_factory):
    """Return what gives the judgement of a scenario; each is made and replayed once."""
    known, root = {}, tmp_path_factory.mktemp('scenarios')

    def of(name):
        if name not in known:
            generate(scenario(name), root / name)
            known[name] = judge(root / name, root / name / PARAMETERS)
        return known[name]

    of.folder = root
    return of


def within(name, rows, time):
    """Return the rows whose stamps lie in a span [s] of a scenario."""
    low, high = (scenario(name).stamp(at) for at in time)
    return [row for row in rows if low <= row['stamp'] <= high]


def seconds(stamp):
    return (stamp - BEGIN) / SECOND


@pytest.mark.parametrize('name', SCENARIOS)
def test_the_levels_follow_each_other_as_expected(judged, name):
    levels = [row['level'] for row in judged(name).rows]
    changes = [levels[0]] + [now for before, now in zip(levels, levels[1:]) if now != before]
    assert tuple(changes) == scenario(name).expected.levels


@pytest.mark.parametrize('name', SCENARIOS)
def test_the_number_of_events_is_the_expected_one(judged, name):
    assert len(judged(name).summary.events) == len(scenario(name).expected.events)


@pytest.mark.parametrize('name', SCENARIOS)
def test_each_event_has_its_cause_start_and_end(judged, name):
    judgement = judged(name)
    for event, expected in zip(judgement.summary.events, scenario(name).expected.events):
        assert judgement.causes[event.event_id] == expected.cause
        low, high = expected.start
        assert low - TINY <= seconds(event.start) <= high + TINY, expected
        assert event.active is (expected.end is None), expected
        if expected.end is not None:
            low, high = expected.end
            assert low - TINY <= seconds(event.end) <= high + TINY, expected


@pytest.mark.parametrize('name', SCENARIOS)
def test_steady_stretches_are_judged_as_expected(judged, name):
    for expected in scenario(name).expected.stretches:
        rows = within(name, judged(name).rows, expected.time)
        assert len(rows) > 5, expected
        for row in rows:
            for quantity in ('zone', 'level', 'validity', 'direction'):
                assert getattr(expected, quantity) in (None, row[quantity]), (quantity, row)
            assert (expected.reason or '') in row['reason']
            if expected.torque is not None:
                assert expected.torque[0] <= row['torque'] <= expected.torque[1]


@pytest.mark.parametrize('name', SCENARIOS)
def test_the_residual_changes_by_what_the_generator_put_in(judged, name):
    for expected in scenario(name).expected.residuals:
        then, now = (
            [row['residual'] for row in within(name, judged(name).rows, time)]
            for time in (expected.since, expected.time)
        )
        assert min(len(then), len(now)) > 100, expected
        change = math.fsum(now) / len(now) - math.fsum(then) / len(then)
        assert change == pytest.approx(expected.change, rel=1e-6, abs=TINY), expected


@pytest.mark.parametrize('name', SCENARIOS)
def test_samples_are_judged_refused_and_late_as_expected(judged, name):
    judgement, expected = judged(name), scenario(name).expected
    _, dropped, received, lag = judgement.inputs['speed']
    sent = sum(record.topic == '/joint_states' for record in scenario(name).records())
    assert dropped == (received if expected.all_refused else 0)
    if expected.all_judged:
        assert judgement.summary.judged == received == sent
    if expected.lag is not None:
        assert lag == pytest.approx(expected.lag, abs=PERIOD)


def test_the_limits_that_expectations_stand_on_are_those_of_the_surface():
    surface = load_surface('x', read_file(ROOT / 'config' / 'nominal_cycle.yaml'))

    def look(point, part=1.0):
        speed, oil = part * point.speed * RPM, kelvin(point.oil)
        return getattr(surface.lookup(speed, point.load, oil), point.quantity)

    points = [point for name in SCENARIOS for point in scenario(name).expected.limit_points]
    for point in points:
        if point.quantity == 'rcs':
            assert look(point, 1.1) < point.value <= look(point, 0.9), point
        else:
            assert look(point) == pytest.approx(point.value, abs=0.01), point


def test_every_expectation_is_of_some_scenario():
    """No field of the expectations is empty everywhere, which would hold nothing."""
    fields = ('events', 'stretches', 'residuals', 'limit_points')
    counts = {
        field: sum(len(getattr(scenario(name).expected, field)) for name in SCENARIOS)
        for field in fields
    }
    assert min(counts.values()) > 0, counts


def test_the_same_source_gives_the_same_bytes(tmp_path):
    for folder in ('one', 'two'):
        assert main(['flapping', '--out', str(tmp_path / folder)]) == 0
    for file in (tmp_path / 'one' / 'flapping').iterdir():
        assert file.read_bytes() == (tmp_path / 'two' / 'flapping' / file.name).read_bytes()


def test_without_a_name_all_are_named(capsys):
    assert main([]) == 0
    assert capsys.readouterr().out.splitlines()[0].startswith('warm_up ')


@pytest.fixture(scope='module')
def log_of(judged):
    """Return what gives the judged log of a scenario, each of them made once."""

    @cache
    def of(name):
        judged(name)
        bag = Bag(judged.folder / name)
        parameters = parameters_for(bag, bag.path / PARAMETERS, ROOT / 'config' / 'none.yaml')
        return judge_log(bag, parameters)

    return of


@pytest.mark.parametrize('name', SCENARIOS)
def test_no_input_of_a_scenario_is_accused_of_contradicting_the_others(log_of, name):
    assert {case.axis: case.balance for case in log_of(name).axes} == {'x': Balance()}


@pytest.mark.parametrize('name', SCENARIOS)
def test_neither_a_load_nor_a_speed_is_advised_unless_the_process_leaves_it_free(
    judged, log_of, name
):
    """Neither in a message nor in a report."""
    assert not any(advice for _, _, advice in advised(judged(name).events, log_of(name)))


@pytest.mark.parametrize('name', ['warm_up', 'flapping'])
def test_a_speed_is_advised_where_the_process_leaves_it_free(judged, name):
    """Contact ends at some speed in each scenario with a warning of it."""
    judged(name)
    bag = Bag(judged.folder / name)
    values = read_file(bag.path / PARAMETERS) | {'x.advice.speed': True}
    events = [event for _, event in replay(bag, values) if event is not None]
    said = advised(events, judge_log(bag, LogParameters(values=values, origin='mine')))
    assert said
    for in_contact, _, advice in said:
        assert re.fullmatch(ADVICE, advice) if advice else not in_contact


def advised(events, log):
    """Return of all warnings: is it of contact, the speed to run at [rad/s], the advice."""
    (case,) = log.axes
    said = [
        (one.cause.code == Code.RCS_HIGH, one.cause.target_speed, one.advice) for one in events
    ]
    said += [(one.quantity == RCS, one.target_speed, one.advice) for one in case.outcome.events]
    assert all(bool(advice) is math.isfinite(speed) for _, speed, advice in said)
    assert all(math.isnan(one.cause.target_load) for one in events)
    assert 'load with' not in '\n'.join(log_lines(log))
    return said
