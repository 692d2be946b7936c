# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Imports downward, as sources say and as a fresh process does it; `surrogate` never ROS."""

import ast
from functools import cache
from pathlib import Path
import subprocess
import sys

import pytest

TREE = Path(__file__).resolve().parent.parent
DEADLINE = 600.0  # [s] which only ends a hang
MODULES = {
    package: sorted((TREE / package).rglob('*.py'))
    for package in ('surrogate', 'ballscrew_monitor')
}
# What the offline half stands on, and where it is forbidden to be heavy.
NUMERICAL = set('distributed matplotlib numba numpy scipy SurfaceTopography yaml'.split())
PLOTTING = {'surrogate.plotting.style'}  # for the picture of a page alone
TASKS = {'surrogate.tasks.pool', 'surrogate.tasks.workers', 'surrogate.tasks.worker'}
LOOKUP = {
    'surrogate',
    'surrogate.files',
    'surrogate.files.limits',
    'surrogate.files.plain_yaml',
    'surrogate.files.store',
    'surrogate.surface',
    'surrogate.surface.compiled',
    'surrogate.surface.records',
    'surrogate.tasks.child',
    'surrogate.units',
}

FLOORS = (
    ('core',),
    ('judge',),
    ('health',),
    ('settings', 'messages'),
    ('recordings',),
    ('node', 'report'),
    ('clients', 'cycle'),
    ('page',),
)
"""Folders of the online half, the lowest first; those beside each other do not meet."""
OFFLINE_FLOORS = (
    ('compiler', 'units', 'files', 'results'),
    ('plotting',),
    ('raceway',),
    ('parameters', 'surface'),
    ('datasheet_writer', 'formulas', 'tasks'),
    ('ehl',),
    ('asperities',),
    ('catalogue', 'contact', 'screw'),
    ('builder',),
    ('surface_tools', 'identify', 'studies'),
    ('commands',),
)
"""Folders and single modules of the offline half, the lowest first."""
STANDS_ON = {
    'surface': {
        'surrogate.compiler',
        'surrogate.files',
        'surrogate.formulas.torque',
        'surrogate.files.limits',
        'surrogate.results',
        'surrogate.units',
    },
    'tasks': {'surrogate.files', 'surrogate.files.store', 'surrogate.surface.file'},
}
"""Folders that import these modules alone: what the node loads, and what knows no physics."""


def name_of(path):
    """Return the dotted name of a module."""
    parts = path.relative_to(TREE).with_suffix('').parts
    return '.'.join(part for part in parts if part != '__init__')


def room(name):
    """Return the folder or single module of a half that holds a module."""
    return f'{name}.'.split('.')[1]


