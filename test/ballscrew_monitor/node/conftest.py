# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Nodes within the process of the tests."""

import gc

import pytest


@pytest.fixture(autouse=True)
def participants():
    """
    Let every DDS participant of a test end with it.

    A lifecycle node refers to itself, so that its participant lives on as garbage; participants
    are numbered within their process, and nobody on its machine finds the one with the number 32.

    """
    yield
    gc.collect()
