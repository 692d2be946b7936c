# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Strips of a raceway that are marched beside the law, and how a build tells them."""

from dataclasses import replace
import json

from surrogate.builder import tiers
from surrogate.builder.full import march
from surrogate.builder.full import tier as full_tier
from surrogate.builder.full.march import march_task, march_tasks
from surrogate.builder.full.settings import default_full_settings
from surrogate.files import InputError
from surrogate.surface import shipped_surface
from surrogate.surface.file import read
from surrogate.surface_tools.describe import march_lines

SHIPPED = read(shipped_surface(tier='full'))
BEGINS, NEVER = (
    {
        'marched_m_s': onset,
        'film_factor': factor,
        'told_m_s': 0.12,
        'shortest_wave_m': 1e-5,
        'status': 'well',
    }
    for onset, factor in ((0.1, 0.91), (None, None))
)


def test_a_strip_of_long_waves_begins_to_touch_near_what_the_law_tells(screw, oil):
    """Within the 1.6 by which the law misses raceways without waves below 10 um."""
    tasks = march_tasks(screw, oil, waves=2.0, transits=6.0)
    assert list(tasks) == ['strip 1', 'strip 2', 'strip 3']
    found = march_task(json.loads(json.dumps(tasks['strip 1'])))
    assert json.loads(json.dumps(found)) == found
    assert found['status'].startswith('Converged')
    assert 1 / 1.6 < found['marched_m_s'] / found['told_m_s'] < 1.6
    assert 1 / 1.3 < found['film_factor'] < 1.3


def test_a_smooth_raceway_is_not_marched(screw, oil, refused):
    smooth = replace(screw, roughness=replace(screw.roughness, rms=0.0))
    refused('march_smooth', march_tasks, smooth, oil)


def test_a_build_keeps_what_strips_gave_and_tells_it(
    screw, oil, tmp_path, monkeypatch, here, capsys
):
    """Beside the law, in the header; a strip that failed is said on stderr and left out."""

    def marched(inputs):
        if inputs['draw'] == 2:
            raise InputError('no luck')
        return NEVER if inputs['draw'] else BEGINS

    monkeypatch.setattr(full_tier, 'build_full', lambda *given: SHIPPED)
    monkeypatch.setattr(march, 'march_task', marched)  # where workers find it
    settings = default_full_settings(screw)
    known = {'pool': here(), 'out': tmp_path / 'a.npz'}
    data = tiers.build_surface('full', screw, oil, settings, march=True, **known)
    assert data.header['march'] == {'strip 1': BEGINS, 'strip 2': NEVER}
    assert 'strip, strip 3: ' in capsys.readouterr().err
    begins, never = march_lines(data.header['march'])
    assert 'strip 1, waves down to 10 um: contact begins at 0.1 m/s' in begins
    assert 'with 0.91 times the film of the law, told over marched 1.20' in begins
    assert 'contact does not begin, told 0.12 m/s' in never
    assert list(march_lines({})) == ['  marched      no strip: all failed']