def imported_by(text):
    """Return line and module of every absolute import of a source, wherever it stands."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            # A name may be a module: `from surrogate import surface`.
            deeper = [f'{node.module}.{alias.name}' for alias in node.names]
            known = [name for name in deeper if (TREE / f'{name.replace(".", "/")}.py').exists()]
            names = known or [node.module or '']
            found += [(node.lineno, '.' * node.level + name) for name in names]
    return found


@cache
def imports(path):
    return imported_by(path.read_text(encoding='utf-8'))


def offenders(check, half):
    """Return `file:line: module` of the imports of a half that a check of a module refuses."""
    return [
        f'{path.relative_to(TREE)}:{line}: {name}'
        for path in MODULES[half]
        for line, name in check(path, imports(path))
    ]


def report(lines):
    """Hold that there is no offender; the failure has each on a line of its own."""
    assert not lines, '\n'.join(lines)


def loaded_by(statement):
    """Return the names of the modules that a fresh process holds after a statement."""
    done = subprocess.run(
        [sys.executable, '-c', f'{statement}; import sys; print(*sys.modules)'],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
        timeout=DEADLINE,
    )
    return set(done.stdout.split())


def beyond_the_numerical_libraries(path, named):
    """No ROS, nothing of the online half."""
    allowed = NUMERICAL | {'surrogate'} | set(sys.stdlib_module_names)
    return [(line, name) for line, name in named if name.split('.')[0] not in allowed]


def beyond_the_lookup(path, named):
    """Only the command line, which is both halves, hands over to the offline one."""
    more = {
        'cli.py': {'surrogate.commands.cli', 'surrogate.parameters'},
        'options.py': {'surrogate.commands.cli'},
        # The bar of both halves, text alone.
        'cycle': {'surrogate.tasks.progress'},
        # Plain arithmetic of published laws.
        'health': {'surrogate.formulas.grades', 'surrogate.formulas.life'},
        'recordings': {'surrogate.tasks.progress'},
        # The page over many recordings, on the workers of the sweeps, and the style of pictures.
        'report': {'surrogate.tasks.progress'} | PLOTTING | TASKS,
        # One command goes from logs by way of sheets and surfaces to a page.
        'check.py': {
            'surrogate.builder.tiers',
            'surrogate.files.datasheet',
            'surrogate.parameters',
            'surrogate.surface.file',
        },
        'free_run.py': {
            'surrogate.datasheet_writer',
            'surrogate.identify.data',
            'surrogate.identify.fit',
            'surrogate.identify.model',
            'surrogate.identify.record',
            'surrogate.parameters',
        },
    }
    allowed = LOOKUP | more.get(path.name, set()) | more.get(path.parent.name, set())
    offline = [(line, name) for line, name in named if name.split('.')[0] == 'surrogate']
    return [(line, name) for line, name in offline if name not in allowed]


def upward(path, named):
    # A folder imports itself and the floors below it; no folder imports the command line.
    own = room(name_of(path))
    floor = next((at for at, rooms in enumerate(FLOORS) if own in rooms), len(FLOORS))
    above = {other for rooms in FLOORS[floor:] for other in rooms if other != own}
    # The command line is for the executable alone, and its options for the command line.
    upper = {'__main__.py': set(), 'cli.py': {'cli'}}.get(path.name, {'cli', 'options'})
    online = [(line, name) for line, name in named if name.startswith('ballscrew_monitor.')]
    return [(line, name) for line, name in online if room(name) in {*above, *upper}]


def upward_offline(path, named):
    # A folder imports itself and the floors below it; two import a few modules alone.
    own = room(name_of(path))
    offline = [(line, name) for line, name in named if name.startswith('surrogate.')]
    others = [(line, name) for line, name in offline if room(name) != own]
    if own in STANDS_ON:
        return [(line, name) for line, name in others if name not in STANDS_ON[own]]
    floor = next((at for at, rooms in enumerate(OFFLINE_FLOORS) if own in rooms), 0)
    below = {room for rooms in OFFLINE_FLOORS[:floor] for room in rooms}
    return [(line, name) for line, name in others if room(name) not in below]


def in_circles(imported):
    """Return the modules that import themselves, of a graph `{module: its imports}`."""
    circular = []
    for module in imported:
        reached, waiting = set(), list(imported[module])
        while waiting:
            name = waiting.pop()
            if name not in reached:
                reached.add(name)
                waiting += imported.get(name, ())
        circular += [module] if module in reached else []
    return circular


def relative(path, named):
    return [(line, name) for line, name in named if name.startswith('.')]


def test_surrogate_imports_numerical_libraries_and_itself():
    report(offenders(beyond_the_numerical_libraries, 'surrogate'))


def test_online_half_imports_the_lookup_alone():
    report(offenders(beyond_the_lookup, 'ballscrew_monitor'))


def test_online_half_imports_downward():
    report(offenders(upward, 'ballscrew_monitor'))


def test_offline_half_imports_downward():
    report(offenders(upward_offline, 'surrogate'))


@pytest.mark.parametrize('half', MODULES)
def test_no_module_imports_itself_by_way_of_others(half):
    """An import for types alone counts too: who reads one of the files needs the other."""
    paths = MODULES[half]
    report(in_circles({name_of(path): {name for _, name in imports(path)} for path in paths}))


def test_an_import_for_types_alone_closes_a_circle():
    sources = {
        'a': 'import b',
        'b': 'from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import c',
        'c': 'def f():\n    import a',
        'd': 'import a',
    }
    imported = {name: {other for _, other in imported_by(text)} for name, text in sources.items()}
    assert in_circles(imported) == ['a', 'b', 'c']


def test_no_import_is_relative():
    report(offenders(relative, 'surrogate') + offenders(relative, 'ballscrew_monitor'))


@pytest.mark.parametrize(
    ('check', 'module', 'text', 'lines'),
    [
        (beyond_the_numerical_libraries, 'surrogate/commands/cli.py', 'import rclpy', [1]),
        (
            beyond_the_numerical_libraries,
            'surrogate/ehl/case.py',
            'import os\ndef f():\n    from ballscrew_monitor import cli',
            [3],
        ),
        (
            beyond_the_numerical_libraries,
            'surrogate/commands/cli.py',
            'from surrogate import files',
            [],
        ),
        (beyond_the_lookup, 'ballscrew_monitor/core/a.py', 'import surrogate.ehl.case', [1]),
        (beyond_the_lookup, 'ballscrew_monitor/cli.py', 'import surrogate.commands.cli', []),
        (
            beyond_the_lookup,
            'ballscrew_monitor/node/a.py',
            'from surrogate import units\nfrom surrogate.tasks import progress',
            [2],
        ),
        (beyond_the_lookup, 'ballscrew_monitor/cycle/a.py', 'import surrogate.tasks.progress', []),
        (upward, 'ballscrew_monitor/core/a.py', 'import ballscrew_monitor.judge.step', [1]),
        (upward, 'ballscrew_monitor/judge/a.py', 'import ballscrew_monitor.core.state', []),
        (upward, 'ballscrew_monitor/node/a.py', 'import ballscrew_monitor.report.page', [1]),
        (upward, 'ballscrew_monitor/page/a.py', 'from ballscrew_monitor import cli', [1]),
        (upward, 'ballscrew_monitor/__main__.py', 'from ballscrew_monitor import cli', []),
        (upward, 'ballscrew_monitor/cli.py', 'from ballscrew_monitor import options', []),
        (upward_offline, 'surrogate/ehl/a.py', 'import surrogate.screw.solve', [1]),
        (upward_offline, 'surrogate/screw/a.py', 'import surrogate.ehl.solver', []),
        (upward_offline, 'surrogate/surface/a.py', 'import surrogate.raceway.fractal', [1]),
        (upward_offline, 'surrogate/surface/a.py', 'import surrogate.formulas.torque', []),
        (
            relative,
            'surrogate/ehl/a.py',
            'import os\nfrom . import case\nfrom ..a import b',
            [2, 3],
        ),
    ],
)
def test_each_check_finds_what_offends(check, module, text, lines):
    assert [line for line, _ in check(TREE / module, imported_by(text))] == lines


@pytest.mark.parametrize(
    ('half', 'floors'),
    [
        ('surrogate', OFFLINE_FLOORS),
        ('ballscrew_monitor', (*FLOORS, ('cli', 'options', '__main__'))),
    ],
)
def test_every_room_has_a_floor(half, floors):
    """No folder and no single module is forgotten, and none is named that is gone."""
    rooms = {room(name_of(path)) for path in MODULES[half]} - {''}
    assert rooms == {one for floor in floors for one in floor}


def test_surrogate_loads_no_ros():
    """As seen by a process that imports all of it."""
    loaded = loaded_by(f'import {", ".join(map(name_of, MODULES["surrogate"]))}')
    assert not [name for name in loaded if name == 'rclpy' or name.split('.')[0].endswith('_msgs')]
    assert 'ballscrew_monitor' not in loaded


def test_judgement_health_and_store_load_no_messages():
    """Messages are a form that others read: nothing that decides or keeps is made of them."""
    rooms = ('core', 'judge', 'health')
    paths = [path for path in MODULES['ballscrew_monitor'] if room(name_of(path)) in rooms]
    modules = [*map(name_of, paths), 'ballscrew_monitor.node.solver', 'surrogate.files.store']
    loaded = loaded_by(f'import {", ".join(modules)}')
    assert not [name for name in loaded if name.split('.')[0].endswith('_msgs')]


@pytest.mark.parametrize(
    ('module', 'heavy'),
    [
        ('surrogate.surface', {'matplotlib', 'numba', 'rclpy', 'scipy', 'yaml'}),
        ('surrogate.builder.tiers', {'distributed', 'numba', 'scipy'}),
        ('ballscrew_monitor.report.command', {'contourpy', 'polars', 'scipy'}),
    ],
)
def test_what_must_start_quickly_loads_nothing_heavy(module, heavy):
    """The lookup in any process, a point by formulas, the table of tiers, a printed replay."""
    loaded = loaded_by(f'import {module}')
    assert module in loaded
    assert not loaded & heavy


def test_node_loads_of_surrogate_what_the_lookup_needs():
    """The process that watches the machine holds nothing of the solver, plots or recordings."""
    laws = 'surrogate.formulas.grades, surrogate.formulas.life'
    rooms = ('files.plain_yaml', 'files.store', 'surface', 'tasks.child')
    offline = ', '.join(f'surrogate.{room}' for room in rooms)
    needed = loaded_by(f'import {offline}, {laws}')
    loaded = loaded_by('import ballscrew_monitor.node.run')
    assert not {name for name in loaded - needed if name.split('.')[0] == 'surrogate'}
    assert not loaded & {'matplotlib', 'mcap', 'scipy'}
