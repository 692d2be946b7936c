# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew solve` as the console script, beside a node that is started plainly."""

import json
import os
from pathlib import Path
import signal
import subprocess
import sys
from types import SimpleNamespace

from ballscrew_monitor.clients import solve
from ballscrew_monitor.clients.solve import _Conversation, goal_of
import pytest
from rclpy.task import Future
from surrogate.tasks.child import one_thread_environment

SCRIPT = Path(sys.executable).with_name('ballscrew')
DEADLINE = 600.0  # [s] which only ends a hang
PATIENT = ('--wait', str(DEADLINE), '--timeout', str(DEADLINE))
SIGNS = (955.0, -500.0), (-955.0, -500.0)  # [rev/min], [N]: the load drives, it opposes
# Hot oil and hardly any speed: seconds.
LONG = ('--speed-rpm', '0.5', '--load-N', '2600', '--temperature-degC', '80')
# What `ballscrew point` says of the same points, on one thread as the node solves.
POINTS = (
    'import sys\n'
    'from ballscrew_monitor.cli import main\n'
    'for place in sys.argv[1:]:\n'
    "    speed, load = place.split(',')\n"
    "    options = ['--tier', 'full', '--json', '--temperature-degC', '40']\n"
    "    main(['point', f'--speed-rpm={speed}', f'--load-N={load}', *options])\n"
    "    print('end of a point')\n"
)


