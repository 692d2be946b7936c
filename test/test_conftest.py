# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The tests on a machine that lacks what ROS 2 does not bring along."""

import os
from pathlib import Path
import subprocess
import sys

from hypothesis import HealthCheck, settings

TREE = Path(__file__).resolve().parents[1]
BLIND = """
from importlib.machinery import PathFinder
import sys


class Blind(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if name.split('.')[0] != 'mcap':
            return PathFinder.find_spec(name, path, target)


sys.meta_path[sys.meta_path.index(PathFinder)] = Blind
"""


def test_without_mcap_the_tests_that_need_it_are_skipped(tmp_path):
    """Neither an error when they are collected, nor a failure of a test with a bag."""
    (tmp_path / 'blind.py').write_text(BLIND)
    paths = (str(tmp_path), os.environ.get('PYTHONPATH', ''))
    folder = TREE / 'test' / 'ballscrew_monitor'
    done = subprocess.run(
        [
            *(sys.executable, '-m', 'pytest', '-q', '-p', 'blind', '-p', 'no:cacheprovider'),
            *(folder / 'recordings' / 'test_bag.py', folder / 'core' / 'test_advice.py'),
        ],
        cwd=TREE,
        env=os.environ | {'PYTHONPATH': os.pathsep.join(filter(None, paths))},
        check=False,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert 'mcap is not installed' in done.stdout
    assert 'passed, 1 skipped' in done.stdout


def test_no_example_is_judged_by_its_time():
    """A busy machine fails no property."""
    assert settings().deadline is None
    assert HealthCheck.too_slow in settings().suppress_health_check


def test_the_tests_draw_the_same_examples_each_time_and_fuzzing_does_not():
    """Nobody's first `make test` finds a defect that is not of their change."""
    same, fuzz = settings.get_profile('same'), settings.get_profile('fuzz')
    assert (same.derandomize, same.database) == (True, None)
    assert not fuzz.derandomize
    assert fuzz.database is not None
    assert fuzz.max_examples > same.max_examples
