# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The run of the node process, from its arguments to its exit code.

The ports are bound when ROS starts, so `localhost` must be known earlier. Only this one parameter
is looked for; whatever is wrong with an argument ROS says itself.

"""

from collections.abc import Iterator, Mapping, Sequence
import gc
import re
import signal
import sys
from typing import Any

from ballscrew_monitor.node.node import BallscrewMonitor
from ballscrew_monitor.node.solve_server import MOST_SOLVES
from ballscrew_monitor.settings import middleware, parameters
import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions
from surrogate.files import InputError
from surrogate.files.plain_yaml import plain_values

BAD_INPUT = 2
NAME = 'localhost'
_TAKES_VALUE = {'-p': '-p', '--param': '-p', '-r': '-r', '--remap': '-r', '--params-file': 'file'}
POLL = 0.2  # [s] longest wait before a signal is noticed


def run(args: list[str] | None, stop: Sequence[int]) -> int:
    """Run the node until `stop` holds a signal; return 0, or 2 after bad input."""
    try:
        local = wants_localhost(sys.argv[1:] if args is None else args)
        if local:  # before any of the middleware is there
            middleware.stay_local()
        # The handlers of rclpy tear the context down while the executor still waits on it.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        node = BallscrewMonitor()
        if node.get_parameter('localhost').value is not local:
            raise InputError(
                'parameter localhost is found in another place than the one that ROS takes it '
                'from: state it for the full name of the node, or as -p localhost:=true'
            )
    except (InputError, ParameterException, RuntimeError) as error:
        print(f'{parameters.NODE_NAME}: {parameters.explain(error)}', file=sys.stderr)
        rclpy.try_shutdown()
        return BAD_INPUT
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    if not stop:
        node.start()
    # What has been made by now stays: a search through all of it takes 40 ms of the judgement.
    gc.freeze()
    while not stop:
        executor.spin_once(timeout_sec=POLL)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    _end(node, executor)
    return 0


def _end(node: BallscrewMonitor, executor: SingleThreadedExecutor) -> None:
    node.finish()
    for _ in range(MOST_SOLVES):  # the goals that this has ended are answered
        executor.spin_once(timeout_sec=0.0)
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()


def wants_localhost(arguments: Sequence[str]) -> bool:
    """Return True if the arguments of the node set `localhost`; the last one counts."""
    given: list[tuple[str, str]] = []  # kind and value of those between `--ros-args` and `--`
    inside, kind = False, ''
    for argument in arguments:
        if kind:
            given.append((kind, argument))
            kind = ''
        elif argument in ('--ros-args', '--'):
            inside = argument == '--ros-args'
        elif inside:
            kind = _TAKES_VALUE.get(argument, '')
    names: dict[str, str] = {}  # of two rules the first one counts
    for rule in (value for kind, value in given if kind == '-r'):
        place, _, value = rule.partition(':=')
        key = place.rpartition(':')[2]
        names.setdefault('__node' if key == '__name' else key, value)
    namespace = names.get('__ns', '').strip('/')
    name = names.get('__node', parameters.NODE_NAME)
    node = f'/{namespace}/{name}' if namespace else f'/{name}'
    wanted = False
    for kind, value in given:
        setting = _of_file(value, node) if kind == 'file' else {}
        if kind == '-p':
            setting = _of_rule(value, node)
        wanted = bool(setting.get(NAME, wanted))
    return wanted


def _of_rule(rule: str, node: str) -> dict[str, Any]:
    place, _, text = rule.partition(':=')
    target, _, name = place.rpartition(':')
    if name != NAME or (target and target != node.rpartition('/')[2]):
        return {}
    try:
        return {NAME: plain_values(text) is True}
    except InputError:
        return {}


def _of_file(path: str, node: str) -> dict[str, Any]:
    try:
        sections = parameters.sections(path)
    except InputError:
        return {}
    parts = {'*': '/[^/]+', '**': '(?:/[^/]+)*'}  # one part of a name, any number of them
    setting: dict[str, Any] = {}
    for pattern, values in _patterns(sections):
        form = ''.join(parts.get(part, f'/{re.escape(part)}') for part in pattern[1:].split('/'))
        if NAME in values and re.fullmatch(form, node):
            setting = {NAME: values[NAME] is True}
    return setting


def _patterns(
    section: Mapping[str, Any], prefix: str = ''
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the pattern of each node that a file speaks of, and its parameters."""
    for key, inner in section.items():
        if key == 'ros__parameters' and isinstance(inner, dict):
            yield prefix, inner
        elif isinstance(inner, dict):
            yield from _patterns(inner, f'{prefix}/{str(key).strip("/")}')
