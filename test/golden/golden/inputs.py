# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Recordings and parameters that golden outputs are made of, the same bytes every time."""

import dataclasses
import math
from pathlib import Path

from ballscrew_monitor.recordings.log_facts import PREFIX
import monthly_logs
import nominal_cycle
import numpy as np
from recording import write_bag
from scenario import generate, NOMINAL_PARAMETERS, PARAMETERS
from scenarios import SCENARIOS
import yaml

SURFACES = Path(__file__).resolve().parents[1] / 'surfaces'
NOMINAL, FEED = SURFACES / 'nominal.npz', SURFACES / 'feed.npz'
CYCLE = 'nominal_cycle'
RECORDINGS = (*SCENARIOS, CYCLE)
LONG = ('warm_up', 'preload_loss', CYCLE)
"""Recordings with a state each 0.1 s instead of one for each sample."""


def scenario(folder, name):
    """Write a scenario of `bags/` into a folder; return its bag and its parameters."""
    bag = folder / name
    if name == CYCLE:
        nominal_cycle.generate(bag)
        text = NOMINAL_PARAMETERS.read_text()
    else:
        generate(SCENARIOS[name](), bag)
        text = (bag / PARAMETERS).read_text()
    parameters = folder / f'{name}.yaml'
    changes = {'publish_period': 0.1} if name in LONG else {}
    parameters.write_text(changed(text, **changes))
    return bag, parameters


def changed(text, **changes):
    """Return a parameter file with other values of its axes, and the surface of the tests."""
    content = yaml.safe_load(text)
    (node,) = content.values()
    values = node['ros__parameters']
    for axis in values['axes']:
        values[axis] |= {'surface': str(NOMINAL)} | changes
    return yaml.safe_dump(content, sort_keys=False)


PLAN = monthly_logs.Plan(logs=9, apart=7 * monthly_logs.DAY, cuts=(900.0,), period=0.1)
WORSE, RUBS = 7, 0.3
"""Logs of an axis, the number of the first in which a cover rubs, and its torque [N m]."""


def months(folder):
    """Write the logs of an axis whose cover rubs at last, with the parameters that they carry."""
    folder.mkdir()
    for number in range(PLAN.logs):
        month = monthly_logs.Month(number=number, plan=PLAN)
        records = month_records(month)
        texts = {f'{PREFIX}parameters': monthly_logs.parameters_text(str(FEED))}
        write_bag(folder / f'month_{month.number + 1}', records, texts)
    return folder


def month_records(month):
    """Return the messages of a month, with a friction in closed form."""
    motion = monthly_logs.samples_of(monthly_logs.motion_of(month), PLAN.period)
    speed, along = np.abs(motion.speed), np.tanh(motion.speed / 0.1)
    film = 0.35 * (1.0 + 0.05 * np.sqrt(speed))
    drag = film * np.exp(-0.012 * (motion.oil - 35.0)) + 2e-5 * np.abs(motion.load)
    drag += RUBS * (month.number >= WORSE)
    drag += monthly_logs.WIPER + monthly_logs.SEAL * np.exp(-speed / monthly_logs.SEAL_SPEED)
    torque = along * drag - motion.load * monthly_logs.LEAD / 2.0 / math.pi
    wave = np.sin(0.37 * np.arange(torque.size) * (1.0 + month.number))
    torque, load = torque + 0.01 * wave, motion.load + 4.0 * wave[::-1]
    numbers = [np.round(one, 6) for one in (torque, load, motion.oil)]
    rounded = dataclasses.replace(motion, oil=numbers[2])
    made = monthly_logs._messages(month, rounded, *numbers)
    return sorted(made, key=lambda record: (record.log_time, record.topic))
