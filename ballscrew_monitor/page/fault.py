# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""File to send when something fails, as the page makes it: what it knows, and what lies here."""

import asyncio
from collections.abc import Awaitable, Callable, Mapping
import contextlib
import csv
import io
from pathlib import Path
from typing import Any

from ballscrew_monitor.clients.fault_report import fault_report, FaultCase, is_state
from ballscrew_monitor.node.restart_state import AUTO, state_directory
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.history import Array, COLUMNS
from ballscrew_monitor.page.hub import Hub
from surrogate.files import json_text

SPAN = 120.0  # [s] of the last rows of an axis
Known = tuple[str, Array, dict[str, Any]]
"""Name of an axis, its rows, and what else is known of it."""
Making = Callable[[], Awaitable[bytes]]


def fault_maker(hub: Hub, log: Path | None, token: str | None) -> Making:
    """Return what makes the file in a thread of its own, for nodes or a recording `log`."""

    async def make() -> bytes:
        views = list(hub.axes.values())
        axes = [(view.name, view.history.since(0), known_of(view)) for view in views]
        events = [event for view in views for event in view.events.values()]
        names = [event.get('acknowledged_by', '') for event in events]
        reasons = [reason for view in views for reason in reasons_in(view)]
        return await asyncio.to_thread(_content, views, axes, names, reasons)

    def _content(
        views: list[AxisView], axes: list[Known], names: list[str], reasons: list[str]
    ) -> bytes:
        case = FaultCase(
            paths=[log] if log else sorted(places_of(views)),
            texts={name: text for axis in axes for name, text in texts_of(*axis).items()},
            tokens=[token] if token else [],
            table_refused=False,
            names=names,
            reasons=reasons,
        )
        return fault_report(case)[0]

    return make


def known_of(view: AxisView) -> dict[str, Any]:
    """Return what is known of an axis but for its rows, which the view changes no more."""
    return {
        **view.hello(),
        'state': view.state,
        'standing': view.standing,
        'health': view.health,
        'events': list(view.events.values()),
        'codes': dict(view.codes),
        'parameters': view.parameters,
    }


def texts_of(name: str, rows: Array, known: Mapping[str, Any]) -> dict[str, str]:
    """Return the last rows of an axis as CSV, and as JSON all else that is known of it."""
    buffer = io.StringIO()
    writer = csv.writer(buffer)
    writer.writerow(COLUMNS)
    writer.writerows(rows[rows[:, 0] >= rows[-1:, 0].max(initial=0.0) - SPAN].tolist())
    name = name.strip('/').replace('/', '_')
    return {f'page_{name}.json': json_text(known), f'page_{name}.csv': buffer.getvalue()}


def reasons_in(view: AxisView) -> list[str]:
    """Return why warnings of an axis were acknowledged and shelved."""
    reasons = [event.get('acknowledge_reason', '') for event in view.events.values()]
    return [*reasons, (view.state.get('shelved') or {}).get('reason', '')]


def places_of(views: list[AxisView]) -> set[Path]:
    """Return the state directories and recordings on this machine of the nodes of some axes."""
    places: set[Path] = set()
    for view in views:
        values: Mapping[str, Any] = view.parameters
        with contextlib.suppress(OSError):  # of another user
            state = state_directory(str(values.get('state_dir', AUTO)), view.node)
            places |= {state} if state is not None and is_state(state) else set()
        with contextlib.suppress(OSError):
            recordings = Path(str(values.get('record_dir', AUTO)))
            places |= {recordings} if recordings.is_absolute() and recordings.is_dir() else set()
    return places
