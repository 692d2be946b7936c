# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Logs of machine controls as tables, their maps, and tables that are refused."""

import itertools
import math

from courses import constant, moves
from golden.inputs import FEED, NOMINAL
import polars as pl

RATE = 50.0  # [Hz]
DURATION = 24.0  # [s]
LEAD = 10.0  # [mm]
SPEED = moves((0.5, 900.0), (5.0, 120.0), (8.0, -900.0), (13.0, 0.0), (15.0, 1500.0), ramp=0.2)
"""Speed of the screw [rev/min]."""
LOAD = moves((0.5, -1000.0), (8.0, 900.0), (14.0, -150.0), (18.0, -2200.0), ramp=0.2)
"""Force on the nut [N]."""
OIL = constant(38.5)


def samples():
    """Yield time [s], speed [mm/s], position [mm], load [N], torque [N m] and oil [degC]."""
    position = 100.0
    for number in range(round(DURATION * RATE)):
        time = number / RATE
        speed = SPEED.at(time) * LEAD / 60.0
        position += speed / RATE
        friction = 0.12 * math.tanh(speed)
        torque = friction - LOAD.at(time) * LEAD / 2000.0 / math.pi
        yield time, speed, position, LOAD.at(time), torque, OIL.at(time) + 0.02 * time


def english(folder):
    """Write a CSV of an English control: load from the current, damaged cells and rows."""
    lines = ['# exported by a control', 't_s,X1_ActualVelocity [mm/s],X1_Current [A],Oil [degC]']
    for number, (time, speed, _, _, torque, oil) in enumerate(samples()):
        current = f'{torque / 0.8:.4f}' if number % 97 else ''
        warm = f'{oil:.2f}' if number % 89 else ''
        cells = f'{time:.2f},{speed:.4f},{current},{warm}'
        lines.append(cells if number != 333 else f'n/a,{speed:.4f},{current},{warm}')
    lines[700], lines[701] = lines[701], lines[700]
    path = folder / 'mill.csv'
    path.write_text('\n'.join(lines) + '\n', 'utf-8')
    return path, ENGLISH


ENGLISH = f"""
log: mill.csv
time: {{column: t_s, unit: s}}
axes:
  x:
    speed: {{column: 'X1_ActualVelocity [mm/s]', unit: mm/s}}
    current: {{column: 'X1_Current [A]', unit: A}}
    temperature: {{column: 'Oil [degC]', unit: degC}}
    lead_mm: {LEAD}
    screw: nominal
    oil: iso_vg_68
    surface: {NOMINAL}
assumed:
  x.load.from: {{value: current, reason: no force is in the log}}
  x.torque_constant_Nm_per_A: {{value: 0.8, reason: on no plate}}
  x.efficiency: {{value: 0.9, reason: usual for a ball screw}}
  time.epoch: {{value: '2026-01-05T08:00:00Z', reason: the log counts from 0}}
"""


def german(folder):
    """Write a CSV of a German control: decimal comma, units in a row, load by the torque."""
    lines = ['Maschine: Fräse 3', 'Datum;Uhrzeit;Vorschub X;Motormoment X;Öltemperatur']
    lines.append(';;mm/min;Nm;°C')
    for time, speed, _, _, torque, oil in samples():
        if not 16.0 < time < 19.0:
            numbers = f'{60.0 * speed:.3f};{torque:.4f};{oil:.2f}'.replace('.', ',')
            moment = f'05.01.2026;08:00:{time:06.3f}'.replace('.', ',').replace('05,01,', '05.01.')
            lines.append(f'{moment};{numbers}')
    path = folder / 'fraese.csv'
    path.write_bytes('\r\n'.join(lines).encode('cp1252'))
    return path, GERMAN


GERMAN = f"""
log: fraese.csv
skip: 1
header_rows: 2
time: {{column: Uhrzeit, unit: s, date: Datum}}
axes:
  x:
    speed: {{column: 'Vorschub X [mm/min]', unit: mm/min}}
    torque: {{column: 'Motormoment X [Nm]', unit: N m}}
    load: {{from: motor_torque}}
    torque_uncertainty_Nm: 0.05
    inertia_kg_m2: 0.001
    temperature: {{column: 'Öltemperatur [°C]', unit: degC}}
    lead_mm: {LEAD}
    screw: iso3408_40x10
    oil: iso_vg_68
    surface: {FEED}
parameters: {{x: {{limits: {{efficiency: 0.8}}, publish_period: 0.0}}}}
"""


