# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Identify a synthetic recording of known parasitic torque in both tiers, and draw it.

Run `python studies/identify.py [--out DIR]`: the nominal screw without load, ISO VG 68 at 40 degC,
torque of the full tier with 0.12 N m, 0.4 mN m s/rad, an offset of 0.03 N m and normal noise of
4 mN m, 12 speeds in both directions. Prints how often intervals hold the truth, how far balls
balanced again are from a fresh solve, the parameters by tier and by what is fitted, and how far
the table of the full tier is from contacts solved at the point itself. Some minutes.

"""

import argparse
from dataclasses import replace
from pathlib import Path
import time

import numpy as np
from surrogate.formulas.lubricant import lubricant_state
from surrogate.identify.data import no_load_run
from surrogate.identify.figures import draw_identification
from surrogate.identify.fit import identify
from surrogate.identify.model import anchored, closed_form_model, thickened
from surrogate.identify.table import solved_model
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw.opened import Contacts
from surrogate.screw.solve import rebalance_screw, solve_screw
from surrogate.units import RPM

SPEEDS = np.array([10, 20, 40, 60, 100, 150, 220, 330, 500, 800, 1200, 2000]) * RPM
CONSTANT, RATE, OFFSET, NOISE = 0.12, 4e-4, 0.03, 4e-3
WARM = 313.15
THICK, THICK_SPEEDS = 1.6, (0, 4, 9)
"""Viscosity factor [-] and places of the speeds at which the table is checked, too."""
FAST = 30.0
"""Least speed of the fast part of the recording [rad/s]."""
HALF_SPEEDS, HOT_SPEEDS, HOT = (10, 30, 100, 1000), (30, 300), 333.15
"""Speeds [rev/min] at twice the viscosity and at a temperature [K] far from the mean."""
DRAWS = 2000
COLUMNS = ('speed', 'torque', 'torque_std', 'load', 'temperature')


def recording(screw, oil):
    """Return the synthetic recording, and the torque of the contacts [N m] at its speeds."""
    speed = np.concatenate([SPEEDS, -SPEEDS])
    blank = no_load_run(
        {'speed': speed, 'torque': np.ones_like(speed), 'torque_std': NOISE + 0 * speed},
        source='synthetic',
        temperature=WARM,
    )
    points = [OperatingPoint(speed=float(one), load=0.0, temperature=WARM) for one in SPEEDS]
    contacts = np.array(
        [solve_screw(Contacts.of(screw), oil, point).friction_torque for point in points]
    )
    drag = np.sign(speed) * (np.tile(contacts, 2) + CONSTANT) + RATE * speed + OFFSET
    noise = NOISE * np.random.default_rng(3).standard_normal(len(speed))
    return replace(blank, torque=drag + noise), contacts


def show(label, found):
    """Print the parameters of an identification."""
    for one in found.estimates:
        interval = one.reason or f'{one.low:.5g} to {one.high:.5g}'
        print(f'{label:32} {one.name:22} {one.value:10.5g}  {interval}', flush=True)
    print(f'{label:32} {"residual rms [N m]":22} {found.rms:10.5f}')


def check_table(screw, oil, model, contacts):
    """Print the error of the table where its nodes are not, for two viscosities."""
    error = model.torque(1.0, screw.roughness.asperity_friction, 1.0)[: len(SPEEDS)] / contacts - 1
    for speed, one in zip(SPEEDS, error, strict=True):
        print(f'table at {speed / RPM:5.0f} rev/min: {100 * one:6.2f} %')
    found, thick = (
        model.torque(THICK, screw.roughness.asperity_friction, 1.0),
        thickened(anchored(oil, WARM), THICK),
    )
    for place in THICK_SPEEDS:
        point = OperatingPoint(speed=float(SPEEDS[place]), load=0.0, temperature=WARM)
        exact = solve_screw(Contacts.of(screw), thick, point).friction_torque
        print(
            f'table at {SPEEDS[place] / RPM:5.0f} rev/min, viscosity times {THICK:g}: '
            f'{100 * (found[place] / exact - 1):6.2f} %'
        )


def check_balance(screw, oil):
    """Print how far balls balanced again on contacts of another oil are from a solve with it."""
    warm = anchored(oil, WARM)
    hot = lubricant_state(oil, HOT)
    cases = [(rpm, thickened(warm, 2.0), 2.0, WARM) for rpm in HALF_SPEEDS]
    cases += [(rpm, oil, float(hot.viscosity) / warm.viscosity, HOT) for rpm in HOT_SPEEDS]
    for rpm, thick, factor, kelvin in cases:
        speed = rpm * RPM
        point = OperatingPoint(speed=speed, load=0.0, temperature=kelvin)
        base = OperatingPoint(speed=speed * factor, load=0.0, temperature=WARM)
        solved = solve_screw(Contacts.of(screw), warm, base)
        exact = solve_screw(Contacts.of(screw), thick, point).friction_torque
        found = rebalance_screw(Contacts.of(screw), thick, point, solved).friction_torque
        print(
            f'{rpm:5.0f} rev/min at {kelvin:g} K, viscosity times {factor:.3g}: the product alone '
            f'{100 * (solved.friction_torque / exact - 1):6.2f} %, balls balanced again '
            f'{100 * (found / exact - 1):6.2f} %',
            flush=True,
        )


def check_intervals(screw, oil):
    """Print how often intervals hold the truth, closed-form tier, 24 points, normal noise."""
    speed = np.geomspace(50.0, 2000.0, 12) * RPM
    speed = np.concatenate([speed, -speed])
    run = no_load_run({'speed': speed, 'torque': speed}, source='synthetic', temperature=WARM)
    contacts = closed_form_model(screw, oil, run)
    friction = contacts.torque(1.0, screw.roughness.asperity_friction, 1.0)
    drag = np.sign(speed) * (friction + CONSTANT) + RATE * speed + OFFSET
    truth = (CONSTANT, RATE, OFFSET)
    for loss in ('linear', 'soft_l1'):
        drawn, held = np.random.default_rng(99), np.zeros(3)
        for _ in range(DRAWS):
            noisy = replace(run, torque=drag + 1e-3 * drawn.standard_normal(len(speed)))
            found = identify(screw, noisy, contacts, loss=loss).estimates
            held += [one.low <= true <= one.high for one, true in zip(found, truth, strict=True)]
        print(f'{loss}: intervals hold the truth in {100 * held / DRAWS} % of {DRAWS} draws')


def main():
    """Identify, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    args = parser.parse_args()
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    check_intervals(screw, oil)
    check_balance(screw, oil)
    run, contacts = recording(screw, oil)
    quick = np.abs(run.speed) > FAST
    fast = replace(run, **{name: getattr(run, name)[quick] for name in COLUMNS})
    show('closed_form', identify(screw, run, closed_form_model(screw, oil, run)))
    show('closed_form, fast', identify(screw, fast, closed_form_model(screw, oil, fast)))
    for fitted in ((), ('viscosity_factor',), ('viscosity_factor', 'asperity_friction')):
        began = time.process_time()
        model = solved_model(screw, oil, run, fitted)
        found = identify(screw, run, model, fitted)
        show(f'full {" ".join(fitted)}', found)
        print(f'{time.process_time() - began:.0f} s')
        if not fitted:
            title = 'Synthetic recording, nominal screw, ISO VG 68 at 40 °C, tier full'
            print(draw_identification(args.out, run, found, title))
        if fitted == ('viscosity_factor',):
            check_table(screw, oil, model, contacts)


if __name__ == '__main__':
    main()
