# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the verdict of a report stands on: model, screw, oil and limits, and how each is known."""

from collections.abc import Iterable, Sequence
import math

from ballscrew_monitor.core.conversions import celsius
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.recordings.log_facts import grouped
from ballscrew_monitor.recordings.words import shown_unit
from ballscrew_monitor.report.case import AxisCase
from ballscrew_monitor.report.inputs_seen import inputs_seen, NAMES
from ballscrew_monitor.report.markup import element, joined, Markup, table, TableRow
from surrogate.units import MILLI

TIERS = {
    'full': 'full model (solved contacts, roughness that rolls)',
    'closed_form': 'closed-form model (published formulas): an estimate, whose contact begins '
    'within a factor of two in speed',
}
KEYS = {
    'screw': 'the screw',
    'oil': 'the oil',
    'lead_mm': 'lead of {} mm',
    'efficiency': 'efficiency of {} used for the load',
    'torque_constant_Nm_per_A': 'torque constant of the motor of {} N m/A',
    'time.rate_Hz': 'rate of the samples of {} Hz',
    'time.epoch': 'date',
}
"""Words for what a log may leave to be assumed, with a place for its value."""
TAGS = {
    'measured': 'tag measured',
    'stated': 'tag',
    'assumed': 'tag assumed',
    'contradiction': 'tag bad',
}


def caution(cases: Sequence[AxisCase]) -> Iterable[Markup]:
    """Yield what the verdicts rest on that is neither measured nor stated, if anything."""
    groups = grouped({case.axis: list(_assumed_names(case)) for case in cases})
    head, tail = 'Assumed, neither measured nor stated:', 'The verdict holds as far as these do.'
    if not groups:
        return
    if len(cases) == 1:
        names = ', '.join(groups[0][1])
        yield element('p', f'{head} {names}. {tail}', class_='hint')
        return
    items = (element('li', f'{whose}: {", ".join(names)}') for whose, names in groups)
    yield element(
        'div', element('p', head), element('ul', *items), element('p', tail), class_='hint'
    )


def _assumed_names(case: AxisCase) -> Iterable[str]:
    """Yield in words what is assumed of an axis."""
    if case.nominal:
        yield from (KEYS['screw'], KEYS['oil'])
    if case.load_origin:
        yield f'axial load, {case.load_origin}'
    if Source.TEMPERATURE not in case.inputs and case.facts.default_temperature_known == 'assumed':
        yield f'oil temperature of {celsius(case.settings.default_temperature):g} °C'
    for key, one in case.facts.assumed.items():
        if key not in ('load.from', 'load', 'temperature_degC'):
            yield _assumed_name(key, one.get('value'))


def _assumed_name(key: str, value: object) -> str:
    """Return in words what is assumed by its place in a map."""
    shown = f'{value:g}' if isinstance(value, float) else str(value)
    if key == 'efficiency' and isinstance(value, float):
        shown = f'{100.0 * value:g} %'
    what, dot, part = key.rpartition('.')
    if dot and part == 'unit':
        return f'{what} in {shown_unit(shown)}'
    words = KEYS.get(key)
    return words.format(shown) if words else key.replace('.', ' ').replace('_', ' ')


def assumptions_part(case: AxisCase, parameters: str) -> Markup:
    """Return what the verdict stands on: model, screw, oil, limits, and what was assumed."""
    surface, limits = case.surface, case.settings.limits
    facts = [
        ('Model', TIERS.get(surface.tier, surface.tier), _stated(case, 'surface')),
        ('Screw', surface.screw_name, _stated(case, 'screw')),
        *_leads(case),
        ('Preload', f'{surface.preload:g} N', _stated(case, 'screw')),
        ('Oil', surface.oil_name, _stated(case, 'oil')),
        *_conditions(case),
        (
            'Limits',
            f'RCS below {limits.rcs:g}, efficiency from {100 * limits.efficiency:g} %, '
            f'judged from {limits.light_load:.4g} N and {limits.standstill_speed:g} rad/s on',
            _stated(case, 'limits'),
        ),
        ('Parameters', parameters, _stated(case, 'parameters')),
    ]
    rows = [_fact_row(*fact) for fact in facts]
    rows += [
        _fact_row(f'Assumed: {key}', f'{one.get("value")}: {one.get("reason", "")}', 'assumed')
        for key, one in case.facts.assumed.items()
    ]
    return joined(
        [
            element('h3', 'What this rests on'),
            table(('What', 'Value', 'Known how'), rows),
            element(
                'p',
                'Screw, oil and model are those of the parameters; nothing in a recording tells '
                'whether the machine has them.',
                class_='muted',
            ),
        ]
    )


def _stated(case: AxisCase, key: str) -> str:
    unsaid = case.nominal or key in case.facts.assumed or key in case.facts.defaulted
    return 'assumed' if unsaid else 'stated'


def _leads(case: AxisCase) -> list[tuple[str, str, str]]:
    """Return the lead, and that of the surface where it is another."""
    used, known = case.surface.lead, _stated(case, 'lead_mm')
    if math.isnan(case.facts.lead) or math.isclose(case.facts.lead, used, rel_tol=1e-6):
        return [('Lead', f'{MILLI * used:g} mm', known)]
    text = f'{MILLI * used:g} mm, not that of the axis: build the surface of this screw'
    return [
        ('Lead', f'{MILLI * case.facts.lead:g} mm', known),
        ('Lead of the surface', text, 'contradiction'),
    ]


def _conditions(case: AxisCase) -> list[tuple[str, str, str]]:
    """Return where oil temperature and load come from."""
    rows = []
    for seen in inputs_seen(case):
        if seen.source in (Source.TEMPERATURE, Source.LOAD):
            text = f'{seen.origin}, {seen.place}' if seen.place else seen.origin
            rows.append((NAMES[seen.source], text, seen.known))
    oil = case.survey.oil
    if math.isfinite(oil.mean):
        low, high = celsius(oil.low), celsius(oil.high)
        span = f'{low:.3g} °C' if low == high else f'{low:.3g} to {high:.3g} °C'
        rows.append(('Oil in motion', span, rows[1][2] if len(rows) > 1 else 'assumed'))
    return rows


def _fact_row(name: str, value: str, known: str) -> TableRow:
    return TableRow((name, value, element('span', known, class_=TAGS[known])))
