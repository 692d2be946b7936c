# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Conventions that no linter knows: units, headers, versions, manifests and what is collected."""

import ast
from importlib.metadata import requires
from pathlib import Path
import re
import runpy
import subprocess
import sys
import tomllib
from xml.etree import ElementTree

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
import pytest

TREE = Path(__file__).resolve().parent.parent
FOLDERS = 'ballscrew_monitor bags bench docs launch scripts studies surrogate test'.split()
SOURCES = sorted(path for name in FOLDERS for path in (TREE / name).rglob('*.py'))
PACKAGES = [
    path
    for path in SOURCES
    if path.is_relative_to(TREE / 'ballscrew_monitor') or path.is_relative_to(TREE / 'surrogate')
]
TEXTS = SOURCES + sorted(
    path
    for pattern in ('*', '.ci/*', 'config/*', 'docs/**/*.md', 'msg_defs/*/*', 'scripts/*')
    for path in TREE.glob(pattern)
    if path.is_file() and path not in SOURCES
)
HEADER = """\
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
# The last word of the name of a quantity that has a unit.
QUANTITIES = {
    *'age angle damping density duration efficiency energy film force lead load mass'.split(),
    *'modulus period power preload pressure radius rate rcs roughness speed stamp'.split(),
    *'temperature thickness time torque viscosity'.split(),
}
UNIT = re.compile(r'\[[^\]]+\]|[Dd]imensionless')
UNIT_BESIDE = re.compile(r'#.*\[[^\]]+\]')
MISSPELT = re.compile(r'\[(?:Nm|N\.m|N\*m|rpm|RPM|sec|C|°C|deg C|Pas|Pa\.s|Celsius|Kelvin)\]')
# Python packages by the names that a ROS machine knows them by.
ROSDEP = {
    'matplotlib': 'python3-matplotlib',
    'numpy': 'python3-numpy',
    'scipy': 'python3-scipy',
    'yaml': 'python3-yaml',
}
# Tests of a whole folder instead of one of its files, by what they hold it against.
THEMES = {
    'bags/test_identity.py',
    'ballscrew_monitor/judge/test_edge_floats.py',
    'ballscrew_monitor/judge/test_golden.py',
    'ballscrew_monitor/node/test_clocks.py',
    'ballscrew_monitor/node/test_one_clock.py',
    'ballscrew_monitor/node/test_cures.py',
    'ballscrew_monitor/node/test_deadline.py',
    'ballscrew_monitor/node/test_dump.py',
    'ballscrew_monitor/node/test_kept.py',
    'ballscrew_monitor/node/test_faults.py',
    'ballscrew_monitor/node/test_loss.py',
    'ballscrew_monitor/node/test_motor_torque.py',
    'ballscrew_monitor/node/test_policy.py',
    'ballscrew_monitor/node/test_solve.py',
    'ballscrew_monitor/node/test_system.py',
    'ballscrew_monitor/page/components/test_german.py',
    'ballscrew_monitor/recordings/test_black_box.py',
    'ballscrew_monitor/recordings/test_compatibility.py',
    'ballscrew_monitor/report/test_memory.py',
    'ballscrew_monitor/test_hostile.py',
    'ballscrew_monitor/test_mutations.py',
    'ballscrew_monitor/test_signals.py',
    'config/test_deployment.py',
    'config/test_parameter_files.py',
    'config/test_workspace.py',
    'surrogate/builder/full/test_shipped.py',
    'surrogate/ehl/test_identities.py',
    'surrogate/ehl/test_mixed.py',
    'surrogate/ehl/test_tables.py',
}
# Not asked of rosdep: numba, and the extras bags, report, xlsx, page, areal, dask and netcdf.
OPTIONAL = {
    *'SurfaceTopography apsw contourpy distributed fastexcel h11 lz4 mcap numba'.split(),
    *'polars prometheus_client rosbags starlette uvicorn websockets xarray zstandard'.split(),
}


def name_of(path):
    return str(path.relative_to(TREE))


def public(body):
    """Return the public functions and classes of a module or class, methods included."""
    found: list[ast.FunctionDef | ast.ClassDef] = []
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith('_'):
            found += [node, *(public(node.body) if isinstance(node, ast.ClassDef) else [])]
    return found


def quantities(node):
    """Return the names of the float parameters or fields that are quantities."""
    if isinstance(node, ast.FunctionDef):
        given = [(arg.arg, arg.annotation) for arg in (*node.args.args, *node.args.kwonlyargs)]
    else:
        given = [
            (part.target.id, part.annotation)
            for part in node.body
            if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name)
        ]
    return [
        name
        for name, annotation in given
        if annotation
        and re.match(r'float|Array|NDArray', ast.unparse(annotation))
        and name.split('_')[-1] in QUANTITIES
    ]


def says_unit(node, text):
    """Tell whether a unit is in the docstring, or in a comment beside the fields of a class."""
    if UNIT.search(ast.get_docstring(node) or ''):
        return True
    segment = ast.get_source_segment(text, node) or ''
    return isinstance(node, ast.ClassDef) and bool(UNIT_BESIDE.search(segment))


@pytest.mark.parametrize('path', PACKAGES, ids=name_of)
def test_docstrings_say_units(path):
    text = path.read_text()
    for node in public(ast.parse(text).body):
        named = quantities(node)
        assert not named or says_unit(node, text), f'{node.name}: no [unit] for {named}'


@pytest.mark.parametrize('path', PACKAGES, ids=name_of)
def test_units_are_spelt_as_everywhere(path):
    """One spelling for one unit: N m, rev/min, s, degC, Pa s."""
    tree = ast.parse(path.read_text())
    for node in (tree, *public(tree.body)):
        assert not MISSPELT.findall(ast.get_docstring(node) or '')


@pytest.mark.parametrize('path', [*SOURCES, TREE / 'setup.py'], ids=name_of)
def test_sources_carry_copyright_and_licence(path):
    text = path.read_text()
    assert text.startswith(HEADER) or text.split('\n', 1)[1].startswith(HEADER)


@pytest.mark.parametrize('path', TEXTS, ids=name_of)
def test_no_file_knows_the_machine_it_was_written_on(path):
    assert not re.findall(r'(?<![\w.])/(?:home|root|tmp|work|Users)/\w+', path.read_text())


def version_in(name, pattern):
    """Return what a pattern finds first in a file."""
    match = re.search(pattern, (TREE / name).read_text(), re.MULTILINE)
    assert match, f'no version in {name}'
    return match[1]


def test_version_is_the_same_everywhere():
    assert (
        len(
            {
                version_in('package.xml', r'<version>(.*)</version>'),
                version_in('msg_defs/package.xml', r'<version>(.*)</version>'),
                version_in('setup.py', r"version='(.*)'"),
                version_in('CHANGELOG.rst', r'^(\d+\.\d+\.\d+) \('),
            }
        )
        == 1
    )


def test_pins_meet_all_requirements():
    """What setup.py asks for, with all extras, is pinned to a version that it allows."""
    lines = (TREE / 'constraints.txt').read_text().splitlines()
    pins = dict(line.split('==') for line in lines if not line.startswith('#'))
    pinned = {canonicalize_name(name): version for name, version in pins.items()}
    for requirement in map(Requirement, requires('ballscrew-monitor') or []):
        version = pinned[canonicalize_name(requirement.name)]
        assert requirement.specifier.contains(version), f'{requirement}: {version} is pinned'


def test_manifest_names_what_is_imported():
    """Every package that is imported is depended on, and none that is not."""
    manifest = ElementTree.parse(TREE / 'package.xml')
    declared = {element.text for element in manifest.iter('exec_depend')}
    shipped = [*PACKAGES, *TREE.glob('launch/*.py')]
    imported = {
        name.split('.')[0]
        for path in shipped
        for node in ast.walk(ast.parse(path.read_text()))
        for name in (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else [node.module or '']
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    own = {'ballscrew_monitor', 'surrogate'} | OPTIONAL | set(sys.stdlib_module_names)
    needed = {ROSDEP.get(name, name) for name in imported - own}
    assert needed <= declared
    # A message type may be used by its name only.
    text = ''.join(path.read_text() for path in [*shipped, *TREE.glob('config/*.yaml')])
    assert not {name for name in declared - needed if f'{name}/' not in text}


def test_every_file_of_tests_is_collected():
    for path in sorted((TREE / 'test').rglob('*.py')):
        names = [
            node.name
            for node in ast.walk(ast.parse(path.read_text()))
            if isinstance(node, ast.FunctionDef) and node.name.startswith('test')
        ]
        assert len(names) == len(set(names)), f'{path.name}: a test hides another of its name'
        assert path.name == 'conftest.py' or (path.name.startswith('test_') and names), path.name


def test_every_golden_sentence_is_asked_for():
    """The file of tests that a table is of names each of its keys, in their order."""
    folder = TREE / 'test'
    golden = tomllib.loads((folder / 'data' / 'sentences.toml').read_text(encoding='utf-8'))
    for name, sentences in golden.items():
        nodes = ast.walk(ast.parse((folder / name).read_text(encoding='utf-8')))
        unasked = sentences.keys() - {
            node.value for node in nodes if isinstance(node, ast.Constant)
        }
        assert not unasked, f'{name} asks for no {unasked}'
        assert list(sentences) == sorted(sentences), name
    assert list(golden) == sorted(golden)


def test_tests_mirror_the_sources():
    """Each file of tests in a folder stands where the file stands that it tests."""
    folder = TREE / 'test'
    nested = {path.relative_to(folder) for path in folder.glob('*/**/test_*.py')}
    alone = {
        str(path)
        for path in nested
        if not list((TREE / path.parent).glob(f'{path.stem.removeprefix("test_")}.*'))
    }
    assert alone == THEMES


def test_a_deadline_only_ends_a_hang():
    """Every file that has one has the same, long enough for a machine that is busy elsewhere."""
    texts = [path.read_text() for path in (TREE / 'test').rglob('*.py')]
    found = {one for text in texts for one in re.findall(r'^DEADLINE = .*?(?=,|$)', text, re.M)}
    assert found == {'DEADLINE = 600.0  # [s] which only ends a hang'}
    calls = re.compile(r'^ +timeout=\d|\.(?:run|communicate|wait|join|result)\(.*timeout=\d', re.M)
    assert not [one for text in texts for one in calls.findall(text)]


def test_slow_tests_are_there():
    """What is named as slow is a file or folder of tests; a move would make it fast unseen."""
    slow = runpy.run_path(str(TREE / 'test' / 'conftest.py'))['SLOW']
    assert not [name for name in slow if not (TREE / 'test' / name).exists()]


def test_only_sources_are_in_the_repository():
    """Nothing that is made, nothing large."""
    listed = subprocess.run(
        ['git', 'ls-files', '-z'], cwd=TREE, capture_output=True, text=True, check=False
    ).stdout.split('\0')
    if listed == ['']:
        pytest.skip('not a git work tree')
    tracked = [TREE / name for name in listed if (TREE / name).is_file()]
    large = [name_of(path) for path in tracked if path.stat().st_size > 2_000_000]
    assert not large
    assert not [name_of(path) for path in tracked if path.suffix in {'.mcap', '.pyc', '.so'}]
