# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The branch of the interfaces holds their package at its top, a commit for each release."""

import os
from pathlib import Path
import shutil
import subprocess

from catkin_pkg.package import parse_package_string
import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / 'scripts' / 'release_interfaces.sh'
BRANCH = 'interfaces'


@pytest.fixture
def repository(tmp_path):
    """Return what runs git in a repository with the interfaces of this one."""
    names = {'GIT_AUTHOR_NAME': 'a', 'GIT_AUTHOR_EMAIL': 'a@b.c'}
    names |= {name.replace('AUTHOR', 'COMMITTER'): value for name, value in names.items()}
    environment = {'PATH': os.environ['PATH'], 'HOME': str(tmp_path), **names}

    def run(*command, code=0):
        done = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout.strip() or done.stderr.strip()

    run('git', 'init', '-q')
    shutil.copytree(ROOT / 'msg_defs', tmp_path / 'msg_defs')
    (tmp_path / 'setup.py').touch()
    commit(run)
    return tmp_path, run


def commit(run):
    run('git', 'add', '.')
    run('git', 'commit', '-q', '-m', 'a change')


def test_a_release_is_the_package_at_the_top_of_its_branch(repository):
    folder, run = repository
    run('sh', SCRIPT)
    manifest = folder / 'msg_defs' / 'package.xml'
    package = parse_package_string(run('git', 'show', f'{BRANCH}:package.xml'))
    assert package.name == 'ballscrew_msgs'
    assert run('git', 'rev-parse', f'{BRANCH}^{{tree}}') == run(
        'git', 'rev-parse', 'HEAD:msg_defs'
    )
    first = run('git', 'rev-parse', BRANCH)
    assert run('git', 'rev-parse', f'interfaces/{package.version}^{{commit}}') == first

    newer = manifest.read_text().replace(f'<version>{package.version}<', '<version>9.8.7<')
    manifest.write_text(newer)
    commit(run)
    run('sh', SCRIPT)
    assert run('git', 'rev-parse', f'{BRANCH}~1') == first
    assert run('git', 'rev-parse', 'interfaces/9.8.7^{commit}') == run('git', 'rev-parse', BRANCH)
    assert run('git', 'status', '--porcelain') == ''


def test_no_release_is_made_twice_or_of_what_is_not_committed(repository, says):
    folder, run = repository
    (folder / 'msg_defs' / 'package.xml').write_text('<package/>')
    assert run('sh', SCRIPT, code=2) == says('not_committed')
    run('git', 'checkout', '-q', 'msg_defs')
    run('sh', SCRIPT)
    before = run('git', 'rev-parse', BRANCH)
    assert run('sh', SCRIPT, code=2) == says('released', version='0.1.0')
    assert run('git', 'rev-parse', BRANCH) == before
