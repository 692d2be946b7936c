# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Another temperature, oil or feed is asked for, and never shown as the present state."""

import pytest

POINT = {'zone': 'optimal', 'efficiency': 0.931, 'rcs': 0.002, 'film_ratio': 2.13}
POINT |= {'torque_N_m': 1.25, 'words': ''}
PLACE = ('speed_rpm', 'load_N', 'temperature_degC')


@pytest.fixture
def shown(tab, greeted, frames):
    """Return the tab of a page that may act and whose maps are answered."""

    def answer(request):
        warmth = request['temperature_degC'] or 35.0
        record, arrays = frames.map(quantity=request['quantity'], temperature_degC=warmth)
        return [(record | {'kind': 'answer', 'ok': True}, arrays)]

    greeted.answers['map'] = answer
    greeted.answers['read'] = lambda one: [
        (POINT | {'kind': 'answer', 'ok': True} | {key: one[key] for key in PLACE}, None)
    ]
    greeted.greeting[0] = frames.hello(frames.axis(), acting=True)
    tab.visit(greeted.url)
    tab.reads('.what-if h2', 'Operating map at 35 °C')
    return tab


def change(tab, selector, value):
    tab.ask(f"""(() => {{
        const control = document.querySelector('.what-if {selector}');
        control.value = '{value}';
        control.dispatchEvent(new Event(control.type === 'range' ? 'input' : 'change'));
    }})()""")


def test_another_state_is_asked_for_said_and_left(shown, greeted, frames, wait_for):
    change(shown, 'input[type=range]', 50)
    shown.reads('.what-if h2', 'Operating map at 50 °C')
    change(shown, 'label:nth-of-type(3) select', 'ISO VG 46')
    said = 'What if: this map is for 50 °C and ISO VG 46. It is not the present state.'
    shown.reads('.assumed', said)
    shown.until('page.whatIf.map.record.temperature_degC === 50')
    wanted = {'quantity': 'efficiency', 'temperature_degC': 50, 'oil': 'ISO VG 46'}
    wait_for(lambda: wanted.items() <= greeted.requests[-1].items(), 'the oil')
    # A map of the present state does not take the place of the one that was asked for.
    greeted.send(*frames.map(temperature_degC=36.0))
    shown.until('page.axis.map.temperature_degC === 36')
    assert shown.text('.what-if h2') == 'Operating map at 50 °C'
    shown.button('.what-if', 'Back to now')
    shown.reads('.what-if h2', 'Operating map at 35 °C')
    assert shown.text('.assumed') == ''


def test_a_map_without_the_corrections_of_the_node_says_so(shown, greeted, frames):
    greeted.send(*frames.map(without=2))
    shown.reads('.assumed', 'This map still lacks corrections of the node: 2.')
    greeted.send(*frames.map(without=0))
    shown.reads('.assumed', '')


def test_a_pinned_place_is_read_solved_and_the_solve_cancelled(shown, greeted):
    assert shown.ask('page.whatIf.solve.disabled')
    shown.ask("""(() => {
        const { map } = page.whatIf;
        const box = map.canvas.getBoundingClientRect();
        map.canvas.dispatchEvent(new MouseEvent('click', {
          clientX: box.left + map.x(800), clientY: box.top + map.y(1200) }));
    })()""")
    shown.until('!page.whatIf.solve.disabled')
    greeted.answers['solve'] = lambda one: [
        ({'kind': 'progress', 'share': 0.4, 'words': 'rough contact'}, None)
    ]
    shown.button('.what-if', 'Solve the pinned place')
    shown.reads('.results', 'Solving, 40 % done. rough contact')
    solve = greeted.requests[-1]
    pixel = 0.05  # of the map, in speed and load
    assert [solve[key] for key in PLACE] == pytest.approx([800.0, 1200.0, 35.0], rel=pixel)

    def cancelled(request):
        refusal = {'kind': 'answer', 'id': request['solve'], 'ok': False, 'message': 'Cancelled.'}
        return [(refusal, None), ({'kind': 'answer', 'ok': True}, None)]

    greeted.answers['cancel'] = cancelled
    shown.button('.what-if', 'Cancel the solve')
    shown.reads('.results', 'Cancelled.')
    assert greeted.requests[-1]['solve'] == solve['id']
    greeted.answers['solve'] = lambda one: [
        (POINT | {'kind': 'answer', 'ok': True} | {key: one[key] for key in PLACE}, None)
    ]
    shown.button('.what-if', 'Solve the pinned place')
    point = 'optimal. Efficiency 93.1 %, contact 0.2 %, film ratio 2.13, torque 1.25 N m.'
    shown.until(f"""/^Solved: [.\\d]+ m.min .*: {point}$/.test(
        document.querySelector('.results').textContent)""")


def test_other_feeds_have_their_sentences_and_paths(shown, greeted):
    ghosts = [
        {'factor': factor, 'outside_share': 0.1 / factor, 'lost_J': 1500.0, 'duration_s': 120.0}
        | {'array': f'path{number}', 'words': ['beyond the surface', '', ''][number]}
        for number, factor in enumerate((0.8, 1.0, 1.2))
    ]
    paths = {f'path{number}': [100.0, 500.0, 300.0, 600.0] for number in range(3)}
    greeted.answers['ghosts'] = lambda one: [
        ({'kind': 'answer', 'ok': True, 'ghosts': ghosts}, paths)
    ]
    shown.button('.what-if', 'Try 80, 100 and 120 % feed')
    shown.until("document.querySelectorAll('.results p').length === 3")
    assert greeted.requests[-1]['factors'] == [0.8, 1.0, 1.2]
    assert shown.text('.results p') == (
        'At 80 % of the feed: 13 % of the motion outside the optimal zone, '
        '1.5 kJ lost to friction in 2:00. beyond the surface'
    )
    labels = shown.ask('page.whatIf.map.over.ghosts.map((one) => [one.label, [...one.points]])')
    assert labels == [[name, [100, 500, 300, 600]] for name in ('80 %', '100 %', '120 %')]


def test_a_refusal_is_said_and_a_missing_surface_too(tab, shown, greeted, frames):
    greeted.answers['ghosts'] = lambda one: [
        ({'kind': 'answer', 'ok': False, 'message': 'The axis has not moved yet.'}, None)
    ]
    shown.button('.what-if', 'Try 80, 100 and 120 % feed')
    shown.reads('.results', 'The axis has not moved yet.')
    words = 'The surface file is not on this machine.'
    greeted.send(*frames.hello(frames.axis(no_map=words), words=frames.words('en'), language='en'))
    shown.reads('.no-map', words)
    assert shown.ask("document.querySelectorAll('.what-if canvas').length") == 0
