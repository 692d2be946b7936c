# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Progress: rate, time left, a bar on a terminal and few lines elsewhere."""

import io
import itertools
import sys

import pytest
from surrogate.tasks.progress import bar, Progress


class Terminal(io.StringIO):
    """A stream that says that it is a terminal."""

    def isatty(self):
        return True


def run(stream, total, seconds, there=0):
    """Do all steps, each of them `seconds` after the one before."""
    now = [0.0]
    progress = Progress(total, 'solves', stream=stream, clock=lambda: now[0])
    for number in range(total):
        now[0] += 0.0 if number < there else seconds
        progress.step(there=number < there)
    return stream.getvalue()


def test_a_bar_is_full_only_at_the_end():
    """Its length never changes, whatever the share."""
    assert [bar(share, 4, blank='.') for share in (-1.0, 0.0, 0.5, 0.99, 1.0, 2.0)] == [
        '....',
        '....',
        '##..',
        '###.',
        '####',
        '####',
    ]
    assert bar(0.25, 4) == '#   '


def test_a_terminal_gets_a_bar_with_rate_and_time_left():
    """One line that is written over; the last one ends."""
    lines = run(Terminal(), 4, 30.0).split('\r')[1:]
    assert len(lines) == 4
    assert lines[0].startswith('[' + 10 * '#' + 30 * ' ' + '] 1/4 solves, 30 s each, 2 min left')
    assert '3/4 solves, 30 s each, 30 s left' in lines[2]
    assert lines[3].endswith('\n')
    assert lines[3].startswith('[' + 40 * '#' + ']')


def test_a_log_gets_a_line_per_tenth_or_minute():
    """A thousand fast steps are ten lines; of slow ones no silence is longer than 80 s."""
    lines = run(io.StringIO(), 1000, 0.01).splitlines()
    assert len(lines) == 10
    assert lines[0] == '100/1000 solves, 100 per s, 9 s left'
    assert lines[-1].startswith('1000/1000 solves')
    expected = '3/1000 solves, 4 s each, 66 min left'
    assert run(io.StringIO(), 1000, 4.0).splitlines()[0] == expected


def test_a_log_hears_of_work_that_goes_on_after_10_s_of_silence():
    now, stream = [0.0], io.StringIO()
    progress = Progress(3, 'solves', stream=stream, clock=lambda: now[0])
    for now[0], lines in ((9.9, 0), (10.0, 1), (19.9, 1), (20.0, 2)):
        progress.beat()
        assert stream.getvalue().count('\n') == lines
    quiet = Terminal()
    Progress(3, 'solves', stream=quiet, clock=itertools.count(0.0, 10.0).__next__).beat()
    assert quiet.getvalue() == ''


def test_what_was_there_does_not_count_for_the_rate():
    """Two kept results of four, the others 10 s each."""
    lines = run(Terminal(), 4, 10.0, there=2).split('\r')[1:]
    assert '2/4 solves\x1b[K' in lines[1]
    assert '3/4 solves, 10 s each, 10 s left' in lines[2]


def test_work_may_grow():
    """A builder that refines adds what it has found to do."""
    stream = io.StringIO()
    progress = Progress(1, 'solves', stream=stream, clock=lambda: 0.0)
    progress.add(1)
    progress.step()
    assert stream.getvalue() == '1/2 solves\n'


def test_steps_that_differ_tell_their_share():
    """A quarter of the work in 10 s leaves 30 s, whatever the number of steps; notes come last."""
    stream, now = Terminal(), [0.0]
    progress = Progress(0, 'solves', stream=stream, clock=lambda: now[0])
    now[0] = 5.0
    progress.show(0, 8)
    now[0] = 15.0
    progress.show(3, 8, share=0.25, note='screw 5 rev/min 50 N')
    line = stream.getvalue().removeprefix('\r').removesuffix('\x1b[K')
    assert line.startswith('[##########' + 30 * ' ' + '] 3/8 solves, 3.3 s each, 30 s left')
    assert line.endswith(', screw 5 rev/min 50 N')


def test_work_that_ends_early_ends_its_line():
    """Once, on a terminal alone, and not after the last step, which has ended it."""
    for stream, done, expected in (
        (Terminal(), 2, True),
        (Terminal(), 4, False),
        (Terminal(), 0, False),
        (io.StringIO(), 1, False),
    ):
        progress = Progress(4, 'steps', stream=stream)
        for _ in range(done):
            progress.step()
        before = stream.getvalue()
        progress.close()
        assert (stream.getvalue() == before + '\n') is expected


@pytest.mark.parametrize(
    ('stream', 'expected', 'lines'),
    [
        (Terminal(), '\r[##########' + 30 * ' ' + '] 0/2 steps, 30 s left\x1b[K', 2),
        (io.StringIO(), '0/2 steps, 30 s left\n', 1),
    ],
)
def test_the_first_step_shows_how_far_it_is(stream, expected, lines):
    """A long step before the first is done: the bar grows, and so does a log, by tenths."""
    now = [0.0]
    progress = Progress(2, 'steps', stream=stream, clock=lambda: now[0])
    now[0] = 10.0
    progress.show(0, 2, share=0.25)
    assert stream.getvalue() == expected
    progress.show(0, 2, share=0.3)
    assert stream.getvalue().count('0/2') == lines
    progress.close()
    assert stream.getvalue().endswith('\n')


def refuse(text):
    raise BrokenPipeError


@pytest.mark.parametrize('kind', [Terminal, io.StringIO])
def test_what_nobody_can_see_does_not_end_the_work(monkeypatch, kind):
    """Whoever reads has gone, or was never there; nothing is shown in another place."""
    stream = kind()
    monkeypatch.setattr(stream, 'write', refuse)
    progress = Progress(4, 'steps', stream=stream)
    progress.step()
    progress.close()
    monkeypatch.setattr(sys, 'stderr', None)
    monkeypatch.setattr(sys, 'stdout', io.StringIO())
    progress = Progress(1, 'steps')
    progress.step()
    progress.close()
    assert sys.stdout.getvalue() == ''
