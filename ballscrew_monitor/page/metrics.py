# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of all axes for Prometheus, read when it asks."""

from collections.abc import Callable, Iterable
import time

from ballscrew_monitor.page.axis_view import ACTIVE, AxisView
from ballscrew_monitor.page.history import COLUMNS
from ballscrew_monitor.page.hub import Hub
from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily
from prometheus_client.openmetrics.exposition import CONTENT_TYPE_LATEST, generate_latest
from prometheus_client.registry import Collector
from starlette.responses import Response

LABELS = ('node', 'axis')
GOOD = ('ok', 'derived')
"""States of an input that can be judged with."""
LEVELS = {'unknown': 0.0, 'ok': 1.0, 'warn': 2.0}
Values = Iterable[tuple[tuple[str, ...], float]]
"""Values of labels beyond those of the axis, and a number."""


def _level(view: AxisView) -> Values:
    yield (), LEVELS[view.state['level'] if view.standing == ACTIVE else 'unknown']


def _column(name: str) -> Callable[[AxisView], Values]:
    def newest(view: AxisView) -> Values:
        rows = view.history.since(view.history.count - 1)
        if len(rows):
            yield (), rows[-1, COLUMNS.index(name)]

    return newest


def _total(name: str) -> Callable[[AxisView], Values]:
    def total(view: AxisView) -> Values:
        if 'totals' in view.state:
            yield (), view.state['totals'][name]

    return total


def _outside_share(view: AxisView) -> Values:
    totals = view.state.get('totals', {})
    judged = totals.get('optimal_time', 0.0) + totals.get('outside_time', 0.0)
    if judged > 0.0:
        yield (), totals['outside_time'] / judged


def _inputs(name: str) -> Callable[[AxisView], Values]:
    def of_inputs(view: AxisView) -> Values:
        for each in view.state.get('inputs', ()):
            value = each['state'] in GOOD if name == 'state' else each[name]
            if each['state'] != 'not_configured' and value is not None:
                yield (each['name'],), float(value)

    return of_inputs


def _health(view: AxisView) -> Values:
    for quantity in (view.health or {}).get('quantities', ()):
        yield (quantity['name'], quantity['unit']), quantity['value']


INPUT, QUANTITY = (*LABELS, 'input'), (*LABELS, 'quantity', 'unit')
GAUGES: dict[str, tuple[str, tuple[str, ...], Callable[[AxisView], Values]]] = {
    'level': ('Level: 0 unknown, 1 ok, 2 warning', LABELS, _level),
    'outside_share_ratio': ('Part of the judged motion outside the zone', LABELS, _outside_share),
    'speed_rev_per_min': ('Screw speed, machine frame', LABELS, _column('speed_rpm')),
    'axial_load_newtons': ('Axial load, machine frame', LABELS, _column('load_N')),
    'oil_celsius': ('Oil temperature', LABELS, _column('temperature_degC')),
    'efficiency_ratio': ('Efficiency where it is judged', LABELS, _column('efficiency')),
    'rcs_ratio': ('Load carried where metal pierces the film', LABELS, _column('rcs')),
    'film_ratio': ('Film over roughness', LABELS, _column('film_ratio')),
    'input_ok': ('1 while an input can be judged with', INPUT, _inputs('state')),
    'input_age_seconds': ('Age of the last sample of an input', INPUT, _inputs('age_s')),
    'health': ('A quantity of health, such as preload or life used', QUANTITY, _health),
}
COUNTERS: dict[str, tuple[str, tuple[str, ...], Callable[[AxisView], Values]]] = {
    'running_seconds': ('Time in motion', LABELS, _total('running_time')),
    'outside_seconds': ('Time in motion outside the zone', LABELS, _total('outside_time')),
    'energy_lost_joules': ('Energy lost to friction', LABELS, _total('energy_lost')),
    'input_lost': ('Messages of an input lost on the way', INPUT, _inputs('lost')),
    'input_dropped': ('Messages of an input refused', INPUT, _inputs('dropped')),
}
"""Name, help, labels and values of each number of an axis."""


class HubCollector(Collector):
    """Reads the hub."""

    def __init__(self, hub: Hub, wrong_tokens: Callable[[], int]) -> None:
        self._hub, self._wrong_tokens = hub, wrong_tokens

    def collect(self) -> Iterable[GaugeMetricFamily | CounterMetricFamily]:
        """Yield all families of numbers."""
        for table, kind in ((GAUGES, GaugeMetricFamily), (COUNTERS, CounterMetricFamily)):
            for name, (text, labels, values) in table.items():
                family = kind(f'ballscrew_{name}', text, labels=labels)
                for view in self._hub.axes.values():
                    for more, value in values(view):
                        family.add_metric([view.node, view.axis, *more], value)
                yield family
        age = GaugeMetricFamily(
            'ballscrew_state_age_seconds', 'Since the last state', labels=LABELS
        )
        for view in self._hub.axes.values():
            age.add_metric([view.node, view.axis], view.age(time.monotonic()))
        yield age
        yield GaugeMetricFamily(
            'ballscrew_page_browsers', 'Browsers that look', value=len(self._hub.browsers)
        )
        for name, text, count in (
            ('dropped_frames', 'Frames that a slow browser did not get', self._hub.dropped),
            ('lost_messages', 'Messages of nodes that were lost on the way', self._hub.missed),
            ('wrong_tokens', 'Tokens that were wrong', self._wrong_tokens()),
        ):
            yield CounterMetricFamily(f'ballscrew_page_{name}', text, value=count)


class Metrics:
    """Answers of `/metrics`."""

    def __init__(self, collector: HubCollector) -> None:
        self._registry = CollectorRegistry()
        self._registry.register(collector)

    def __call__(self) -> Response:
        """Return the answer of now."""
        return Response(generate_latest(self._registry), media_type=CONTENT_TYPE_LATEST)
