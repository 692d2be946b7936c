# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A machine that lacks a package: one sentence with the cure, from each command and the node."""

import ast
from pathlib import Path
import re
import subprocess
import sys

from ballscrew_monitor.core.prerequisites import CURES, LAST_FIELDS, refuse, require
from ballscrew_monitor.cycle.node_process import child_environment
from ballscrew_msgs import msg
import pytest

ROOT = Path(__file__).resolve().parents[3]
PACKAGES = ('ballscrew_monitor', 'surrogate')
LOOKUP = 'surrogate/data/surfaces/nominal_iso_vg_68.npz'
POINT = ('point', '--speed-rpm', '600', '--load-N', '1000')
# What needs which package: {bag} is a recording, {out} a folder, and {csv} a table.
FULL = (
    POINT,
    ('contact', 'nominal_smooth'),
    ('figures', '--out', '{out}'),
    ('validate',),
    ('surface', 'build', '--out', '{out}/b.npz', '--workers', '1'),
    ('surface', 'sweep', '{full}', '--out', '{out}'),
    ('identify', '{csv}', '--tier', 'full'),
)
SOLVES = (
    *FULL,
    (*POINT, '--tier', 'closed_form'),
    ('onset',),
    ('identify', '{csv}'),
    ('surface', 'build', '--out', '{out}/a.npz', '--tier', 'closed_form'),
    ('surface', 'check', LOOKUP),
    ('surface', 'sweep', '{catalogue}', '--out', '{out}'),
)
JUDGES = (
    ('replay', '{bag}'),
    ('replay', '{bag}', '{bag}', '--out', '{out}', '--workers', '1'),
    ('health', '{bag}'),
    ('run', '--bag', '{bag}', '--out', '{out}'),
    ('page', '{bag}', '--port', '0'),
)
READS = (*JUDGES, ('play', '{bag}'), ('recover', '{bag}'), ('import', '{csv}', '--guess'))
REPORTS = (*JUDGES[1:2], ('replay', '{bag}', '--out', '{out}'), *JUDGES[3:4])
PICTURES = (
    ('figures', '--out', '{out}'),
    ('surface', 'plot', LOOKUP, '--out', '{out}'),
    *JUDGES[3:4],
)
PAGES = (('page',),)
ROS = (*READS[:-2], *PAGES, ('doctor',), ('solve', '--axis', 'x'))
NEEDS = {
    'ballscrew_msgs': (*ROS[:5], ('doctor',)),
    'contourpy': (*REPORTS, *PAGES),
    'distributed': (('surface', 'build', '--out', '{out}/c.npz', '--dask', 'local'),),
    'h11': PAGES,
    'matplotlib': PICTURES,
    'mcap': READS,
    'numba': (*FULL, *JUDGES),
    'numpy': (POINT, ('doctor',)),
    'polars': (*REPORTS, ('import', '{csv}', '--guess'), ('identify', '{csv}')),
    'prometheus_client': PAGES,
    'rclpy': ROS,
    'scipy': SOLVES,
    'sensor_msgs': (READS[-1], JUDGES[1]),
    'starlette': PAGES,
    'uvicorn': PAGES,
    'websockets': PAGES,
    'yaml': (POINT, ('doctor',)),
    'zstandard': READS[:-1],
}
BLIND = """
from importlib.machinery import PathFinder
import sys

hidden = set(sys.argv[1].split())


class Blind(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if name.split('.')[0] not in hidden:
            return PathFinder.find_spec(name, path, target)


sys.meta_path[sys.meta_path.index(PathFinder)] = Blind
"""
COMMANDS = f"""{BLIND}
from ballscrew_monitor.__main__ import main

for words in sys.argv[2:]:
    sys.argv[1:] = words.split()
    print(main())
"""
NODE = f"""{BLIND}
from ballscrew_monitor.node.__main__ import main

sys.exit(main([]))
"""
OLDER = """
from ballscrew_msgs.msg import BallScrewState

fields = BallScrewState.get_fields_and_field_types()
fields.popitem()
BallScrewState.get_fields_and_field_types = classmethod(lambda kind: fields)
"""
# All that rosdep does not bring, and what no command of the node is for.
OPTIONAL = 'numba matplotlib scipy mcap zstandard lz4 polars contourpy fastexcel starlette'


