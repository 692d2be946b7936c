# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A domain for those who play and record."""

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import ros_environment
import pytest


@pytest.fixture
def domain(monkeypatch):
    with free_domain() as number:
        for name, value in ros_environment(number).items():
            monkeypatch.setenv(name, value)
        yield number
