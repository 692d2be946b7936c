# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Conventions that no linter knows: units, headers, versions, manifests and what is collected."""

import ast
import functools
from functools import cache
from importlib.metadata import requires
import json
from pathlib import Path
import re
import runpy
import subprocess
import sys
import tomllib
import types
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
TESTS = [path for path in SOURCES if path.is_relative_to(TREE / 'test')]
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
HOMES = 'home root tmp work Users'.split()
MACHINE = re.compile(rf'(?<![\w.])/(?:{"|".join(HOMES)})/\w+')
HANG = 'DEADLINE = 600.0  # [s] which only ends a hang'
FIXED_TIMEOUT = re.compile(r'^ +timeout=\d|\.(?:run|communicate|wait|join|result)\(.*timeout=\d')
# How logic would read a sentence, and the attributes that hold one.
READERS = {*'count endswith find index partition removeprefix rpartition split startswith'.split()}
MATCHES = ast.In, ast.NotIn
SAID = set('advice message msg reason refusal sentence text verdict'.split())
WORDS = re.compile(r'[a-z]+[ :,]+[a-z]+[ :,]+[a-z]+|[a-z]: $')
# Sentences that are shortened where they are shown, and those of rcl, which has no codes.
SHOWN = (
    'ballscrew_monitor/report/overview.py',
    'ballscrew_monitor/settings/parameters.py',
    'surrogate/files/datasheet.py',
    'surrogate/identify/record.py',
    'surrogate/parameters.py',
)
# Python packages by the names that a ROS machine knows them by.
ROSDEP = {
    'matplotlib': 'python3-matplotlib',
    'numpy': 'python3-numpy',
    'scipy': 'python3-scipy',
    'yaml': 'python3-yaml',
}
# Tests of a whole folder instead of one of its files, by what they hold it against.
THEMES = {
    'ballscrew_monitor/recordings/tables/test_cases.py',
    'ballscrew_monitor/recordings/tables/test_written_forms.py',
    'surrogate/files/test_files.py',
    'bags/test_identity.py',
    'ballscrew_monitor/judge/test_edge_floats.py',
    'ballscrew_monitor/judge/test_golden.py',
    'ballscrew_monitor/node/test_clocks.py',
    'ballscrew_monitor/node/test_one_clock.py',
    'ballscrew_monitor/node/test_cures.py',
    'ballscrew_monitor/node/test_deadline.py',
    'ballscrew_monitor/node/test_executors.py',
    'ballscrew_monitor/node/test_dump.py',
    'ballscrew_monitor/node/test_kept.py',
    'ballscrew_monitor/node/test_faults.py',
    'ballscrew_monitor/node/test_loss.py',
    'ballscrew_monitor/node/test_motor_torque.py',
    'ballscrew_monitor/node/test_policy.py',
    'ballscrew_monitor/node/test_solve.py',
    'ballscrew_monitor/node/test_system.py',
    'ballscrew_monitor/page/components/test_german.py',
    'ballscrew_monitor/page/components/test_screens.py',
    'ballscrew_monitor/recordings/test_black_box.py',
    'ballscrew_monitor/recordings/test_compatibility.py',
    'ballscrew_monitor/report/test_memory.py',
    'ballscrew_monitor/test_exit_codes.py',
    'ballscrew_monitor/test_hostile.py',
    'ballscrew_monitor/test_mutations.py',
    'ballscrew_monitor/test_signals.py',
    'config/test_deployment.py',
    'config/test_parameter_files.py',
    'config/test_workspace.py',
    'golden/test_golden.py',
    'surrogate/builder/full/test_shipped.py',
    'surrogate/ehl/test_identities.py',
    'surrogate/ehl/test_mixed.py',
    'surrogate/ehl/test_tables.py',
}
# Not asked of rosdep: numba, and the extras bags, report, xlsx, page, areal and dask.
OPTIONAL = {
    *'SurfaceTopography contourpy distributed fastexcel h11 lz4 mcap numba polars'.split(),
    *'prometheus_client starlette uvicorn websockets zstandard'.split(),
}


def name_of(path):
    return str(path.relative_to(TREE))


@cache
def text_of(path):
    return path.read_text(encoding='utf-8')


@cache
def syntax(text):
    """Return the syntax tree of a source, which several checks read."""
    return ast.parse(text)


@pytest.fixture(scope='module', autouse=True)
def _trees_are_of_these_tests_alone():
    yield
    syntax.cache_clear()
    text_of.cache_clear()


def offenders(check, paths):
    """Return `file:line: why` of all that a check of a text finds in files."""
    return [
        f'{name_of(path)}:{line}: {why}' for path in paths for line, why in check(text_of(path))
    ]


def report(lines):
    """Hold that there is no offender; the failure has each on a line of its own."""
    assert not lines, '\n'.join(lines)


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


