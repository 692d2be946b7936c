# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Maps that follow the axes, and the questions that a surface answers: map, read, ghosts.

All is computed in a thread beside the server's, one thing at a time.

"""

import asyncio
from collections.abc import Callable, Iterable, Mapping
import logging
from typing import Any
import weakref

from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.page import maps
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.frames import frame
from ballscrew_monitor.page.hub import Browser, Hub
from ballscrew_monitor.page.phrases import free, phrase, Refused
from ballscrew_monitor.page.questions import Answer, Handler, number_in, text_in
from surrogate.files import InputError
from surrogate.surface import Surface
from surrogate.units import RPM

LOG = logging.getLogger(__name__)
WARMER = 0.5  # [K] by which the oil changes until there is a new map
LOOK = 0.5  # [s] between two looks at the axes
QUANTITY = 'efficiency'
MOST_FACTORS, FACTORS = 5, (0.1, 3.0)


Followed = tuple[str, Limits, float, tuple[float, float]]


class WhatIf:
    """Maps of the axes of a hub; surfaces of other oils by their names."""

    def __init__(self, hub: Hub, oils: Iterable[Surface] = ()) -> None:
        self._hub, self._oils = hub, tuple(oils)
        # What a map was made for: hash of the surface, limits, temperature [degC], loads [N].
        self._followed: weakref.WeakKeyDictionary[AxisView, Followed] = weakref.WeakKeyDictionary()
        self._turn = asyncio.Lock()

    @property
    def handlers(self) -> dict[str, Handler]:
        """Return what answers the questions."""
        return {'map': self._map, 'read': self._read, 'ghosts': self._ghosts}

    def grades(self, view: AxisView) -> list[str]:
        """Return the oils for which there is a surface of the screw of an axis."""
        if view.surface is None:
            return []
        screw, oil = view.surface.screw_name, view.surface.oil_name
        return [oil, *(other.oil_name for other in self._oils if other.screw_name == screw)]

    async def follow(self) -> None:
        """Keep the map of every axis as its motion is now, until cancelled."""
        while True:
            for view in tuple(self._hub.axes.values()):
                if view.surface is not None and view.limits['rcs_limit'] is not None:
                    await self._try(view, view.surface)
            await asyncio.sleep(LOOK)

    async def _try(self, view: AxisView, surface: Surface) -> None:
        """Keep one axis; where the program fails, the others go on."""
        try:
            await self.keep(view, surface)
        except Exception as error:
            LOG.exception('no map of %s', view.name)
            if view.surface is surface:
                view.know(view.about, None, phrase('no_map_fault', why=free(repr(error))))

    async def keep(self, view: AxisView, surface: Surface) -> None:
        """Make the map of an axis as its motion is now, if the last one does not suit."""
        grades = self.grades(view)
        view.is_changed |= grades != view.grades
        view.grades = grades
        rows, limits = view.history.since(0), maps.limits_of(view.limits)
        motion = maps.Motion.of(rows, limits)
        warmth = maps.oil_temperature(rows, surface)
        view.warmth = warmth
        if view in self._followed and view.map_frame is not None:
            sha256, old_limits, old_warmth, (lowest, highest) = self._followed[view]
            low, high = motion.load_span()
            same = (sha256, old_limits) == (surface.sha256, limits)
            if same and abs(old_warmth - warmth) < WARMER and not (low < lowest or high > highest):
                return
        exact = warmth
        warmth = round(warmth / WARMER) * WARMER
        record, arrays = await self._in_turn(
            maps.map_of, surface, limits, warmth, motion, QUANTITY
        )
        if view.surface is not surface:  # another has come meanwhile
            return
        loads = record['load']['low'], record['load']['high']
        self._followed[view] = surface.sha256, limits, exact, loads
        head = {'axis': view.name, 'without': view.without}
        view.map_frame = frame('map', head | record, arrays)
        self._hub.tell(view.map_frame)

    async def _in_turn(self, compute: Callable[..., Any], *args: Any) -> Any:
        async with self._turn:
            return await asyncio.to_thread(compute, *args)

    def _view(self, request: Mapping[str, Any]) -> tuple[AxisView, Surface, Limits]:
        """Return the axis of a request, its surface and limits; raises InputError without."""
        view = self._hub.view(text_in(request, 'axis'))
        if view.surface is None:
            raise Refused(view.no_map)
        if view.limits['rcs_limit'] is None:
            raise Refused(phrase('no_limits'))
        oil = request.get('oil')
        for surface in (view.surface, *self._oils):
            is_of_screw = surface.screw_name == view.surface.screw_name
            if is_of_screw and oil in (None, surface.oil_name):
                return view, surface, maps.limits_of(view.limits)
        raise InputError(
            f'oil is {oil!r:.40}, allowed is {", ".join(self.grades(view))}: give the page more '
            'surfaces with --oils'
        )

    async def _map(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        view, surface, limits = self._view(request)
        rows = view.history.since(0)
        warmth = number_in(request, 'temperature_degC', maps.oil_temperature(rows, surface))
        motion, quantity = maps.Motion.of(rows, limits), text_in(request, 'quantity')
        without = view.without if surface is view.surface else 0
        record, arrays = await self._in_turn(
            maps.map_of, surface, limits, warmth, motion, quantity
        )
        head = {'axis': view.name, 'oil': surface.oil_name, 'without': without}
        return head | record, arrays

    async def _read(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        view, surface, limits = self._view(request)
        warmth = maps.oil_temperature(view.history.since(0), surface)
        return await self._in_turn(
            maps.point_of,
            surface,
            limits,
            number_in(request, 'speed_rpm') * RPM,
            number_in(request, 'load_N'),
            number_in(request, 'temperature_degC', warmth),
        ), {}

    async def _ghosts(self, browser: Browser, request: Mapping[str, Any]) -> Answer:
        view, surface, limits = self._view(request)
        factors = request.get('factors')
        if not isinstance(factors, list) or not 1 <= len(factors) <= MOST_FACTORS:
            raise InputError(f'factors must be a list of 1 to {MOST_FACTORS} numbers')
        known = [number_in({'factor': factor}, 'factor') for factor in factors]
        if not all(FACTORS[0] <= factor <= FACTORS[1] for factor in known):
            raise InputError(f'a factor must be {FACTORS[0]:g} to {FACTORS[1]:g}')
        rows = view.history.since(0)
        motion = maps.Motion.of(rows, limits)
        if not motion.speed.size:
            raise Refused(phrase('not_moved'))
        warmth = number_in(request, 'temperature_degC', maps.oil_temperature(rows, surface))
        return await self._in_turn(maps.ghosts_of, surface, limits, motion, warmth, known)
