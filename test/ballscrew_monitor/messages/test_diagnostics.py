# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Diagnostics, case by case."""

import dataclasses
import math
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.inputs import InputSample, InputState, Refusal, Source, Why
from ballscrew_monitor.core.judgement import Code, Level, PointValidity, WarningPolicy
from ballscrew_monitor.core.links import Link, Publisher
from ballscrew_monitor.core.state import LoadDerivation, shelve
from ballscrew_monitor.core.vitals import VitalSigns
from ballscrew_monitor.health.records import Condition, Health, Quantity
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.messages.diagnostics import ERROR, OK, STALE, WARN
from ballscrew_monitor.messages.state_messages import plain_values
import pytest

START = 1000 * SECOND
WALL = 1_800_000_000 * SECOND
NOTHING = None, (), Code.UNKNOWN  # state, inputs and cause of an axis that has said nothing
LINKS = {
    Source.SPEED: Link(topic='/s', type_name='a/msg/B', matched=1),
    Source.LOAD: Link(topic='/l', type_name='a/msg/B'),
}


def sample(source, value, stamp=START):
    return InputSample(source=source, value=value, stamp=stamp)


def after(
    core,
    *events,
    surface=None,
    clock_stands=False,
    settings=None,
    links=None,
    policy=WarningPolicy.ZONE,
    usual=(),
    health=None,
    advice='',
    **limits,
):
    delays = {'raise_delay': 0, 'clear_delay': 0}
    monitor = core.monitor(surface, core.limits(**(delays | limits)), **(settings or {}))
    last = (core.feed(monitor, events) or [types.SimpleNamespace(message=None, inputs=())])[-1]
    made = diagnostics.statuses(
        'node',
        'x',
        last.message,
        last.inputs,
        monitor.event_code,
        monitor.surface,
        links=links or LINKS,
        clock_stands=clock_stands,
        policy=policy,
        usual=usual,
        health=health,
        advice=advice,
    )
    return {status.name.rpartition(' ')[2]: status for status in made}


def said(status):
    return status.level, status.message


def values_of(status):
    return {pair.key: pair.value for pair in status.values}


LOAD, SPEED = sample(Source.LOAD, -1000.0), sample(Source.SPEED, 10.0)
HEAVY, STILL = sample(Source.LOAD, 1e5), sample(Source.SPEED, 0.1)
LATE = sample(Source.SPEED, 10.0, START + 10 * SECOND)
EVERY_SECOND = [
    sample(source, value, START + i * SECOND)
    for i in range(3)
    for source, value in ((Source.LOAD, -1000.0), (Source.SPEED, 10.0))
]
OUTSIDE = 'outside the optimal zone: asperities carry too much'


def test_names():
    """Each status begins as an error that says that nothing was set."""
    made = diagnostics.failed('ballscrew_monitor', 'x', 'no message was set')
    assert [(status.name, status.level, status.message) for status in made] == [
        (f'ballscrew_monitor: x: {part}', ERROR, 'no message was set')
        for part in ('Lubrication', 'Inputs', 'Surface')
    ]


def test_names_and_hardware_of_two_machines_and_two_axes_differ(core):
    made = [
        status
        for node in ('/mill/monitor', '/lathe/monitor')
        for axis in ('x', 'y')
        for status in diagnostics.statuses(node, axis, *NOTHING, core.surface(), links=None)
    ]
    assert len({status.name for status in made}) == 12
    assert made[0].name == 'mill/monitor: x: Lubrication'
    assert made[0].hardware_id == 'mill/x: constant'
    assert len({status.hardware_id for status in made}) == 4
    assert diagnostics.failed('/mill/monitor', 'x', 'why')[0].name == made[0].name


def test_all_is_well_once_the_delay_is_over(core):
    made = after(core, LOAD, SPEED)
    assert [status.level for status in made.values()] == [OK, OK, OK]
    assert made['Lubrication'].message == 'optimal'
    assert {status.hardware_id for status in made.values()} == {'x: constant'}
    status = after(core, LOAD, SPEED, clear_delay=SECOND)['Lubrication']
    assert said(status) == (WARN, 'not judged for long enough yet')