def quantities_without_unit(text):
    for node in public(syntax(text).body):
        named = quantities(node)
        if named and not says_unit(node, text):
            yield node.lineno, f'{node.name}: no [unit] for {named}'


def misspelt_units(text):
    tree = syntax(text)
    for node in (tree, *public(tree.body)):
        for unit in MISSPELT.findall(ast.get_docstring(node) or ''):
            yield getattr(node, 'lineno', 1), unit


def missing_header(text):
    # A line with the interpreter may stand before it.
    if not text.startswith(HEADER) and not text.partition('\n')[2].startswith(HEADER):
        yield 1, 'no copyright and licence'


def paths_of_a_machine(text):
    for number, line in enumerate(text.split('\n'), 1):
        for path in MACHINE.findall(line):
            yield number, path


def texts_of_constants(paths):
    """Return the texts that names in capitals stand for in some files, by their names."""
    return {
        target.id: node.value.value
        for path in paths
        for node in syntax(text_of(path)).body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        for target in node.targets
        if isinstance(target, ast.Name) and isinstance(node.value.value, str)
    }


def sentences_that_are_read(text, constants=types.MappingProxyType({})):
    """Yield where words decide: a code or a number is what logic may read."""
    for node in ast.walk(syntax(text)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            words, read = node.args, node.func.value
            if node.func.attr not in READERS or not words:
                continue
        elif isinstance(node, ast.Compare) and isinstance(node.ops[0], MATCHES):
            words, read = [node.left], node.comparators[0]
        else:
            continue
        texts = [constants.get(getattr(word, 'id', None), '') for word in words]
        texts += [word.value for word in words if isinstance(word, ast.Constant)]
        is_worded = any(isinstance(text, str) and WORDS.search(text) for text in texts)
        is_said = isinstance(node, ast.Call) and getattr(read, 'attr', '') in SAID
        if is_worded or is_said or ast.unparse(read) in ('str(error)', 'str(why)'):
            yield node.lineno, ast.unparse(node)


def functions_of_tests(text):
    return [
        node
        for node in ast.walk(syntax(text))
        if isinstance(node, ast.FunctionDef) and node.name.startswith('test')
    ]


def hidden_tests(text):
    """Yield each test whose name hides another one."""
    first = {}
    for node in functions_of_tests(text):
        if first.setdefault(node.name, node) is not node:
            yield node.lineno, f'{node.name} hides another of its name'


def other_deadlines(text):
    """Every deadline is the same, long enough for a machine that is busy elsewhere."""
    for number, line in enumerate(text.split('\n'), 1):
        deadline = re.match(r'DEADLINE = .*?(?=,|$)', line)
        if deadline and deadline[0] != HANG:
            yield number, deadline[0]
        if FIXED_TIMEOUT.search(line):
            yield number, line.strip()


def test_no_logic_reads_a_sentence():
    """Whoever improves the English must not change what the program does."""
    constants = texts_of_constants(PACKAGES)
    check = functools.partial(sentences_that_are_read, constants=constants)
    report([line for line in offenders(check, PACKAGES) if not line.startswith(SHOWN)])


def test_docstrings_say_units():
    report(offenders(quantities_without_unit, PACKAGES))


def test_units_are_spelt_as_everywhere():
    """One spelling for one unit: N m, rev/min, s, degC, Pa s."""
    report(offenders(misspelt_units, PACKAGES))


def test_sources_carry_copyright_and_licence():
    report(offenders(missing_header, [*SOURCES, TREE / 'setup.py']))


def test_no_file_knows_the_machine_it_was_written_on():
    report(offenders(paths_of_a_machine, TEXTS))


SILENT = 'def carry(load: float) -> None:\n    """Carry it."""\n'
NUT = 'class Nut:\n    lead: float\n\n    def turn(self, end_speed: Array): ...\n'


@pytest.mark.parametrize(
    ('check', 'text', 'lines'),
    [
        (quantities_without_unit, SILENT, [1]),
        (quantities_without_unit, SILENT.replace('it', 'it [N]'), []),
        (quantities_without_unit, NUT, [1, 4]),
        (quantities_without_unit, NUT.replace('float', 'float  # [m]'), [4]),
        (
            misspelt_units,
            f'"""Loads [sec]."""\n{SILENT}'.replace('it.', '[Nm] or [rpm].'),
            [1, 2, 2],
        ),
        (misspelt_units, SILENT.replace('it.', '[N m].'), []),
        (missing_header, '', [1]),
        (missing_header, f'\n\n{HEADER}', [1]),
        (missing_header, HEADER, []),
        (missing_header, f'#!/bin/sh\n{HEADER}', []),
        *((paths_of_a_machine, f'a\nb = "/{home}/me/b"', [2]) for home in HOMES),
        (paths_of_a_machine, '../tmp/a docs/work/b', []),
        (sentences_that_are_read, "if 'not configured: ' in text: ...", [1]),
        (sentences_that_are_read, "event.text.endswith(', by the torque')", [1]),
        (sentences_that_are_read, 'event.advice.startswith(ACKNOWLEDGED)', [1]),
        (sentences_that_are_read, "axis.partition('.')\nif 'x' in names: ...", []),
        (hidden_tests, 'def test_a(): ...\n\n\ndef test_a(): ...', [4]),
        (hidden_tests, 'def test_a(): ...\n\n\ndef a(): ...\n\n\ndef a(): ...', []),
        (other_deadlines, 'DEADLINE = 60.0  # [s]\nrun(\n    timeout=9.0)\n', [1, 3]),
        (other_deadlines, f'task.join(timeout={5.0})', [1]),
        (other_deadlines, f'{HANG}, in this file\ntask.join(timeout=DEADLINE)', []),
    ],
)
def test_each_check_finds_what_offends(check, text, lines):
    assert [line for line, _ in check(text)] == lines


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
                version_in('CITATION.cff', r'^version: (.*)'),
            }
        )
        == 1
    )


