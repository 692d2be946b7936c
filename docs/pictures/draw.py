# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Draw concept.png and rooms.png, which show no result, and report.png, a page in a browser.

Usage: python docs/pictures/draw.py. Film and pressure are sketches, not solutions. The page is the
report of bags/nominal_cycle, drawn by Chromium without its bars and tables.

"""

from pathlib import Path
import re
import shutil
import subprocess
import sys
import tempfile

from matplotlib.axes import Axes
import matplotlib.pyplot as plt
import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
METAL, OIL, PUNCTURED, INK = '#9aa5b1', '#f2cf7a', '#d55e00', '#222222'
OFFLINE, ONLINE, FILE = '#dbe9f6', '#dff1e6', '#fbe3cf'
STATES = (
    (2.8, 'fast: hydrodynamic', 'Λ = 4, RCS = 0\nthe film carries the whole load'),
    (0.95, 'slower: mixed by Λ', 'Λ = 2, RCS = 0\nno asperity touches: no warning'),
    (0.16, 'slow or hot: punctured', 'Λ < 1, RCS = 0.1\na tenth of the load at punctures'),
)
OFFLINE_ROOMS = (
    ('parameters', 'datasheets'),
    ('formulas   raceway', 'laws, rough surfaces'),
    ('ehl   asperities', 'one contact'),
    ('screw', 'balls, torque'),
    ('builder', 'nodes, errors'),
)
ONLINE_ROOMS = (
    ('node', 'topics'),
    ('judge', 'inputs, point'),
    ('surface', 'lookup'),
    ('judge', 'zone, level'),
    ('messages   node', 'state, warning,\ndiagnostics'),
)

BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
PAGE_WIDTH, PAGE_HEIGHT, PAGE_SCALE = 1120, 1750, 0.8  # [px], [-]
LEFT_OUT = """
    h3:has(+ .bar), .bar, .bar + .legend, .bar + .legend + p,
    h3:has(+ p + .wide), h3 + p:has(+ .wide), .wide { display: none; }
    h3:has(+ p.screen) { border-top: 2px solid var(--grid); padding-top: 1rem; }
"""


def sketch(axes: Axes, film: float, title: str, text: str) -> None:
    """Draw raceway, ball and oil for a mean `film`, in units of the rms roughness [-]."""
    x = np.linspace(-1.0, 1.0, 1200)
    rng = np.random.default_rng(4)
    waves = sum(
        np.sin(2 * np.pi * n * x + phase) / n**0.7
        for n, phase in zip((3, 5, 8, 13, 19), rng.uniform(0, 6.28, 5))
    )
    rough = 0.3 * waves / np.std(waves)
    ball = film + 0.35 + np.maximum(np.abs(x) - 0.62, 0) ** 2 * 9
    touches = rough >= ball
    raceway = np.minimum(rough, ball)
    axes.fill_between(x, raceway, ball, color=OIL)
    axes.fill_between(x, -2.2, raceway, color=METAL)
    axes.fill_between(x, ball, 5.2, color=METAL)
    axes.fill_between(x, raceway - 0.28, ball + 0.1, where=touches, color=PUNCTURED, linewidth=2)
    axes.text(0, 4.3, 'ball', ha='center', color=INK)
    axes.text(0, -1.9, 'raceway', ha='center', color=INK)
    axes.annotate('oil', (0, 0.5 * film + 0.2), ha='center', va='center', color=INK, fontsize=9)
    axes.set(title=title, xlim=(-1, 1), ylim=(-2.2, 5.2), xticks=[], yticks=[], xlabel=text)


def concept() -> None:
    """Draw what film ratio and RCS are."""
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.6), layout='constrained')
    for one, state in zip(axes, STATES):
        sketch(one, *state)
    figure.supxlabel(
        'Λ = film of the smooth contact / rms roughness          '
        'RCS = share of the load where the film is punctured (orange)',
        fontsize=10,
    )
    figure.savefig(HERE / 'concept.png', dpi=130)
    plt.close(figure)


def room(axes: Axes, x: float, y: float, words: tuple[str, str], colour: str) -> None:
    """Draw a room with its name and what it holds."""
    axes.add_patch(plt.Rectangle((x, y), 1.7, 1.0, facecolor=colour, edgecolor=INK, linewidth=0.8))
    axes.text(x + 0.85, y + 0.67, words[0], ha='center', va='center', weight='bold', fontsize=10)
    axes.text(x + 0.85, y + 0.3, words[1], ha='center', va='center', fontsize=8.5)


def row(axes: Axes, y: float, words: tuple[tuple[str, str], ...], colour: str) -> None:
    """Draw a row of rooms with arrows between them."""
    for place, pair in enumerate(words):
        room(axes, 2.2 * place, y, pair, colour)
        if place:
            arrow(axes, (2.2 * place - 0.5, y + 0.5), (2.2 * place, y + 0.5))


def arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Draw an arrow."""
    axes.annotate('', end, start, arrowprops={'arrowstyle': '-|>', 'color': INK})


