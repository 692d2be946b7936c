# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Several axes are cards with their levels, and the chosen one is shown below."""


def test_axes_are_cards_of_which_one_is_chosen(tab, server, frames):
    server.greeting = [
        frames.hello(frames.axis('x'), frames.axis('y', lead_mm=5.0)),
        frames.state('x'),
        frames.state('y', level='warn', zone='outside', headline='Too slow.'),
    ]
    tab.visit(server.url)
    tab.until("document.querySelectorAll('.card[data-state]').length === 2")
    levels = "[...document.querySelectorAll('.card')].map((one) => one.dataset.state).join()"
    tab.until(f"{levels} === 'ok,warn'")
    pressed = "[...document.querySelectorAll('.card')].map((one) => one.ariaPressed).join()"
    assert tab.ask(pressed) == 'true,false'
    tab.click('.card:nth-child(2)')
    tab.reads('.reason', 'Too slow.')
    tab.until(f"{pressed} === 'false,true'")
