# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Imports downward, as sources say and as a fresh process does it; `surrogate` never ROS."""

import ast
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
NUMERICAL = set('distributed matplotlib numba numpy scipy SurfaceTopography xarray yaml'.split())
PLOTTING = {'surrogate.plotting.style'}  # for the picture of a page alone
TASKS = {'surrogate.tasks.pool', 'surrogate.tasks.worker', 'surrogate.tasks.workers'}
LOOKUP = {
    'surrogate',
    'surrogate.files',
    'surrogate.limits',
    'surrogate.plain_yaml',
    'surrogate.surface',
    'surrogate.surface.compiled',
    'surrogate.surface.records',
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
    ('units', 'files', 'progress'),
    ('limits',),
    ('plain_yaml',),
    ('datasheet', 'plotting'),
    ('raceway',),
    ('parameters', 'surface'),
    ('datasheet_writer', 'formulas', 'tasks'),
    ('ehl',),
    ('asperities',),
    ('catalogue', 'contact', 'screw'),
    ('builder',),
    ('surface_tools', 'identify', 'paper', 'on_demand', 'validation'),
    ('commands',),
    ('cli',),
)
"""Folders and single modules of the offline half, the lowest first."""
STANDS_ON = {
    'surface': {
        'surrogate.files',
        'surrogate.formulas.torque',
        'surrogate.limits',
        'surrogate.units',
    },
    'tasks': {'surrogate.files', 'surrogate.progress', 'surrogate.surface.file'},
}
"""Folders that import these modules alone: what the node loads, and what knows no physics."""


def name_of(path):
    """Return the dotted name of a module."""
    parts = path.relative_to(TREE).with_suffix('').parts
    return '.'.join(part for part in parts if part != '__init__')


def room(name):
    """Return the folder or single module of a half that holds a module."""
    return f'{name}.'.split('.')[1]


def imports(path):
    """Yield every absolute import of a module, wherever it stands."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, f'{path.name} imports relatively'
            # A name may be a module: `from surrogate import surface`.
            assert node.module
            deeper = [f'{node.module}.{alias.name}' for alias in node.names]
            known = [name for name in deeper if (TREE / f'{name.replace(".", "/")}.py').exists()]
            yield from known or [node.module]


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


@pytest.mark.parametrize('path', MODULES['surrogate'], ids=name_of)
def test_surrogate_imports_numerical_libraries_and_itself(path):
    """No ROS, nothing of the online half."""
    allowed = NUMERICAL | {'surrogate'} | set(sys.stdlib_module_names)
    assert {name.split('.')[0] for name in imports(path)} <= allowed


@pytest.mark.parametrize('path', MODULES['ballscrew_monitor'], ids=name_of)
def test_online_half_imports_the_lookup_alone(path):
    """Only the command line, which is both halves, hands over to the offline one."""
    more = {
        'cli.py': {'surrogate.cli', 'surrogate.parameters'},
        'options.py': {'surrogate.cli'},
        # The bar of both halves, text alone.
        'cycle': {'surrogate.progress'},
        # Plain arithmetic of published laws.
        'health': {'surrogate.formulas.grades', 'surrogate.formulas.life'},
        'recordings': {'surrogate.progress'},
        # The page over many recordings, on the workers of the sweeps, and the style of pictures.
        'report': {'surrogate.progress'} | PLOTTING | TASKS,
    }
    allowed = LOOKUP | more.get(path.name, set()) | more.get(path.parent.name, set())
    assert {name for name in imports(path) if name.split('.')[0] == 'surrogate'} <= allowed


@pytest.mark.parametrize('path', MODULES['ballscrew_monitor'], ids=name_of)
def test_online_half_imports_downward(path):
    """A folder imports itself and the floors below it; no folder imports the command line."""
    own = room(name_of(path))
    floor = next((at for at, rooms in enumerate(FLOORS) if own in rooms), len(FLOORS))
    above = {other for rooms in FLOORS[floor:] for other in rooms if other != own}
    named = {room(name) for name in imports(path) if name.startswith('ballscrew_monitor.')}
    # The command line is for the executable alone, and its options for the command line.
    upper = {'__main__.py': set(), 'cli.py': {'cli'}}.get(path.name, {'cli', 'options'})
    assert not named & {*above, *upper}


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


@pytest.mark.parametrize('path', MODULES['surrogate'], ids=name_of)
def test_offline_half_imports_downward(path):
    """A folder imports itself and the floors below it; two import a few modules alone."""
    own = room(name_of(path))
    named = {name for name in imports(path) if name.startswith('surrogate.')}
    others = {name for name in named if room(name) != own}
    if own in STANDS_ON:
        assert others <= STANDS_ON[own]
        return
    floor = next((at for at, rooms in enumerate(OFFLINE_FLOORS) if own in rooms), 0)
    below = {room for rooms in OFFLINE_FLOORS[:floor] for room in rooms}
    assert {room(name) for name in others} <= below


def test_surrogate_loads_no_ros():
    """As seen by a process that imports all of it."""
    loaded = loaded_by(f'import {", ".join(map(name_of, MODULES["surrogate"]))}')
    assert not [name for name in loaded if name == 'rclpy' or name.split('.')[0].endswith('_msgs')]
    assert 'ballscrew_monitor' not in loaded


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
    needed = loaded_by(f'import surrogate.plain_yaml, surrogate.surface, {laws}')
    loaded = loaded_by('import ballscrew_monitor.node.run')
    assert not {name for name in loaded - needed if name.split('.')[0] == 'surrogate'}
    assert not loaded & {'matplotlib', 'mcap', 'scipy'}
