# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Fit the onset factor of synthetic machines whose truth lies outside the fit.

Run `python studies/onset_machines.py [--write SEED]`: the nominal screw without load on a
staircase of 14 speeds in both directions. RCS and rolling loss below the onset of each machine are
those of one marched strip of `asperity_marches.csv` that was held out of the fit of the law; the
onset is off by a drawn factor. Boundary friction, viscosity and parasitic parts are drawn, the
parasitic torque as 2 to 8 times the contacts; a seal adds up to half of it that fades with the
speed by a curve that the fit does not have; each point has a ripple of 1 %, normal noise and an
oil that warms up unseen. Prints how often the factor lies within 1.3 and intervals and bounds hold
the truth, and writes `onset_machines.csv`. The same for staircases that end above the upturn of
most machines (`fast`), for machines that touch late, so that their seals alone turn the torque up
over most speeds (`late`), and for a ripple of 0.3 % (`steady`); `--late N` and so on draw another
number, `--first SEED` others. Some minutes. Such machines test the estimator alone, not the law.
`--write` writes the run of one machine to `staircase.csv` instead.

"""

import argparse
import csv
from dataclasses import dataclass
import math
from pathlib import Path

import numpy as np
from surrogate.asperities import law as laws
from surrogate.identify.data import no_load_run
from surrogate.identify.fit import identify
from surrogate.identify.model import thickened
from surrogate.identify.onset import FITTED, onset_speeds
from surrogate.identify.table import formula_model
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, with_raceway
from surrogate.units import RPM

MARCHES = Path(__file__).parent / 'results' / 'asperity_marches.csv'
WARM = 313.15
SPEEDS = np.geomspace(3.0, 1000.0, 14)
FAST = np.geomspace(200.0, 2000.0, 10)
"""Speeds of a staircase, and of one that ends above most upturns [rev/min]."""
SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
WITHIN = 1.3
DRAG = 2.0, 8.0
"""Parasitic torque over the mean torque of the contacts [-]."""
FADING = 0.0035, 0.3
"""Sliding speed over which the drag of a seal fades [m/s]."""
FADES = {
    'hyperbola': lambda over: 1 / (1 + over),
    'bell': lambda over: 1 / (1 + over**2),
    'arch': lambda over: 2 * np.exp(-over) / (1 + np.exp(-2 * over)),
    'two lips': lambda over: 0.5 * np.exp(-over) + 0.5 * np.exp(-over / 5),
}
"""Shares of the fading drag that are left [-], by the speed over that at which it fades [-]."""
LATE = 0.1, 0.3
"""Onset factors of machines that touch late [-], whose seals fade over 10 mm/s and more."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MachineLaw(laws.AsperityLaw):
    """An asperity law whose curves below the onset are those of one marched strip."""

    march: dict

    def touching(self, side, contact, load, oil, floor, speeds):
        """Return RCS, asperity share and loss factor [-] at many speeds [m/s]."""
        share, strips, onset = self._strips(side, contact, load, oil, floor)
        at_onset = laws.film_of(strips, onset[:, None], oil)
        over = np.log(laws.film_of(strips, speeds, oil) / at_onset)
        rcs = self._rcs(over)
        values = rcs, laws.share_at(rcs), self._loss(over)
        return tuple((share[:, None] * one).sum(axis=0) for one in values)

    def _rcs(self, over):
        """Return RCS [-]: in the logit the law, shifted as the march is at half and quarter."""
        met = [
            (laws.FILM_POWER * math.log(part), self.march[name])
            for part, name in ((0.25, 'rcs_quarter'), (0.5, 'rcs_half'))
            if self.march[name]
        ]
        place = np.array([x for x, _ in met] + [0.0])
        marched = np.array([float(rcs) for _, rcs in met] + [laws.ONSET_RCS])
        apart = np.interp(over, place, logit(marched) - logit(laws.rcs_at(place)))
        told = np.clip(laws.rcs_at(over), laws.NOTHING, 1 - laws.NOTHING)
        return 1 / (1 + np.exp(-logit(told) - apart))

    def _loss(self, over):
        """Return the loss factor [-]: the line of the march, smooth far above the onset."""
        onset = float(self.march['loss_onset'])
        half = laws.FILM_POWER * math.log(0.5)
        rise = (float(self.march['loss_half'] or onset) - onset) / half
        return laws.loss_along(onset, rise, over)


