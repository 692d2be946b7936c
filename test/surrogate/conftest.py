# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reference tables and shared objects of the offline tests."""

import csv
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from surrogate.asperities.law import rcs_at
from surrogate.builder.closed_form import build_closed_form, default_settings
from surrogate.builder.full.nodes import onset_speeds
from surrogate.builder.tiers import screw_and_oil
from surrogate.cli import add_commands, Parser
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw import closed_form

REFERENCE = Path(__file__).parents[1] / 'reference'


def rows(name):
    lines = (REFERENCE / name).read_text(encoding='utf-8').splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith('#')))


@pytest.fixture(scope='session')
def table():
    return rows


@pytest.fixture
def run(request):
    """Return the function that runs one command line, which begins with COMMAND of the module."""

    def run_line(*words, read_bag=None):
        parser = Parser()
        add_commands(parser.add_subparsers(required=True), read_bag)
        args = parser.parse_args([*request.module.COMMAND, *map(str, words)])
        return args.handler(args)

    return run_line


@pytest.fixture(scope='session')
def screw():
    return load_screw('nominal')


@pytest.fixture(scope='session')
def oil():
    return load_lubricant('iso_vg_68')


@pytest.fixture(scope='session')
def surface_data(screw, oil):
    return build_closed_form(screw, oil, default_settings(screw))


@pytest.fixture(scope='session')
def stand_in():
    """Return `chain` and `run` of a fast model in place of solved contacts."""
    return SimpleNamespace(chain=chain_stand_in, run=run_stand_in)


def chain_stand_in(inputs):
    """Return what `solve_chain` returns: formulas, and contact by the law at the onset speed."""
    screw, lubricant = screw_and_oil(inputs)
    load, heat = inputs['load'], inputs['temperature']
    place = np.array([load]), np.array([heat])
    onset = float(onset_speeds(screw, lubricant, *place)[0, 0])
    speeds = np.array(inputs['speeds'])
    touching = rcs_at(np.log(speeds / onset)).tolist()
    return {
        sense: [
            stand_in_point(formula, rcs, 0.8 * rcs)
            for speed, rcs in zip(speeds, touching, strict=True)
            for formula in [closed_form.solve(screw, lubricant, float(speed), sign * load, heat)]
        ]
        for sense, sign in (('opposing', 1.0), ('assisting', -1.0))
    }


def stand_in_point(formula, rcs, share):
    if not math.isfinite(formula.film_ratio):
        return {'converged': False, 'status': 'no load'}
    return {
        'friction_torque': 0.5 * float(formula.friction_torque) + 0.06 * rcs,
        'rcs': rcs,
        'asperity_share': share,
        'film_ratio': float(formula.film_ratio),
        'central_film': float(formula.central_film),
        'minimum_film': float(formula.minimum_film),
        'friction_coefficient': 0.02,
        'max_pressure': float(formula.max_pressure),
        'worst_contact': int(formula.worst_contact),
        'rcs_deviation': 0.3 * rcs,
        'converged': True,
        'status': '',
    }


def run_stand_in(tasks):
    return {name: chain_stand_in(inputs) for name, inputs in tasks.items()}
