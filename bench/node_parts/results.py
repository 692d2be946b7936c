# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""All that was measured: as a table, a CSV and a picture."""

from collections.abc import Sequence
import csv
import dataclasses
from pathlib import Path
import statistics
from typing import TYPE_CHECKING

from node_parts.peer import Turn

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclasses.dataclass
class Findings:
    """All that was measured."""

    turns: list[Turn] = dataclasses.field(default_factory=list)
    starts: list[tuple[int, float]] = dataclasses.field(default_factory=list)  # axes, [s]
    memory: list[tuple[float, float]] = dataclasses.field(default_factory=list)  # [s], [MB]


HEAD = (
    f'{"":6}{"axes":>5}{"[Hz]":>6}{"period":>7}{"sent":>9}{"missing":>8}{"topics":>7}{"lost":>7}'
    f'{"reached":>8}{"core":>8}{"per message":>12}{"p50":>9}{"p99":>9}{"load":>6}'
)


def line_of(turns: Sequence[Turn]) -> str:
    """Return a line for turns of one kind: sums of the counts, medians of the rest."""
    one = turns[0]

    def middle(name: str) -> float:
        return statistics.median(getattr(turn, name) for turn in turns)

    def total(name: str) -> int:
        return sum(getattr(turn, name) for turn in turns)

    return (
        f'{one.kind:6}{one.axes:5}{one.rate:6g}{one.period:7g}{total("sent"):9}'
        f'{total("missing"):8}{middle("missing_topics"):7g}{total("lost"):7}'
        f'{middle("reached"):8.2f}{middle("cpu_percent"):6.1f} %{middle("cpu_us"):9.0f} us'
        f'{middle("p50_ms"):6.2f} ms{middle("p99_ms"):6.1f} ms{middle("load"):6.1f}'
    )


def cases(turns: Sequence[Turn]) -> dict[tuple[str, int, float, float], list[Turn]]:
    """Return the turns of each case."""
    found: dict[tuple[str, int, float, float], list[Turn]] = {}
    for turn in turns:
        found.setdefault((turn.kind, turn.axes, turn.rate, turn.period), []).append(turn)
    return found


def report(found: Findings) -> None:
    """Print the table."""
    print('\nmedians of the turns, counts of all', HEAD, sep='\n')
    for turns in cases(found.turns).values():
        print(line_of(turns))
    for axes, start in found.starts:
        print(f'start to first state, {axes} axes: {start:.1f} s')
    if found.memory:
        (begin, first), (end, last) = found.memory[0], found.memory[-1]
        print(f'memory at 1 kHz: {first:.1f} MB, {last:.1f} MB after {(end - begin) / 60:.1f} min')


def write(found: Findings, folder: Path) -> None:
    """Write a CSV and a picture."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / 'node.csv').open('w', newline='') as file:
        writer = csv.DictWriter(file, [field.name for field in dataclasses.fields(Turn)])
        writer.writeheader()
        writer.writerows(dataclasses.asdict(turn) for turn in found.turns)
    from surrogate.plotting.style import draw_picture

    draw_picture(folder / 'node.png', lambda: draw(found))


def draw(found: Findings) -> 'Figure':
    """Return shares of a core, latencies and memory."""
    from surrogate.plotting.style import BLUE, GREY, new_figure

    figure = new_figure(11.0, 3.6)
    shares, latency, memory = figure.subplots(1, 3, width_ratios=[3, 2, 2])
    groups = cases(found.turns)
    thinned = list(dict.fromkeys((turn.rate, turn.axes) for turn in found.turns if turn.period))
    each = list(dict.fromkeys(turn.rate for turn in found.turns if not turn.period))
    for offset, colour, kind in ((-0.2, GREY, 'bare'), (0.2, BLUE, 'node')):
        name = {'bare': 'bare rclpy node', 'node': 'ballscrew_monitor'}[kind]
        values = [
            statistics.median(turn.cpu_percent for turn in groups[kind, axes, rate, 0.1])
            for rate, axes in thinned
        ]
        places = [place + offset for place in range(len(thinned))]
        shares.bar(places, values, 0.4, color=colour, label=name)
        places = [place + offset for place in range(len(each))]
        for field, alpha in (('p99_ms', 0.4), ('p50_ms', 1.0)):
            values = [
                statistics.median(getattr(turn, field) for turn in groups[kind, 1, rate, 0.0])
                for rate in each
            ]
            latency.bar(places, values, 0.4, color=colour, alpha=alpha)
    shares.set_xticks(range(len(thinned)), [f'{axes} x\n{rate:g} Hz' for rate, axes in thinned])
    shares.set(ylabel='share of a core [%]', title='ten states a second')
    shares.legend()
    latency.set_xticks(range(len(each)), [f'{rate:g} Hz' for rate in each])
    latency.set(
        ylabel='latency, p50 dark, p99 light [ms]',
        yscale='log',
        title='one axis, a state for each sample',
    )
    latency.yaxis.set_major_formatter('{x:g}')
    latency.yaxis.set_minor_formatter('')
    latency.set_ylim(bottom=0.1)
    times, sizes = zip(*found.memory)
    memory.plot([at / 60 for at in times], sizes, '.-', color=BLUE)
    memory.set(
        xlabel='time [min]',
        ylabel='memory [MB]',
        title='one axis, 1 kHz',
        ylim=(0, 1.2 * max(sizes)),
    )
    return figure