def rooms() -> None:
    """Draw the folders of both halves in the order the data flows."""
    figure, axes = plt.subplots(figsize=(10.5, 5.2), layout='constrained')
    row(axes, 5.0, OFFLINE_ROOMS, OFFLINE)
    row(axes, 1.0, ONLINE_ROOMS, ONLINE)
    room(axes, 4.4, 3.1, ('SURFACE FILE', '.npz with SHA-256'), FILE)
    arrow(axes, (9.65, 5.0), (6.1, 3.7))
    arrow(axes, (5.25, 3.1), (5.25, 2.0))
    for x, y, words, style in (
        (0, 6.3, 'offline, surrogate/: no ROS', {'weight': 'bold'}),
        (0, 4.55, 'tasks: solves on workers      commands: the command line', {}),
        (0, 4.1, 'contact  identify  studies  surface_tools: their users', {}),
        (0, 2.3, 'online, ballscrew_monitor/', {'weight': 'bold'}),
        (5.4, 2.3, 'numpy alone', {}),
        (0, 0.45, 'recordings: bags in and out      cycle: make run', {}),
    ):
        axes.text(x, y, words, fontsize=10, **style)
    room(axes, 4.4, 1.0, ONLINE_ROOMS[2], OFFLINE)
    axes.set(xlim=(-0.1, 10.6), ylim=(0.2, 6.8))
    axes.axis('off')
    figure.savefig(HERE / 'rooms.png', dpi=120)
    plt.close(figure)


def report() -> None:
    """Draw the page of the nominal machine cycle, from its verdict to the first charts."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        sys.exit(f'report.png is not drawn: it needs one of {", ".join(BROWSERS)}')
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / 'report'
        bag = ROOT / 'bags' / 'nominal_cycle'
        command = [
            sys.executable,
            '-m',
            'ballscrew_monitor',
            'replay',
            str(bag),
            '--out',
            str(out),
        ]
        subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
        page = out / 'report.html'
        page.write_text(_shortened(page.read_text()))
        subprocess.run(
            [
                browser,
                '--headless',
                '--no-sandbox',
                '--disable-gpu',
                '--hide-scrollbars',
                f'--user-data-dir={folder}/profile',
                '--virtual-time-budget=8000',
                f'--force-device-scale-factor={PAGE_SCALE}',
                f'--window-size={PAGE_WIDTH},{PAGE_HEIGHT}',
                f'--screenshot={HERE / "report.png"}',
                page.as_uri(),
            ],
            check=True,
            stderr=subprocess.DEVNULL,
        )


def _shortened(page: str) -> str:
    """Return a page without some parts; its policy, which lets in no other style, goes too."""
    page = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', '', page)
    return page.replace('</head>', f'<style>{LEFT_OUT}</style></head>')


if __name__ == '__main__':
    concept()
    rooms()
    report()
