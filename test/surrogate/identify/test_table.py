# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The table of solved contacts: its interpolation against a stand-in, its solves in the small."""

from contextlib import contextmanager
from dataclasses import dataclass, replace
import math

import numpy as np
import pytest
from surrogate.ehl import Settings
from surrogate.identify.data import no_load_run
from surrogate.identify.fit import identify
from surrogate.identify.model import closed_form_model
from surrogate.identify.table import solved_model
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import closed_form
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import solve_screw

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
WARM = 313.15
RPM = math.pi / 30
SMOOTH = ScrewSettings(smooth=Settings(nx=65, ny=65, error_estimate=False), kinematics='smooth')
BOTH = ('viscosity_factor', 'asperity_friction')


def run_at(rpm, **columns):
    """Return a run at speeds [rev/min] whose torque is still to come."""
    speed = np.asarray(rpm) * RPM
    return no_load_run(
        {'speed': speed, 'torque': speed} | columns, source='synthetic', temperature=WARM
    )


@dataclass
class Stub:
    """What the table wants to know of a solution."""

    friction_torque: float
    asperity_share: float = 0.0
    converged: bool = True
    status: str = 'made up'


@contextmanager
def in_place_of_the_solver():
    """Put the closed-form tier there; give the speeds it was asked for."""
    solved = []

    def answer(opened, oil, point, *rest, **options):
        found = closed_form.solve(opened, oil, point.speed, point.load, point.temperature)
        return Stub(float(found.friction_torque), float(found.asperity_share))

    def solve(opened, oil, point, **options):
        solved.append(point.speed)
        return answer(opened, oil, point)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr('surrogate.identify.table.solve_screw', solve)
        patch.setattr('surrogate.identify.table.rebalance_screw', answer)
        yield solved


@pytest.fixture
def formulas():
    """Return the speeds that the closed-form tier was asked for in place of the solver."""
    with in_place_of_the_solver() as solved:
        yield solved


@pytest.fixture(scope='module')
def both():
    """Return a run in both directions, the table over viscosity and friction, and formulas."""
    run = run_at(np.concatenate([np.geomspace(100, 1000, 10), -np.geomspace(120, 900, 9)]))
    with in_place_of_the_solver() as solved:
        model = solved_model(SCREW, OIL, run, BOTH)
    assert len(solved) == len(set(solved)) == 18
    return run, model, closed_form_model(SCREW, OIL, run)


def test_few_speeds_are_solved_as_they_are(formulas):
    """One solve for both directions, exact there, and told to whoever waits."""
    run, told = run_at([60, 200, 600, -60, -200, -600]), []
    model = solved_model(SCREW, OIL, run, progress=lambda *done: told.append(done))
    assert formulas == pytest.approx([60 * RPM, 200 * RPM, 600 * RPM])
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]
    exact = closed_form_model(SCREW, OIL, run)
    np.testing.assert_allclose(
        model.torque(1.0, 0.1, 1.0), exact.torque(1.0, 0.1, 1.0), rtol=1e-12
    )
    np.testing.assert_allclose(model.asperity_share, exact.asperity_share, rtol=1e-12)
    assert model.tier == 'full'


def assert_met(found, expected):
    """Hold numbers to 0.1 %."""
    np.testing.assert_allclose(found, expected, rtol=1e-3)


def test_many_speeds_share_a_few_nodes_and_temperatures_are_met(formulas):
    """Ten nodes a decade; the oil of each point, through its viscosity: 0.2 % over 8 K."""
    run = run_at(np.geomspace(50, 2000, 20))
    model = solved_model(SCREW, OIL, run)
    assert len(formulas) == 18
    exact = closed_form_model(SCREW, OIL, run)
    assert_met(model.torque(1.0, 0.1, 1.0), exact.torque(1.0, 0.1, 1.0))
    run = run_at(np.geomspace(50, 2000, 12), temperature=np.linspace(WARM - 4, WARM + 4, 12))
    model, exact = solved_model(SCREW, OIL, run), closed_form_model(SCREW, OIL, run)
    np.testing.assert_allclose(model.torque(1.0, 0.1, 1.0), exact.torque(1.0, 0.1, 1.0), rtol=2e-3)


def test_viscosity_and_friction_are_met_over_their_ranges(both):
    _, *models = both
    for factor, friction in ((0.5, 0.02), (1.0, 0.1), (0.8, 0.13), (2.0, 0.3), (1.5, 0.06)):
        found, expected = (one.torque(factor, friction, 1.0) for one in models)
        assert_met(found, expected)


def test_known_answers_come_out_of_the_table(both):
    """The whole fit on the table, torque by the formulas themselves."""
    run, model, exact = both
    drag = exact.torque(1.2, 0.08, 1.0) + 0.12
    run = replace(run, torque=run.direction * drag + 4e-4 * run.speed + 0.03)
    found = identify(SCREW, run, model, BOTH)
    expected = (0.12, 4e-4, 0.03, 1.2, 0.08)
    assert [one.value for one in found.estimates] == pytest.approx(expected, rel=0.02)


def test_solved_contacts_and_a_known_answer():
    """Four speeds on a small grid, met to the tolerance of contacts that start warm."""
    run = run_at([100, 250, 600, 1500])
    model = solved_model(SCREW, OIL, run, settings=SMOOTH)
    points = [OperatingPoint(speed=speed, load=0.0, temperature=WARM) for speed in run.speed]
    exact = [solve_screw(OPENED, OIL, one, settings=SMOOTH).friction_torque for one in points]
    np.testing.assert_allclose(model.torque(1.0, 0.1, 1.0), exact, rtol=1e-5)
    run = replace(run, torque=np.array(exact) + 0.12 + 4e-4 * run.speed)
    found = identify(SCREW, run, model)
    assert [one.value for one in found.estimates] == pytest.approx((0.12, 4e-4), rel=1e-4)


def test_what_one_table_cannot_hold_or_is_not_solved_is_refused(formulas, refused, monkeypatch):
    rpm = [60.0, 200.0, 600.0]
    warm = run_at(rpm, temperature=np.array([300.0, 310.0, 330.0]))
    refused('up_16_7', solved_model, SCREW, OIL, warm)
    loaded = run_at(rpm, load=np.array([0.0, 0.0, 300.0]))
    refused('load_n_up_200', solved_model, SCREW, OIL, loaded)
    failed = Stub(math.nan, converged=False, status='It stalled.')
    monkeypatch.setattr('surrogate.identify.table.solve_screw', lambda *given, **options: failed)
    refused('60_rev_min', solved_model, SCREW, OIL, run_at([60, 200, 600]))
