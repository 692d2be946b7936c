# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Faults of those who operate the node, over the real middleware."""

import re
import zipfile

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import confined
from ballscrew_monitor.node.run import run
from ballscrew_monitor.settings import parameters
from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger
from surrogate.files import InputError
from surrogate.surface import shipped_surface
import yaml

AHEAD = 3600.0  # [s]
FAST = 100.0  # [rad/s]
CHANGES = 200
WAITING = 5
LARGEST = 256 * 2**20  # [B] that a surface may come to when unpacked
ROWS = parameters.table(['x'])


def request(number):
    """Return a change; every other one is of a value that is not allowed."""
    value = 0.01 + 1e-4 * number if number % 2 else 2.0 + number
    change = Parameter('x.limits.rcs', value=value).to_parameter_msg()
    return SetParametersAtomically.Request(parameters=[change])


def test_a_hundred_changes_a_second_lose_no_sample(node):
    node.start(x__max_future=AHEAD)
    states, publish = node.watched()
    assert node.set_parameters(x__limits__rcs=0.01).successful  # the service is found
    client = node.clients['set_parameters_atomically']
    futures, begin = [], node.now()

    def waiting():
        """Return how many requests have no answer; the middleware keeps ten of them."""
        return sum(not future.done() for future in futures)

    for number in range(CHANGES):
        publish(FAST)
        futures.append(client.call_async(request(number)))
        node.until(lambda due=begin + 10**7 * number: node.now() >= due and waiting() < WAITING)
    node.until(lambda: all(future.done() for future in futures), 'the last answer')
    results = [future.result().result for future in futures]
    assert [result.successful for result in results] == [False, True] * (CHANGES // 2)
    assert all(bool(result.reason) is not result.successful for result in results)
    publish(FAST)
    node.until(lambda: states[-1].judged == CHANGES + 1, 'the last sample')
    assert [health.lost for health in states[-1].inputs[:2]] == [0, 0]
    assert states[-1].rcs_limit == pytest.approx(0.01 + 1e-4 * (CHANGES - 1))


def write_bomb(path):
    """Write a file that unpacks to more than is allowed, and is small itself."""
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        with archive.open('field.npy', 'w') as entry:
            for _ in range(LARGEST // 2**20 + 1):
                entry.write(bytes(2**20))


def write_half(path):
    content = shipped_surface().read_bytes()
    path.write_bytes(content[: len(content) // 2])


def test_a_surface_that_cannot_be_is_not_taken_and_told_in_one_sentence(node, tmp_path):
    surface = tmp_path / 'surface.npz'
    surface.write_bytes(shipped_surface().read_bytes())
    node.start(x__surface=surface, x__max_future=AHEAD)
    states, publish = node.watched()

    def said():
        return node.levels('x: Surface')[-1:]

    for write, reason in ((write_bomb, ' bytes when unpacked, allowed is '), (write_half, '')):
        write(surface)
        answer = node.call(Trigger, 'reload_surface')
        assert not answer.success
        prefix = f'kept the old surface: axis x: {surface}: '
        assert answer.message.startswith(prefix)
        assert reason in answer.message
        message = 'kept the old surface, the reload is refused: ' + answer.message[22:]
        node.until(lambda told=message: said() == [(DiagnosticStatus.WARN, told)], message)
        judged = states[-1].judged if states else 0
        publish(FAST)
        node.until(lambda before=judged: states and states[-1].judged > before, 'a judgement')
    surface.write_bytes(shipped_surface().read_bytes())
    assert node.call(Trigger, 'reload_surface').success
    node.until(
        lambda: said() == [(DiagnosticStatus.OK, 'full surface loaded')], 'the good surface'
    )


def bad_value(row):
    """Return a value of the right type that is not allowed, or else one of another type."""
    if isinstance(row.default, float):
        return '.nan' if row.high == float('inf') else repr(2.0 * abs(row.high) + 1.0)
    if row.choices:
        return 'furlong'
    return "'maybe'" if isinstance(row.default, bool) else '3.5'


def test_each_parameter_refuses_a_bad_value():
    for name, row in ROWS.items():
        with pytest.raises(InputError, match=f'parameter {name} is .*, (allowed is|it must be) '):
            row.check(name, yaml.safe_load(bad_value(row)))


@pytest.fixture(scope='module')
def environment():
    """Stay in a free domain with the middleware of this process."""
    with free_domain() as domain, pytest.MonkeyPatch.context() as patch:
        for name, value in confined(domain).items():
            patch.setenv(name, value)
        yield


def test_a_bad_start_value_is_one_sentence_and_exit_code_2(environment, capfd):
    """A parameter of each type, with choices or without."""
    kinds = {(type(row.default), bool(row.choices)): name for name, row in ROWS.items()}
    offenders = []
    for name in kinds.values():
        row = ROWS[name]
        code = run(['--ros-args', '-p', f'{name}:={bad_value(row)}'], [1])
        out, err = capfd.readouterr()
        sentence = rf'ballscrew_monitor: parameter {name} is .*, (allowed is|it must be) .*\n'
        if (code, out) != (2, '') or not re.fullmatch(sentence, err):
            offenders.append((name, code, out, err))
    assert not offenders


@pytest.mark.parametrize(
    ('argument', 'sentence'),
    [
        ('x.limits.rcs:=1', 'limits_rcs_1'),
        ('x.limits.rsc:=0.1', 'limits_rsc_unknown'),
        ('diagnostic_period:=2.0', 'diagnostic_period_unknown'),
        ("axis:=['y']", 'unknown'),
        ('y.screw:=nominal', 'y_screw_unknown'),
        ('x.speed.unit:=rpm', 'speed_unit_rpm'),
        ("axes:=['X']", 'axes_holds'),
    ],
)
def test_a_bad_parameter_is_one_sentence(environment, argument, sentence, says, capfd):
    assert run(['--ros-args', '-p', argument], [1]) == 2
    said = capfd.readouterr().err
    assert said.count('\n') == 1
    assert said.startswith(f'ballscrew_monitor: {says(sentence)}')
