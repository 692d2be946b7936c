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
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.msg import OperatingPoint
from ballscrew_msgs.srv import EvaluateOperatingPoint
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
GUIDE = ROOT / 'docs' / 'guide' / 'start.md'
SECTION = '## 6. On a stock ROS 2 machine'
PATH = os.pathsep.join([str(Path(sys.executable).parent), os.environ['PATH']])
COLCON = shutil.which('colcon', path=PATH)
DEADLINE = 600.0  # [s] which only ends a hang
BOTH = ['ballscrew_msgs', 'ballscrew_monitor']
LIST = 'colcon list --topological-order --names-only'
ROSDEP = yaml.safe_load((ROOT / 'test' / 'reference' / 'rosdep.yaml').read_text())
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


def installed_by_pip():
    """Return the modules that the guide has pip install into a venv."""
    lines = re.findall(r'venv/bin/pip install (.*)', GUIDE.read_text(encoding='utf-8'))
    names = [name for line in lines for name in shlex.split(line)]
    return [re.split('[<>=]', name)[0].replace('-', '_') for name in names]


def ask(domain, wait_for, node):
    """Return what a running node answers about a point."""
    with started_node('caller', domain) as caller:

        def spin():
            assert node.poll() is None
            caller.executor.spin_once(timeout_sec=0.02)

        client = caller.create_client(EvaluateOperatingPoint, '/ballscrew_monitor/evaluate')
        wait_for(client.service_is_ready, 'the service', meanwhile=spin)
        point = OperatingPoint(speed=60.0, axial_load=1000.0, temperature=40.0)
        future = client.call_async(EvaluateOperatingPoint.Request(axis='x', points=[point]))
        wait_for(future.done, 'the answer', meanwhile=spin)
        return future.result()


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
    """
    The interfaces are those of the environment, as compiling them would take a minute.

    `setup.bash`, which colcon makes beside it where it knows bash, sources `setup.sh`.

    """
    folder, _ = workspace
    bash('colcon build --base-paths src/ballscrew_monitor', folder)
    (folder / 'blind').mkdir()
    (folder / 'blind' / 'sitecustomize.py').write_text(BLIND.format(hidden=installed_by_pip()))
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
            assert ask(domain, wait_for, node).success
            node.send_signal(signal.SIGINT)
            assert node.wait(DEADLINE) == 0, log.read_text()
    assert 'is judged by the full surface' in log.read_text()


def keys():
    """Return the keys that rosdep is asked for; the workspace itself has the others."""
    manifests = [ElementTree.parse(ROOT / folder / 'package.xml') for folder in ('', 'msg_defs')]
    asked = {
        str(element.text)
        for manifest in manifests
        for element in manifest.getroot()
        if element.tag.endswith('depend')
    }
    return asked - set(BOTH)


def test_rosdep_knows_every_key():
    """Of Python packages Ubuntu 24.04 lacks numba, for which rosdep has a rule all the same."""
    assert keys() == {*ROSDEP['rules'], *ROSDEP['released']}


@pytest.mark.parametrize('distribution', ROSDEP['platforms'])
def test_rosdep_resolves_every_key_to_a_package_of_ubuntu(distribution):
    lookup = pytest.importorskip('rosdep2.lookup', reason='rosdep is not installed')
    debian = pytest.importorskip('rosdep2.platforms.debian')
    rules = ROSDEP['rules'] | {
        name: {'ubuntu': [f'ros-{distribution}-{name.replace("_", "-")}']}
        for name in ROSDEP['released']
    }
    platform, installer = ('ubuntu', ROSDEP['platforms'][distribution]), debian.AptInstaller()
    for key in keys():
        definition = lookup.RosdepDefinition(key, rules[key])
        kind, rule = definition.get_rule_for_platform(*platform, ['apt', 'pip'], 'apt')
        assert (kind, len(installer.resolve(rule))) == ('apt', 1), key
