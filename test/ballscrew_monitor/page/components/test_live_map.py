# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The map shows zone or a quantity, two fogs apart, and can be read by pointer and by keys."""

import pytest

MAP = 'page.whatIf.map'


@pytest.fixture
def shown(tab, greeted):
    tab.visit(greeted.url)
    tab.until("document.querySelector('.over')?.height > 150")
    tab.until(f'{MAP}.area')
    return tab


def pixel(tab, speed, load):
    """Return the colour of the map at a place, of the lower canvas."""
    return tab.ask(f"""(() => {{
        const [x, y] = [{MAP}.x({speed}), {MAP}.y({load})].map((one) => one * devicePixelRatio);
        return [...{MAP}.pen.getImageData(x, y, 1, 1).data];
    }})()""")


def test_stretches_are_between_breaks(shown):
    cases = [
        ('1,2,3,4', [[0, 4]]),
        ('1,2,NaN,NaN,3,4', [[0, 2], [4, 6]]),
        ('NaN,NaN', [[0, 0], [2, 2]]),
    ]
    for points, stretches in cases:
        assert shown.ask(f'LiveMap.stretches([{points}])') == stretches


@pytest.mark.parametrize('scale', ['log', 'linear'])
def test_a_place_comes_back_on_either_scale(shown, greeted, frames, scale):
    record, arrays = frames.map()
    greeted.send(record | {'speed': record['speed'] | {'scale': scale}}, arrays)
    shown.until(f"{MAP}.record.speed.scale === '{scale}'")
    found = shown.ask(f"""(() => {{
        const [x, y] = [{MAP}.x(400), {MAP}.y(1000)];
        const box = {MAP}.canvas.getBoundingClientRect();
        const at = {MAP}.place({{ clientX: box.left + x, clientY: box.top + y }});
        return [at.speed, at.load];
    }})()""")
    assert found == pytest.approx([400.0, 1000.0])


def test_the_two_bands_of_the_limit_are_never_one(shown):
    """The limit at 290 rev/min has a band of 40 % for what is not known, of 7 % for numerics."""
    inside, both, outside = (pixel(shown, speed, 2000.0) for speed in (200.0, 278.0, 60.0))
    assert outside[3] == 0  # paper shows through
    assert 0 < inside[3] < both[3]


def test_inside_and_outside_of_the_zone_differ_in_every_view(shown, greeted, frames):
    def answer(request):
        record, arrays = frames.map(quantity=request['quantity'])
        return [(record | {'kind': 'answer', 'ok': True}, arrays)]

    greeted.answers['map'] = answer
    assert pixel(shown, 1000.0, 1500.0)[3] == 255
    for quantity in ('efficiency', 'rcs', 'film_ratio'):
        shown.ask(f"""(() => {{
            const select = document.querySelector('.what-if select');
            select.value = '{quantity}';
            select.dispatchEvent(new Event('change'));
        }})()""")
        shown.until(f"{MAP}.record.quantity === '{quantity}'")
        shown.until("document.querySelector('.sample-hatched')")
        assert greeted.requests[-1]['quantity'] == quantity
    shown.until("document.querySelector('.sample-ramp-film_ratio') !== null")


def test_keys_move_the_pinned_place_and_read_it(shown, greeted, wait_for):
    greeted.answers['read'] = lambda one: [
        (
            {'kind': 'answer', 'ok': True, 'zone': 'optimal', 'efficiency': 0.93, 'rcs': 0.002}
            | {'film_ratio': 2.1, 'torque_N_m': 1.2, 'words': ''}
            | {key: one[key] for key in ('speed_rpm', 'load_N', 'temperature_degC')},
            None,
        )
    ]
    shown.ask(f'{MAP}.canvas.focus()')
    assert shown.ask(f'document.activeElement === {MAP}.canvas')
    for key in ('ArrowRight', 'ArrowRight', 'ArrowUp'):
        shown.press(key)
    shown.until(f'Math.abs({MAP}.over.pinned.up - 0.52) < 1e-9')
    assert shown.ask(f'{MAP}.over.pinned.across') == pytest.approx(0.54)
    expected = shown.ask(f'{MAP}.point(0.54, 0.52)')
    wait_for(lambda: greeted.requests and greeted.requests[-1]['load_N'] == expected['load'])
    assert greeted.requests[-1]['speed_rpm'] == pytest.approx(expected['speed'])
    shown.until("document.querySelector('.map .readout').textContent.includes('Efficiency 93 %')")
    assert 'optimal' in shown.text('.map .readout')
    assert shown.ask("document.querySelector('.map .readout').ariaLive") == 'polite'