@pytest.mark.parametrize(('derived', 'key'), [(False, 'not_moved'), (True, 'not_derived')])
def test_the_torque_is_blamed_only_where_the_load_follows_from_it(core, derived, key, says):
    (last,) = core.feed(core.monitor(None, core.limits()), [LOAD, SPEED])
    last.message.result.validity = int(PointValidity.UNKNOWN)
    inputs = list(last.inputs)
    if derived:
        inputs[1] = dataclasses.replace(inputs[1], state=InputState.DERIVED)
    lubrication, _ = diagnostics.summaries(last.message, inputs, Code.UNKNOWN, LINKS)
    assert (lubrication.level, lubrication.message) == (WARN, says(key))


@pytest.mark.parametrize('late', [[], [LATE]])
def test_a_warning_names_its_cause_and_stands_while_inputs_are_lost(core, late):
    found = after(core, LOAD, SPEED, *late, surface=core.surface(rcs=0.5))
    assert said(found['Lubrication']) == (WARN, OUTSIDE)


@pytest.mark.parametrize('policy', WarningPolicy)
def test_the_zone_warns_where_the_policy_asks_for_it(core, policy, says):
    outside = core.surface(rcs=0.5)
    found = after(core, LOAD, SPEED, surface=outside, policy=policy)['Lubrication']
    quiet = (OK, says('no_warning'))
    assert said(found) == ((WARN, OUTSIDE) if policy.of_zone else quiet)
    stands = after(core, LOAD, SPEED, surface=outside, policy=policy, clock_stands=True)
    assert stands['Lubrication'].level == (WARN if policy.of_zone else STALE)
    lost = after(core, SPEED, policy=policy)['Lubrication']
    assert said(lost) == (STALE, says('judged_input_missing'))


@pytest.mark.parametrize(
    ('events', 'part', 'level', 'message'),
    [
        ([SPEED], 'Lubrication', STALE, 'judged_input_missing'),
        ([LOAD, STILL], 'Lubrication', OK, 'standstill_judged_long'),
        ([LOAD, SPEED, STILL], 'Lubrication', OK, 'standstill_2'),
        ([LOAD, SPEED, HEAVY, STILL], 'Lubrication', WARN, 'judged_load_outside'),
        ([LOAD, sample(Source.SPEED, 1e3)], 'Lubrication', WARN, 'judged_speed_above'),
        ([HEAVY, SPEED], 'Lubrication', WARN, 'judged_load_outside'),
        ([SPEED], 'Inputs', STALE, 'load_was_never'),
        (
            [LOAD, Refusal(source=Source.LOAD, why=Why.FUTURE), SPEED],
            'Inputs',
            STALE,
            'load_usable_stamps',
        ),
        (
            [LOAD, Refusal(source=Source.LOAD, why=Why.OTHER_CLOCK), SPEED],
            'Inputs',
            STALE,
            'load_usable',
        ),
        ([LOAD, LATE], 'Inputs', STALE, 'load_stale_publisher'),
        (EVERY_SECOND[:4], 'Inputs', OK, 'all_inputs_arrive'),
        (EVERY_SECOND, 'Inputs', WARN, 'speed_comes_less'),
    ],
)
def test_what_is_not_judged_and_why(core, events, part, level, message, says):
    assert said(after(core, *events)[part]) == (level, says(message))


def test_while_the_clock_stands_nothing_is_well_and_a_warning_stays(core):
    made = after(core, LOAD, SPEED, clock_stands=True)
    stands = (STALE, diagnostics.CLOCK_STANDS)
    assert said(made['Lubrication']) == said(made['Inputs']) == stands
    assert made['Surface'].level == OK
    assert said(after(core, clock_stands=True)['Inputs']) == stands
    made = after(core, LOAD, SPEED, surface=core.surface(rcs=0.5), clock_stands=True)
    assert made['Lubrication'].level == WARN
    assert said(made['Inputs']) == stands


def test_a_glitch_is_told_for_ten_seconds_and_counted(core):
    def told(after_glitch):
        stamp = START + after_glitch
        good = [sample(Source.LOAD, -1000.0, stamp), sample(Source.SPEED, 10.0, stamp)]
        glitch = sample(Source.SPEED, 1e12)
        return after(core, LOAD, glitch, *good, settings={'plausible': {Source.SPEED: 300.0}})

    cure = 'mend the source, its unit or scale, or raise limits.plausible_speed or '
    status = told(10 * SECOND - 1)['Inputs']
    text = f'speed samples beyond the plausible range were refused: {cure}limits.plausible_load'
    assert said(status) == (WARN, text)
    assert values_of(status)['Speed implausible [-]'] == '1'
    assert told(10 * SECOND)['Inputs'].level == OK


