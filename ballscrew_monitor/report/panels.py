# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What each panel over time shows: title, unit, lines, limits and bands."""

import itertools
from typing import Any

from ballscrew_monitor.core.judgement import Limits
from surrogate.surface import FILM_RATIO_LIMITS, REGIMES

SMALLEST_RCS, SMALLEST_RATIO, LARGEST_RATIO = 1e-4, 0.05, 10.0
"""Ends of the logarithmic panels [-]: what is smaller is drawn on the lowest line."""
HEIGHT = 140


def panels(limits: Limits) -> list[dict[str, Any]]:
    """Return all panels of an axis, in their order."""
    efficiency, percent = limits.efficiency, 100.0 * limits.efficiency
    return [
        _panel('Screw speed', 'rev/min', [_line('speed', 'speed')]),
        _panel('Axial load, positive along the axis', 'N', [_line('load', 'load')]),
        _panel('Oil temperature', '°C', [_line('temperature', 'oil')], height=110),
        _panel(
            'Efficiency, where it is judged',
            '%',
            [_line('efficiency', 'efficiency')],
            limits=[_limit(percent, f'limit {100 * efficiency:g} %', 'efficiency')],
            most=100.0,
        ),
        _panel(
            'Film ratio: oil film over roughness',
            '',
            [_line('film_ratio', 'film ratio')],
            floor=SMALLEST_RATIO,
            bands=_bands(),
            show=[0.5, LARGEST_RATIO],
        ),
        _panel(
            'RCS: share of the load carried where metal pierces the oil film',
            '',
            [_line('rcs', 'RCS')],
            floor=SMALLEST_RCS,
            limits=[_limit(limits.rcs, f'limit {limits.rcs:g}', 'rcs')],
            show=[SMALLEST_RCS, 1.0],
        ),
        _panel(
            'Torque on the screw, measured and modelled',
            'N m',
            [
                _line('measured_torque', 'measured', 'measured'),
                _line('machine_torque', 'modelled', 'modelled', dashed=True),
            ],
        ),
    ]


def _panel(title: str, unit: str, series: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    return {
        'title': f'{title} [{unit}]' if unit else f'{title} [-]',
        'unit': unit,
        'height': HEIGHT,
        'series': series,
        'floor': None,
        'most': None,
        'limits': [],
        'bands': [],
        'show': [limit['value'] for limit in more.get('limits', [])],
    } | more


def _line(key: str, label: str, colour: str = 'ink', *, dashed: bool = False) -> dict[str, Any]:
    return {'key': key, 'label': label, 'colour': colour, 'dashed': dashed}


def _limit(value: float, label: str, colour: str) -> dict[str, Any]:
    return {'value': value, 'label': label, 'colour': colour}


def _bands() -> list[dict[str, Any]]:
    edges = itertools.pairwise((SMALLEST_RATIO / 2, *FILM_RATIO_LIMITS, 10 * LARGEST_RATIO))
    return [
        {'low': low, 'high': high, 'colour': f'{regime.word}-band', 'label': regime.word}
        for regime, (low, high) in zip(REGIMES, edges, strict=True)
    ]
