# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Without numba the kernels can be imported; the one that is called says what is missing."""

import importlib
import subprocess
import sys

import pytest
from surrogate import compiler

CLOSED_FORM = """
import sys

sys.modules['numba'] = None
from surrogate.builder import closed_form, sheets_onset, tiers
from surrogate.identify import fit
from surrogate.screw import closed_form_record, sensitivity
"""


@pytest.fixture(name='bare')
def without_numba(monkeypatch):
    with monkeypatch.context() as hidden:
        hidden.setitem(sys.modules, 'numba', None)
        yield importlib.reload(compiler)
    importlib.reload(compiler)


def test_a_kernel_refuses_to_be_called_without_numba(bare):
    @bare.njit(cache=True, error_model='numpy')
    def twice(number):
        return 2 * number

    for call in (lambda: twice(1), bare.check):
        with pytest.raises(ModuleNotFoundError) as refusal:
            call()
        assert refusal.value.name == 'numba'


def test_a_numba_that_does_not_run_is_said_to_be_the_reason(monkeypatch, tmp_path):
    (tmp_path / 'numba.py').write_text("raise ImportError('needs another NumPy')\n")
    with monkeypatch.context() as broken:
        broken.syspath_prepend(tmp_path)
        broken.delitem(sys.modules, 'numba')
        importlib.reload(compiler)
        with pytest.raises(ImportError, match='^needs another NumPy$') as refusal:
            compiler.check()
    importlib.reload(compiler)
    assert refusal.value.name == 'numba'


def test_a_kernel_is_compiled_with_numba():
    compiler.check()
    assert compiler.njit(lambda number: 2 * number)(2) == 4


def test_the_closed_form_loads_without_numba():
    command = [sys.executable, '-c', CLOSED_FORM]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, '')
