# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A workspace of colcon, made as the guide says, and the node from its install space."""

import os
from pathlib import Path
import re
import shlex
import shutil
import signal
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment
import pytest

ROOT = Path(__file__).resolve().parents[2]
GUIDE = ROOT / 'docs' / 'guide' / 'start.md'
SECTION = '## 6. On a stock ROS 2 machine'
PATH = os.pathsep.join([str(Path(sys.executable).parent), os.environ['PATH']])
COLCON = shutil.which('colcon', path=PATH)
DEADLINE = 600.0  # [s] which only ends a hang
BOTH = ['ballscrew_msgs', 'ballscrew_monitor']
LIST = 'colcon list --topological-order --names-only'
# What rosdep has a key of, and Ubuntu 24.04 a package; numba has a key and no package.
UBUNTU = {f'python3-{name}' for name in 'hypothesis matplotlib numpy pytest scipy yaml'.split()}
UBUNTU |= {'python3-pytest-timeout'}
STAND_INS = """
source() { :; }
sudo() { :; }
rosdep() { :; }
git() { cp -r "$TRACKED" "$3"; }
"""
BLIND = """
from importlib.machinery import PathFinder
import sys


class Blind(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if name.split('.')[0] not in {hidden}:
            return PathFinder.find_spec(name, path, target)


sys.meta_path[sys.meta_path.index(PathFinder)] = Blind
"""
# What the guide has pip install.
HIDDEN = 'numba mcap zstandard polars fastexcel rosbags starlette uvicorn websockets'.split()

needs_colcon = pytest.mark.skipif(
    COLCON is None, reason='colcon is neither in the environment nor on the PATH'
)


@pytest.fixture(scope='module')
def tracked(tmp_path_factory):
    """Return a folder with the files of the repository alone, as a clone has them."""
    listed = subprocess.run(
        ['git', 'ls-files', '-z'], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode:
        pytest.skip('not a git work tree')
    folder = tmp_path_factory.mktemp('tracked') / 'clone'
    for name in filter(None, listed.stdout.split('\0')):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    return folder


def bash(script, folder, **environment):
    """Return what a script prints."""
    home = {'PATH': PATH, 'COLCON_HOME': str(folder)}
    done = subprocess.run(
        ['bash', '-ec', script],
        cwd=folder,
        env=child_environment(0) | home | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=DEADLINE,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def steps_of_the_guide():
    """Return the commands that make a workspace, in which `colcon build` only lists."""
    text = GUIDE.read_text(encoding='utf-8').partition(SECTION)[2]
    block = re.search(r'((?:^    .*\n)+)', text, re.MULTILINE)[0]
    assert block.endswith('    colcon build\n')
    return block.replace('<this repository>', 'here').replace('colcon build', LIST)


@pytest.fixture
def workspace(tracked, tmp_path):
    """Return a workspace, and what colcon lists there."""
    listed = bash(STAND_INS + steps_of_the_guide(), tmp_path, TRACKED=str(tracked))
    return tmp_path / 'ws', listed.split()


@needs_colcon
def test_the_guide_makes_a_workspace_of_both_packages(workspace):
    """The interfaces come first: the node depends on them."""
    folder, listed = workspace
    assert listed == BOTH
    (folder / 'src' / 'ballscrew_msgs').unlink()
    assert bash(LIST, folder).split() == BOTH[1:]


@needs_colcon
def test_the_repository_alone_is_a_workspace_of_both_packages(tracked):
    assert bash(LIST, tracked).split() == BOTH


@needs_colcon
def test_the_node_runs_from_the_install_space_with_what_rosdep_brings(workspace, wait_for):
    """The interfaces are those of the environment, as compiling them would take a minute."""
    folder, _ = workspace
    bash('colcon build --base-paths src/ballscrew_monitor', folder)
    (folder / 'blind').mkdir()
    (folder / 'blind' / 'sitecustomize.py').write_text(BLIND.format(hidden=HIDDEN))
    setup = f'export PYTHONPATH={shlex.quote(str(folder / "blind"))}; . install/setup.sh'
    python = f'{setup}; {shlex.quote(sys.executable)} -c'
    script = 'import ballscrew_monitor as package; print(package.__file__)'
    place = bash(f'{python} "{script}"', folder).strip()
    assert Path(place).is_relative_to(folder / 'install')
    script = "from importlib.util import find_spec; print(find_spec('numba'))"
    assert bash(f'{python} "{script}"', folder) == 'None\n'
    program = 'install/ballscrew_monitor/lib/ballscrew_monitor/ballscrew_monitor'
    log = folder / 'node.log'
    with free_domain() as domain, log.open('w') as output:
        environment = child_environment(domain)
        environment |= {'XDG_STATE_HOME': str(folder), 'ROS_LOG_DIR': str(folder / 'ros')}
        with subprocess.Popen(
            ['sh', '-c', f'{setup}; exec {program}'],
            cwd=folder,
            env=environment,
            stdout=output,
            stderr=output,
        ) as node:
            wait_for(
                lambda: node.poll() is not None or 'axis x reads load' in log.read_text(),
                'the axis of the node',
            )
            node.send_signal(signal.SIGINT)
            assert node.wait(DEADLINE) == 0, log.read_text()
    assert 'is judged by the full surface' in log.read_text()


def test_rosdep_is_asked_for_what_ubuntu_has():
    manifest = ElementTree.parse(ROOT / 'package.xml').getroot()
    keys = {str(element.text) for element in manifest if element.tag.endswith('depend')}
    assert {key for key in keys if key.startswith('python3-')} <= UBUNTU
