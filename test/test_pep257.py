# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The docstrings of the whole tree pass ament_pep257, as they do on a machine with ROS 2."""

from pathlib import Path

from ament_pep257.main import main
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


@pytest.mark.linter
@pytest.mark.pep257
def test_pep257(capsys: pytest.CaptureFixture[str]) -> None:
    """No finding: the text of a finding is what the assertion shows."""
    paths = [str(TREE / name) for name in ('setup.py', *FOLDERS) if (TREE / name).exists()]
    code = main(argv=paths)
    assert code == 0, capsys.readouterr().err
