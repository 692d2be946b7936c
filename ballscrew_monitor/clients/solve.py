# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
`ballscrew solve`: a full solve asked of the running node, with a line of progress.

Speed and load are those of `ballscrew point`: a load of the sign of the speed opposes the motion.
The node wants the machine frame, in which the force on the nut counts.

"""

from collections.abc import Callable, Sequence
import math
import re
import signal
import sys
import threading
from typing import Any

from ballscrew_monitor.clients.doctor import spun
from ballscrew_monitor.core.conversions import direction_of, opposing_load
from ballscrew_monitor.core.interrupts import interrupts, SIGNALLED
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.settings.parameters import REFUSALS
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.action import SolveOperatingPoint
from ballscrew_msgs.msg import OperatingPoint, PointResult
from rcl_interfaces.msg import Log
from rclpy.action import ActionClient
from rclpy.action.graph import get_action_names_and_types
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.time import Time
from surrogate.files import InputError, json_text
from surrogate.units import digits, RPM

ACTION_TYPE = 'ballscrew_msgs/action/SolveOperatingPoint'
SOLVED, NOT_SOLVED, INTERRUPTED = 0, 1, SIGNALLED + signal.SIGINT
LAST_WORD = 1.0  # [s] for the node to know that a goal is cancelled
REJECTED = 'the node refuses this solve, its log says why'
LOG_QOS = QoSProfile(depth=1000, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
RATE = re.compile(r'(\S+) rad/s')
WHERE = 'start one, and mind ROS_DOMAIN_ID and ROS_AUTOMATIC_DISCOVERY_RANGE'
SIDES = {PointResult.SIDE_SCREW: 'screw', PointResult.SIDE_NUT: 'nut'}
NUTS = {PointResult.NUT_POSITIVE: 'positive nut', PointResult.NUT_NEGATIVE: 'negative nut'}
# Words, field of a PointResult, factor, unit.
LINES = (
    ('efficiency', 'efficiency', 1.0, ''),
    ('RCS', 'rcs', 1.0, ''),
    ('asperity share', 'asperity_share', 1.0, ''),
    ('film ratio', 'film_ratio', 1.0, ''),
    ('central film', 'central_film', 1e9, 'nm'),
    ('friction torque', 'friction_torque', 1.0, 'N m'),
    ('driving torque', 'driving_torque', 1.0, 'N m'),
)
FACTS = (
    *('efficiency_difference', 'rcs_difference', 'efficiency_stderr', 'rcs_stderr'),
    *('within_stated_error', 'corrected', 'correction'),
)
"""Fields of a result that are printed as they are."""


def goal_of(
    axis: str,
    *,
    speed: float = math.nan,
    load: float = math.nan,
    temperature: float = math.nan,
    timeout: float = 0.0,
) -> Any:
    """
    Return the goal of a solve in the machine frame; raises InputError for half a point.

    Speed [rad/s] and load [N] as `ballscrew point` has them, both NaN for the current point;
    temperature [degC], NaN for that of the axis; timeout [s], 0 for the default.

    """
    if math.isnan(speed) is not math.isnan(load):
        raise InputError(
            'speed and load belong together: give both, or none of them for the current point'
        )
    goal = SolveOperatingPoint.Goal(
        axis=axis, use_current=math.isnan(speed), timeout=float(timeout)
    )
    # The load of the command opposes the motion when it has the sign of the speed.
    opposing = math.copysign(1.0, speed) * load
    goal.point = OperatingPoint(
        speed=float(speed),
        axial_load=float(opposing_load(opposing, direction_of(speed))),
        temperature=float(temperature),
    )
    return goal


def ask(goal: Any, node_name: str = '', *, wait: float, as_json: bool) -> int:
    """
    Ask the node, print what comes of it, and return the exit code.

    `node_name` is its full name, empty for the only one there is.

    """
    with interrupts(threading.Event()) as interrupted:
        with started_node('ballscrew_solve') as node:
            talk = _Conversation(node, goal, interrupted, node_name)
            code = talk.run(wait, as_json=as_json)
        return SIGNALLED + interrupted[0] if interrupted else code


class _Conversation:
    """One goal, from finding the node to its result."""

    def __init__(
        self, node: Node, goal: Any, interrupted: Sequence[int], node_name: str = ''
    ) -> None:
        self._node, self._goal, self._interrupted = node, goal, interrupted
        self._node_name = node_name

    def _until(self, condition: Callable[[], Any], seconds: float = math.inf) -> Any:
        return spun(self._node, condition, seconds, self._interrupted)

    def run(self, wait: float, *, as_json: bool) -> int:
        """Ask and print; return the exit code unless interrupted."""
        refusals = self._hear_refusals()
        action = self._find(wait)
        if action is None:
            return self._give_up(f'no node offers {ACTION_TYPE} within {wait:g} s: {WHERE}')
        client = ActionClient(self._node, SolveOperatingPoint, action)
        silence = f'{action} does not answer within {wait:g} s'
        if not self._until(client.server_is_ready, wait):
            return self._give_up(silence)
        sent = client.send_goal_async(self._goal, feedback_callback=_show)
        gone = f'{action} is gone, its node has ended'
        self._until(lambda: sent.done() or not client.server_is_ready(), wait)
        if not sent.done():
            silence = silence if client.server_is_ready() else gone
            self._take_back_late(sent)
            return self._give_up(silence)
        handle = sent.result()
        if not handle.accepted:
            self._until(lambda: refusals, max(wait, LAST_WORD))
            return _complain(refusals[-1] if refusals else REJECTED)
        answer = handle.get_result_async()
        over = self._until(lambda: answer.done() or not client.server_is_ready())
        if sys.stderr.isatty():
            print('\r\x1b[K', end='', file=sys.stderr, flush=True)
        if not over:
            self._take_back(handle)
            return INTERRUPTED
        if not answer.done():
            return _complain(gone)
        return _print(self._goal.axis, answer.result().result, as_json=as_json)

    def _hear_refusals(self) -> list[str]:
        """Return the list to which the node's log adds why it refuses a solve from now on."""
        refusals = list[str]()
        now = self._node.get_clock().now().nanoseconds

        def hear(line: Log) -> None:
            if line.name.endswith(f'.{REFUSALS}') and Time.from_msg(line.stamp).nanoseconds >= now:
                refusals.append(line.msg)

        self._node.create_subscription(Log, '/rosout', hear, LOG_QOS)
        return refusals

    def _give_up(self, sentence: str) -> int:
        """Complain of a node that was waited for in vain; an interrupt needs no words."""
        return INTERRUPTED if self._interrupted else _complain(sentence)

    def _find(self, wait: float) -> str | None:
        """Return the name of the action; raises InputError when several nodes offer it."""
        wanted = f'{self._node_name.rstrip("/")}/solve' if self._node_name else ''

        def offered() -> list[str]:
            return [
                name
                for name, types in get_action_names_and_types(self._node)
                if ACTION_TYPE in types and wanted in ('', name)
            ]

        actions: list[str] | None = self._until(offered, wait)
        if actions and len(actions) > 1:
            nodes = ', '.join(sorted(name.rpartition('/')[0] for name in actions))
            raise InputError(f'several nodes solve, name one of them with --node: {nodes}')
        return actions[0] if actions else None

    def _take_back(self, handle: Any) -> None:
        """Cancel a goal, and wait a little until the node knows, whatever interrupts."""
        spun(self._node, handle.cancel_goal_async().done, LAST_WORD)

    def _take_back_late(self, sent: Any) -> None:
        """Cancel a goal that may be accepted only now, as nobody waits for it any more."""
        if spun(self._node, sent.done, LAST_WORD) and sent.result().accepted:
            self._take_back(sent.result())


