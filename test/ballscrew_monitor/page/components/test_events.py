# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Warnings are listed as they were sent; acting needs a name, a reason, and leave."""

import pytest


@pytest.fixture
def acting(tab, greeted, frames):
    """Return the tab of a page that may act."""
    greeted.greeting[0] = frames.hello(frames.axis(), acting=True)
    tab.visit(greeted.url)
    tab.until("document.querySelector('.events td')")
    return tab


def fill(tab, name, reason):
    tab.ask(f"""(() => {{
        const fields = document.querySelectorAll('.events input');
        [fields[0].value, fields[1].value] = [{name!r}, {reason!r}];
    }})()""")


def test_warnings_are_listed_and_lead_to_their_moment(acting, greeted, frames):
    advice = 'At this load run at 6.4 m/min (640 rev/min) or faster.'
    assert acting.texts('.events td')[1:] == ['8 s', 'contact 12 %, limit 1 %', advice, '']
    acting.click('.events td button')
    begin, end = acting.ask('page.strips.range')
    assert (begin, end) == pytest.approx((frames.begin + 15.0, frames.begin + 33.4))
    seen = {'acknowledged': True, 'acknowledged_by': 'Ada', 'acknowledge_reason': 'oil is ordered'}
    nameless = {'acknowledged': True}
    greeted.send(*frames.events('x', seen, {'active': True}, nameless, {'shelved': True}))
    acting.until("document.querySelectorAll('.events tbody tr').length === 4")
    who = acting.texts('.events td:last-child')
    assert who == ['Ada: oil is ordered', '', 'without a name', 'shelved']
    assert acting.ask("document.querySelectorAll('.events tr.bad').length") == 1
    greeted.send(*frames.events('x'))
    acting.reads('.events .wide', 'No warning yet.')


def test_acts_carry_name_and_reason(acting, greeted, frames):
    greeted.answers['acknowledge'] = lambda one: [
        ({'kind': 'answer', 'ok': True, 'message': ''}, None)
    ]
    greeted.answers['shelve'] = lambda one: [
        ({'kind': 'answer', 'ok': False, 'message': 'No warning is active.'}, None)
    ]
    words = frames.words('en')
    acting.button('.events', 'Acknowledge')
    acting.reads('.message', words['act_needs_name'])
    fill(acting, 'Ada', ' ')
    acting.button('.events', 'Shelve')
    acting.reads('.message', words['act_needs_reason'])
    assert greeted.requests == []
    acting.button('.events', 'Acknowledge')
    acting.reads('.message', 'Done.')
    fill(acting, 'Ada', 'run-in')
    acting.button('.events', 'Shelve')
    acting.reads('.message', 'No warning is active.')
    acting.button('.events', 'Acknowledge')
    acting.reads('.message', 'Done.')
    common = {'axis': '/ballscrew_monitor/x', 'name': 'Ada'}
    assert [
        {key: value for key, value in one.items() if key != 'id'} for one in greeted.requests
    ] == [
        common | {'do': 'acknowledge'},
        common | {'do': 'shelve', 'minutes': 15, 'reason': 'run-in'},
        common | {'do': 'acknowledge', 'reason': 'run-in'},
    ]


def test_where_acting_is_off_the_page_says_so(tab, greeted, frames):
    tab.visit(greeted.url)
    tab.until("document.querySelector('.events td')")
    tab.reads('.message', frames.words('en')['acting_off'])
    controls = '.events .controls :is(button, input, select)'
    assert tab.ask(f"[...document.querySelectorAll('{controls}')].every((one) => one.disabled)")


def test_sums_are_in_the_units_of_an_operator(acting):
    tiles = acting.texts('.events .tile dd')
    assert tiles == ['46.2 h', '13 %', '80 %', '1260 kJ', '842800']
    acting.reads('.events div h2', 'Totals')


def test_sums_of_a_recording_are_those_of_its_end(acting, greeted, frames):
    greeted.send({'kind': 'clock', 'at_s': 12.0, 'span_s': 60.0, 'rate': 1, 'playing': False})
    record, _ = frames.state()
    greeted.send(record | {'totals': record['totals'] | {'running_time': 312.0}})
    acting.reads('.events .tile dd', '5:12')
    acting.reads('.events div h2', 'Totals at the end of the recording')


def test_on_a_phone_no_word_of_a_warning_is_broken_and_no_column_cut(tab, greeted, frames):
    advice = {'free': 'at least 90 % would with an oil temperature of 55 degC or with ISO VG 220'}
    greeted.greeting[-2] = frames.events('x', {'advice': advice, 'acknowledged_by': 'Ada: seen'})
    tab.visit(greeted.url, width=360)
    tab.until("document.querySelector('.events td')")
    assert tab.ask("""[...document.querySelectorAll('.events td, .events table')]
        .every((one) => one.getBoundingClientRect().right <= innerWidth
          && one.scrollWidth <= one.clientWidth + 1)""")
    heads = tab.ask("""[...document.querySelectorAll('.events td')]
        .map((one) => getComputedStyle(one, '::before').content)""")
    assert heads[0] == '"Begin: "'
    assert tab.ask("getComputedStyle(document.querySelector('.events td')).display") == 'block'


def test_a_warning_that_is_perhaps_one_is_amber_and_a_usual_one_grey(tab, greeted, frames):
    greeted.greeting[3] = frames.events('x', {'active': True}, {'id': 2, 'usual': True})
    colours = {}
    for outside in ('surely', 'perhaps'):
        greeted.greeting[-1] = frames.state(level='warn', zone='outside', outside=outside)
        tab.visit(greeted.url)
        tab.until(f"document.querySelector('.events')?.dataset.state === '{outside}'")
        edge = "getComputedStyle(document.querySelector('.events tr.bad td')).borderLeftColor"
        sign = "getComputedStyle(document.querySelector('.sign.level')).backgroundColor"
        colours[outside] = tab.ask(edge)
        assert colours[outside] == tab.ask(sign)
    assert colours['surely'] != colours['perhaps']
    grey = tab.ask("getComputedStyle(document.querySelector('.events tr.usual')).color")
    assert grey == tab.ask("getComputedStyle(document.querySelector('.events th')).color")
