# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Quantities of health are listed with their intervals; what is not known says so."""


def test_quantities_have_value_interval_and_picture(tab, greeted, frames):
    tab.visit(greeted.url)
    tab.until("document.querySelector('.health td')")
    rows = tab.ask("""[...document.querySelectorAll('.health tbody tr')].map((row) =>
        [...row.cells].map((one) => (one.querySelector('svg') ? 'picture' : one.textContent)))""")
    assert rows == [
        ['Preload', '98 %', '92 to 104', 'picture'],
        ['Friction change', '3 %', '-2 to 8', 'picture'],
        ['Hours left at this programme', '8200 h', '6100 to 11000', ''],
        ['Share of life used', 'not known', 'not known yet: no whole day'],
    ]
    assert tab.text('.health .sentence').startswith(
        'Normal for this axis The friction is as it was'
    )


def test_notes_of_the_node_are_read_below_the_advice(tab, greeted, frames):
    note = {'free': 'The drag has no forward motion.'}
    greeted.greeting[-1] = frames.state(health=frames.health(notes=[note], advice='Lubricate.'))
    tab.visit(greeted.url)
    tab.until("document.querySelector('.health td')")
    assert tab.texts('.health .verdict p')[1:] == ['Lubricate.', note['free']]
    assert tab.ask("document.querySelector('.health .verdict .muted span').lang") == 'en'


def test_marks_of_an_interval_are_where_they_belong(tab, greeted):
    tab.visit(greeted.url)
    tab.until("document.querySelector('.health td')")
    found = tab.ask("""(() => {
        const bar = Health.bar(0.7, 0.6, 0.8);
        const at = (one, name) => Number(one.getAttribute(name));
        const [zero, whole, interval] = bar.querySelectorAll('line');
        const part = (x) => (x - at(zero, 'x1')) / (at(whole, 'x1') - at(zero, 'x1'));
        const dot = bar.querySelector('circle');
        return [at(interval, 'x1'), at(interval, 'x2'), at(dot, 'cx')]
          .map((x) => Number(part(x).toFixed(9)));
    })()""")
    assert found == [0.6, 0.8, 0.7]


def test_a_new_assessment_replaces_the_old_and_none_is_kept(tab, greeted, frames):
    tab.visit(greeted.url)
    tab.until("document.querySelector('.health td')")
    greeted.send(*frames.state(health=frames.health('worse', verdict='Worse.', quantities=[])))
    tab.reads('.health .sentence', 'Changed: worse than before Worse.')
    greeted.send(*frames.state())
    tab.until('page.painter.views.every((view) => !view.news)')
    assert tab.text('.health .sentence') == 'Changed: worse than before Worse.'
