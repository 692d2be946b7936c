# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The surface of an axis as its node judges with it: the file on this machine, and the corrections.

`SurfaceInfo` tells where full solves have corrected the surface, not what they found. A corrected
surface agrees with the solve at its point, so the node is asked for its numbers there, and at a
few places more, by which the file is known to be that of the node.

"""

from collections.abc import Callable, Mapping, Sequence
import dataclasses
import itertools
import math
import time
from typing import Any

from ballscrew_monitor.core.conversions import celsius, Direction, kelvin, opposing_load
from ballscrew_monitor.judge.full_point import corrected, JUDGED, KeptSolve, SolvedAt
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.phrases import free, Phrase, phrase, Said
from ballscrew_msgs.msg import OperatingPoint, PointResult, SurfaceInfo
from ballscrew_msgs.srv import EvaluateOperatingPoint
import numpy as np
from rclpy.node import Node
from rclpy.task import Future
from surrogate.surface import FIELDS, find_surface, Surface, SurfaceError

PARTS = 4  # of each range of a surface, at whose inner borders it is held against the node
SAME = 1e-6  # [-] by which equal numbers may differ
PATIENCE = 10.0  # [s] for an answer, until it is asked for again
Post = Callable[..., Any]
"""Calls a function with arguments in the thread of the hub."""


def known_surface(info: SurfaceInfo, wanted: str) -> tuple[Surface | None, Said]:
    """
    Return the surface that `info` describes, or None and why there is none.

    `wanted` is the parameter `surface` of the axis. Of a surface that full solves have corrected,
    the file tells what it was before.

    """
    if not info.sha256:
        return None, phrase('no_map_none')
    try:
        path = find_surface(wanted, info.screw, info.oil)
        surface = Surface.load(path, screw=info.screw, oil=info.oil)
    except SurfaceError as error:
        return None, phrase('no_map_no_file', why=free(str(error)))
    if surface.sha256 != info.sha256 and not len(info.corrected_speed):
        return None, _another(info, wanted)
    return surface, ''


def _another(info: SurfaceInfo, wanted: str) -> Phrase:
    """Return that the file is another one; the hash of a corrected surface is not of its file."""
    path = find_surface(wanted, info.screw, info.oil)
    if len(info.corrected_speed):
        return phrase('no_map_another', path=str(path))
    return phrase('no_map_other', path=str(path), sha256=info.sha256[:16])


def places_of(info: SurfaceInfo, surface: Surface) -> list[SolvedAt]:
    """Return the places of the corrections, in their order, and then those of the comparison."""
    heats = map(kelvin, info.corrected_temperature)
    spans = surface.load_range, surface.temperature_range
    inner = [np.geomspace(*surface.speed_range, PARTS + 1)[1:-1].tolist()]
    inner += [np.linspace(*span, PARTS + 1)[1:-1].tolist() for span in spans]
    places = [*zip(info.corrected_speed, info.corrected_load, heats), *itertools.product(*inner)]
    return [
        SolvedAt(speed=speed, opposing_load=load, temperature=heat) for speed, load, heat in places
    ]


def point_message(place: SolvedAt) -> OperatingPoint:
    """Return a place as a point of a motion forward."""
    return OperatingPoint(
        speed=float(place.speed),
        axial_load=float(opposing_load(place.opposing_load, Direction.POSITIVE)),
        temperature=celsius(float(place.temperature)),
    )


def with_corrections(
    surface: Surface, count: int, answers: Sequence[tuple[SolvedAt, PointResult]]
) -> Surface | None:
    """
    Return a surface with the corrections of a node, by its answers; None for another surface.

    The first `count` answers are those at the corrections. Raises SurfaceError for what corrects
    nothing.

    """
    solves = [
        KeptSolve(
            **dataclasses.asdict(place), solved={name: getattr(answer, name) for name in FIELDS}
        )
        for place, answer in answers[:count]
    ]
    surface = corrected(surface, solves)
    for place, answer in answers:
        point = surface.lookup(place.speed, place.opposing_load, place.temperature)
        for name in JUDGED:
            ours, theirs = getattr(point, name), getattr(answer, name)
            both_unknown = math.isnan(ours) and math.isnan(theirs)
            if not both_unknown and not math.isclose(ours, theirs, rel_tol=SAME, abs_tol=SAME):
                return None
    return surface


class PatientClient:
    """A client of a service that is called again if no answer comes in time."""

    def __init__(self, node: Node, kind: Any, name: str) -> None:
        """Call a service of a `kind` by its full `name`."""
        self._node, self._client = node, node.create_client(kind, name)
        self._asked: Future | None = None
        self._asked_at = -math.inf  # [s]

    def close(self) -> None:
        """Call no more."""
        self._node.destroy_client(self._client)

    def drop(self) -> None:
        """Wait no more for an answer."""
        if self._asked is not None:
            self._client.remove_pending_request(self._asked)
            self._asked = None

    def call(self, request: Any, hear: Callable[[Future], None]) -> None:
        """Call, unless the service is not there or may answer the last call yet."""
        waits = self._asked is not None and not self._asked.done()
        if waits and time.monotonic() - self._asked_at < PATIENCE:
            return
        if self._client.service_is_ready():
            self.drop()
            self._asked_at = time.monotonic()
            self._asked = self._client.call_async(request)
            self._asked.add_done_callback(hear)


class SurfaceLink:
    """Tells the view of an axis its surface, without the corrections until the node says them."""

    def __init__(self, node: Node, view: AxisView, post: Post) -> None:
        """Ask the node of a `view` through a `node`; `post` calls in the thread of the hub."""
        self._view, self._post = view, post
        self._client = PatientClient(node, EvaluateOperatingPoint, f'{view.node}/evaluate')
        self._request: EvaluateOperatingPoint.Request | None = None
        self._hear: Callable[[Future], None] = lambda future: None

    @property
    def is_asking(self) -> bool:
        """Return True if the node has corrections that are not known yet."""
        return self._request is not None

    def close(self) -> None:
        """Ask no more."""
        self._client.close()

    def tell(self, about: Mapping[str, Any], info: SurfaceInfo, wanted: str) -> None:
        """Tell what the axis is, and the surface of `info`; its file is the parameter `wanted`."""
        surface, no_map = known_surface(info, wanted)
        count = len(info.corrected_speed)
        self._post(self._view.know, about, surface, no_map, count)
        self._request = None
        self._client.drop()
        if surface is None or not count:
            return
        places, another = places_of(info, surface), _another(info, wanted)
        points = [point_message(place) for place in places]
        request = EvaluateOperatingPoint.Request(axis=self._view.axis, points=points)

        def hear(future: Future) -> None:
            """Take an answer; one to a request of before, or a refusal, tells nothing."""
            answer = future.result()
            if request is not self._request or answer is None or not answer.success:
                return
            self._request = None
            answers = list(zip(places, answer.results))
            try:
                corrected_surface = with_corrections(surface, count, answers)
            except SurfaceError:  # the map stays without them, and says so
                return
            why = another if corrected_surface is None else ''
            self._post(self._view.know, about, corrected_surface, why)

        self._request, self._hear = request, hear
        self.ask()

    def ask(self) -> None:
        """Ask for the corrections, until they are known; a first answer may be lost."""
        if self._request is not None:
            self._client.call(self._request, self._hear)
