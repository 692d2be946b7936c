# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A task in a worker: its name, its result bit for bit, how far it is."""

import json
import math
import os
from pathlib import Path
import struct
import subprocess
import sys

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.tasks.worker import (
    describe_failure,
    listener,
    plain_result,
    run_task,
    ShareTeller,
    task_name,
    tell_share,
)

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda parts: st.lists(parts, max_size=4) | st.dictionaries(st.text(max_size=8), parts),
    max_leaves=12,
)
ROOT = Path(__file__).resolve().parents[3]
DEADLINE = 600.0  # [s] which only ends a hang
CALLER = """
import ctypes
import os
from pathlib import Path
import signal

def call_back():
    os.kill(os.getpid(), signal.SIGTERM)

def work(inputs):
    try:
        ctypes.CFUNCTYPE(None)(call_back)()
        signal.pause()
    finally:
        Path('removed').touch()
"""
SCRIPT = """
from surrogate.tasks.worker import task_name

def square(inputs):
    return {'square': inputs['x'] ** 2}

if __name__ == '__main__':
    from surrogate.tasks.pool import run_tasks
    from surrogate.tasks.workers import open_pool

    with open_pool(1) as pool:
        print(task_name(square), run_tasks(pool, square, {'a': {'x': 3.0}})['a'].result)
"""


def bits(value):
    """Return plain JSON with every float as its bytes, so that NaN and -0.0 can be compared."""
    if isinstance(value, float):
        return struct.pack('<d', value) if value == value else 'nan'
    if isinstance(value, dict):
        return {key: bits(part) for key, part in value.items()}
    return [bits(part) for part in value] if isinstance(value, list) else (value, type(value))


@given(PLAIN)
def test_a_line_of_json_holds_a_plain_result_bit_for_bit(result):
    """Whatever the floats are: a worker sends it so, and a store keeps it so."""
    assert bits(plain_result(result)) == bits(result)
    assert bits(json.loads(json.dumps(result))) == bits(result)


def test_only_plain_results_are_taken():
    for result in ({'a': np.zeros(3)}, {1: 2.0}, [b'a'], {'a': np.int64(1)}):
        with pytest.raises(TypeError):
            plain_result(result)
    assert plain_result({'a': (np.float64(0.5), 1)}) == {'a': [0.5, 1]}


def test_a_task_is_known_by_its_name_and_a_failure_is_a_sentence():
    assert task_name(math.sqrt) == 'math:sqrt'
    with pytest.raises(TypeError, match='top level of a module'):
        task_name(lambda inputs: inputs)
    assert run_task('math:sqrt', 9.0)['result'] == 3.0
    assert run_task('math:sqrt', -9.0)['sentence'] == 'ValueError: math domain error'
    assert run_task('gone:a', {})['sentence'] == "ModuleNotFoundError: No module named 'gone'"
    assert run_task('math:gone', {})['result'] is None
    missing = run_task('surrogate.files.datasheet:read_yaml', '/none')
    assert missing['sentence'].startswith('/none: ')


def test_a_task_of_a_script_is_found_beside_it(tmp_path):
    """A study is run as a script, and its workers are not."""
    script = tmp_path / 'study.py'
    script.write_text(SCRIPT)
    done = subprocess.run([sys.executable, script], check=True, capture_output=True, text=True)
    assert done.stdout == "study:square {'square': 9.0}\n"


def test_steps_are_told_and_shares_not_more_often_than_is_worth_it():
    steps = []
    tell_share(0.5)  # to nobody
    token = listener.set(ShareTeller(steps.append))
    try:
        for share in (0.25, 0.251, 0.5):
            tell_share(share)
        listener.get()({'stage': 'contact'})
    finally:
        listener.reset(token)
    assert steps == [0.25, 0.5, {'stage': 'contact'}]


def test_a_signal_in_a_callback_of_c_ends_the_task_after_it(tmp_path):
    """A compiler calls back so. What the task has half made is removed, and nothing is printed."""
    (tmp_path / 'caller.py').write_text(CALLER)
    worker = [sys.executable, '-m', 'surrogate.tasks.worker', '0', '0']
    task = json.dumps({'task': 'caller:work', 'inputs': {}}) + '\n'
    path = os.pathsep.join([str(tmp_path), str(ROOT)])
    with subprocess.Popen(
        worker,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
        env=os.environ | {'PYTHONPATH': path},
    ) as process:
        process.stdin.write(task)
        process.stdin.flush()
        process.wait(timeout=DEADLINE)
        assert (process.returncode, process.stderr.read()) == (1, '')
    assert (tmp_path / 'removed').exists()


def test_all_that_lacks_memory_is_told_as_such():
    with pytest.raises(MemoryError) as caught:
        np.zeros(2**50, np.uint8)  # numpy has an error of its own
    assert describe_failure(caught.value).startswith('MemoryError: ')