def pins():
    """Return the pinned versions by package."""
    lines = (TREE / 'constraints.txt').read_text().splitlines()
    found = [line.partition(' ;')[0] for line in lines if not line.startswith('#')]
    return dict(line.split('==') for line in found)


def test_a_package_that_newer_pythons_hold_is_pinned_below_them():
    pin = runpy.run_path(str(TREE / 'scripts' / 'pin.py'))['pin']
    package = {'name': 'Backports.x', 'version': '1.0', 'requires_python': '<3.14,>=3.10'}
    assert pin(package) == 'backports.x==1.0 ; python_version < "3.14"'
    assert pin(package | {'requires_python': '>=3.9, <4'}) == 'backports.x==1.0'


def test_pins_meet_all_requirements():
    """What setup.py asks for, with all extras, is pinned to a version that it allows."""
    pinned = {canonicalize_name(name): version for name, version in pins().items()}
    for requirement in map(Requirement, requires('ballscrew-monitor') or []):
        version = pinned[canonicalize_name(requirement.name)]
        assert requirement.specifier.contains(version), f'{requirement}: {version} is pinned'


def test_bill_of_materials_is_that_of_the_pins():
    """After a change of either: `python scripts/sbom.py`."""
    bill = runpy.run_path(str(TREE / 'scripts' / 'sbom.py'))['bill']()
    assert json.loads((TREE / 'sbom.cdx.json').read_text()) == bill
    assert {one['name']: one['version'] for one in bill['components']} == pins()


def test_image_installs_what_setup_asks_for():
    asked = re.findall(r"'([\w-]+>=[\d.]+)'", (TREE / 'Dockerfile').read_text())
    known = [Requirement(text) for text in requires('ballscrew-monitor') or []]
    allowed = {f'{one.name}{one.specifier}' for one in known}
    assert asked
    assert set(asked) <= allowed


def test_manifest_names_what_is_imported():
    """Every package that is imported is depended on, and none that is not."""
    manifest = ElementTree.parse(TREE / 'package.xml')
    declared = {element.text for element in manifest.iter('exec_depend')}
    shipped = [*PACKAGES, *TREE.glob('launch/*.py')]
    imported = {
        name.split('.')[0]
        for path in shipped
        for node in ast.walk(syntax(text_of(path)))
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
    text = ''.join(text_of(path) for path in [*shipped, *TREE.glob('config/*.yaml')])
    assert not {name for name in declared - needed if f'{name}/' not in text}


def test_every_file_of_tests_is_collected():
    """All but what makes the golden outputs, and the friction that tests of a ball share."""
    golden = TREE / 'test' / 'golden'
    makers = {golden / 'record.py', *golden.glob('golden/*.py')}
    makers.add(TREE / 'test' / 'surrogate' / 'screw' / 'coulomb.py')
    report(offenders(hidden_tests, TESTS))
    files = [path for path in TESTS if path.name != 'conftest.py' and path not in makers]
    assert not [name_of(path) for path in files if not path.name.startswith('test_')]
    assert not [name_of(path) for path in files if not functions_of_tests(text_of(path))]


def test_every_golden_sentence_is_asked_for():
    """The file of tests that a table is of names each of its keys, in their order."""
    folder = TREE / 'test'
    golden = tomllib.loads((folder / 'data' / 'sentences.toml').read_text(encoding='utf-8'))
    for name, sentences in golden.items():
        nodes = ast.walk(syntax(text_of(folder / name)))
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
    report(offenders(other_deadlines, TESTS))


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
