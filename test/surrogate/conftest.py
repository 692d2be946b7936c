# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reference tables and shared objects of the offline tests."""

from contextlib import contextmanager
import csv
from functools import lru_cache
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from surrogate.asperities import law, running_in
from surrogate.asperities.topography_onset import onset_of
from surrogate.commands.cli import add_commands, Parser
from surrogate.parameters import load_lubricant, load_screw, screw_and_oil
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.surface import FIELDS, shipped_surface
from surrogate.surface.file import read

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

    def run_line(*words, **readers):
        parser = Parser()
        add_commands(parser.add_subparsers(required=True), readers)
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
def one_small_tile():
    """
    Return the context in which raceways have one small tile: what needs no statistics of it.

    What is worked out is kept beside that of whole tiles, and for the next time.

    """
    kept, onsets = (lru_cache(one.__wrapped__) for one in (Contacts.of, onset_of))

    @contextmanager
    def small():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(running_in, 'TILES', 1)
            patch.setattr(running_in, 'LENGTH', 1.2)
            patch.setattr(running_in, 'WIDTH', 0.6)
            patch.setattr(Contacts, 'of', staticmethod(kept))
            patch.setattr(law, 'onset_of', onsets)
            yield

    return small


@pytest.fixture(scope='module')
def small_tiles(one_small_tile):
    """Draw a small tile for each raceway of a module."""
    with one_small_tile():
        yield


@pytest.fixture(scope='session')
def surface_data():
    return read(shipped_surface(tier='closed_form'))


@pytest.fixture(scope='session')
def stand_in():
    """Return a fast model in place of solved contacts, and its torque over that of formulas."""
    return SimpleNamespace(chain=chain_stand_in, run=run_stand_in, torque=torque_of_stand_in)


def chain_stand_in(inputs):
    """Return what `solve_chain` returns: formulas, of which torque and films are corrected."""
    screw, lubricant = screw_and_oil(inputs)
    load, heat = inputs['load'], inputs['temperature']
    found = closed_form.solve(
        Contacts.of(screw), lubricant, np.array(inputs['speeds']), load, heat
    )
    return {
        sense: [
            stand_in_point(found, place, torque_of_stand_in(speed, sign * load, heat))
            for place, speed in enumerate(inputs['speeds'])
        ]
        for sense, sign in (('opposing', 1.0), ('assisting', -1.0))
    }


def torque_of_stand_in(speed, load, heat):
    """Return the friction torque over that of the formulas [-]: smooth, of either sign."""
    return 1.1 + 0.02 * math.log(speed) + 1e-5 * load + 1e-3 * (heat - 313.15)


def stand_in_point(found, place, torque):
    values = {name: float(getattr(found, name)[place]) for name in FIELDS}
    if not math.isfinite(values['film_ratio']):
        return {'converged': False, 'status': 'no load'}
    values['friction_torque'] *= torque
    values['central_film'] *= 0.9
    return {
        **values,
        'worst_contact': int(found.worst_contact[place]),
        'rcs_deviation': 0.3 * values['rcs'],
        'converged': True,
        'status': '',
    }


def run_stand_in(tasks):
    return {name: chain_stand_in(inputs) for name, inputs in tasks.items()}
