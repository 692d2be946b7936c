# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page docs/theory/published_study.md: its claims against its rows, the rows against code."""

from pathlib import Path
import re

import pytest
from surrogate.commands.figures import DRAWS
from surrogate.paper.cases import NEEDS, StudyTask, tasks
from surrogate.paper.mark import Mark, table
from surrogate.paper.marks import marks
from surrogate.paper.rows import inputs_hash, read_rows
from surrogate.paper.solve import solve_task
from surrogate.parameters import load_lubricant, load_screw

TREE = Path(__file__).parents[3]
SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
ROWS = read_rows(TREE / 'test' / 'data' / 'paper.csv')
MARKS = marks(SCREW, ROWS)
PAGE = (TREE / 'docs' / 'theory' / 'published_study.md').read_text(encoding='utf-8')
LOADED, RELIEVED = 'RCS, loaded nut', 'RCS, relieved nut'
LAST = '2000 N less preload only'


def mark(start: str, *words: str) -> Mark:
    """Return the one number whose name begins so and holds all the words."""
    begun = [one for one in MARKS if one.name.startswith(start)]
    found = [one for one in begun if all(word in one.name for word in words)]
    assert len(found) == 1, f'{start} {words}: {[one.name for one in begun]}'
    return found[0]


def test_page_shows_the_numbers_of_its_rows():
    """The table of the page is what the command prints from the rows."""
    assert table(MARKS) in PAGE


def test_rows_are_those_of_the_default_run():
    """Every task once, all of the shipped datasheets, all converged."""
    assert {row.key for row in ROWS.values()} == {task.key for task in tasks(tuple(NEEDS), DRAWS)}
    assert {row.inputs for row in ROWS.values()} == {inputs_hash(SCREW, OIL)}
    assert {row.status for row in ROWS.values()} == {'CONVERGED'}


def number(start: str, *words: str, digits: int = 2) -> str:
    """Return the value of a number as text."""
    return f'{mark(start, *words).value:.{digits}f}'


def percent(start: str, *words: str) -> str:
    """Return by how many percent a ratio differs from one."""
    return f'{abs(100 * mark(start, *words).value - 100):.0f} %'


@pytest.mark.parametrize(
    'words',
    [
        f'In all {len(ROWS)} solves',
        f'{sum(row.seconds for row in ROWS.values()):.0f} s of processor time',
        f'from 2 to {number("speed of the least torque", digits=0)} rev/min',
        f'to {number("torque at 1000", digits=1)} times the least',
        f'{100 * mark("rolling share").value:.0f} % of the torque at 600',
        f'central film {number("central film, smooth, 502.65", digits=1)} nm smooth',
        f'falls by {percent("central film, smooth, loaded")} to 2400 N',
        f'by {percent("central film, smooth, relieved")} to 2000 N',
        f'by {percent("RCS of the relieved nut")} at 5 rev/min and 2400 N',
        f'{number("RCS at 5 rev/min")} at 5, {number("RCS at 12 rev/min", digits=3)} at 12, '
        f'{number("RCS at 40 rev/min", digits=5)} at 40 rev/min',
        f'falls from {number("friction coefficient", ", 2 rev", digits=3)} at 2 to '
        f'{number("friction coefficient", ", 25 rev", digits=4)} at 25 rev/min',
        f'falls to {number("least coefficient", digits=3)} at 16 rev/min and rises to '
        f'{number("that coefficient", digits=1)} times that',
        f'passes 0.01 at {number("speed where RCS", "worst", digits=0)} rev/min, film ratio '
        f'{number("film ratio there")}',
        f'rises to {number("best efficiency", digits=3)} at 15 rev/min and then falls to '
        f'{number("efficiency, 1000 rev", digits=3)} at 1000',
        f'0.85 takes {number("least load", "15 rev", digits=0)} N at 15 rev/min and '
        f'{number("least load", "1000 rev", digits=0)} N at 1000',
        f'passes 0.01 at {number("speed where RCS", "80 degC", digits=0)} rev/min | film of '
        f'{number("central film, smooth, oil at 80", digits=0)} nm',
        f'passes 0.01 at {number("speed where RCS", "floor", digits=0)} rev/min; waves',
        f'rises with load, by {100 * mark("central film, inlet", "2400 N").value - 100:.1f} %',
        f'sliding {percent("sliding torque with the central film")} larger',
        f'{number("torque of friction along the track over ours", digits=1)} times the torque, '
        f'{number("torque of friction along the track over our sl", digits=0)} times its sliding',
    ],
)
def test_sentences_have_the_numbers_of_the_table(words):
    """As the page prints them."""
    assert words in ' '.join(PAGE.split())


