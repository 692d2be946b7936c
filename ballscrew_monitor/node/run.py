# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The run of the node process, from its arguments to its exit code."""

from collections.abc import Sequence
import signal
import sys

from ballscrew_monitor.node.arguments import wants_localhost
from ballscrew_monitor.node.node import BallscrewMonitor
from ballscrew_monitor.node.solve_server import MOST_SOLVES
from ballscrew_monitor.settings import middleware, parameters
import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions
from surrogate.files import InputError

BAD_INPUT = 2
POLL = 0.2  # [s] longest wait before a signal is noticed


def run(args: list[str] | None, stop: Sequence[int]) -> int:
    """Run the node until `stop` holds a signal; return 0, or 2 after bad input."""
    try:
        node = _make_node(args)
    except (InputError, ParameterException, RuntimeError) as error:
        print(f'{parameters.NODE_NAME}: {parameters.explain(error)}', file=sys.stderr)
        rclpy.try_shutdown()
        return BAD_INPUT
    if said := middleware.notice():
        node.get_logger().warning(said)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    if not stop:
        node.start()
    while not stop:
        executor.spin_once(timeout_sec=POLL)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    _end(node, executor)
    return 0


def _make_node(args: list[str] | None) -> BallscrewMonitor:
    """Return the node; what `localhost` asks for is done before any of the middleware is."""
    local = wants_localhost(sys.argv[1:] if args is None else args)
    if local:
        middleware.stay_local()
    # The handlers of rclpy tear the context down while the executor still waits on it.
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    node = BallscrewMonitor()
    if node.get_parameter('localhost').value is not local:
        raise InputError(
            'parameter localhost is found in another place than the one that ROS takes it from: '
            'state it for the full name of the node, or as -p localhost:=true'
        )
    return node


def _end(node: BallscrewMonitor, executor: SingleThreadedExecutor) -> None:
    node.finish()
    for _ in range(MOST_SOLVES):  # the goals that this has ended are answered
        executor.spin_once(timeout_sec=0.0)
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()
