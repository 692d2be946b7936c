# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The browser for the tests, on machines played by a folder of commands: never an error."""

from pathlib import Path
import shutil
import subprocess

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / 'scripts' / 'browser.sh'
DEADLINE = 600.0  # [s] which only ends a hang
ROOT, USER = 'echo 0', 'echo 1000'
NOTES = 'echo "$@" >> asked'


@pytest.fixture
def machine(tmp_path):
    """Return a function that runs the script where there are just these commands; what it says."""
    folder = tmp_path / 'bin'
    folder.mkdir()
    for name in ('mkdir', 'sh'):
        (folder / name).symlink_to(shutil.which(name))

    def run(**commands):
        for name, text in commands.items():
            path = folder / name.replace('_', '-')
            path.write_text(f'#!/bin/sh\n{text}\n')
            path.chmod(0o755)
        done = subprocess.run(
            [folder / 'sh', SCRIPT],
            env={'PATH': str(folder)},
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=True,
            timeout=DEADLINE,
        )
        assert done.stdout == ''
        return done.stderr

    return run


@pytest.mark.parametrize('name', ['chromium', 'chromium_browser', 'google_chrome'])
def test_a_browser_that_is_there_is_enough(machine, tmp_path, name):
    assert machine(id=ROOT, apt_get=NOTES, **{name: 'true'}) == ''
    assert not (tmp_path / 'asked').exists()


def test_root_gets_it(machine, tmp_path, says):
    said = machine(id=ROOT, apt_get=NOTES)
    assert said == says('set_up_installing')
    expected = ['update', 'install -y --no-install-recommends chromium']
    assert (tmp_path / 'asked').read_text().splitlines() == expected


@pytest.mark.parametrize(
    ('commands', 'end'),
    [
        ({'id': ROOT}, 'install_chromium'),
        ({'id': USER, 'apt_get': NOTES}, 'sudo_apt_get'),
        ({'id': ROOT, 'apt_get': 'exit 100'}, 'could_install_chromium'),
    ],
)
def test_without_it_one_sentence_says_so(machine, tmp_path, commands, end, says):
    said = machine(**commands).splitlines()
    assert said[-1].startswith(says('set_up_page'))
    assert said[-1].endswith(says(end))
    assert not (tmp_path / 'asked').exists()
