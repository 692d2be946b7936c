# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The first screen shows what was sent, in the axis' own terms; old data say nothing."""

import itertools
import math

from hypothesis import given, settings
from hypothesis import strategies as st
import pytest

LEVELS = {'ok': 'Optimal zone', 'warn': 'Outside the optimal zone', 'unknown': 'Not known'}
HOSTILE = '<img src=x onerror=alert(1)><script>alert(2)</script>'


@pytest.fixture
def shown(tab, greeted):
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    return tab


def rounded(value, digits):
    """Return a number as Format.number writes it, within the range of plain notation."""
    if not math.isfinite(value):
        return '–'
    found = float(f'{value:.{digits - 1}e}')
    return f'{found:.10f}'.rstrip('0').rstrip('.') if found else '0'


def test_values_on_screen_are_those_of_the_states(shown, greeted, frames):
    number = itertools.count()

    @settings(max_examples=12)
    @given(
        st.floats(5, 3000),
        st.floats(10, 30_000),
        st.floats(10, 90),
        st.floats(0.86, 0.99),
        st.sampled_from(sorted(LEVELS)),
    )
    def holds(speed, load, temperature, efficiency, level):
        values = {'speed_rpm': speed, 'load_N': load, 'temperature_degC': temperature}
        rows = frames.rows(2, efficiency=efficiency, **values)
        headline = f'state {next(number)}'
        greeted.send(*frames.state(level=level, zone='outside', rows=rows, headline=headline))
        shown.reads('.reason', headline)
        shown.reads('.sign.level .word', LEVELS[level])
        shown.until(f"document.querySelector('.sign.level').dataset.state === '{level}'")
        expected = [
            f'{rounded(speed * 0.01, 3)} m/min',
            f'{rounded(load, 3)} N',
            f'{rounded(temperature, 3)} °C',
            f'{rounded(100 * efficiency, 3)} %',
        ]
        found = shown.ask(
            "[...document.querySelectorAll('.numbers .big')].map((one) => one.textContent)"
        )
        assert found[:4] == expected
        assert shown.text('.numbers .more') == f'{rounded(speed, 3)} rev/min'

    holds()


def test_numbers_that_are_not_known_are_dashes(shown, greeted, frames):
    nothing = dict.fromkeys(('speed_rpm', 'load_N', 'temperature_degC', 'efficiency'), math.nan)
    rows = frames.rows(1, **nothing)
    greeted.send(*frames.state(rows=rows, limit={'speed_rpm': None}))
    shown.until("""[...document.querySelectorAll('.numbers .big')]
        .every((one) => one.textContent === '–')""")


@pytest.mark.parametrize(
    ('margin', 'text'),
    [(0.35, '35 % above'), (-0.4, '40 % below'), (1.4, '2.4 × limit'), (0.0, '0 % above')],
)
def test_how_far_the_limit_is(shown, margin, text):
    assert shown.ask(f'FirstScreen.distance({margin})') == text


@pytest.mark.parametrize(
    ('value', 'text'), [(1030.4, '1030'), (1.0312e-7, '0.000000103'), (-2e-9, '-0.000000002')]
)
def test_no_number_is_written_by_powers_of_ten(shown, value, text):
    assert shown.ask(f'Format.number({value!r})') == text


def test_at_standstill_no_distance_is_told(shown, greeted, frames):
    greeted.send(*frames.state(rows=frames.rows(1, speed_rpm=4.0)))
    shown.reads('.numbers > div:last-child .big', '–')
    greeted.send(*frames.state(rows=frames.rows(1, 1.0, speed_rpm=-885.0)))
    shown.reads('.numbers > div:last-child .big', '50 % above')


def test_at_standstill_nothing_is_green(shown, greeted, frames):
    """Whatever level is held, but for a warning, which stays."""
    for level in ('ok', 'unknown'):
        greeted.send(*frames.state(level=level, zone='unknown', at_rest=True))
        shown.reads('.sign.level .word', 'At rest')
        assert shown.ask("document.querySelector('.sign.level').dataset.state") == 'rest'
        greeted.send(*frames.state(level='warn', zone='outside', at_rest=False))
        shown.reads('.sign.level .word', 'Outside the optimal zone')
    greeted.send(*frames.state(level='warn', zone='unknown', at_rest=True, headline='still'))
    shown.reads('.reason', 'The warning is held; at this moment: still')
    assert shown.text('.sign.level .word') == 'Outside the optimal zone'