def refused_at_100_hz(core, every, *, silence=0):
    """Return the diagnostics after 20 s with a refused load before one in `every` good ones."""
    events = []
    for number in range(2000):
        stamp = START + number * SECOND // 100
        if number % every == 0:
            refusal = Refusal(source=Source.LOAD, why=Why.NOT_A_NUMBER, arrival=stamp)
            events.append(refusal)
        events += [sample(Source.LOAD, -1000.0, stamp), sample(Source.SPEED, 10.0, stamp)]
    end = stamp + silence
    events += [sample(Source.LOAD, -1000.0, end), sample(Source.SPEED, 10.0, end)]
    return after(core, *events)['Inputs']


@pytest.mark.parametrize(('every', 'level'), [(1, WARN), (50, WARN), (200, OK)])
def test_refused_messages_are_told_with_their_share_though_the_last_one_was_good(
    core, every, level, says
):
    status = refused_at_100_hz(core, every)
    assert said(status) == (level, says('refused' if level is WARN else 'few_refused'))
    share = float(values_of(status)['Load refused share [-]'])
    assert share == pytest.approx(1.0 / (every + 1), rel=0.1)


def test_a_refusal_is_told_for_ten_seconds_after_the_last_one(core, says):
    def message(silence):
        return refused_at_100_hz(core, 2, silence=silence).message

    last = SECOND // 100  # [ns] from the last refusal to the last sample
    assert message(10 * SECOND - last - 1) == says('refused')
    assert message(10 * SECOND - last) == 'all inputs arrive'


SEVERAL = Link(
    topic='/loads',
    type_name='a/msg/B',
    matched=2,
    several=True,
    publishers=(
        Publisher(type_name='a/msg/B', node='/sim'),
        Publisher(type_name='', node='/drive'),
    ),
)


def test_several_publishers_of_one_input_are_named(core, says):
    links = LINKS | {Source.LOAD: SEVERAL}
    refusal = Refusal(source=Source.LOAD, why=Why.SEVERAL, arrival=START)
    found = after(core, LOAD, SPEED, refusal, SPEED, links=links)
    assert said(found['Inputs']) == (STALE, says('several_refused'))
    assert found['Lubrication'].level == STALE
    found = after(core, LOAD, SPEED, links=links)
    assert said(found['Inputs']) == (OK, says('several_allowed'))
    unknown = {Source.LOAD: dataclasses.replace(SEVERAL, several=None)}
    assert said(after(core, LOAD, SPEED, links=unknown)['Inputs']) == (WARN, says('not_known'))


