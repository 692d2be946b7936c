# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page in a browser: charts are drawn, nothing fails, hostile names stay text, it prints."""

import html
import re

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.recordings.summary import RunRecord
from ballscrew_monitor.report.log_page import report_page
from ballscrew_monitor.report.page import CHARTS
import pytest

HOSTILE = '</script><script>document.body.dataset.errors = 1</script><img src=x onerror=alert(1)>'


@pytest.fixture(scope='module')
def written(judged, tmp_path_factory):
    """Return a page of two axes, one with a torque, with hostile names, and its text."""
    events = [judged.event(1, 10.0, 5.0, advice=HOSTILE)]
    values = judged.values('y', **{'y.torque.topic': HOSTILE, 'y.torque.field': 'data'})
    torque = {'motor_torque': 1.6, 'motor_torque_source': 1, 'axis': 'y'}
    assumptions = {HOSTILE: {'value': HOSTILE, 'reason': HOSTILE}}
    known = {'assumed': assumptions, 'load_from': HOSTILE}
    axes = [
        judged.case([judged.rows(count=20_000)], events, known=known),
        judged.case([judged.rows(count=500, **torque)], values=values),
    ]
    named = {'name': HOSTILE, 'parameters': HOSTILE, 'notes': [HOSTILE]}
    text = report_page(judged.log(*axes, empty=['z'], assumptions=assumptions, **named))
    path = tmp_path_factory.mktemp('page') / 'report.html'
    path.write_text(text)
    return path, text


def test_hostile_names_are_text_the_verdict_comes_first_and_what_was_assumed_is_tagged(written):
    _, text = written
    assert HOSTILE not in text
    assert html.escape(HOSTILE) in text
    assert text.count('<script') == text.count('</script') == len(CHARTS) + 1
    main = written[1].partition('<main>')[2]
    assert re.findall(r'<strong>([^<]*)</strong>', main) == ['Outside:', 'Good:', 'Not known:']
    assert main.index('class="verdict') < main.index('class="map"')
    assert '<span class="tag assumed">assumed</span>' in written[1]


def test_a_load_that_was_worked_out_is_not_called_measured(judged, says):
    known = {'load_from': 'current', 'assumed': {'screw': {'value': 'nominal', 'reason': 'usual'}}}
    values = judged.values(**{'x.temperature.topic': ''})
    case = judged.case([judged.rows()], values=values, known=known)
    text = report_page(judged.log(case))
    assert says('assumed_neither_measured') in text
    assert says('oil_temperature_40') in text
    row = text.partition('<td>Axial load</td>')[2].partition('</tr>')[0]
    assert says('span_class_tag') in row
    screw = text.partition('<td>Screw</td>')[2].partition('</tr>')[0]
    assert '<span class="tag assumed">assumed</span>' in screw


def test_where_all_is_known_there_is_no_caution_and_long_tables_are_cut(judged):
    text = report_page(judged.log(judged.case([judged.rows()])))
    assert 'Assumed, neither' not in text
    events = [judged.event(number + 1, 0.1 * number, 0.05) for number in range(1200)]
    case = judged.case([judged.rows(count=100)], events)
    text = report_page(judged.log(case))
    assert 'The worst 1000 of 1200 are shown.' in text
    assert text.count('<tr data-begin') + text.count('<tr class="bad" data-begin') == 1000


@pytest.mark.parametrize('advice', ['', 'at this load run at 573 rev/min'])
def test_a_warning_says_where_it_was_worst_and_what_to_do_if_that_is_advised(judged, advice):
    case = judged.case([judged.rows()], [judged.event(1, 0.1, 0.2, advice=advice)])
    text = report_page(judged.log(case))
    table = text.partition('Warnings: 1')[2].partition('</table>')[0]
    assert '<td>430 rev/min and -1200 N</td>' in table
    assert ('What to do' in table) == (f'<td>{advice}</td>' in table) == bool(advice)
    assert ('What to do: as in warning 1' in text) == bool(advice)


def test_charts_are_drawn_without_an_error(written, browse):
    dom = browse(written[0], '--dump-dom')
    body = re.search(r'<body[^>]*>', dom)[0]
    assert 'data-ready="true"' in body
    assert 'data-errors=""' in body
    # A map, the bars and the panels of each axis: six, and one more for the torque.
    assert 'data-charts="17"' in body
    assert 'every sample around the worst warning.' in dom


