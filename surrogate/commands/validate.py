# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `validate`: published numbers beside those that this model computes now."""

import argparse
from pathlib import Path
from typing import Any

from surrogate.commands.output import add_json, show
from surrogate.files import InputError, replace_file


def add_validate_command(subparsers: Any) -> None:
    """Add `validate`; its handler imports what solves."""
    parser = subparsers.add_parser('validate', help='published numbers beside ours, computed now')
    add_json(parser)
    parser.add_argument('--out', type=Path, metavar='FILE', help='write the tables in Markdown')
    parser.set_defaults(handler=_validate)


def _validate(args: argparse.Namespace) -> int:
    from surrogate.studies.validation import validation_page, validation_record

    record = validation_record()
    if args.out:
        try:
            replace_file(args.out, f'{validation_page(record)}\n'.encode())
        except OSError as error:
            raise InputError(f'--out: {args.out} cannot be written, {error.strerror}') from None
    show(record, validation_page, json=args.json)
    return 0
