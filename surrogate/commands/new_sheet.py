# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommands `screw new` and `oil new`: a sheet out of a catalogue, by flags or questions."""

import argparse
from dataclasses import fields
from pathlib import Path
import shlex
import sys
from typing import Any

from surrogate.catalogue.words import CatalogueOil, CatalogueScrew, flag_of
from surrogate.commands.output import tell
from surrogate.files import InputError
from surrogate.files.datasheet import key_of, sheet_of

SHEETS = {
    'screw': (CatalogueScrew, 'make the sheet of a screw out of a catalogue'),
    'oil': (CatalogueOil, 'make the sheet of an oil or grease out of its data sheet'),
}


def add_new_commands(subparsers: Any) -> None:
    """Add `screw new` and `oil new`; their flags are those of the declared words."""
    for name, (words, text) in SHEETS.items():
        actions = subparsers.add_parser(name, help=text)
        parser = actions.add_subparsers(required=True, metavar='new').add_parser('new', help=text)
        for spec in fields(words):
            parser.add_argument(flag_of(spec), metavar='X', help=spec.metadata['words'])
        parser.add_argument('--out', type=Path, metavar='FILE', help='default NAME.yaml')
        parser.add_argument('--force', action='store_true', help='write over a file')
        parser.set_defaults(handler=_new, sheet=name)


def _new(args: argparse.Namespace) -> int:
    from surrogate.datasheet_writer import write_sheet

    words = SHEETS[args.sheet][0]
    texts = {spec: getattr(args, key_of(spec)) for spec in fields(words)}
    if not any(texts.values()) and sys.stdin.isatty():
        texts = {spec: _answer(spec) for spec in fields(words)}
    texts = {spec: text for spec, text in texts.items() if text}
    content = {key_of(spec): _value(spec, text) for spec, text in texts.items()}
    given: Any = sheet_of(words, content, f'{args.sheet} new')
    sheet: Any
    if args.sheet == 'oil':
        from surrogate.catalogue.oil import oil_of

        sheet, notes = oil_of(given)
    else:
        from surrogate.catalogue.raceways import typical_roughness
        from surrogate.catalogue.screw import equal_halves, heavy_preload, screw_of
        from surrogate.formulas.plausibility import doubts

        sheet, notes = screw_of(given)
        preload = heavy_preload(sheet)
        tell([*doubts(sheet), *preload, *equal_halves(given), *typical_roughness(given)])
    out = args.out or Path(f'{sheet.name}.yaml')
    if out.exists() and not args.force:
        raise InputError(f'--out: {out} is there already, allowed is another file, or --force')
    flags = ' '.join(f'{flag_of(spec)} {shlex.quote(text)}' for spec, text in texts.items())
    write_sheet(out, sheet, [f'ballscrew {args.sheet} new {flags}'], notes)
    print(out)
    return 0


def _answer(spec: Any) -> str:
    """Return the answer to a question, which may be empty; the end of the input interrupts."""
    unit = spec.metadata.get('unit')
    try:
        return input(f'{spec.metadata["words"]}{f" [{unit}]" if unit else ""}: ').strip()
    except EOFError:
        raise KeyboardInterrupt from None


def _value(spec: Any, text: str) -> Any:
    """Return the number that a text is, or the text, which the sheet refuses if it must."""
    if 'low' not in spec.metadata:
        return text
    try:
        return int(text) if spec.metadata.get('whole') else float(text)
    except ValueError:
        if spec.name == 'turns' and '+' in text:
            raise InputError(
                f"screw new: turns is '{text}', allowed is one number: turns of two nuts or "
                'halves are not modelled apart; with nut double state their mean, with nut offset '
                'their sum'
            ) from None
        return text
