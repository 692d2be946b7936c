# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""An identification as a record, a page and the datasheets that hold what was found."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, replace
from itertools import combinations
import math
from typing import Any

import numpy as np
from surrogate.formulas.geometry import helix_angle
from surrogate.formulas.torque import drag_torque_catalogue
from surrogate.identify.data import NoLoadRun
from surrogate.identify.fit import Identification
from surrogate.identify.model import ContactModel, thickened
from surrogate.identify.onset import calibrated_band, onset_speeds
from surrogate.parameters import Lubricant, Screw
from surrogate.screw import closed_form
from surrogate.units import digits, RPM, ZERO_CELSIUS

UNITS = {
    'parasitic_torque': 'N m',
    'parasitic_torque_rate': 'N m s/rad',
    'torque_offset': 'N m',
    'viscosity_factor': '-',
    'asperity_friction': '-',
    'onset_factor': '-',
    'seal_torque': 'N m',
}
"""Unit of each parameter."""
CLOSED_FORM_SHARE = 0.1
"""Asperity share from which on the closed-form tier is warned about [-]."""
EXPECTED_SCATTER = (0.5, 2.0)
"""Residual over the standard deviation given, root mean square, that is not warned about [-]."""
STRONG = 0.95
"""Correlation from which on two parameters are warned about [-]."""
MOST_LOAD = 0.25
"""Axial load over the preload up to which a run counts as without load [-]."""
PROVENANCE = 'Parasitic torque identified from'
SUFFIX = '_identified'


def identification_record(
    screw: Screw, run: NoLoadRun, contacts: ContactModel, fit: Identification
) -> dict[str, Any]:
    """Return an identification as plain numbers, SI units, NaN with a reason where unknown."""
    speed = np.abs(run.speed)
    parasitic = fit.value('parasitic_torque') + fit.value('parasitic_torque_rate') * speed
    total = fit.contacts + parasitic
    share = np.divide(fit.contacts, total, out=np.ones_like(total), where=total > 0)
    return {
        'tier': contacts.tier,
        'status': _status(fit),
        'converged': fit.converged,
        'warnings': [*_warnings(screw, run, contacts, fit)],
        'screw': screw.name,
        'oil': contacts.lubricant.name,
        'data': run.source,
        'notes': list(run.notes),
        'points': len(run.speed),
        'speed_range_rad_s': [float(speed.min()), float(speed.max())],
        'temperature_K': run.mean_temperature,
        'parameters': [
            {'name': estimate.name, 'unit': UNITS[estimate.name], **asdict(estimate)}
            for estimate in fit.estimates
        ],
        'correlation': {'of': list(fit.correlated), 'matrix': fit.correlation.tolist()},
        'onset': _onset_record(run, contacts, fit),
        'offset_force_N': fit.value('torque_offset') * 2 * math.pi / screw.lead,
        'residual_rms_Nm': fit.rms,
        'residual_rms_before_Nm': fit.rms_before,
        'degrees_of_freedom': fit.degrees_of_freedom,
        'reduced_chi_square': fit.reduced_chi_square,
        'contact_share_range': [float(share.min()), float(share.max())],
        'catalogue_drag_torque_Nm': drag_torque_catalogue(
            screw.preload, screw.lead, helix_angle(screw)
        ),
    }


def _status(fit: Identification) -> str:
    if not fit.converged:
        return 'the fit ended before it converged'
    return 'the onset is refused, and no sheet is written' if fit.onset_refused else 'fitted'


def _onset_record(
    run: NoLoadRun, contacts: ContactModel, fit: Identification
) -> dict[str, Any] | None:
    """Return the onset of the raceway under the load of the run, None where it was not asked."""
    onset = fit.estimate('onset_factor')
    if onset is None:
        return None
    speed, low, high = onset_speeds(contacts, run, (onset.value, onset.low, onset.high))
    torque = run.direction * fit.after
    return {
        'speed_rad_s': speed,
        'speed_low_rad_s': low,
        'speed_high_rad_s': high,
        'turns_up_rad_s': abs(float(run.speed[np.argmin(torque)])),
        'band': calibrated_band(onset.low, onset.high),
        'reason': onset.reason,
        'refused': fit.onset_refused,
    }


