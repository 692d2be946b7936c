# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Targets of the Makefile, and the files that they may touch."""

from pathlib import Path
import shutil
import subprocess

TREE = Path(__file__).resolve().parents[1]


def test_clean_leaves_the_bags_of_others(tmp_path):
    """Only the bag that is generated is removed."""
    shutil.copy(TREE / 'Makefile', tmp_path)
    for name in ('bags/nominal_cycle', 'bags/mine', 'out'):
        (tmp_path / name).mkdir(parents=True)
    subprocess.run(['make', 'clean'], cwd=tmp_path, check=True, capture_output=True)
    assert [path.name for path in (tmp_path / 'bags').iterdir()] == ['mine']
    assert not (tmp_path / 'out').exists()