@pytest.mark.parametrize('assumed', [False, True])
def test_a_temperature_that_is_assumed_is_marked_on_its_tile(shown, greeted, frames, assumed):
    greeted.send(*frames.state(temperature_assumed=assumed, headline='now'))
    shown.reads('.reason', 'now')
    text = 'assumed, not measured' if assumed else ''
    shown.reads('.numbers > div:nth-child(3) .more', text)


def test_without_data_one_line_says_what_is_missing(tab, greeted, frames):
    quantity = {'value': None, 'low': None, 'high': None, 'unit': '-', 'known': False}
    unknown = [quantity | {'name': f'q{i}', 'words': {'free': 'No torque.'}} for i in range(15)]
    health = frames.health('unknown', quantities=unknown)
    state = {'level': 'unknown', 'zone': 'unknown', 'headline': 'no valid sample: Speed'}
    greeted.greeting = [
        frames.hello(frames.axis()),
        frames.state(rows={}, health=health, limit=None, **state),
    ]
    tab.visit(greeted.url)
    tab.reads('.reason', 'no valid sample: Speed')
    tab.reads('.health summary', 'Not known yet: 15 quantities. Open this line to read why.')
    assert tab.ask("document.querySelector('.health').innerText.match(/not known/gi).length") <= 2
    for part in ('.numbers', '.strips', '.what-if'):
        assert tab.ask(f"getComputedStyle(document.querySelector('{part}')).display") == 'none'
    assert tab.text('.age') == ''
    greeted.send(*frames.state())
    tab.until("getComputedStyle(document.querySelector('.strips')).display !== 'none'")


def test_a_warning_that_is_only_held_says_so(shown, greeted, frames):
    greeted.send(*frames.state(level='warn', zone='unknown', headline='the screw stands still'))
    shown.reads('.reason', 'The warning is held; at this moment: the screw stands still')
    greeted.send(*frames.state(level='warn', zone='outside', headline='too slow'))
    shown.reads('.reason', 'too slow')


@pytest.mark.parametrize(
    ('changes', 'state', 'word'),
    [
        ({'outside': 'surely'}, 'surely', 'Surely outside the optimal zone'),
        ({'outside': 'perhaps'}, 'perhaps', 'Perhaps outside the optimal zone'),
        ({'outside': 'unbanded'}, 'warn', 'Outside the optimal zone'),
        ({'outside': 'surely', 'usual': True}, 'usual', 'Outside the optimal zone, as usual'),
        ({'outside': 'perhaps', 'zone': 'unknown'}, 'warn', 'Outside the optimal zone'),
        ({'outside': 'perhaps', 'level': 'ok'}, 'ok', 'Optimal zone'),
    ],
)
def test_how_surely_it_is_outside_is_seen_and_read(shown, greeted, frames, changes, state, word):
    greeted.send(
        *frames.state(**{'level': 'warn', 'zone': 'outside', 'headline': 'now'} | changes)
    )
    shown.until("document.querySelector('.reason').textContent.includes('now')")
    shown.reads('.sign.level .word', word)
    assert shown.ask("document.querySelector('.sign.level').dataset.state") == state
    bare = changes['outside'] == 'unbanded'
    assert shown.text('.reason').endswith('Build it again.') == bare


def test_three_answers_stand_in_their_order(shown):
    order = shown.ask("""['condition', 'level', 'advice'].map((name) => document
        .querySelector(`.first .${name}`)).map((one, i, all) => !i
        || Boolean(all[i - 1].compareDocumentPosition(one) & Node.DOCUMENT_POSITION_FOLLOWING))""")
    assert order == [True, True, True]