@pytest.mark.parametrize(
    ('changes', 'message'),
    [
        ({'lost': 2}, 'speed_messages_lost'),
        ({'lost': None}, 'speed_loss_unknown'),
        ({'stamp': WALL - SECOND}, 'speed_stamps_lag'),
        ({'stamp': 5 * SECOND}, 'speed_stamps_simulated'),
    ],
)
def test_a_trouble_of_an_input_has_one_sentence_with_its_cure(core, changes, message, says):
    speed = dataclasses.replace(sample(Source.SPEED, 10.0, WALL), **changes)
    load = sample(Source.LOAD, -1000.0, WALL)
    arrived = dataclasses.replace(speed, arrival=WALL)
    status = after(core, load, arrived, settings={'max_lag': SECOND // 2})
    assert said(status['Inputs']) == (WARN, says(message))


@pytest.mark.parametrize(
    ('links', 'message'),
    [(LINKS, 'nothing has been judged yet'), (None, 'the node is inactive, nothing is judged')],
)
def test_without_a_state_there_is_no_news(core, links, message):
    made = diagnostics.statuses('n', 'x', *NOTHING, core.surface(), links=links)
    assert [said(status) for status in made[:2]] == [(STALE, message)] * 2
    assert made[2].level == OK


@pytest.mark.parametrize(
    ('events', 'shown'),
    [
        ([LOAD, SPEED], (OK, 'shelved until 1970-01-01 00:17:40 UTC: nut is ordered')),
        ([LOAD, SPEED, STILL], (OK, 'shelved until 1970-01-01 00:17:40 UTC: nut is ordered')),
        ([LOAD, SPEED, HEAVY, SPEED], (WARN, 'not judged: load outside the surface')),
    ],
)
def test_a_shelved_warning_is_no_warning_and_hides_no_other(core, events, shown):
    monitor = core.monitor(core.surface(rcs=0.5), core.limits(raise_delay=0))
    monitor.shelving = shelve(START, 60.0, 'nut is ordered')
    last = core.feed(monitor, events)[-1]
    assert last.level == Level.WARN
    cause = monitor.event_code
    assert diagnostics.summaries(last.message, last.inputs, cause, LINKS)[0][:2] == shown
    assert not plain_values(last.message)['out_of_zone']


def test_the_state_directory():
    good, bad = (diagnostics.of_folder('/cell/node', problem) for problem in ('', 'it is full'))
    assert said(good) == (OK, 'sums, events and corrections are kept')
    assert said(bad) == (WARN, 'it is full')
    assert good.name == bad.name == 'cell/node: State directory'


@pytest.mark.parametrize(
    ('event', 'place'),
    [
        (LOAD, f'the load -1000.0 (SI) that arrived at {START} ns'),
        (
            Refusal(source=Source.SPEED, why=Why.FUTURE, arrival=START),
            f'the speed refused that arrived at {START} ns',
        ),
        (START, f'a tick at {START} ns'),
    ],
)
def test_a_defect_says_where_it_came_up_and_what_to_do(core, event, place, says):
    monitor = core.monitor()
    sentence = diagnostics.defect_text(ZeroDivisionError('by 0'), event)
    assert sentence == says('program_failed', place=place)
    made = diagnostics.statuses(
        'node', 'x', None, (), monitor.event_code, monitor.surface, links=LINKS, defect=sentence
    )
    assert said(made[0]) == (ERROR, sentence)
    assert all(status.message != sentence for status in made[1:])


def test_a_typical_drag_is_told_beside_the_efficiency_that_is_judged(core):
    """As the band that it makes of it; a surface whose drag is identified has none."""
    assert 'Efficiency with typical drag [-]' not in values_of(
        after(core, LOAD, SPEED)['Lubrication']
    )
    surface = core.surface()
    surface.with_typical_drag = lambda friction, load: {
        'efficiency': {'low': 0.9, 'typical': 0.8, 'high': 0.5}
    }
    values = values_of(after(core, LOAD, SPEED, surface=surface)['Lubrication'])
    assert values['Efficiency with typical drag [-]'] == '0.8 (0.5 to 0.9)'


def test_values_carry_their_unit(core):
    made = after(core, LOAD, SPEED)
    values = values_of(made['Lubrication'])
    assert values['Speed [rad/s]'] == '10'
    assert values['Oil temperature [degC]'] == '40'
    assert values['Efficiency [-]'] == '0.9'
    values = values_of(made['Inputs'])
    assert (values['Speed state'], values['Torque state']) == ('OK', 'NOT_CONFIGURED')
    assert (values['Speed publishers [-]'], values['Load publishers [-]']) == ('1', '0')
    values = values_of(made['Surface'])
    assert values['Opposing load max [N]'] == '4000'


def codes_of(made):
    return [int(values_of(status)['Code']) for status in made]


@pytest.mark.parametrize(
    ('events', 'codes'),
    [
        ([LOAD, SPEED], [Fault.NONE, Fault.NONE, Fault.NONE]),
        ([SPEED], [Fault.NO_INPUT, Fault.INPUT_MISSING, Fault.NONE]),
        ([HEAVY, SPEED], [Fault.LOAD_OUTSIDE, Fault.NONE, Fault.NONE]),
        ([LOAD, STILL], [Fault.NONE, Fault.NONE, Fault.NONE]),
        (
            [LOAD, Refusal(source=Source.LOAD, why=Why.FUTURE), SPEED],
            [Fault.NO_INPUT, Fault.INPUT_FUTURE, Fault.NONE],
        ),
        ([], [Fault.NOTHING_YET, Fault.NOTHING_YET, Fault.NONE]),
    ],
)
def test_the_code_of_a_status_is_its_first_value(core, events, codes):
    made = after(core, *events)
    assert codes_of(made.values()) == codes
    assert all(status.values[0].key == 'Code' for status in made.values())


@pytest.mark.parametrize('policy', WarningPolicy)
def test_a_warning_that_is_not_to_call_keeps_its_code(core, policy):
    found = after(core, LOAD, SPEED, surface=core.surface(rcs=0.5), policy=policy)
    assert codes_of(found.values()) == [Fault.RCS_HIGH, Fault.NONE, Fault.NONE]


@pytest.mark.parametrize(
    ('policy', 'level'),
    [(WarningPolicy.ZONE, WARN), (WarningPolicy.BOTH, OK), (WarningPolicy.CHANGE, OK)],
)
def test_a_usual_warning_is_not_raised_by_who_asks_for_changes(core, policy, level):
    """With the zone alone all stays as it is; another warning is raised as ever."""
    surface = core.surface(rcs=0.5)
    plain = after(core, LOAD, SPEED, surface=surface, policy=policy)['Lubrication']
    found = after(core, LOAD, SPEED, surface=surface, policy=policy, usual=(1,))['Lubrication']
    assert found.level == level
    assert codes_of([found]) == [Fault.RCS_HIGH]
    assert (said(found) == said(plain)) == (policy is WarningPolicy.ZONE)
    assert diagnostics.usual_of(found) == {1}
    assert diagnostics.usual_of(plain) == frozenset()
    other = after(core, LOAD, SPEED, surface=surface, policy=policy, usual=(2, 3))['Lubrication']
    assert said(other) == said(plain)


def health_of(condition, **drag):
    """Return a health with a change of the friction."""
    quantity = Quantity(name='drag change', **drag)
    day = 20_000 * 86_400 * SECOND
    return Health(
        axis='x',
        stamp=day,
        condition=condition,
        verdict='',
        advice='measure the backlash',
        since=day,
        quantities=[quantity],
    )


def test_three_answers_come_first_and_in_order(core):
    health = health_of(Condition.UNKNOWN, reason='not known yet: 3 of 5 logs')
    for rcs, outside, remedy in ((0.0, 'not', ''), (0.5, 'surely', 'look')):
        surface = core.surface(rcs=rcs)
        made = after(core, LOAD, SPEED, surface=surface, health=health, advice='look')
        assert [(pair.key, pair.value) for pair in made['Lubrication'].values[1:4]] == [
            ('Normal', 'not known yet: 3 of 5 logs'),
            ('Outside the zone', outside),
            ('What to do', remedy),
        ]


def test_the_remedy_of_a_change_is_an_answer_though_the_zone_is_fine(core):
    worse = health_of(Condition.WORSE, value=-0.11, low=-0.13, high=-0.09)
    found = after(core, LOAD, SPEED, surface=core.surface(rcs=0.0), health=worse)
    values = values_of(found['Lubrication'])
    assert values['Normal'].startswith('changed since about 4 October 2024')
    assert values['Normal'].endswith('its friction is 11 % lower (9 to 13 %)')
    assert values['What to do'] == 'measure the backlash'


def test_what_holds_for_the_whole_axis_or_node_has_its_code(core):
    surface = core.surface()
    inactive = diagnostics.statuses('n', 'x', *NOTHING, surface, links=None)
    assert codes_of(inactive) == [Fault.INACTIVE, Fault.INACTIVE, Fault.NONE]
    facts = {'refused': 'why', 'defect': 'it failed', 'clock_stands': True}
    made = diagnostics.statuses('n', 'x', *NOTHING, surface, links=LINKS, **facts)
    assert codes_of(made) == [Fault.PROGRAM_FAILED, Fault.CLOCK_STANDS, Fault.RELOAD_REFUSED]
    assert codes_of(diagnostics.failed('n', 'x', 'why')) == [Fault.NOT_CONFIGURED] * 3
    for problem, kept, recorded in (('', 0, 0), ('why', Fault.NOT_KEPT, Fault.NOT_RECORDED)):
        assert codes_of([diagnostics.of_folder('n', problem)]) == [kept]
        assert codes_of([diagnostics.recording('n', problem)]) == [recorded]


@pytest.mark.parametrize(('share', 'code'), [(0.1, Fault.NONE), (0.9, Fault.BUSY)])
def test_the_node_itself(share, code, says):
    signs = VitalSigns(loop_time=0.25, queue_depth=3, processor_share=share)
    status = diagnostics.of_node('/cell/node', signs)
    assert (status.name, codes_of([status])) == ('cell/node: Node', [code])
    assert said(status) == ((WARN, says('busy')) if code else (OK, 'the node keeps up'))
    assert values_of(status)['Loop time [s]'] == '0.25'
    assert (values_of(status)['Queue depth [-]'], status.values[0].key) == ('3', 'Code')


@pytest.mark.parametrize('share', [0.1, 0.9])
@pytest.mark.parametrize(('step', 'word'), [(3600 * SECOND, 'forward'), (-SECOND, 'back')])
def test_the_node_says_that_its_clock_was_set(share, step, word, says):
    signs = VitalSigns(loop_time=0.25, queue_depth=3, processor_share=share)
    status = diagnostics.of_node('node', signs, step)
    busy = f'; {says("busy")}' if share > 0.5 else ''
    assert said(status) == (WARN, says('clock_was_set', way=word) + busy)
    assert codes_of([status]) == [Fault.CLOCK_SET]
    assert values_of(status)['Clock step [s]'] == f'{step / SECOND:.6g}'


@pytest.mark.parametrize(('share', 'busy'), [(0.1, ''), (0.9, '; ')])
def test_the_node_says_that_its_clock_was_never_set(share, busy, says):
    signs = VitalSigns(processor_share=share)
    status = diagnostics.of_node('node', signs, is_clock_set=False)
    assert said(status) == (WARN, says('clock_not_set') + (busy and busy + says('busy')))
    assert codes_of([status]) == [Fault.CLOCK_NOT_SET]
    after = diagnostics.of_node('node', signs, SECOND, is_clock_set=False)
    assert after == diagnostics.of_node('node', signs, SECOND)


@pytest.mark.parametrize('step', [0, SECOND])
def test_the_node_says_that_another_one_has_its_name(step, says):
    status = diagnostics.of_node('node', VitalSigns(), step, ['here', 'there', 'beyond'])
    assert said(status) == (ERROR, says('two_nodes'))
    assert codes_of([status]) == [Fault.TWO_NODES]
    hosts = [one.value for one in status.values if one.key == diagnostics.HOST]
    assert hosts == ['here', 'there', 'beyond']
    alone = diagnostics.of_node('node', VitalSigns(), step, ['here'])
    assert alone == diagnostics.of_node('node', VitalSigns(), step)


def test_messages_hold_no_measured_numbers(core):
    for events in ([LOAD, SPEED], [SPEED], [LOAD, sample(Source.SPEED, 1e3)]):
        for status in after(core, *events).values():
            assert not any(character.isdigit() for character in status.message)


DERIVED = {
    'timeouts': dict.fromkeys((Source.SPEED, Source.TORQUE), SECOND // 2),
    'derivation': LoadDerivation(
        inertia=0.0,
        window=SECOND // 20,
        torque_uncertainty=0.125,
        parts_uncertainty=0.0,
        largest_share=0.5,
    ),
}


def straight(core, drag=0.0):
    surface = core.surface(driving_torque=lambda speed, load: load / 1024.0)
    surface.parasitic_torque, surface.lead = drag, math.tau / 1024.0
    return surface


def test_a_derived_load_is_told_with_its_uncertainty_or_why_it_is_not(core):
    torque = sample(Source.TORQUE, 1.0)
    found = after(core, torque, SPEED, surface=straight(core), settings=DERIVED)
    lubrication, inputs = values_of(found['Lubrication']), values_of(found['Inputs'])
    assert lubrication['Axial load [N]'] == '-1024'
    assert lubrication['Axial load from'] == 'DERIVED'
    assert lubrication['Axial load uncertainty [N]'] == '128'
    assert (inputs['Load state'], inputs['Torque state']) == ('DERIVED', 'OK')
    assert found['Inputs'].level == OK
    found = after(core, torque, SPEED, surface=straight(core, 0.75), settings=DERIVED)
    text = 'not judged: the motor torque does not tell the load here'
    assert said(found['Lubrication']) == (WARN, text)
    assert found['Inputs'].level == OK
    still = after(core, torque, SPEED, STILL, surface=straight(core), settings=DERIVED)
    assert still['Lubrication'].level == OK


def test_without_the_torque_a_derived_load_is_lost(core, says):
    links = {Source.TORQUE: Link(topic='/t', type_name='a/msg/B')}
    found = after(core, SPEED, surface=straight(core), settings=DERIVED, links=links)
    assert (found['Inputs'].level, found['Lubrication'].level) == (STALE, STALE)
    assert found['Inputs'].message == says('torque_was_never')
