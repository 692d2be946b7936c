# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The docstrings of the whole tree pass ament_pep257, as they do on a machine with ROS 2."""

from pathlib import Path

from ament_pep257.main import main
import pytest

TREE = Path(__file__).resolve().parent.parent
FOLDERS = ('ballscrew_monitor', 'bags', 'bench', 'docs', 'launch', 'scripts', 'surrogate', 'test')


@pytest.mark.linter
@pytest.mark.pep257
def test_pep257(caplog: pytest.LogCaptureFixture) -> None:
    """No finding: they are in the captured output."""
    caplog.set_level('WARNING', 'pydocstyle.utils')
    paths = [str(TREE / name) for name in ('setup.py', *FOLDERS) if (TREE / name).exists()]
    assert main(argv=paths) == 0