def _warnings(
    screw: Screw, run: NoLoadRun, contacts: ContactModel, fit: Identification
) -> Iterator[str]:
    """Yield a sentence for each thing that makes the numbers say less than they seem to."""
    yield from (
        f'{estimate.name}: {estimate.reason}' for estimate in fit.estimates if estimate.reason
    )
    if not run.both_directions:
        yield (
            'one direction only: a weight on the axis or a wrong zero of the torque counts as '
            'parasitic torque'
        )
    hint = f'check oil, temperature, preload and the sign of the torque, tier {contacts.tier}'
    if fit.value('parasitic_torque') == 0:
        yield f'the contacts of the model take more torque than was measured: {hint}'
    elif fit.value('parasitic_torque_rate') == 0:
        yield f'the torque measured rises less with speed than that of the contacts: {hint}'
    touching = int((contacts.asperity_share > CLOSED_FORM_SHARE).sum())
    calibrated = fit.estimate('onset_factor') is not None
    if touching and contacts.tier == closed_form.TIER and not calibrated:
        yield (
            f'{touching} of {len(run.speed)} points have an asperity share above '
            f'{CLOSED_FORM_SHARE:g}, which the closed-form tier misjudges'
        )
    scatter = math.sqrt(fit.reduced_chi_square) if fit.reduced_chi_square >= 0 else 1.0
    if not EXPECTED_SCATTER[0] <= scatter <= EXPECTED_SCATTER[1]:
        misses = ', the model misses something' if scatter > 1 else ''
        yield f'the residual is {scatter:.2g} times the standard deviation given{misses}'
    load = float(np.abs(run.load).max())
    if load > MOST_LOAD * screw.preload:
        yield (
            f'the load is up to {load:.4g} N, above {MOST_LOAD:g} of the preload: what the '
            'model misses under load counts as parasitic'
        )
    if calibrated:
        yield (
            'the onset factor holds what sheet, running in, film floor and law are off by '
            'together: it tells neither the hardness nor any other key of the sheet'
        )
    for (row, first), (column, second) in combinations(enumerate(fit.correlated), 2):
        correlated = fit.correlation[row, column]
        if abs(correlated) > STRONG:
            yield (
                f'{first} and {second} are correlated by {correlated:.3f}: the data '
                'tell a mixture of them better than either'
            )


def identified_screw(
    screw: Screw, run: NoLoadRun, contacts: ContactModel, fit: Identification, day: str = ''
) -> Screw:
    """
    Return the datasheet with what was found, and in its source from where.

    An onset that has an interval is calibrated on the `day`; another one is no calibration, and
    leaves that of the datasheet unless it moves its factor.

    """
    friction, onset = fit.value('asperity_friction'), fit.estimate('onset_factor')
    rough = screw.roughness
    if not math.isnan(friction):
        rough = replace(rough, asperity_friction=friction)
    if onset is not None and not (onset.reason and onset.value == rough.onset_factor):
        band = None if onset.reason else calibrated_band(onset.low, onset.high)
        rough = replace(
            rough, onset_factor=onset.value, onset_band=band, calibrated=day if band else None
        )
    return replace(
        screw,
        name=screw.name.removesuffix(SUFFIX) + SUFFIX,
        source=f'{screw.source.split(PROVENANCE)[0].rstrip()} {_provenance(run, contacts, fit)}',
        parasitic_torque=fit.value('parasitic_torque'),
        parasitic_torque_rate=fit.value('parasitic_torque_rate'),
        typical_drag=None,
        typical_drag_low=None,
        typical_drag_high=None,
        roughness=rough,
    )


