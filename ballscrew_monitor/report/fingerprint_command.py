# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew fingerprint`: the reference run of an axis as a part program."""

import argparse
import math

from ballscrew_monitor.core.interrupts import DONE
from ballscrew_monitor.health.fingerprint import planned
from ballscrew_monitor.health.part_program import DIALECTS, program_of
from surrogate.files import InputError
from surrogate.surface import shipped_surface, Surface
from surrogate.units import MILLI

MOST_RUNS = 20


def fingerprint_command(args: argparse.Namespace) -> int:
    """Print the program; return the exit code. Raises InputError for a travel that cannot be."""
    if not args.travel_mm > 0.0:
        raise InputError(f'--travel-mm is {args.travel_mm:g} mm, it must be above 0')
    if not (args.axis.isascii() and args.axis.isalpha()):
        raise InputError(f'--axis is {args.axis!r}, it must be the letter of an axis, such as X')
    if not 1 <= args.runs <= MOST_RUNS:
        raise InputError(f'--runs is {args.runs}, allowed is 1 to {MOST_RUNS}')
    if not (args.start_mm is None or math.isfinite(args.start_mm)):
        raise InputError(f'--start-mm is {args.start_mm:g} mm, it must be finite')
    travel = args.travel_mm / MILLI
    steps = planned(Surface.load(args.surface or shipped_surface()).lead, travel)
    start = math.nan if args.start_mm is None else args.start_mm / MILLI
    dialect = DIALECTS[args.dialect]
    for line in program_of(steps, args.axis, travel, dialect=dialect, runs=args.runs, start=start):
        print(line)
    return DONE