@pytest.mark.parametrize(
    ('condition', 'state', 'advice'),
    [
        ('normal', {}, 'What to do: nothing has to be done'),
        ('normal', {'at_rest': True}, 'What to do: nothing has to be done'),
        (
            'normal',
            {'level': 'warn', 'zone': 'outside', 'usual': True},
            'What to do: nothing has to be done: usual for this axis',
        ),
        ('worse', {}, 'What to do: Look at the nut.'),
        ('slightly_changed', {'advice': 'Run on.'}, 'What to do: Run on.'),
        ('unknown', {}, ''),
        ('normal', {'level': 'warn', 'zone': 'outside'}, ''),
        (
            'normal',
            {'level': 'warn', 'zone': 'outside', 'outside': 'perhaps'},
            'What to do: nothing has to be done',
        ),
    ],
)
def test_what_to_do_is_said_also_where_it_is_nothing(
    shown, greeted, frames, condition, state, advice
):
    health = frames.health(condition, advice='Look at the nut.')
    greeted.send(*frames.state(health=health, headline='now', **state))
    shown.until("document.querySelector('.reason').textContent.includes('now')")
    shown.reads('.advice', advice)


def test_while_it_learns_it_says_how_far_it_is(shown, greeted, frames):
    health = frames.health('unknown', verdict='3 of 5 logs')
    greeted.send(*frames.state(health=health))
    shown.reads('.change', '3 of 5 logs')
    shown.reads('.sign.condition .word', 'Normal? Not known yet')


RCS = {'key': 'cause_rcs', 'values': {'value': {'rcs': 0.27}, 'limit': {'rcs': 0.01}}}
ADVICE = {'key': 'advice_speed', 'values': {'speed': {'speed': 640.0}}}


@pytest.mark.parametrize(
    ('said', 'english', 'german'),
    [
        (
            RCS,
            'The oil film is too thin: 27 % of the load is carried where metal pierces it, '
            'the limit is 1 %.',
            'Der Ölfilm ist zu dünn: 27 % der Last ruhen auf Metall, das ihn durchstößt, '
            'die Grenze ist 1 %.',
        ),
        (
            {'key': 'reason_speed_below_range', 'values': {'speed': {'speed': 12.5}}},
            'the speed of 0.125 m/min, 12.5 rev/min is below the surface, which begins at '
            '0.2 m/min, 20 rev/min',
            'Der Vorschub von 0,125 m/min, 12,5 U/min liegt unter dem Kennfeld, das bei '
            '0,2 m/min, 20 U/min beginnt.',
        ),
        (
            {'key': 'reason_missing', 'values': {'inputs': [{'key': 'input_load'}] * 2}},
            'no valid sample: Load, Load',
            'Kein gültiger Messwert: Last, Last',
        ),
        (
            {
                'key': 'with_detail',
                'values': {'what': {'key': 'reason_no_derived_load'}, 'why': {'free': 'A fault.'}},
            },
            'the motor torque does not tell the load: A fault.',
            'Aus dem Motormoment lässt sich die Last hier nicht ableiten. A fault.',
        ),
        ({'free': 'A fault.'}, 'A fault.', 'A fault.'),
    ],
)
def test_the_reason_is_said_in_the_language_of_the_reader(
    tab, greeted, frames, said, english, german
):
    """A sentence of the node alone stays English, and is marked so."""
    greeted.greeting[-1] = frames.state(level='warn', zone='outside', headline=said)
    for language, text in (('en', english), ('de', german)):
        tab.visit(greeted.url, language=language)
        tab.reads('.reason', text)
        marked = tab.texts('.reason [lang=en]')
        assert marked == (['A fault.'] if 'A fault.' in text else [])


def test_a_fault_is_said_with_its_code(shown, greeted, frames):
    greeted.send(*frames.state(faults=[215, 301]))
    shown.until("document.querySelectorAll('.fault').length === 2")
    assert shown.texts('.fault') == [
        'Code 215: an input is beyond the plausible range.',
        'Code 301: kept the old surface, the reload is refused.',
    ]