def begin(node, *arguments):
    """Start the command in the domain of a node, for which it waits unless told otherwise."""
    return subprocess.Popen(
        [SCRIPT, 'solve', *PATIENT, *map(str, arguments)],
        env=node.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def end(process):
    out, err = process.communicate(timeout=DEADLINE)
    return process.returncode, out, err


def ask(node, *arguments):
    return end(begin(node, *arguments))


def said(node, words):
    return words in node.output.read_text()


def test_signs_of_speed_and_load_are_those_of_point(node):
    reference = subprocess.Popen(
        [sys.executable, '-c', POINTS, *(f'{speed},{load}' for speed, load in SIGNS)],
        env=one_thread_environment(),
        stdout=subprocess.PIPE,
        text=True,
    )
    node.start(x__correct_surface=False)
    found = []
    for speed, load in SIGNS:
        place = (f'--speed-rpm={speed}', f'--load-N={load}', '--temperature-degC=40')
        code, out, err = ask(node, '--axis', 'x', *place, '--json')
        assert (code, err) == (0, '')
        found.append(json.loads(out))
    texts = reference.communicate(timeout=DEADLINE)[0].split('end of a point')[:2]
    points = [*map(json.loads, texts)]
    assert [point['opposing_load_N'] for point in points] == pytest.approx([-500.0, 500.0])
    for record, point in zip(found, points, strict=True):
        full = record['full']
        assert full['efficiency'] == pytest.approx(point['efficiency'], rel=1e-6)
        assert full['friction_torque'] == pytest.approx(point['friction_torque_Nm'], rel=1e-6)
        assert full['rcs'] == pytest.approx(point['rcs'], abs=1e-6)
        assert record['rcs_stderr'] > 0
        # The surface was asked for the same point.
        assert record['efficiency_difference'] == pytest.approx(0.0, abs=0.02)
        assert not record['corrected']
    driven, opposed = (record['full']['efficiency'] for record in found)
    assert driven != pytest.approx(opposed, rel=1e-3)


def test_a_page_about_the_current_point_is_for_a_person(node, says):
    node.start(
        x__max_future=3600.0,
        x__speed__timeout=60.0,
        x__load__timeout=60.0,
        x__correct_surface=False,
    )
    states, publish = node.watched()
    publish(100.0, -500.0)
    node.until(lambda: states and states[-1].judged, 'the judged point')
    code, out, err = ask(node, '--axis', 'x')
    assert (code, err) == (0, '')
    assert f'{states[-1].result.efficiency:14.5g}' in out
    lines = out.splitlines()
    assert lines[0].startswith('axis x: Solved')
    assert lines[1].split() == ['full', 'solve', 'surface']
    expected = [*('efficiency', 'RCS', 'asperity', 'film', 'central', 'friction', 'driving')]
    assert [line.split()[0] for line in lines[2:9]] == expected
    assert lines[-1] == says('surface_corrected')


def test_what_the_node_cannot_solve_is_a_sentence_and_exit_code_1(node):
    node.start()
    place = ('--speed-rpm', 955, '--load-N', 500)
    for arguments, sentence in (
        (
            ('--axis', 'q', *place),
            "ballscrew: solve of axis q rejected: axis 'q' is unknown, known are: x\n",
        ),
        (
            ('--axis', 'x'),
            'ballscrew: solve of axis x rejected: no valid sample of speed and load\n',
        ),
        (
            ('--axis', 'x', '--speed-rpm', 0, '--load-N', 500),
            'ballscrew: solve of axis x rejected: the speed of the point is 0 rev/min, '
            'a solve needs motion\n',
        ),
    ):
        assert ask(node, *arguments) == (1, '', sentence)


def test_half_a_point_is_bad_input(node, says):
    for half in (('--speed-rpm', 955), ('--load-N', 500)):
        code, out, err = ask(node, '--axis', 'x', *half)
        assert (code, out) == (2, '')
        assert err.startswith(says('speed_load_belong'))


def test_without_a_node_it_waits_no_longer_than_told(node, says):
    code, out, err = ask(node, '--axis', 'x', '--wait', 0.5)
    assert (code, out) == (1, '')
    assert err.startswith(says('node_offers_ballscrew_msgs'))
    assert 'within 0.5 s' in err


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_takes_the_goal_back(node, number):
    node.start()
    process = begin(node, '--axis', 'x', *LONG)
    (worker,) = node.until(node.solvers, 'the solve')
    process.send_signal(number)
    code, out, err = end(process)
    assert (code, out, err) == (128 + number, '', '')
    node.until(lambda: worker not in node.solvers(), 'the end of the solve')
    assert node.process.poll() is None


@pytest.mark.parametrize(
    ('number', 'sentence'),
    [(signal.SIGINT, 'stopped_node_longer'), (signal.SIGKILL, 'ballscrew_monitor_solve_gone')],
)
def test_a_node_that_ends_meanwhile_is_told(node, number, sentence, says):
    node.start()
    process = begin(node, '--axis', 'x', *LONG)
    (worker,) = node.until(node.solvers, 'the solve')
    node.stop(number)
    assert end(process) == (1, '', says(sentence))
    node.until(lambda: not os.path.exists(f'/proc/{worker}'), 'the end of the worker')


def test_a_goal_that_is_accepted_too_late_is_taken_back():
    """Interrupted before the node answers: the answer is waited for, and the goal cancelled."""
    sent, cancelled = Future(), Future()
    handle = SimpleNamespace(accepted=True, cancel_goal_async=lambda: cancelled)
    calls = []

    def spin_once(timeout_sec):
        calls.append(timeout_sec)
        if len(calls) == 3:
            sent.set_result(handle)
        if len(calls) == 5:
            cancelled.set_result('cancelled')

    node = SimpleNamespace(executor=SimpleNamespace(spin_once=spin_once))
    _Conversation(node, None, [signal.SIGINT])._take_back_late(sent)
    assert cancelled.done()
    assert len(calls) == 5


@pytest.mark.parametrize(
    ('interrupted', 'code', 'sentence'), [([], 1, 'm_solve_does'), ([signal.SIGINT], 130, '')]
)
def test_a_server_not_ready_is_sent_no_goal(
    monkeypatch, capsys, interrupted, code, sentence, says
):
    client = SimpleNamespace(server_is_ready=lambda: False)  # has no way to send
    monkeypatch.setattr(solve, 'ActionClient', lambda *arguments: client)
    monkeypatch.setattr(
        solve, 'get_action_names_and_types', lambda node: [('/m/solve', [solve.ACTION_TYPE])]
    )
    monkeypatch.setattr(_Conversation, '_hear_refusals', lambda self: [])
    monkeypatch.setattr(_Conversation, '_until', lambda self, given, wait: given())
    talk = _Conversation(None, goal_of('x'), interrupted)
    assert talk.run(2.0, as_json=False) == code
    assert capsys.readouterr() == ('', (sentence and says(sentence)))


def test_an_interrupt_before_a_node_is_found_needs_no_words(monkeypatch, capsys):
    monkeypatch.setattr(_Conversation, '_hear_refusals', lambda self: [])
    monkeypatch.setattr(_Conversation, '_until', lambda self, given, wait: None)
    talk = _Conversation(None, goal_of('x'), [signal.SIGTERM])
    assert talk.run(2.0, as_json=False) == 130
    assert capsys.readouterr() == ('', '')