def logit(share):
    """Return the logarithm of the odds of a share [-]."""
    return np.log(share / (1 - share))


def held_out():
    """Return the marches that were held out of the fit of the law."""
    with MARCHES.open(encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    return [row for row in rows if row['role'] == 'held out' and row['rcs_half']]


def machine(seed, rpm=SPEEDS, kind=''):
    """Return the run of a machine, and its truth; `rpm` are the speeds of its staircase."""
    late, ripple = kind == 'late', 0.003 if kind == 'steady' else 0.01
    drawn, marches = np.random.default_rng(seed), held_out()
    march = marches[seed % len(marches)]
    truth = {
        'march': march['march'],
        'asperity_friction': float(np.clip(0.1 * drawn.lognormal(0, 0.2), 0.06, 0.16)),
        'parasitic_torque': drawn.uniform(*DRAG),
        'parasitic_torque_rate': drawn.uniform(1e-4, 5e-4),
    }
    factor = math.exp(np.clip(0.5 * drawn.standard_normal(), -1.1, 1.1))
    if late:
        factor = math.exp(drawn.uniform(*np.log(LATE)))
    screw = with_raceway(SCREW, onset_factor=factor, asperity_friction=truth['asperity_friction'])
    oil = thickened(OIL, drawn.lognormal(0, 0.05))
    speed = np.concatenate([rpm, -rpm]) * RPM
    kelvin = WARM + drawn.uniform(0, 2) * np.linspace(-0.5, 0.5, len(speed))
    truth['seal'] = drawn.uniform(0.2 if late else 0.0, 0.5)
    truth['fades'] = math.exp(drawn.uniform(*np.log([0.01 if late else FADING[0], FADING[1]])))
    truth['fade'] = str(drawn.choice([*FADES]))
    left = FADES[truth['fade']](np.abs(speed) * screw.pitch_radius / truth['fades'])
    drag = contact_torque(screw, oil, march, np.abs(speed), kelvin)
    truth['parasitic_torque'] *= float(drag.mean())
    drag += truth['parasitic_torque'] * (1 + truth['seal'] * left)
    drag *= 1 + ripple * drawn.standard_normal(len(speed))
    torque = np.sign(speed) * drag + truth['parasitic_torque_rate'] * speed
    torque += 0.01 * drawn.standard_normal() + 0.001 * drawn.standard_normal(len(speed))
    begun = onset_point(Contacts.of(screw), oil, 0.0, WARM)['speed_rad_s']
    truth['onset_factor'] = begun / onset_point(OPENED, OIL, 0.0, WARM)['speed_rad_s']
    return no_load_run(
        {'speed': speed, 'torque': torque}, source='machine', temperature=WARM
    ), truth


def contact_torque(screw, oil, march, speed, kelvin):
    """Return the friction torque [N m] of contacts by the curves of a march."""
    opened = Contacts.of(screw)
    usual = opened.law
    law = MachineLaw(onsets=usual.onsets, deviation=usual.deviation, march=march)
    vars(opened)['law'] = law
    try:
        return closed_form.solve(opened, oil, speed, 0.0, kelvin).friction_torque
    finally:
        vars(opened)['law'] = usual


def contacts_of(run):
    """Return the contacts of all machines with the speeds of a run."""
    return formula_model(SCREW, OIL, run, FITTED)


def rows_of(kind, rpm, seeds):
    """Yield a row of truth and estimates for every machine."""
    contacts = None
    for seed in seeds:
        run, truth = machine(seed, rpm, kind)
        contacts = contacts or contacts_of(run)
        found = identify(SCREW, run, contacts, FITTED)
        row = {'kind': kind, 'seed': seed}
        row |= {name: truth.pop(name) for name in ('march', 'seal', 'fades', 'fade')}
        row['slowest_over_onset'] = (
            rpm[0] * RPM / onset_speeds(contacts, run, (truth['onset_factor'],) * 3)[0]
        )
        for name, value in truth.items():
            one = found.estimate(name)
            row |= {name: value, f'{name}_found': one.value, f'{name}_low': one.low}
            row |= {f'{name}_high': one.high, f'{name}_reason': one.reason}
        yield row


def report(rows):
    """Print how the estimates meet the truth."""
    closed = [row for row in rows if not row['onset_factor_reason']]
    print(f'{len(rows)} machines, {len(closed)} with an interval of the onset factor')
    for name in ('onset_factor', 'asperity_friction', 'parasitic_torque', 'parasitic_torque_rate'):
        known = [row for row in closed if not row[f'{name}_reason']]
        held = [row[f'{name}_low'] <= row[name] <= row[f'{name}_high'] for row in known]
        print(f'  {name}: {sum(held)} of {len(held)} intervals hold the truth')
    off = np.array([math.log(row['onset_factor_found'] / row['onset_factor']) for row in closed])
    if len(off):
        near = int((np.abs(off) < math.log(WITHIN)).sum())
        wide = [row['onset_factor_high'] / row['onset_factor_low'] for row in closed]
        print(
            f'  within {WITHIN:g}: {near} of {len(off)}; mean {off.mean():.3f}, standard '
            f'deviation {off.std():.3f} of the logarithm, interval {np.sqrt(np.median(wide)):.3g}'
        )
    for word, sign in (('at most ', 1), ('at least ', -1)):
        ends = [
            (row['onset_factor'], float(row['onset_factor_reason'].partition(word)[2].split()[0]))
            for row in rows
            if word in row['onset_factor_reason']
        ]
        print(
            f'  {sum(sign * (true - end) <= 0 for true, end in ends)} of {len(ends)} bounds'
            f' {word}hold'
        )
    for words in ('leave', 'nothing', 'not told'):
        print(f'  {words}:', sum(words in row['onset_factor_reason'] for row in rows))


def write_run(folder, seed):
    """Write the run of a machine as `ballscrew identify` reads it."""
    run, _ = machine(seed)
    with (folder / 'staircase.csv').open('w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file)
        writer.writerow(['speed_rpm', 'torque_Nm'])
        writer.writerows(np.column_stack([run.speed / RPM, run.torque]).tolist())


def main():
    """Draw, fit, write and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--machines', type=int, default=120)
    parser.add_argument('--fast', type=int, default=40)
    parser.add_argument('--late', type=int, default=80)
    parser.add_argument('--steady', type=int, default=60)
    parser.add_argument('--first', type=int, default=0, help='seed of the first of each')
    parser.add_argument('--out', type=Path, default=Path('studies/results'))
    parser.add_argument('--write', type=int, metavar='SEED')
    args = parser.parse_args()
    if args.write is not None:
        write_run(args.out, args.write)
        return
    every = []
    for kind, rpm, number in (
        ('staircase', SPEEDS, args.machines),
        ('fast', FAST, args.fast),
        ('late', SPEEDS, args.late),
        ('steady', SPEEDS, args.steady),
    ):
        rows = list(rows_of(kind, rpm, range(args.first, args.first + number)))
        print(kind, end=': ', flush=True)
        report(rows)
        every += rows
    with (args.out / 'onset_machines.csv').open('w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, every[0])
        writer.writeheader()
        writer.writerows(
            {
                name: f'{value:.5g}' if isinstance(value, float) else value
                for name, value in row.items()
            }
            for row in every
        )


if __name__ == '__main__':
    main()
