# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The contact command as a user types it."""

import argparse
from dataclasses import replace
import json
import sys

import pytest
from surrogate.cli import add_commands
from surrogate.ehl import solve_contact, Status
from surrogate.files import InputError
from surrogate.parameters import DATA

SMOOTH = (DATA / 'cases' / 'nominal_smooth.yaml').read_text(encoding='utf-8')


def run(*words):
    """Run one command line and return its exit code."""
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers(required=True))
    args = parser.parse_args([str(word) for word in words])
    return args.handler(args)


@pytest.fixture
def small(tmp_path):
    """Return the path of the nominal smooth case on a small grid."""
    path = tmp_path / 'small.yaml'
    path.write_text(SMOOTH + 'grid: [65, 33]\n', encoding='utf-8')
    return path


def test_contact_as_json(capsys, small):
    """Strict JSON, exit code 0."""
    assert run('contact', small, '--json') == 0
    found = json.loads(capsys.readouterr().out)
    assert found['converged'] is True
    assert found['central_film_m'] == pytest.approx(150e-9, rel=0.05)


def test_contact_as_a_page(capsys, small):
    """Central film and status."""
    assert run('contact', small) == 0
    out = capsys.readouterr().out
    assert 'central film' in out
    assert 'status: Converged' in out


def test_a_shipped_case_by_name(capsys):
    """The name of a shipped case is enough."""
    assert run('contact', 'nominal_smooth', '--json') == 0
    assert json.loads(capsys.readouterr().out)['grid'] == [257, 65]


def test_a_result_that_is_not_converged_exits_with_1(capsys, small, monkeypatch):
    """Whatever the reason, the status is a sentence and the exit code says it too."""

    def stalled(*arguments, **options):
        return replace(solve_contact(*arguments, **options), status=Status.STALLED)

    monkeypatch.setattr('surrogate.contact.solve.solve_contact', stalled)
    assert run('contact', small, '--json') == 1
    found = json.loads(capsys.readouterr().out)
    assert found['converged'] is False
    assert found['status'] == Status.STALLED.value


def test_pictures(small, tmp_path):
    """--plot writes the pictures and leaves nothing half-written."""
    pytest.importorskip('matplotlib')
    folder = tmp_path / 'deep' / 'plots'
    assert run('contact', small, '--plot', folder) == 0
    assert sorted(path.name for path in folder.iterdir()) == [
        'contact_3d.png',
        'contact_maps.png',
        'contact_profiles.png',
    ]


def test_pictures_that_cannot_be_made(small, tmp_path, monkeypatch):
    """No directory, no matplotlib: one sentence."""
    with pytest.raises(InputError, match='--plot: .*small.yaml cannot be written'):
        run('contact', small, '--plot', small)
    monkeypatch.setitem(sys.modules, 'surrogate.contact.figures', None)
    with pytest.raises(InputError, match='--plot needs matplotlib: install the extra `plot`'):
        run('contact', small, '--plot', tmp_path / 'plots')
