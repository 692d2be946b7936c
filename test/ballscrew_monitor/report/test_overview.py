# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page over recordings: rows by date, a trend where there is one, bad ones named."""

import dataclasses
import math
import re

from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.health.assess import DRAG
from ballscrew_monitor.health.records import Condition, Health, Quantity, UsualWarning
from ballscrew_monitor.report import overview
from ballscrew_monitor.report.log_report import AxisLine, LogResult
from ballscrew_monitor.report.overview import overview_page, with_usual

DAY = 86400.0
HOSTILE = '</script><script>alert(1)</script>'


def make_entry(name, day, outside, *, axis='x'):
    line = AxisLine(
        axis=axis,
        standing='bad' if outside else 'good',
        verdict='Outside: it was.',
        begins=1_767_600_000.0 + DAY * day,
        recorded=3600.0,
        running_time=1800.0,
        outside_time=outside,
        warnings=int(outside > 0),
        worst='RCS 0.5' if outside else '',
        depth=0.5,
    )
    return LogResult(name=name, folder=name, lines=[line])


def rows_of(page):
    return re.findall(r'<td[^>]*><a href="([^"]*)">', page)


def test_rows_are_in_the_order_of_their_dates():
    page = overview_page([make_entry('late', 9, 18.0), make_entry('early', 1, 0.0)])
    assert rows_of(page) == ['early/report.html', 'late/report.html']
    assert '1 of 2 axis recordings ran outside' in page
    assert '2026-01-14' in page


def test_the_verdict_comes_first_and_stays_in_sight_on_a_phone(browse, tmp_path):
    """Where the table goes on beyond the screen, also after it was moved to its end."""
    page = overview_page([make_entry('a_recording_with_a_long_name', 1, 18.0)])
    assert re.search(r'<th scope="col">([^<]*)', page)[1] == 'Verdict'
    script = """<script>
      const wide = document.querySelector('table.verdicts').parentElement;
      wide.scrollLeft = 1e4;
      const cell = wide.querySelector('td').getBoundingClientRect();
      document.body.dataset.seen = [wide.scrollLeft > 0, Math.round(cell.left)];
    </script>"""
    path = tmp_path / 'index.html'
    path.write_text(
        re.sub('<meta http-equiv[^>]*>', '', page).replace('</body>', f'{script}</body>')
    )
    dom = browse(path, '--dump-dom', '--window-size=500,800')
    scrolled, left = re.search(r'data-seen="([^"]*)"', dom)[1].split(',')
    assert scrolled == 'true'
    assert 0 <= int(left) < 20


def test_times_and_shares_read_as_a_person_would_say_them():
    page = overview_page([make_entry('a', 1, 0.0)])
    assert '<td class="short" data-value="3600.0">60 min</td>' in page
    assert '<td class="short" data-value="1800.0">30 min</td>' in page
    assert '[-]' not in page
    entries = [make_entry('a', 0, 1790.46), make_entry('b', 1, math.nan)]
    page = overview_page(entries)
    assert '>99.5</td>' in page
    assert '>–</td>' in page
    assert page.count('<circle') == 0


def test_a_trend_has_a_point_for_each_date_and_one_date_is_none():
    page = overview_page(
        [make_entry('a', 0, 18.0), make_entry('b', 3, 36.0), make_entry('c', 5, 9.0)]
    )
    assert page.count('<circle') == 3
    assert 'the highest point is 2 %' in page
    page = overview_page([make_entry('a', 0, 18.0), make_entry('b', 1, 18.0, axis='y')])
    assert '<circle' not in page


def test_recordings_that_could_not_be_read_are_named_as_text():
    bad = LogResult(name=HOSTILE, folder='bad', failure=f'bag {HOSTILE} is damaged')
    page = overview_page([bad])
    assert HOSTILE not in page
    assert page.count('alert(1)') == 2
    assert '1 recording could not be read' in page
    assert not bad.judged


def test_what_is_not_known_is_a_dash():
    line = AxisLine(axis='x', standing='unknown', verdict='nothing was judged')
    page = overview_page([LogResult(name='a', folder='a', lines=[line], unjudged=['x'])])
    assert 'nan' not in page.partition('<tbody>')[2].partition('</tbody>')[0].replace(
        'data-value="NaN"', ''
    )
    assert '1 could not be judged' in page


def test_usual_warnings_are_counted_apart_and_grey(monkeypatch):
    """A recording of whose warnings all are usual is neither good nor bad."""
    known = UsualWarning(Code.RCS_HIGH, 3, -8, 1)
    health = Health(
        axis='x',
        stamp=0,
        condition=Condition.NORMAL,
        verdict='Normal.',
        quantities=[Quantity(name=DRAG)],
        usual_warnings=(known,),
    )
    entries = []
    for name, places in (('all', [known, known]), ('some', [known, known._replace(direction=-1)])):
        entry = make_entry(name, len(name), 18.0)
        (line,) = entry.lines
        # As JSON of a worker leaves them.
        line = dataclasses.replace(line, warnings=2, places=[list(place) for place in places])
        entries.append(dataclasses.replace(entry, lines=[line]))
    courses = {line.key: [health] for entry in entries for line in entry.lines}
    monkeypatch.setattr(overview, '_courses', lambda entries: courses)
    page = overview_page(entries)
    assert '1 of 2 axis recordings ran outside the optimal zone' in page
    assert ', 1 as usual for their axis, ' in page
    assert '<span class="tag usual">Usual</span>' in page
    assert [page.count(text) for text in ('>2, usual 2<', '>2, usual 1<')] == [1, 1]
    assert page.count('class="usual"') == 1
    (whole,), (part,) = (entry.lines for entry in with_usual(entries))
    assert (whole.standing, part.standing) == ('usual', 'bad')
    usual = 'Usual for this axis, as its baseline had them: 1 of 2 warnings.'
    assert part.told == f'{part.verdict} {usual}'
    courses.clear()
    assert [line.usual for entry in with_usual(entries) for line in entry.lines] == [0, 0]
