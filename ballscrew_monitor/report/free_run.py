# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parasitic torque of a screw out of a recording without load, if it is one."""

from collections.abc import Mapping
import dataclasses
import datetime
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import kelvin, POSITION_UNITS
from ballscrew_monitor.core.inputs import OpenInput, Source
from ballscrew_monitor.recordings import no_load
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.settings.axis import scaling_of
from ballscrew_monitor.settings.parameters import absolute, is_configured
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw

RECORD = (
    'Record a free run: no process force, the motor torque, at least five constant speeds in both '
    'directions, two seconds or more each (ballscrew fingerprint prints such a program); then '
    'friction beside the contacts is identified (--free-run names a log that is one)'
)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class FreeRun:
    """What an identification gave: its page as text and the sheet that it wrote, or why not."""

    log: str
    axis: str
    text: str
    sheet: Path | None = None


def identified(
    bag: Bag,
    values: Mapping[str, Any],
    axis: str,
    sheets: tuple[Screw, Lubricant],
    out: Path,
    *,
    is_free: bool = False,
) -> FreeRun | None:
    """
    Identify the parasitic torque by a recording, and write the screw with it to `out`.

    Returns None if the recording is no free run of the axis: without speed and motor torque, with
    a measured load above the light one, or with a load that is not known, unless `is_free`.

    """
    from surrogate.datasheet_writer import write_sheet
    from surrogate.identify.data import no_load_run
    from surrogate.identify.fit import identify
    from surrogate.identify.model import closed_form_model
    from surrogate.identify.record import identification_record, identified_screw, page

    screw, oil = sheets
    if not _is_free(bag, values, axis, screw, is_free):
        return None
    wanted = [Source.SPEED, Source.TORQUE]
    if is_configured(axis, values, Source.TEMPERATURE):
        wanted.append(Source.TEMPERATURE)
    name = bag.path.name
    try:
        columns, notes = no_load.read_no_load(
            bag, [_channel(values, axis, source, screw.lead) for source in wanted]
        )
        oil_temperature = kelvin(values[f'{axis}.temperature.default'])
        run = no_load_run(columns, source=name, temperature=oil_temperature, notes=notes)
        contacts = closed_form_model(screw, oil, run)
        result = identify(screw, run, contacts)
    except InputError as error:
        return FreeRun(log=name, axis=axis, text=f'not identified: {error}')
    text = page(identification_record(screw, run, contacts, result))
    if not result.converged:
        return FreeRun(log=name, axis=axis, text=text)
    out.parent.mkdir(parents=True, exist_ok=True)
    day = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    write_sheet(out, identified_screw(screw, run, contacts, result, day))
    return FreeRun(log=name, axis=axis, text=text, sheet=out)


def _is_free(
    bag: Bag, values: Mapping[str, Any], axis: str, screw: Screw, is_stated: bool
) -> bool:
    speed, torque = Source.SPEED, Source.TORQUE
    if not is_configured(axis, values, torque) or values[f'{axis}.speed.unit'] in POSITION_UNITS:
        return False
    if is_stated:
        return True
    if not is_configured(axis, values, Source.LOAD):
        return bool(values[f'{axis}.health.always_free'])
    light = values[f'{axis}.limits.light_load_fraction'] * screw.preload
    channels = [_channel(values, axis, source, screw.lead) for source in (speed, Source.LOAD)]
    return no_load.largest(bag, channels)[Source.LOAD] <= light


def _channel(values: Mapping[str, Any], axis: str, source: Source, lead: float) -> OpenInput:
    prefix = f'{axis}.{source.name.lower()}'
    return OpenInput(
        source=source,
        topic=absolute(values[f'{prefix}.topic']),
        field=values[f'{prefix}.field'],
        scaling=scaling_of(axis, values, source, lead),
    )