def _complain(sentence: str) -> int:
    """Say a sentence of the node in the unit in which the command is asked."""
    say(RATE.sub(_in_rpm, sentence))
    return NOT_SOLVED


def _in_rpm(rate: re.Match[str]) -> str:
    try:
        return f'{digits(float(rate[1]) / RPM, 4)} rev/min'
    except ValueError:  # a word
        return rate[0]


def _show(message: Any) -> None:
    """Write how far the solve is over the last line of a terminal."""
    step = message.feedback
    if not sys.stderr.isatty():
        return
    place = ' '.join(filter(None, (NUTS.get(step.nut, ''), SIDES.get(step.side, ''))))
    left = '' if math.isnan(step.seconds_left) else f', {step.seconds_left:.0f} s left'
    text = f'{100 * step.fraction:3.0f} %  {step.stage} {place}, iteration {step.iteration}{left}'
    print(f'\r{text}\x1b[K', end='', file=sys.stderr, flush=True)


def _print(axis: str, result: Any, *, as_json: bool) -> int:
    """Print a result; one that is not converged is a sentence."""
    if not result.success:
        return _complain(result.status)
    print(json_text(record_of(axis, result)) if as_json else page_of(axis, result))
    return SOLVED


def record_of(axis: str, result: Any) -> dict[str, Any]:
    """Return a result as plain numbers, SI units but degC, NaN where unknown."""
    points = {'full': result.full, 'surface': result.surface}
    numbers = {
        part: {name: getattr(point, name) for name in point.get_fields_and_field_types()}
        for part, point in points.items()
    }
    facts = {name: getattr(result, name) for name in FACTS}
    return {'axis': axis, 'status': result.status, **numbers, **facts, 'wall_s': result.wall_time}


def page_of(axis: str, result: Any) -> str:
    """Return a result for a person: the full solve beside the surface."""
    head = f'axis {axis}: {result.status} ({result.wall_time:.1f} s)'
    rows = [f'{"":18}{"full solve":>14}{"surface":>14}']
    for words, name, factor, unit in LINES:
        full, surface = (factor * getattr(part, name) for part in (result.full, result.surface))
        rows.append(f'{words:18}{full:14.5g}{surface:14.5g}  {unit}'.rstrip())
    within = 'within' if result.within_stated_error else 'beyond'
    rows.append(
        f'difference in efficiency {result.efficiency_difference:+.2g}, in RCS '
        f'{result.rcs_difference:+.2g}: {within} the error that the surface states'
    )
    correction = result.correction or 'not corrected'
    rows.append(correction if result.corrected else f'surface not corrected: {correction}')
    return '\n'.join([head, *rows])