def test_every_picture_is_there_and_small():
    """Each picture of the page is a small PNG, and each in the folder is on the page."""
    pictures = TREE / 'docs' / 'pictures'
    shown = set(re.findall(r'\]\(\.\./pictures/(paper_\w+\.png)\)', PAGE))
    assert shown == {path.name for path in pictures.glob('paper_*.png')}
    assert len(shown) == 11
    assert all((pictures / name).stat().st_size < 300_000 for name in shown)


def test_film_is_that_of_the_study():
    """Smooth within 1 %, the mean of rough draws within two standard errors of 153 nm."""
    assert mark('central film, smooth, 502.65').value == pytest.approx(153.0, rel=0.01)
    rough = mark('mean film of the inner half', '502.65')
    assert 0 < rough.error < 8
    assert abs(rough.value - 153.0) < 2 * rough.error


def test_torque_falls_then_rises():
    """An interior least, but below the expected 30 rev/min; both ends are far above it."""
    assert 8 <= mark('speed of the least torque').value < 30
    assert mark('torque at 2 rev/min').value > 2
    assert mark('torque at 1000 rev/min over').value > 3
    assert mark('rolling share').value > 0.7


def test_sliding_friction_hardly_rises():
    """It falls to a quarter, rises by a few percent and falls again; with rolling it rises."""
    slow, low, high, fast = (
        mark('friction coefficient of the sliding', f', {rpm} rev/min').value
        for rpm in (2, 25, 200, 1000)
    )
    assert slow > 4 * low
    assert 1.01 * low < high < 1.06 * low
    assert fast < 0.98 * high
    assert 8 <= mark('speed of the least coefficient').value < 30
    assert mark('that coefficient at 1000 rev/min').value > 3


def test_rcs_falls_with_speed():
    """Between 5, 12 and 40 rev/min by more than three standard errors, from above the limit."""
    slow, edge, clear = (mark(f'RCS at {rpm} rev/min') for rpm in (5, 12, 40))
    assert slow.value > 0.3
    assert slow.value - edge.value > 3 * (slow.error + edge.error)
    assert edge.value > 0.01 > 1e-3 > clear.value
    assert edge.value - clear.value > 3 * edge.error


def test_rcs_does_not_rise_with_load_in_the_loaded_nut():
    """Within the error at 5 rev/min, a fall at 12."""
    inside, edge = (mark(LOADED, f' {rpm} rev/min, {LAST}') for rpm in (5, 12))
    assert abs(inside.value) < 2 * inside.error < 0.1
    assert edge.value < -2 * edge.error < 0


def test_rcs_of_the_relieved_nut():
    """No change within the error up to 2000 N; near its unloading it rises, the other does not."""
    for load in (1000, 2000):
        moved = mark(RELIEVED, f'{load} N less')
        assert abs(moved.value) < 2 * moved.error < 0.05
    loaded, relieved = (mark(f'RCS of the {nut} nut').value for nut in ('loaded', 'relieved'))
    assert 0.9 < loaded < 1.1
    assert relieved > 1.3


def test_asperity_load_moves_to_the_centre():
    """By more than two standard errors at both loads."""
    for load in (1000, 2000):
        moved = mark('distance of the asperity load', f'{load} N less')
        assert moved.value < -2 * moved.error < 0


def test_film_falls_weakly_with_load():
    """By less than 10 % in the loaded nut; the relieved one gains."""
    assert 0.9 < mark('central film, smooth, loaded nut').value < 0.98
    assert mark('central film, smooth, relieved nut').value > 1.05
    rough = mark('mean film of the inner half', LAST)
    assert rough.value < -2 * rough.error < 0


def test_what_makes_the_film_rise_with_load():
    """A short inlet does; so does one node of a rough film, in some draws."""
    short = 'central film, inlet of 1.5 half-widths'
    assert mark(short, 'Pa s, preload').value == pytest.approx(153.0, rel=0.01)
    assert mark(short, '2400 N over').value > 1.05
    assert mark('film at the very centre', 'lowest draw').value < 0.95
    assert mark('film at the very centre', 'highest draw').value > 1.1


