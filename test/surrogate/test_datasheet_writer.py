# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Datasheets written and read again."""

from dataclasses import replace

import pytest
from surrogate.datasheet_writer import write_sheet
from surrogate.parameters import BallRoughness, load_lubricant, load_screw


def test_every_number_comes_back(tmp_path, screw, oil):
    """Twelve digits, blocks and texts; nothing half-written is left."""
    odd = replace(screw, lead=0.01 / 3, parasitic_torque=1e-7, source='two: words # and 1 é')
    path = tmp_path / 'deep' / 'screw.yaml'
    write_sheet(path, odd, ['a line of comment ' * 9])
    found = load_screw(str(path))
    assert found.lead == pytest.approx(odd.lead, rel=1e-11)
    assert found.contact_angle == pytest.approx(odd.contact_angle, rel=1e-11)
    assert replace(found, lead=odd.lead, contact_angle=odd.contact_angle) == odd
    assert path.read_text(encoding='utf-8').startswith('# a line of comment')
    assert max(map(len, path.read_text(encoding='utf-8').splitlines())) < 120
    assert 'flank_clearance' not in path.read_text(encoding='utf-8')
    assert 'ball_roughness' not in path.read_text(encoding='utf-8')
    rough = replace(odd, ball_roughness=BallRoughness(grade='G10'))
    write_sheet(path, rough)
    assert load_screw(str(path)).ball_roughness == rough.ball_roughness
    write_sheet(path, replace(odd, flank_clearance=3e-6))
    assert load_screw(str(path)).flank_clearance == pytest.approx(3e-6, rel=1e-11)
    write_sheet(tmp_path / 'deep' / 'oil.yaml', oil)
    again = load_lubricant(str(tmp_path / 'deep' / 'oil.yaml'))
    assert again.reference_temperature == pytest.approx(oil.reference_temperature)
    assert sorted(one.name for one in path.parent.iterdir()) == ['oil.yaml', 'screw.yaml']


def test_a_place_that_cannot_be_written_is_a_sentence(tmp_path, screw, refused):
    refused('cannot_written_regular', write_sheet, tmp_path, screw)
    (tmp_path / 'file').write_text('x')
    refused('datasheet_cannot_written', write_sheet, tmp_path / 'file' / 'screw.yaml', screw)
