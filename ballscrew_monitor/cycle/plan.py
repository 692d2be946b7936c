# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a run is to do: checked before anything is started or written."""

from collections.abc import Sequence
import dataclasses
import importlib.util
from pathlib import Path
from typing import Any

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import speed_messages
from ballscrew_monitor.report.logs import JUDGED
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import Axis, build_axis
from ballscrew_monitor.settings.topics import input_topics, with_types
from surrogate.files import InputError

RECORDING = 'cycle'
"""Name of the recording in the output directory, without its ending."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """
    A checked run: what is played, with which parameters, and where it is written.

    `expected` counts the speed messages by axis, `rate` is bag time over wall time [-].

    """

    bag: Bag
    params: Path
    values: dict[str, Any]
    axes: Sequence[Axis]
    expected: dict[str, int]
    rate: float
    out: Path


def plan(bag: Path, params: Path, out: Path, rate: float) -> Plan:
    """
    Return a checked plan for bag time over wall time `rate` [-].

    Of a damaged bag the intact part is played; the notes of the bag say how much that is. Raises
    InputError before anything is started or written.

    """
    for name in ('matplotlib', 'polars', 'contourpy'):  # asked early, imported late: they are slow
        if importlib.util.find_spec(name) is None:
            raise ModuleNotFoundError(f'no report without {name}', name=name)
    if not 0.0 < rate <= 1000.0:
        raise InputError(f'rate is {rate:g}, allowed is above 0 to 1000')
    opened = Bag(bag, salvage=True)
    values = with_types(parameters.read_file(params), opened.types)
    axes = [build_axis(name, values) for name in values['axes']]
    taken = {(out / f'{RECORDING}.mcap').resolve(), (out / JUDGED / f'{JUDGED}.mcap').resolve()}
    if any(file.resolve() in taken for file in opened.files):
        raise InputError(
            f'bag {bag} would be overwritten by the recording in {out}, '
            'another output directory must be given'
        )
    opened.require(input_topics(values))
    return Plan(
        bag=opened,
        params=params,
        values=values,
        axes=axes,
        rate=rate,
        out=out,
        expected=speed_messages(opened, axes),
    )
