# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reference tables and shared objects of the offline tests."""

from collections.abc import Mapping
import csv
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from surrogate.builder.closed_form import build_closed_form, default_settings
from surrogate.builder.full.chain import solved_chain
from surrogate.builder.tiers import screw_and_oil
from surrogate.formulas import closed_form
from surrogate.parameters import load_lubricant, load_screw, Lubricant, Screw
from surrogate.surface.file import SurfaceData

REFERENCE = Path(__file__).parents[1] / 'reference'


def rows(name: str) -> list[dict[str, str]]:
    """Return the rows of a reference table, without its header lines."""
    lines = (REFERENCE / name).read_text(encoding='utf-8').splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith('#')))


@pytest.fixture(scope='session')
def table():
    """Return the reader of the reference tables."""
    return rows


@pytest.fixture(scope='session')
def screw() -> Screw:
    """Return the nominal screw."""
    return load_screw('nominal')


@pytest.fixture(scope='session')
def oil() -> Lubricant:
    """Return the nominal oil."""
    return load_lubricant('iso_vg_68')


@pytest.fixture(scope='session')
def surface_data(screw: Screw, oil: Lubricant) -> SurfaceData:
    """Build the nominal surface once."""
    return build_closed_form(screw, oil, default_settings(screw))


@pytest.fixture(scope='session')
def stand_in() -> SimpleNamespace:
    """Return `solve` and `run` of a fast model in place of solved contacts."""
    return SimpleNamespace(solve=solve_stand_in, run=run_stand_in)


ONSET_RATIO, STEEPNESS = 0.03, 4.0


def solve_stand_in(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return what `solve_chain` returns, fast: formulas and a logistic share of contact.

    Smooth in all inputs, with draws that scatter.

    """
    drawn = np.random.default_rng(inputs['draw'])
    scale, shift = np.exp(drawn.normal(0.0, 0.1, size=2))
    return {
        sense: [stand_in_record(inputs, speed, sign, scale, shift) for speed in inputs['speeds']]
        for sense, sign in (('opposing', 1.0), ('assisting', -1.0))
    }


def stand_in_record(
    inputs: Mapping[str, Any], speed: float, sign: float, scale: float, shift: float
) -> dict[str, Any]:
    screw, lubricant = screw_and_oil(inputs)
    found = closed_form.solve(
        screw, lubricant, speed, sign * inputs['load'], inputs['temperature']
    )
    ratio = float(found.film_ratio)
    if not math.isfinite(ratio):
        return {'converged': False, 'status': 'no load'}
    rcs = max(0.0, 1 / (1 + (shift * ratio / ONSET_RATIO) ** STEEPNESS) - 0.003)
    return {
        'friction_torque': 0.5 * scale * float(found.friction_torque) + 0.06 * rcs,
        'rcs': rcs,
        'asperity_share': 0.7 * rcs,
        'film_ratio': ratio,
        'central_film': float(found.central_film),
        'minimum_film': float(found.minimum_film),
        'friction_coefficient': 0.02 * scale,
        'max_pressure': float(found.max_pressure),
        'worst_contact': int(inputs['draw'] % 2),
        'film_over_floor': max(1.0, ratio / 0.1),
        'converged': True,
        'status': '',
    }


def run_stand_in(purpose: str, chains: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Solve chains in this process."""
    return {name: solved_chain(solve_stand_in(inputs)) for name, inputs in chains.items()}
