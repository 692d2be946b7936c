# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Corrections of surfaces on the disk, so that they outlive the node: a file for each axis.

A file holds what was solved, not what became of the surface.

"""

from collections.abc import Sequence
from typing import Any

from ballscrew_monitor.core.full_point import KeptSolve
from ballscrew_monitor.node.state_folder import StateFolder
from surrogate.surface import Correction, FIELDS


class CorrectionStore:
    """The corrections kept for the axes of one node."""

    def __init__(self, folder: StateFolder) -> None:
        """Keep them in a `folder`."""
        self._folder = folder

    def load(self, axis: str) -> tuple[str, list[KeptSolve]]:
        """
        Return the hash of the surface that the kept solves of an axis belong to, and the solves.

        Raises InputError for a file that is none; it is moved aside and nothing is lost.

        """
        return self._folder.read(_name(axis), _parsed) or ('', [])

    def save(self, axis: str, sha256: str, corrections: Sequence[Correction]) -> str:
        """Keep the corrections of the surface of a hash; return why that failed, or nothing."""
        kept = [
            {
                'speed_rad_s': one.speed,
                'opposing_load_N': one.opposing_load,
                'temperature_K': one.temperature,
                'solved': dict(one.solved),
            }
            for one in corrections
        ]
        # The last quarter is for the event log and the sums, which are never refused.
        spare = self._folder.limit // 4
        return self._folder.write(
            _name(axis), {'surface': sha256, 'corrections': kept}, spare=spare
        )


def _name(axis: str) -> str:
    return f'{axis}.corrections.json'


def _parsed(content: Any) -> tuple[str, list[KeptSolve]]:
    return str(content['surface']), [_kept(one) for one in content['corrections']]


def _kept(one: dict[str, Any]) -> KeptSolve:
    solved = {name: float(one['solved'][name]) for name in FIELDS if name in one['solved']}
    return KeptSolve(
        speed=float(one['speed_rad_s']),
        opposing_load=float(one['opposing_load_N']),
        temperature=float(one['temperature_K']),
        solved=solved,
    )