def test_efficiency_falls_where_the_study_has_it_rise():
    """Best below 30 rev/min, several points lower at 1000 rev/min; rolling is the reason."""
    assert 8 <= mark('speed of the best efficiency').value < 30
    best, fast = mark('best efficiency').value, mark('efficiency, 1000 rev/min').value
    assert fast < best - 0.05
    slow, bare, quick = (
        mark(f'efficiency without rolling, {rpm} rev/min').value for rpm in (5, 15, 1000)
    )
    assert bare > slow + 0.01
    assert abs(quick - bare) < 0.003
    assert quick > fast + 0.05


def test_efficiency_is_above_constant_friction():
    """At every one of the points of the map, by little at the least."""
    least = mark('efficiency less that of constant friction')
    assert 0.003 < least.value < 0.05
    assert '42 points, at 1000 rev/min, 50 N' in least.name
    loads = [mark('least load for efficiency', f'{rpm} rev/min').value for rpm in (15, 1000)]
    assert 50 < loads[0] < 150 < 400 < loads[1] < 700


def test_statistical_contact_makes_efficiency_rise():
    """At every step up to 1000 rev/min, where its share still is above the limit."""
    assert mark('efficiency, statistical share', 'least step').value > 1e-4
    first, last = (
        mark('efficiency, statistical share', f', {rpm} rev/min').value for rpm in ('2', '1000')
    )
    assert last > first + 0.03
    assert mark('statistical share at 1000').value > 0.01
    assert mark('statistical share, loaded nut').value > 1.1


def test_contact_at_higher_speeds():
    """Thin oil and a high floor each move the onset by more than two."""
    ours = mark('speed where RCS passes', 'worst of four').value
    assert 8 < ours < 30
    assert mark('speed where RCS passes', 'oil at 80').value > 2 * ours
    assert mark('speed where RCS passes', 'floor 10 nm').value > 2 * ours
    assert 0.05 < mark('film ratio there').value < 0.15
    assert mark('central film, smooth, oil at 80').value < 0.6 * 153


def test_other_rules_of_friction():
    """The central film changes sliding by a few percent; friction along the track is no rule."""
    assert 1.01 < mark('sliding torque with the central film').value < 1.08
    assert mark('torque of friction along the track over ours').value > 5
    assert mark('torque of friction along the track over our sliding').value > 30


@pytest.mark.parametrize(
    ('task', 'columns', 'tolerance'),
    [
        (
            StudyTask(kind='contact', rpm=600.0, load=2400.0),
            ('central_film', 'minimum_film'),
            2e-3,
        ),
        (
            StudyTask(kind='contact', rpm=600.0, load=2400.0, case='short inlet'),
            ('central_film', 'max_pressure'),
            2e-3,
        ),
        (
            StudyTask(kind='contact', rpm=12.0, load=0.0, draw=3),
            ('rcs', 'asperity_share', 'asperity_distance', 'mean_film'),
            0.02,
        ),
        (
            StudyTask(kind='contact', rpm=12.0, load=1000.0, draw=1, case='relieved nut'),
            ('rcs', 'mean_film'),
            0.02,
        ),
        (
            StudyTask(kind='screw', rpm=1000.0, load=1000.0, draw=0),
            ('friction_torque', 'sliding_torque', 'track_torque', 'central_film'),
            5e-3,
        ),
        (
            StudyTask(kind='screw', rpm=12.0, load=0.0, draw=1),
            ('friction_torque', 'friction_coefficient', 'rcs', 'asperity_coefficient'),
            0.02,
        ),
        (
            StudyTask(kind='formulas', rpm=600.0, load=2400.0),
            ('rcs_loaded', 'friction_torque'),
            1e-4,
        ),
    ],
    ids=lambda value: value.key if isinstance(value, StudyTask) else '',
)
def test_rows_are_what_the_code_solves(task, columns, tolerance):
    """One row of every kind, solved again; none of the compared numbers is zero."""
    kept = ROWS[task.key]
    row, _ = solve_task(SCREW, OIL, task, kept.inputs)
    assert row.status == kept.status
    for name in columns:
        assert getattr(kept, name) > 0
        assert getattr(row, name) == pytest.approx(getattr(kept, name), rel=tolerance), name
