# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The whole tree passes the linters of a machine with ROS 2."""

from pathlib import Path
import subprocess
import sys

from ament_flake8.main import main_with_errors
from ament_pep257.main import main
import flake8_docstrings
import pytest

TREE = Path(__file__).resolve().parent.parent
FOLDERS = 'ballscrew_monitor bags bench docs launch scripts studies surrogate test'.split()
PATHS = [str(TREE / name) for name in ('setup.py', *FOLDERS) if (TREE / name).exists()]


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8(capsys, monkeypatch):
    """No finding but of docstrings, for which `ament_pep257` asks the same program for more."""
    monkeypatch.setattr(flake8_docstrings.pep257Checker, 'run', lambda self: ())
    code, findings = main_with_errors(argv=PATHS)
    capsys.readouterr()
    assert code == 0, '\n'.join(findings)


@pytest.mark.linter
@pytest.mark.pep257
def test_pep257(capsys):
    """No finding: the text of a finding is what the assertion shows."""
    code = main(argv=PATHS)
    assert code == 0, capsys.readouterr().err


@pytest.mark.linter
def test_mypy():
    """No finding; the settings name the files."""
    checked = subprocess.run(
        [sys.executable, '-m', 'mypy'], cwd=TREE, capture_output=True, text=True
    )
    assert checked.returncode == 0, checked.stdout


@pytest.mark.linter
@pytest.mark.xmllint
def test_xmllint():
    """The manifests follow the schema of package format 3; needs ROS 2 and the net."""
    xmllint = pytest.importorskip(
        'ament_xmllint.main', reason='ament_xmllint is not in the wheels'
    )
    assert xmllint.main(argv=[str(TREE / 'package.xml'), str(TREE / 'msg_defs')]) == 0
