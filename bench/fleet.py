# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Collect years of logs of axes, assess them on one core, and print size and time of both.

Usage: python bench/fleet.py [--axes N] [--seed S] [--schedule weekly]. The years are those of
`health_parts`, with a position of motor and table in each log; every second axis has a fault.
Times are of this core; what 32 of them do in an hour is computed, as axes share nothing.

"""

import argparse
from pathlib import Path
import sys
import tempfile
import time

from ballscrew_monitor.health.stroke import Positions
from ballscrew_monitor.report.health_axes import assess_task, joined_axes
from ballscrew_monitor.report.health_folder import keep
from ballscrew_monitor.report.health_history import HistoryMaker
from ballscrew_monitor.settings.axis import settings_of
from ballscrew_monitor.settings.parameters import defaults
from health_parts.axis_year import axis_year, AxisYear, SCHEDULES
from health_parts.faults import CLEAN, FAULTS
from health_parts.summaries import rows_of
from surrogate.surface import shipped_surface, Surface

CORES, HOUR = 32, 3600.0
OPTIONS = {'baseline_days': 91.0, 'days': None, 'speed_allowed': False}


def collect_year(year: AxisYear, folder: Path, machine: str) -> int:
    """Keep a year of logs of an axis x in a folder; return how many there are."""
    file = shipped_surface()
    surface = Surface.load(file)
    settings = settings_of('x', defaults(['x']), surface)
    for number, log in enumerate(year.logs):
        rows = rows_of(log)
        positions = Positions(rows['stamp'], log.position, log.table)
        maker = HistoryMaker(surface, log=f'{number}.csv', positions=positions)
        maker.add(rows)
        history = maker.history('x', file, settings, machine=machine)
        keep(folder, f'{number:016x}-{0:016x}', [history], ())
    return len(year.logs)


def main() -> int:
    """Collect, assess and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0].strip())
    parser.add_argument('--axes', type=int, default=6, help='years of axes')
    parser.add_argument('--seed', type=int, default=1, help='the first one')
    parser.add_argument('--schedule', choices=SCHEDULES, default='weekly', help='of the logs')
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder, logs = Path(name), 0
        faults = list(FAULTS.values())
        begin = time.perf_counter()
        for number in range(asked.axes):
            fault = faults[number // 2 % len(faults)] if number % 2 else CLEAN
            year = axis_year(asked.seed + number, fault, schedule=asked.schedule, scale=True)
            logs += collect_year(year, folder, f'mill {number}')
        made = time.perf_counter() - begin
        size = sum(path.stat().st_size for path in folder.rglob('*.parquet'))
        each = size / logs / 1e3
        print(f'{logs} logs drawn, gathered and kept in {made:.1f} s, {each:.1f} kB each')
        times = []
        for key, inputs in joined_axes({}, folder).items():
            begin = time.perf_counter()
            assess_task({**inputs, 'title': key.machine, 'options': OPTIONS})
            times.append(time.perf_counter() - begin)
        mean = sum(times) / len(times)
        most = max(times)
        print(f'an axis-year of {asked.schedule} logs: {mean:.2f} s, at most {most:.2f} s')
        print(f'computed: {CORES} cores assess {CORES * HOUR / mean:,.0f} axis-years an hour')
    return 0


if __name__ == '__main__':
    sys.exit(main())
