# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Acts of a browser on a node, where they are allowed: acknowledge, shelve, and ask for a solve.

The thread of the server waits without holding others up; everything of ROS is called in the thread
of the executor.

"""

import asyncio
from collections.abc import Callable, Mapping
from concurrent.futures import Future
import math
from typing import Any

from action_msgs.msg import GoalStatus
from ballscrew_monitor.clients.solve import goal_of
from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.messages.health_messages import stamp_of
from ballscrew_monitor.page import maps
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.frames import frame
from ballscrew_monitor.page.hub import Browser, Hub
from ballscrew_monitor.page.phrases import free, Phrase, phrase, Refused
from ballscrew_monitor.page.questions import Answer, Handler, number_in, text_in
from ballscrew_msgs.action import SolveOperatingPoint
from ballscrew_msgs.srv import AcknowledgeAlarm, ShelveAlarm
from rclpy.action import ActionClient
from rclpy.node import Node
from surrogate.files import InputError
from surrogate.units import MINUTE, RPM

ACTS = ('acknowledge', 'shelve', 'solve', 'cancel')
LONG = ('solve',)
"""Acts during which the browser may ask for more."""
POLL = 0.02  # [s] until an answer is noticed
PATIENCE = 10.0  # [s] for an answer of the node
STUCK = 60.0  # [s] for a turn in the thread of ROS
REPEAT = 2.0  # [s] after which a service is asked again: a first answer may be lost
MOST_SOLVES = 4


def refusals() -> dict[str, Handler]:
    """Return what answers the acts where acting is off."""

    async def refuse(browser: Browser, request: Mapping[str, Any]) -> Answer:
        raise Refused(phrase('acting_off'))

    return dict.fromkeys(ACTS, refuse)


class Acting:
    """Calls services and the action of the nodes of a hub."""

    def __init__(self, node: Node, hub: Hub) -> None:
        """Act through a `node` that another thread spins."""
        self._node, self._hub = node, hub
        self._solves: dict[tuple[Browser, Any], Any] = {}

    @property
    def handlers(self) -> dict[str, Handler]:
        """Return what answers the acts."""
        return {name: getattr(self, f'_{name}') for name in ACTS}

    async def _acknowledge(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        view, name = self._hub.view(text_in(request, 'axis')), text_in(request, 'name')
        reason = text_in(request, 'reason') if request.get('reason') else ''
        asked = AcknowledgeAlarm.Request(axis=view.axis, name=name, reason=reason)
        message = (await self._call(view, AcknowledgeAlarm, 'acknowledge_as', asked)).message
        plain, done = f'acknowledged of {view.axis} by {name}', phrase('acknowledged', name=name)
        return {'message': done if message == plain else free(message)}, {}

    async def _shelve(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        view, name = self._hub.view(text_in(request, 'axis')), text_in(request, 'name')
        duration = number_in(request, 'minutes') * MINUTE
        reason = f'{text_in(request, "reason")} ({name})' if duration else ''
        asked = ShelveAlarm.Request(axis=view.axis, duration=duration, reason=reason)
        answer = await self._call(view, ShelveAlarm, 'shelve', asked)
        until = clock_text(stamp_of(answer.until))
        plain, done = f'shelved until {until}: {view.axis}', phrase('shelved_until', until=until)
        return {'message': done if answer.message == plain else free(answer.message)}, {}

    async def _call(self, view: AxisView, kind: Any, name: str, request: Any) -> Any:
        """Return what a service answers; raises InputError with its refusal, or without one."""
        client = await self._in_ros(self._node.create_client, kind, f'{view.node}/{name}')
        answers: list[Any] = []
        try:
            if not await _waited(client.service_is_ready, PATIENCE):
                if view.node in await self._in_ros(self._node.get_fully_qualified_node_names):
                    raise Refused(phrase('node_older', node=view.node, name=name))
                raise Refused(_silent('node_silent', PATIENCE, node=view.node))
            for patience in (REPEAT, PATIENCE):
                answers.append(await self._in_ros(client.call_async, request))
                if await _waited(lambda: any(answer.done() for answer in answers), patience):
                    break
            else:
                raise Refused(_silent('node_silent', PATIENCE, node=view.node))
        finally:
            await self._in_ros(self._node.destroy_client, client)
        answer = next(answer.result() for answer in answers if answer.done())
        if not answer.success:
            raise InputError(answer.message)
        return answer

    async def _solve(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        view = self._hub.view(text_in(request, 'axis'))
        if len(self._solves) >= MOST_SOLVES:
            raise Refused(phrase('solves_many', count=str(MOST_SOLVES)))
        speed, load = number_in(request, 'speed_rpm') * RPM, number_in(request, 'load_N')
        temperature = number_in(request, 'temperature_degC', math.nan)
        goal = goal_of(view.axis, speed=speed, load=load, temperature=temperature)
        key = browser, request['id']
        if key in self._solves:
            raise InputError(f'a solve with the id {request["id"]} is under way')
        self._solves[key] = None
        action = f'{view.node}/solve'
        client = await self._in_ros(ActionClient, self._node, SolveOperatingPoint, action)
        try:
            result = await self._solved(client, goal, key)
        finally:
            del self._solves[key]
            await self._in_ros(client.destroy)
        if not result.success:
            raise InputError(result.status)
        full, limits = result.full, maps.limits_of(view.limits)
        zone, _ = maps.judged(full.rcs, full.efficiency, load, limits)
        return {  # as that of `read`, and what the solve did to the surface
            'speed_rpm': speed / RPM,
            'load_N': load,
            'temperature_degC': temperature,
            'efficiency': full.efficiency,
            'rcs': full.rcs,
            'film_ratio': full.film_ratio,
            'torque_N_m': full.driving_torque,
            'zone': zone,
            'words': free('; '.join(filter(None, (result.status, result.correction)))),
        }, {}

    async def _solved(self, client: Any, goal: Any, key: tuple[Browser, Any]) -> Any:
        """Return the result of a goal; a browser that leaves takes it back."""
        await self._until(client.server_is_ready, PATIENCE, 'solve_none')
        post = asyncio.get_running_loop().call_soon_threadsafe
        browser, number = key

        def show_progress(message: Any) -> None:
            step = message.feedback
            record = {'id': number, 'share': step.fraction, 'words': step.stage}
            post(browser.reply, frame('progress', record))

        sent = await self._in_ros(client.send_goal_async, goal, show_progress)
        await self._until(sent.done, PATIENCE, 'solve_silent')
        handle = sent.result()
        if not handle.accepted:
            raise Refused(phrase('solve_refused'))
        self._solves[key] = handle
        answer = await self._in_ros(handle.get_result_async)
        while not answer.done():
            if browser not in self._hub.browsers:
                await self._in_ros(handle.cancel_goal_async)
                raise InputError('the browser has left')
            if not client.server_is_ready():
                raise Refused(phrase('solve_node_left'))
            await asyncio.sleep(POLL)
        if answer.result().status == GoalStatus.STATUS_CANCELED:
            raise Refused(phrase('solve_cancelled'))
        return answer.result().result

    async def _cancel(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        handle = self._solves.get((browser, request.get('solve')))
        if handle is None:
            raise InputError('there is no such solve under way')
        await self._in_ros(handle.cancel_goal_async)
        return {}, {}

    async def _in_ros(self, call: Callable[..., Any], *args: Any) -> Any:
        """Return what a call gives in the thread of the executor, or raise what it raises."""
        assert self._node.executor is not None
        done: Future[Any] = Future()

        def calling() -> None:
            try:
                done.set_result(call(*args))
            except Exception as error:  # raised by a task, it would end the thread
                done.set_exception(error)

        self._node.executor.create_task(calling)
        await self._until(done.done, STUCK, 'ros_silent')
        return done.result()

    async def _until(self, condition: Callable[[], Any], seconds: float, key: str) -> None:
        if not await _waited(condition, seconds):
            raise Refused(_silent(key, seconds))


def _silent(key: str, seconds: float, **values: str) -> Phrase:
    """Return that there is no answer within some `seconds` [s]."""
    return phrase(key, seconds=f'{seconds:g}', **values)


async def _waited(condition: Callable[[], Any], seconds: float) -> bool:
    """Wait some `seconds` [s] for a condition; return True if it has come."""
    clock = asyncio.get_running_loop().time
    end = clock() + seconds
    while not condition():
        if clock() > end:
            return False
        await asyncio.sleep(POLL)
    return True