def test_an_advice_without_the_lead_has_the_turns_alone(tab, greeted, frames):
    for lead, speed in ((10.0, '6.4 m/min, 640 rev/min'), (None, '640 rev/min')):
        greeted.greeting[0] = frames.hello(frames.axis(lead_mm=lead))
        greeted.greeting[-1] = frames.state(level='warn', zone='outside', advice=ADVICE)
        tab.visit(greeted.url)
        tab.reads('.advice', f'What to do: at this load run at {speed}')


def test_advice_condition_and_inputs_are_said(shown, greeted, frames):
    inputs = [
        {'name': 'load', 'state': 'stale', 'age_s': 4.0, 'words': 'The last sample is 4 s old.'}
    ]
    health = frames.health('worse', verdict='The friction has risen by 30 %.')
    greeted.send(
        *frames.state(
            level='warn',
            zone='outside',
            advice='Run at 6.4 m/min.',
            inputs=inputs,
            health=health,
            shelved={'left_s': 600.0, 'reason': 'run-in'},
        )
    )
    shown.reads('.advice', 'What to do: Run at 6.4 m/min.')
    shown.reads('.sign.condition .word', 'Changed: worse than before')
    shown.reads('.change', 'The friction has risen by 30 %.')
    shown.reads('.shelved', 'Shelved for 10 min: run-in')
    shown.reads('.input', 'Load too oldThe last sample is 4 s old.')
    assert shown.ask("document.querySelector('.input').dataset.state") == 'stale'


def test_a_level_that_stays_is_not_read_out_again(shown, greeted, frames):
    assert shown.ask("document.querySelector('.sign.level .word').getAttribute('role')") == 'alert'
    shown.ask("""globalThis.changes = 0;
        new MutationObserver(() => { changes += 1; }).observe(
          document.querySelector('.sign.level .word'), { childList: true, characterData: true });
        0""")
    for number, level in enumerate(('ok', 'ok', 'warn', 'warn')):
        greeted.send(*frames.state(level=level, zone='outside', headline=f'state {number}'))
        shown.reads('.reason', f'state {number}')
    shown.until('changes === 1')


def test_of_old_data_nothing_is_concluded(shown, greeted, frames):
    greeted.send(*frames.state(age_s=7.0, advice='Run faster.'))
    shown.reads('.sign.level .word', 'Not known')
    assert 'the present state is not known' in shown.text('.reason')
    assert shown.text('.advice') == ''
    greeted.send(*frames.state(age_s=7.0, standing='inactive'))
    inactive = frames.words('en')['node_inactive'].format(node='/ballscrew_monitor')
    shown.reads('.reason', inactive)
    shown.reads('.sign.level .word', 'Not known')
    greeted.send(*frames.state())
    shown.reads('.sign.level .word', 'Optimal zone')


def test_a_node_that_is_gone_is_said_to_be(shown, greeted, frames):
    greeted.send(*frames.state(standing='gone'))
    left = frames.words('en')['node_left'].format(node='/ballscrew_monitor')
    shown.reads('.reason', left)
    shown.reads('.sign.level .word', 'Not known')
    greeted.send(*frames.state())
    shown.reads('.sign.level .word', 'Optimal zone')


def test_names_with_markup_are_shown_as_text(tab, server, frames):
    axes = [frames.axis(HOSTILE, screw=HOSTILE, oil=HOSTILE), frames.axis('y')]
    state = frames.state(
        HOSTILE,
        level='warn',
        zone='outside',
        headline=HOSTILE,
        advice=HOSTILE,
        inputs=[{'name': HOSTILE, 'state': HOSTILE, 'age_s': 0.0, 'words': HOSTILE}],
        health=frames.health('worse', verdict=HOSTILE, advice=HOSTILE),
    )
    server.greeting = [
        frames.hello(*axes),
        state,
        frames.map(HOSTILE),
        frames.events(HOSTILE, {'advice': HOSTILE, 'acknowledged_by': HOSTILE}),
    ]
    tab.visit(server.url)
    tab.reads('.reason', HOSTILE)
    tab.reads('.card .name', HOSTILE)
    tab.until("document.querySelector('.events td')")
    assert tab.ask("document.querySelectorAll('img, main script').length") == 0