def identified_oil(
    lubricant: Lubricant, run: NoLoadRun, contacts: ContactModel, fit: Identification
) -> Lubricant:
    """Return the oil as it was in the run, anchored at its temperature."""
    return replace(
        thickened(contacts.lubricant, fit.value('viscosity_factor')),
        name=lubricant.name.removesuffix(SUFFIX) + SUFFIX,
        source=f'{lubricant.source.split(PROVENANCE)[0].rstrip()} '
        f'{_provenance(run, contacts, fit)}',
    )


def _provenance(run: NoLoadRun, contacts: ContactModel, fit: Identification) -> str:
    speed, estimates = np.abs(run.speed) / RPM, []
    for estimate in fit.estimates:
        unit = f' {UNITS[estimate.name]}' if UNITS[estimate.name] != '-' else ''
        interval = f'95 % {estimate.low:.5g} to {estimate.high:.5g}'
        estimates.append(
            f'{estimate.name} {estimate.value:.5g}{unit} ({estimate.reason or interval})'
        )
    return (
        f'{PROVENANCE} {run.source}: {len(speed)} points from '
        f'{digits(speed.min(), 4)} to {digits(speed.max(), 4)} rev/min, tier {contacts.tier}, '
        f'oil {contacts.lubricant.name} at '
        f'{run.mean_temperature - ZERO_CELSIUS:.4g} degC, residual {fit.rms:.3g} N m rms. '
        f'{"; ".join(estimates)}.'
    )


def page(record: Mapping[str, Any]) -> str:
    """Return a record as a page of text in workshop units."""
    low, high = (end / RPM for end in record['speed_range_rad_s'])
    least, most = (100 * share for share in record['contact_share_range'])
    force, weight = record['offset_force_N'], 'a weight on the axis for instance'
    return '\n'.join(
        [
            f'{record["screw"]}, {record["oil"]}, tier {record["tier"]}: '
            f'{record["points"]} points of {record["data"]}, {digits(low, 4)} to '
            f'{digits(high, 4)} rev/min, '
            f'{record["temperature_K"] - ZERO_CELSIUS:.4g} degC',
            *(f'  {_row(parameter)}' for parameter in record['parameters']),
            *_onset_rows(record['onset']),
            *([] if math.isnan(force) else [f'  {"offset as a load":22} {force:.3g} N, {weight}']),
            f'  {"residual, rms":22} {record["residual_rms_Nm"]:.4g} N m, '
            f'{record["residual_rms_before_Nm"]:.4g} N m with the datasheet',
            f'  {"contacts":22} {least:.0f} to {most:.0f} % of the friction torque; catalogue '
            f'drag {record["catalogue_drag_torque_Nm"]:.3f} N m',
            *(f'  note: {text}' for text in record['notes']),
            f'  status: {record["status"]}',
            *(f'  warning: {text}' for text in record['warnings']),
        ]
    )


def _onset_rows(onset: Mapping[str, Any] | None) -> list[str]:
    if onset is None:
        return []
    speed, low, high, turn = (
        onset[name] / RPM
        for name in ('speed_rad_s', 'speed_low_rad_s', 'speed_high_rad_s', 'turns_up_rad_s')
    )
    if onset['refused']:
        return [f'  {"contact begins":22} {onset["reason"]}']
    if onset['reason']:
        return [f'  {"contact begins":22} {digits(speed)} rev/min are taken: {onset["reason"]}']
    return [
        f'  {"contact begins":22} {digits(speed)} rev/min ({digits(low)} to {digits(high)}), '
        f'extrapolated from the torque that turns up below {digits(turn)} rev/min:',
        f'  {"":22} RCS 0.01 itself does not show in a torque; within {onset["band"]:.3g} in nine '
        'of ten',
    ]


def _row(parameter: Mapping[str, Any]) -> str:
    unit = '' if parameter['unit'] == '-' else f' {parameter["unit"]}'
    interval = f'95 %: {parameter["low"]:.4g} to {parameter["high"]:.4g}'
    value = f'{parameter["value"]:.4g}{unit:10}'
    return f'{parameter["name"]:22} {value} {parameter["reason"] or interval}'
