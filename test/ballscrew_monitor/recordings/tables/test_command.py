# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew import`, from the guess to the judged log, as it is typed."""

import json
from pathlib import Path

from ballscrew_monitor import cli
from ballscrew_monitor.recordings.tables.command import print_guess
import yaml


def test_a_guess_is_a_map_that_works_unedited(mill_log, tmp_path, capsys, says):
    assert cli.main(['import', str(mill_log), '--guess']) == 0
    captured = capsys.readouterr()
    assert set(yaml.safe_load(captured.out)) == {'log', 'axes', 'assumed'}
    assert says('z_load_known') in captured.err
    mapping, bag = tmp_path / 'map.yaml', tmp_path / 'bag'
    mapping.write_text(captured.out)
    assert cli.main(['import', str(mill_log), '--config', str(mapping), '--out', str(bag)]) == 0
    assert '  assumed x.lead_mm = 10.0: ' in capsys.readouterr().out
    assert cli.main(['replay', str(bag), '--json']) == 0
    captured = capsys.readouterr()
    by_bag = json.loads(captured.out)
    assert set(by_bag) == {'x', 'y', 'z'}
    assert f'parameters: those of {bag}' in captured.err
    assert 'assumed of mill.csv, axis z: load = unknown' in captured.err
    assert says('nothing_was_judged') in captured.err
    assert cli.main(['replay', str(mill_log), '--map', str(mapping), '--json']) == 0
    captured = capsys.readouterr()
    assert json.loads(captured.out) == by_bag
    assert f'parameters: those of {mill_log}' in captured.err


def test_what_is_missing_or_superfluous_is_named(mill_log, tmp_path, capsys, short_bag, refused):
    assert cli.main(['import', str(mill_log)]) == 2
    assert '--config is missing; --guess prints' in capsys.readouterr().err
    assert cli.main(['import', str(mill_log), '--config', str(tmp_path / 'map.yaml')]) == 2
    assert '--out is missing' in capsys.readouterr().err
    assert cli.main(['replay', str(mill_log)]) == 2
    assert 'a table needs a map: ballscrew import' in capsys.readouterr().err
    for log in (short_bag, short_bag / 'short.mcap'):
        refused('bag_needs_import', print_guess, log)
    refused('cannot_read', print_guess, Path(tmp_path / 'nothing.csv'))