def python(script, *arguments):
    return subprocess.run(
        [sys.executable, '-c', script, *arguments],
        cwd=ROOT,
        env=child_environment(0),
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope='module')
def places(short_bag, tmp_path_factory):
    folder = tmp_path_factory.mktemp('without')
    (folder / 'drag.csv').write_text('speed_rpm,torque_Nm\n100,0.11\n800,0.18\n1600,0.26\n')
    (folder / 'catalogue.yaml').write_text('screws: [nominal]\noils: [iso_vg_68]\n')
    tier = 'tier: full\n'
    (folder / 'full.yaml').write_text((folder / 'catalogue.yaml').read_text() + tier)
    names = {'csv': 'drag.csv', 'catalogue': 'catalogue.yaml', 'full': 'full.yaml', 'out': 'out'}
    return {'bag': short_bag} | {name: folder / path for name, path in names.items()}


@pytest.mark.parametrize('module', NEEDS)
def test_a_command_without_a_package_says_how_to_get_it(module, places, says):
    commands = [' '.join(words).format_map(places) for words in NEEDS[module]]
    done = python(COMMANDS, module, *commands)
    sentence = f'ballscrew: {says(module)}'
    lines = [line for line in done.stderr.splitlines() if not line.startswith('ballscrew: param')]
    assert dict(zip(commands, lines, strict=True)) == dict.fromkeys(commands, sentence)
    assert done.stdout.split() == ['2'] * len(commands)


@pytest.mark.parametrize('module', ['ballscrew_msgs', 'numpy', 'rclpy'])
def test_the_node_without_a_package_says_how_to_get_it(module, says):
    done = python(NODE, module)
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == f'ballscrew_monitor: {says(module)}\n'


def test_interfaces_of_an_older_version_are_refused_by_node_and_commands(places, says):
    """That is, a workspace in which they were not built again."""
    sentence = says('interfaces_old')
    done = python(OLDER + NODE, '')
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == f'ballscrew_monitor: {sentence}\n'
    done = python(OLDER + COMMANDS, '', 'replay {bag} --out {out}'.format_map(places))
    assert (done.stdout, done.stderr) == ('2\n', f'ballscrew: {sentence}\n')


def test_the_last_field_of_each_message_is_known():
    kinds = {name: kind for name, kind in vars(msg).items() if isinstance(kind, type)}
    assert LAST_FIELDS == {
        name: [*kind.get_fields_and_field_types()][-1] for name, kind in kinds.items()
    }


def test_the_node_loads_without_what_rosdep_does_not_bring():
    script = f'{BLIND}\nimport ballscrew_monitor.node.run'
    done = python(script, OPTIONAL)
    assert (done.returncode, done.stderr) == (0, '')


def test_a_package_that_lacks_a_part_is_too_old(capsys, says):
    """As `websockets` of Ubuntu 24.04, which has no `websockets.asyncio`."""
    for error in (
        ModuleNotFoundError('', name='websockets.asyncio'),
        ImportError('', name='websockets'),
    ):
        assert refuse('ballscrew', error) == 2
        assert capsys.readouterr().err == f'ballscrew: {says("websockets_old")}\n'


def test_what_nobody_can_install_is_a_fault():
    error = ModuleNotFoundError('', name='surrogate.nothing')
    with pytest.raises(ModuleNotFoundError) as caught:
        refuse('ballscrew', error)
    assert caught.value is error


def test_what_is_required_is_looked_for_and_not_imported(monkeypatch):
    monkeypatch.delitem(sys.modules, 'fastexcel', raising=False)
    require('json', 'fastexcel')
    assert 'fastexcel' not in sys.modules
    with pytest.raises(ModuleNotFoundError) as caught:
        require('json', 'no_such_package', 'nor_this')
    assert caught.value.name == 'no_such_package'


def test_every_package_that_the_sources_import_has_a_cure():
    named = set()
    for path in (path for package in PACKAGES for path in (ROOT / package).rglob('*.py')):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                named |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                named.add(str(node.module).split('.')[0])
    assert named - set(sys.stdlib_module_names) - set(PACKAGES) <= set(CURES)


def test_what_pip_is_to_install_is_what_the_package_asks_for():
    asked = (ROOT / 'setup.py').read_text(encoding='utf-8')
    for cure in CURES.values():
        for names in re.findall('pip install ([^,]+)', cure):
            for name in names.split():
                assert f"'{name.strip(chr(39))}" in asked, name
