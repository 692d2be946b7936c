# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew fingerprint`: the reference run of an axis as a part program."""

import argparse

from ballscrew_monitor.core.interrupts import DONE
from ballscrew_monitor.health.fingerprint import planned, program_of, Step
from surrogate.files import InputError
from surrogate.surface import shipped_surface, Surface
from surrogate.units import MILLI, MINUTE, RPM


def fingerprint_command(args: argparse.Namespace) -> int:
    """Print the program; return the exit code. Raises InputError for a travel that cannot be."""
    if not args.travel_mm > 0.0:
        raise InputError(f'--travel-mm is {args.travel_mm:g} mm, it must be above 0')
    if not (args.axis.isascii() and args.axis.isalpha()):
        raise InputError(f'--axis is {args.axis!r}, it must be the letter of an axis, such as X')
    travel = args.travel_mm / MILLI
    steps = planned(Surface.load(args.surface or shipped_surface()).lead, travel)
    for line in (*map(_said, steps), _total(steps), *program_of(steps, args.axis, travel)):
        print(line)
    return DONE


def _said(step: Step) -> str:
    return (
        f'({step.speed / RPM:.0f} rev/min, {MILLI * MINUTE * step.feed:.0f} mm/min: '
        f'{step.strokes} times forth and back, {step.time:.0f} s)'
    )


def _total(steps: list[Step]) -> str:
    return f'({sum(step.time for step in steps):.0f} s in motion)'
