# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Recordings and parameters that golden outputs are made of, the same bytes every time."""

from pathlib import Path

import nominal_cycle
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
    changes = {'surface': str(NOMINAL)} | ({'publish_period': 0.1} if name in LONG else {})
    parameters.write_text(changed(text, **changes))
    return bag, parameters


def changed(text, **changes):
    """Return a parameter file with other values of its axes."""
    content = yaml.safe_load(text)
    (node,) = content.values()
    values = node['ros__parameters']
    for axis in values['axes']:
        values[axis] |= changes
    return yaml.safe_dump(content, sort_keys=False)
