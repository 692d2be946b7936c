# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of the set-up: what is done again, and what an interruption leaves."""

from collections.abc import Callable
from functools import partial
import importlib.util
import os
from pathlib import Path
import runpy
import sys
import threading
from typing import Any

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / 'scripts' / 'set_up.py'

DEADLINE = 600.0  # [s] which only ends a hang

PACKAGE = 'ballscrew_monitor'

SetUp = Callable[..., list[str]]


@pytest.fixture
def module(tmp_path, monkeypatch):
    specification = importlib.util.spec_from_file_location('set_up', SCRIPT)
    assert specification is not None
    assert specification.loader is not None
    loaded = importlib.util.module_from_spec(specification)
    monkeypatch.setitem(sys.modules, 'set_up', loaded)
    specification.loader.exec_module(loaded)
    monkeypatch.setattr(loaded, 'TREE', tmp_path)
    monkeypatch.setattr(loaded, 'VENV', tmp_path / '.venv')
    monkeypatch.setattr(loaded, 'PYTHON', Path(sys.executable))
    monkeypatch.setattr(loaded, 'STAMPS', tmp_path / 'set_up.json')
    monkeypatch.setattr(loaded, 'LOG', tmp_path / 'log' / 'set_up.log')
    monkeypatch.setattr(loaded, 'SOLVER_LOG', tmp_path / 'log' / 'solver.log')
    return loaded


@pytest.fixture
def set_up(module, monkeypatch):
    """Return a function that sets up by three steps and returns the exit code and what it did."""

    def run(*, raises=None, **keys):
        done: list[str] = []

        def work(name):
            def act():
                done.append(name)
                if raises and name in raises:
                    raise raises[name]

            return act

        monkeypatch.setattr(
            module,
            'steps',
            lambda: [
                module.Step(
                    name=name,
                    text=name,
                    key=keys.get(name, 'same'),
                    work=work(name),
                    made=keys.get(name) != 'lost',
                )
                for name in ('environment', 'interfaces', 'bag')
            ],
        )
        return [str(module.main()), *done]

    return run


def test_a_change_repeats_its_step_and_a_new_environment_all(set_up):
    """A second call does nothing, neither pip nor cmake."""
    assert set_up() == ['0', 'environment', 'interfaces', 'bag']
    assert set_up() == ['0']
    assert set_up(interfaces='changed') == ['0', 'interfaces']
    assert set_up(interfaces='changed', bag='lost') == ['0', 'bag']
    assert set_up(environment='changed') == ['0', 'environment', 'interfaces', 'bag']


def test_interruption_is_made_good(set_up, capsys, says):
    expected = ['130', 'environment', 'interfaces']
    assert set_up(raises={'interfaces': KeyboardInterrupt()}) == expected
    assert capsys.readouterr().err == says('set_up_interrupted')
    assert set_up() == ['0', 'interfaces', 'bag']
    set_up(interfaces='changed', raises={'interfaces': KeyboardInterrupt()})
    assert set_up() == ['0', 'interfaces']


def test_failure_is_one_sentence(module, set_up, capsys, says):
    assert set_up(raises={'bag': module.Failure('pip failed with exit code 1')})[0] == '1'
    assert capsys.readouterr().err.endswith(says('set_up_pip'))


def test_step_beside_others_does_not_hold_them_up(module, monkeypatch):
    """Each waits for the other to be at work."""
    met = threading.Barrier(2)
    done: list[str] = []

    def meet(name):
        met.wait(DEADLINE)
        done.append(name)

    monkeypatch.setattr(
        module,
        'steps',
        lambda: [
            module.Step(name=name, text=name, key='', work=partial(meet, name), beside=beside)
            for name, beside in (('environment', True), ('interfaces', False))
        ],
    )
    assert [module.main(), module.main()] == [0, 0]
    assert sorted(done) == ['environment', 'interfaces']


def test_failure_beside_others_is_told_from_its_own_log(module, monkeypatch, capsys, says):
    """The others are done meanwhile, and the next call repeats that one alone."""
    done: list[str] = []

    def fail():
        done.append('solver')
        module.SOLVER_LOG.write_text('why\n')
        raise module.Failure('python failed with exit code 1', module.SOLVER_LOG)

    monkeypatch.setattr(
        module,
        'steps',
        lambda: [
            module.Step(name='environment', text='', key='', work=lambda: None),
            module.Step(name='solver', text='', key='', work=fail, beside=True),
            module.Step(name='bag', text='', key='', work=lambda: done.append('bag')),
        ],
    )
    assert module.main() == 1
    assert capsys.readouterr().err.endswith(says('why_set_up'))
    assert module.main() == 1
    assert sorted(done) == ['bag', 'solver', 'solver']


def test_failing_command_is_named(module, refused):
    module.LOG.parent.mkdir()
    with refused('python_s_failed'):
        module.run(sys.executable, '-c', 'print("why"); raise SystemExit(3)')
    assert module.LOG.read_text().splitlines()[-1] == 'why'


def test_key_follows_names_and_contents(module, tmp_path):
    first, second = tmp_path / 'a', tmp_path / 'b'
    first.write_text('x')
    keys = [module.digest('step', files=[first])]
    second.write_text('x')
    keys += [module.digest('step', files=[second]), module.digest('step', files=[first, second])]
    first.write_text('y')
    keys.append(module.digest('step', files=[first]))
    assert len(set(keys)) == 4


def walked(share):
    """Return the files below `share` as launch tools find them: no link to a directory counts."""
    return {
        str(Path(folder, name).relative_to(share))
        for folder, _, names in os.walk(share, followlinks=False)
        for name in names
    }


def test_installed_files_are_found_without_following_links(module, tmp_path, monkeypatch):
    """Also over an installation of links to directories, and after a file is gone."""
    monkeypatch.setattr(module, 'run', lambda *command: None)
    wanted = {'config/a.yaml', 'config/layouts/b.json', 'launch/c.launch.py', 'package.xml'}
    for name in wanted:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    share = tmp_path / '.venv' / 'share' / PACKAGE
    module.link(share / 'launch', tmp_path / 'launch')
    module.install_package()
    assert walked(share) == wanted
    assert all((share / name).read_text() == name for name in wanted)
    (tmp_path / 'config' / 'a.yaml').unlink()
    module.install_package()
    assert walked(share) == wanted - {'config/a.yaml'}
    assert (tmp_path / 'launch' / 'c.launch.py').exists()


def test_package_installs_each_shared_file(module, monkeypatch):
    """What setup.py lists is what the set-up links."""
    tree = SCRIPT.parents[1]
    asked: dict[str, Any] = {}
    monkeypatch.chdir(tree)
    monkeypatch.setattr('setuptools.setup', lambda **facts: asked.update(facts))
    runpy.run_path('setup.py')
    listed = {
        f'{place}/{Path(name).name}'.removeprefix(f'share/{PACKAGE}/')
        for place, names in asked['data_files']
        for name in names
        if place.startswith(f'share/{PACKAGE}/')
    }
    linked = {
        str(path.relative_to(tree))
        for name in module.SHARED
        for path in module.files_below(tree / name)
    }
    assert listed == linked
