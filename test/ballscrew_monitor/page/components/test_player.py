# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The player shows the time of a recording and asks for what its controls say."""


def test_the_player_is_there_for_a_recording_and_asks(tab, greeted, wait_for):
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    assert tab.ask("document.querySelector('.player').hidden")
    clock = {'kind': 'clock', 'at_s': 12.0, 'span_s': 60.0, 'rate': 2, 'playing': True}
    greeted.send(clock)
    tab.reads('.player .time', '12 s / 1:00')
    assert tab.text('.player button') == 'Pause'
    tab.click('.player button')
    tab.ask("""(() => {
        const place = document.querySelector('.player input');
        place.value = 30; place.dispatchEvent(new Event('input'));
        const rate = document.querySelector('.player select');
        rate.value = '10'; rate.dispatchEvent(new Event('change'));
    })()""")
    wait_for(lambda: len(greeted.requests) == 3, 'three requests')
    asked = [{key: value for key, value in one.items() if key != 'id'} for one in greeted.requests]
    assert asked == [{'do': 'pause'}, {'do': 'seek', 's': 30}, {'do': 'rate', 'x': 10}]
    greeted.send(clock | {'playing': False})
    tab.reads('.player button', 'Play')


def test_a_recording_that_stands_still_does_not_grow_old(tab, greeted, frames):
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    greeted.send({'kind': 'clock', 'at_s': 12.0, 'span_s': 60.0, 'rate': 1, 'playing': False})
    greeted.send(*frames.state(age_s=100.0, headline='At its place.'))
    tab.reads('.reason', 'At its place.')
    tab.reads('.age', 'A recording, not the present state')
    assert tab.text('.sign.level .word') == 'Optimal zone'
