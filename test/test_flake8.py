# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The whole tree passes ament_flake8, as it does on a machine with ROS 2."""

from pathlib import Path

from ament_flake8.main import main_with_errors
import pytest

TREE = Path(__file__).resolve().parent.parent
FOLDERS = (
    'ballscrew_monitor',
    'bags',
    'bench',
    'docs',
    'launch',
    'scripts',
    'studies',
    'surrogate',
    'test',
)


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8(capsys: pytest.CaptureFixture[str]) -> None:
    """No finding: the text of a finding is what the assertion shows."""
    paths = [str(TREE / name) for name in ('setup.py', *FOLDERS) if (TREE / name).exists()]
    code, findings = main_with_errors(argv=paths)
    capsys.readouterr()
    assert code == 0, '\n'.join(findings)