def test_a_page_of_a_feed_axis_speaks_of_feeds(judged, tmp_path, browse):
    """In verdict, tiles, warnings and chart, without an error; where contact begins is said."""
    values = judged.values(**{'x.speed.unit': 'mm/min'})
    case = judged.case([judged.rows(count=2000)], [judged.event(1, 1.0, 2.0)], values=values)
    path = tmp_path / 'feed.html'
    path.write_text(report_page(judged.log(case)))
    dom = browse(path, '--dump-dom')
    assert 'data-errors=""' in re.search(r'<body[^>]*>', dom)[0]
    verdict = dom.partition('class="verdict')[2].partition('</div>')[0]
    assert case.contact in html.unescape(verdict)
    assert ' m/min, ' in case.contact
    assert 'travelled, 99.95 revolutions' in dom
    assert '<td>4.3 m/min, 430 rev/min and -1200 N</td>' in dom
    assert '<td>at this load run at 5.73 m/min, 573 rev/min</td>' in dom
    assert 'Feed [m/min]' in dom


def test_a_click_on_a_warning_leads_to_it_and_one_on_a_head_sorts(judged, tmp_path, browse):
    events = [judged.event(1, 10.0, 2.0), judged.event(2, 50.0, 5.0)]
    case = judged.case([judged.rows(count=20_000)], events)
    text = report_page(judged.log(case))
    script = """<script>
      document.querySelectorAll('table.leading tr[data-begin]')[1].click();
      document.querySelectorAll('table.leading th')[2].click();
      document.querySelectorAll('table.leading th')[2].click();
      document.querySelector('.controls button:nth-child(2)').click();
    </script>"""
    # A script that is not ours may not run where the policy of the page holds.
    for name, held in (('held.html', True), ('open.html', False)):
        page = text.replace('</body>', f'{script}</body>')
        if not held:
            page = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', '', page)
        (tmp_path / name).write_text(page)
    held = browse(tmp_path / 'held.html', '--dump-dom')
    assert 'Shown: 0.0 s to 3:20.0' in held
    dom = browse(tmp_path / 'open.html', '--dump-dom')
    # Its row shows 49 to 56 s; half of that after one step in.
    assert 'Shown: 50.750 s to 54.250 s' in dom
    assert 'data-errors=""' in re.search(r'<body[^>]*>', dom)[0]
    rows = re.findall(r'<tr[^>]*data-begin="([\d.]+)"', dom)
    assert [float(begin) for begin in rows] == [49.0, 9.0]


def test_a_table_that_is_wider_than_the_screen_says_that_it_scrolls(written, browse):
    def told(width):
        window = f'--window-size={width},900'
        return browse(written[0], '--dump-dom', window).count('wide cut')

    assert told(500)
    assert not told(1200)


def test_it_prints(written, tmp_path, browse):
    paper = tmp_path / 'report.pdf'
    browse(written[0], f'--print-to-pdf={paper}')
    assert paper.read_bytes().startswith(b'%PDF')


def test_columns_of_inputs_are_those_that_say_something(judged):
    def page_of(**changes):
        inputs = tuple(judged.status(source, **changes) for source in Source)
        case = judged.case([judged.rows()], inputs=inputs)
        return report_page(judged.log(case))

    assert 'Left out' not in page_of()
    late = page_of(lag=0.3)
    assert 'Stamps behind arrival' in late
    assert '0.3 s' in late
    assert 'Lost on the way' not in late


def test_each_run_has_a_row_and_a_warning_that_ended_with_one_says_so(judged):
    runs = [
        RunRecord(
            number=number,
            first=judged.begin + number * SECOND if number < 3 else 0,
            last=judged.begin + (number + 1) * SECOND if number < 3 else 0,
            running_time=0.9,
            unjudged_time=0.0,
            optimal_time=0.7,
            outside_time=0.2,
            revolutions=12.0,
            warnings=1,
        )
        for number in (1, 2, 3)
    ]
    events = [judged.event(1, 0.5, 0.3, run_ended=True)]
    case = judged.case([judged.rows(count=301)], events, runs=tuple(runs))
    text = report_page(judged.log(case))
    assert '0.3, the run ended' in text
    table = text.partition('Runs: 3')[2].partition('</table>')[0]
    assert table.count('<tr data-begin') == 2
    assert table.count('12 revolutions; optimal 0.7 s, outside 0.2 s, unjudged 0.0 s') == 2
    assert 'no usable sample' in table
    assert 'Runs: ' not in report_page(judged.log(judged.case([judged.rows()])))
