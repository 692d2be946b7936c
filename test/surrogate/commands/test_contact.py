# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The contact command as a user types it."""

from dataclasses import replace
import json

from ballscrew_monitor.cli import INTERRUPTED, main
import pytest
from surrogate.contact.rolling import march_case
from surrogate.ehl import solve_contact, Status
from surrogate.ehl.moving import MarchStatus
from surrogate.parameters import DATA

COMMAND = ('contact',)

SMOOTH = (DATA / 'cases' / 'nominal_smooth.yaml').read_text(encoding='utf-8')


@pytest.fixture
def small(tmp_path):
    path = tmp_path / 'small.yaml'
    path.write_text(SMOOTH + 'grid: [65, 33]\n', encoding='utf-8')
    return path


def test_contact_as_json_of_a_path_or_a_shipped_name(run, capsys, small):
    """Strict JSON, exit code 0; central film and status on the page."""
    assert run(small, '--json') == 0
    found = json.loads(capsys.readouterr().out)
    assert found['converged'] is True
    assert found['central_film_m'] == pytest.approx(150e-9, rel=0.05)
    assert run(small) == 0
    out = capsys.readouterr().out
    assert 'central film' in out
    assert 'status: Converged' in out
    assert run('nominal_smooth', '--json') == 0
    assert json.loads(capsys.readouterr().out)['grid'] == [257, 65]


def test_a_result_that_is_not_converged_exits_with_1(run, capsys, small, monkeypatch):
    """Whatever the reason, the status is a sentence and the exit code says it too."""

    def stalled(*arguments, **options):
        return replace(solve_contact(*arguments, **options), status=Status.STALLED)

    monkeypatch.setattr('surrogate.contact.solve.solve_contact', stalled)
    assert run(small, '--json') == 1
    found = json.loads(capsys.readouterr().out)
    assert found['converged'] is False
    assert found['status'] == Status.STALLED.value


ROLLING = """
radius_x_mm: 10.0
radius_y_mm: 10.0
reduced_modulus_GPa: 226.4
load_N: 3.66445
entrainment_speed_m_s: 0.1
viscosity_Pa_s: 0.040
pressure_viscosity_1_GPa: 22.0
kinematics: rolling
transits: 2
places: 2
grid: [65, 33]
roughness:
  patch: standard
  rms_um: 0.1
  fractal_dimension: 2.3
  shortest_wavelength_um: 20
"""


@pytest.fixture
def rolling(tmp_path):
    """Return the path of a small case whose roughness rolls."""
    path = tmp_path / 'rolling.yaml'
    path.write_text(ROLLING, encoding='utf-8')
    return path


def test_a_rolling_contact(run, capsys, rolling, tmp_path):
    """JSON on one stream, progress and the path of the picture on the other, exit code 0."""
    pytest.importorskip('matplotlib')
    folder = tmp_path / 'plots'
    assert run(rolling, '--json', '--plot', folder) == 0
    out, err = capsys.readouterr()
    found = json.loads(out)
    assert found['kinematics'] == 'rolling'
    assert found['converged'] is True
    assert 'by the table' in found['roughness']['sentence']
    assert f'{found["steps"]}/{found["steps"]} steps' in err
    assert [path.name for path in folder.iterdir()] == ['rolling_contact.png']


def test_a_march_that_stalls_exits_with_1(run, capsys, rolling, monkeypatch):
    """The page says why."""

    def stalled(case):
        solution, surface = march_case(case)
        return replace(solution, status=MarchStatus.STALLED), surface

    monkeypatch.setattr('surrogate.contact.rolling.march_case', stalled)
    assert run(rolling) == 1
    assert f'status: {MarchStatus.STALLED.value}' in capsys.readouterr().out


def test_an_interrupted_march_leaves_no_traceback(capsys, rolling, monkeypatch):
    def interrupted(step, progress):
        raise KeyboardInterrupt

    monkeypatch.setattr('surrogate.ehl.moving.step.Stepper.step', interrupted)
    assert main(['contact', str(rolling)]) == INTERRUPTED
    assert capsys.readouterr().err.splitlines()[-1] == 'ballscrew: interrupted'


def test_pictures_are_written_or_refused_in_a_sentence(run, small, tmp_path, refused):
    """No directory: one sentence."""
    pytest.importorskip('matplotlib')
    folder = tmp_path / 'deep' / 'plots'
    assert run(small, '--plot', folder) == 0
    expected = ['contact_maps.png', 'contact_profiles.png']
    assert sorted(path.name for path in folder.iterdir()) == expected
    refused('plot_small_cannot', run, small, '--plot', small)
