# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The manifests follow the schema of package format 3; needs a machine with ROS 2 and the net."""

from pathlib import Path

import pytest

TREE = Path(__file__).resolve().parent.parent


@pytest.mark.linter
@pytest.mark.xmllint
def test_xmllint() -> None:
    """No finding."""
    xmllint = pytest.importorskip(
        'ament_xmllint.main', reason='ament_xmllint is not in the wheels'
    )
    assert xmllint.main(argv=[str(TREE / 'package.xml'), str(TREE / 'msg_defs')]) == 0