def parquet(folder):
    """Write a Parquet of two axes: one by its positions, the load of the other is not known."""
    names = ('position_mm', 'kraft_kN', 'Z_rpm', 'Z_torque_percent')
    rows = [
        (position, None if number % 211 == 210 else load / 1000.0, 2.0 * speed, 40.0 * torque)
        for number, (_, speed, position, load, torque, _) in enumerate(samples())
    ]
    path = folder / 'cell.parquet'
    columns = dict(zip(names, map(list, itertools.zip_longest(*rows)), strict=True))
    pl.DataFrame(columns, schema=dict.fromkeys(names, pl.Float64)).write_parquet(path)
    return path, PARQUET


PARQUET = f"""
log: cell.parquet
time: {{rate_Hz: {RATE}, epoch: '2026-01-05T08:00:00Z'}}
axes:
  x:
    position: {{column: position_mm, unit: mm}}
    load: {{column: kraft_kN, unit: kN}}
    temperature_degC: 38.0
    lead_mm: {LEAD}
    screw: nominal
    oil: iso_vg_68
    surface: {NOMINAL}
  z:
    speed: {{column: Z_rpm, unit: rev/min}}
    torque: {{column: Z_torque_percent, unit: '%'}}
    torque_rated_Nm: 2.5
    load: {{unknown: no force is in the log}}
    lead_mm: {LEAD}
    screw: nominal
    oil: iso_vg_68
    surface: {NOMINAL}
"""
TABLES = {'english_csv': english, 'german_csv': german, 'parquet': parquet}
AXIS = f"""
time: {{rate_Hz: 50.0, epoch: '2026-01-05T08:00:00Z'}}
axes: {{x: {{speed: {{column: v, unit: mm/s}}, lead_mm: 10.0, surface: {NOMINAL}, %s}}}}
"""
GOOD = AXIS % 'load: {unknown: none}'
BY_TIME = GOOD.replace('rate_Hz: 50.0', 'column: t, unit: s')
LOG = 'v,F\n1.0,2.0\n2.0,3.0\n'
REFUSED = {
    'empty': ('', GOOD),
    'one_row': ('v,F\n1.0,2.0\n', GOOD),
    'no_names': ('1.0,2.0\n2.0,3.0\n', GOOD),
    'no_such_column': ('vv,F\n1.0,2.0\n2.0,3.0\n', GOOD),
    'no_number': ('v,F\na,2.0\nb,3.0\n', GOOD),
    'no_speed': (LOG, GOOD.replace('speed: {column: v, unit: mm/s}, ', '')),
    'no_lead': (LOG, GOOD.replace('lead_mm: 10.0, ', '')),
    'no_time': (LOG, GOOD.replace('time:', 'parameters: {} #')),
    'no_epoch': (LOG, GOOD.replace(", epoch: '2026-01-05T08:00:00Z'", '')),
    'before_1970': (LOG, GOOD.replace('2026-', '1960-')),
    'unit': (LOG, GOOD.replace('mm/s', 'knots')),
    'unknown_key': (LOG, AXIS % 'colour: red'),
    'unknown_load': (LOG, AXIS % 'load: {from: thin air}'),
    'load_without_torque': (LOG, AXIS % 'load: {from: motor_torque}'),
    'load_of_words': ('v,F\n1.0,a\n2.0,b\n', AXIS % 'load: {column: F, unit: N}'),
    'stated_twice': (LOG, GOOD + 'assumed: {x.lead_mm: {value: 5.0, reason: guessed}}\n'),
    'without_reason': (LOG, GOOD + 'assumed: {x.efficiency: {value: 0.9}}\n'),
    'range': (LOG, GOOD.replace('10.0', '-1.0')),
    'parameter': (LOG, GOOD + 'parameters: {x: {limits: {rcs: 2.0}}}\n'),
    'no_yaml': (LOG, 'axes: {x'),
    'no_surface': (LOG, GOOD.replace('nominal.npz', 'none.npz')),
    'another_screw': (LOG, AXIS % 'load: {unknown: none}, screw: iso3408_40x10'),
    'times_of_words': ('t,v\nnow,1.0\nthen,2.0\n', BY_TIME),
    'times_stand': ('t,v\n' + '3.0,1.0\n' * 4, BY_TIME),
    'times_fall': ('t,v\n' + ''.join(f'{9 - number},1.0\n' for number in range(9)), BY_TIME),
}
"""Tables and their maps by what is wrong with them."""
