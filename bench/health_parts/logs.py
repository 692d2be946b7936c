# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Twenty short logs of an axis, written, judged and assessed by the commands alone."""

from collections.abc import Iterator
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile
from typing import NamedTuple

from health_parts.machine import OIL, SCREW
from surrogate.builder.companions import build_companions
from surrogate.parameters import load_lubricant, load_screw
from surrogate.surface import shipped_surface

GENERATOR = Path(__file__).parents[2] / 'bags' / 'monthly_logs.py'
WORSE = 'Axis x is worse: its drag has changed by -'
CAUSES = {'preload': ' the preload is ', 'oil': ' the oil is thinner, '}
"""What changes in the logs, and what must be said of it as the likeliest cause."""


class Verdict(NamedTuple):
    """What changed, the first sentence on it, and whether it is right."""

    cause: str
    sentence: str
    is_right: bool


def verdicts() -> Iterator[Verdict]:
    """Yield what `ballscrew health` says of logs in which one thing changes."""
    with tempfile.TemporaryDirectory() as place:
        surface = Path(place, 'axis.npz')
        shutil.copy(shipped_surface(SCREW, OIL), surface)
        list(build_companions(load_screw(SCREW), load_lubricant(OIL), {}, surface))
        for cause, expected in CAUSES.items():
            said = _sentence(Path(place, cause), surface)
            yield Verdict(cause, said, said.startswith(WORSE) and expected in said)


def _sentence(logs: Path, surface: Path) -> str:
    """Return the first sentence on logs; the name of their folder is what changes."""
    options = ['--short', '--cause', logs.name, '--surface', surface, '--out', logs]
    _output(GENERATOR, *options)
    return _output('-m', 'ballscrew_monitor', 'health', logs).partition('\n')[0]


def _output(*arguments: str | Path) -> str:
    made = subprocess.run(
        [sys.executable, *arguments], check=True, stdout=subprocess.PIPE, text=True
    )
    return made.stdout
