# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The first screen in ten states against kept pictures, `screens/NAME.png` and `screens.json`.

Fonts of another machine are allowed for: words, colours and the presence of parts are compared
exactly, their boxes and the means of coarse blocks of the picture with a tolerance. After a change
that is meant, run this file with RECORD_SCREENS=1 in the environment, and look at each picture.

"""

import base64
import io
import json
import os
from pathlib import Path

import numpy as np
from PIL import Image
import pytest

KEPT = Path(__file__).parent / 'screens'
RECORDS = bool(os.environ.get('RECORD_SCREENS'))
WIDE, PHONE = (1280, 900), (360, 3700)  # [px]
SCALE = 0.5  # of a kept picture [-]
BLOCK = 16  # [px] of a kept picture, whose mean is compared
SAME, MOST_OTHER = 40.0, 0.06  # of 255 for the mean of a block, share of blocks that may differ
SHIFT = 32  # [px] by which an edge of a part may lie elsewhere
PARTS = (
    *('.card', '.sign', '.told p', '.numbers > div', '.input', '.link'),
    *('.what-if', '.strips', '.health', '.events', '.events tbody tr'),
)
HEARD = """
    window.heard = 0;  // frames that the page has taken
    window.WebSocket = class extends WebSocket {
      constructor(...given) {
        super(...given);
        this.addEventListener('message', () => { window.heard += 1; });
      }
    };
"""
QUIET = """
    document.querySelector('.sign.level .word')?.textContent
    && page.painter.views.every((view) => !view.news)
"""
LOOK = """
    (%s).flatMap((part) => [...document.querySelectorAll(part)].map((one) => [part, one]))
      .map(([part, one]) => [part, one, one.getBoundingClientRect()])
      .filter(([, , box]) => box.width && box.height && box.top < innerHeight)
      .map(([part, one, box]) => ({
        part,
        box: [box.left, box.top, box.right, box.bottom].map(Math.round),
        paper: getComputedStyle(one).backgroundColor,
        ink: getComputedStyle(one).color,
        words: ['.sign', '.told p'].includes(part) ? one.textContent : '',
      }))
"""
RCS = {'key': 'cause_rcs', 'values': {'value': {'rcs': 0.27}, 'limit': {'rcs': 0.01}}}
GRADE = '90 % of this programme would lie in the zone with ISO VG 220'
LEARNING = {
    'key': 'verdict_unknown',
    'values': {'axis': 'x', 'why': {'free': 'not known yet, 3 of 10 days'}},
}
CHANGED = {
    'key': 'verdict_worse_since',
    'values': {
        'axis': 'x',
        'since': '2026-10-02',
        'value': {'value': -0.18, 'unit': '-'},
        'low': {'value': -0.25, 'unit': '-'},
        'high': {'value': -0.11, 'unit': '-'},
        'why': {'key': 'why_none'},
    },
}
NORMAL = {
    'key': 'verdict_normal',
    'values': {'axis': 'x'}
    | {name: {'value': value, 'unit': '-'} for name, value in
       (('value', 0.01), ('low', -0.02), ('high', 0.03))},
}  # fmt: skip
OUTSIDE = {'level': 'warn', 'zone': 'outside', 'headline': RCS, 'outside': 'surely'}
STALE = {'name': 'load', 'state': 'stale', 'age_s': 4.0, 'words': 'The last sample is 4 s old.'}
FRESH = [{'name': name, 'state': 'ok', 'age_s': 0.0, 'words': ''} for name in ('speed', 'load')]


class States:
    """The greeting of a server in each state."""

    def __init__(self, frames):
        self.frames = frames

    def greeting(self, name):
        """Return the frames of a state."""
        return getattr(self, name)() if hasattr(self, name) else self.one()

    def one(self, axes=('x',), rows=None, **state):
        frames, named = self.frames, [self.frames.axis(axis) for axis in axes]
        rows = frames.rows(1, speed_rpm=-750.0) if rows is None else rows
        history = {'kind': 'history', 'axis': '/ballscrew_monitor/x'}
        health = state.pop('health', frames.health(verdict=NORMAL))
        state = {'headline': {'key': 'optimal'}} | state
        return [
            frames.hello(*named),
            (history, frames.rows(3000, -60.0)),
            frames.map(),
            frames.events('x', *state.pop('events', ())),
            frames.state(rows=rows, health=health, **state),
        ]

    def changed(self):
        advice = {'key': 'remedy_preload_lost'}
        return self.one(health=self.frames.health('worse', verdict=CHANGED, advice=advice))

    def learning(self):
        return self.one(health=self.frames.health('unknown', verdict=LEARNING, quantities=[]))

    def surely(self):
        rows = self.frames.rows(1, speed_rpm=-80.0, rcs=0.27)
        return self.one(**OUTSIDE, rows=rows, advice={'free': GRADE}, events=[{'active': True}])

    def perhaps(self):
        rows = self.frames.rows(1, speed_rpm=-420.0, rcs=0.03)
        state = OUTSIDE | {'outside': 'perhaps'}
        return self.one(**state, rows=rows, events=[{'active': True}])

    def rest(self):
        rows = self.frames.rows(1, speed_rpm=0.0)
        return self.one(
            level='ok',
            zone='unknown',
            at_rest=True,
            headline={'key': 'reason_standstill'},
            rows=rows,
            temperature_assumed=True,
        )

    def no_data(self):
        frames = self.frames
        state = {'level': 'unknown', 'zone': 'unknown', 'headline': {'key': 'nothing_heard'}}
        health = frames.health('unknown', verdict=LEARNING, quantities=[])
        told = frames.state(rows={}, health=health, limit=None, totals={}, inputs=[], **state)
        return [frames.hello(frames.axis()), frames.events('x'), told]

    def sensor_dead(self):
        return self.one(
            level='unknown',
            zone='unknown',
            headline={'key': 'reason_missing', 'values': {'inputs': [{'key': 'input_load'}]}},
            inputs=[FRESH[0], STALE],
            faults=[203],
            rows=self.frames.rows(1, load_N=np.nan, efficiency=np.nan, rcs=np.nan),
            limit=None,
        )

    def two_axes(self):
        other = self.frames.state('y', **OUTSIDE)
        return [*self.one(axes=('x', 'y')), other]

    def phone(self):
        events = [{'active': True}, {'id': 2, 'usual': True, 'begin': self.frames.begin - 600.0}]
        return self.one(**OUTSIDE, advice={'free': GRADE}, events=events)


NAMES = (
    *('normal', 'changed', 'learning', 'surely', 'perhaps'),
    *('rest', 'no_data', 'sensor_dead', 'two_axes', 'phone'),
)


def show(tab, server, frames, name):
    """Open the page in a state, and return what of it is seen and its picture."""
    server.greeting = States(frames).greeting(name)
    width, height = PHONE if name == 'phone' else WIDE
    tab.call('Page.addScriptToEvaluateOnNewDocument', source=HEARD)
    tab.visit(server.url, width=width, height=height)
    tab.until(f'window.heard >= {len(server.greeting)}')
    tab.until(QUIET)
    return seen(tab, width, height)


def seen(tab, width, height):
    parts = tab.ask(LOOK % json.dumps(PARTS))
    clip = {'x': 0, 'y': 0, 'width': width, 'height': height, 'scale': SCALE}
    data = tab.call('Page.captureScreenshot', format='png', clip=clip)['data']
    return parts, Image.open(io.BytesIO(base64.b64decode(data))).convert('RGB')


def differences(parts, kept):
    """Return what of the parts is not as it was."""
    names, before = ([one['part'] for one in each] for each in (parts, kept))
    if names != before:
        return [f'parts are {names}, they were {before}']
    return [
        f'{one["part"]} {at}: {key} is {one[key]}, it was {other[key]}'
        for at, (one, other) in enumerate(zip(parts, kept, strict=True))
        for key in ('box', 'paper', 'ink', 'words')
        if one[key] != other[key]
        and (key != 'box' or np.abs(np.subtract(one[key], other[key])).max() > SHIFT)
    ]


def other_blocks(picture, kept):
    """Return which share of the blocks of a picture differs from a kept one."""
    first, second = (_means(np.asarray(one, dtype=float)) for one in (picture, kept))
    return float((np.abs(first - second).max(axis=2) > SAME).mean())


def _means(pixels):
    rows, columns = (size // BLOCK for size in pixels.shape[:2])
    cut = pixels[: rows * BLOCK, : columns * BLOCK]
    return cut.reshape(rows, BLOCK, columns, BLOCK, 3).mean(axis=(1, 3))


def record(name, parts, picture):
    """Keep what is seen of a state."""
    KEPT.mkdir(exist_ok=True)
    file = KEPT / 'screens.json'
    known = json.loads(file.read_text()) if file.exists() else {}
    lines = [f'"{key}": {json.dumps(known[key])}' for key in sorted({*known} - {name})]
    lines = sorted([*lines, f'"{name}": {json.dumps(parts)}'])
    file.write_text('{\n' + ',\n'.join(lines) + '\n}\n')
    picture.quantize(64).save(KEPT / f'{name}.png', optimize=True)


@pytest.mark.parametrize('name', NAMES)
def test_the_first_screen_is_as_it_was_looked_at(tab, server, frames, name):
    parts, picture = show(tab, server, frames, name)
    if RECORDS:
        record(name, parts, picture)
    kept = json.loads((KEPT / 'screens.json').read_text())[name]
    assert differences(parts, kept) == []
    assert other_blocks(picture, Image.open(KEPT / f'{name}.png').convert('RGB')) < MOST_OTHER


@pytest.mark.parametrize(
    'change',
    [
        "document.querySelector('.sign.level').dataset.state = 'ok'",
        "document.querySelector('.numbers > div:nth-child(2)').style.background = 'red'",
        "document.querySelector('.numbers > div:nth-child(3)').remove()",
        "document.querySelector('.advice').hidden = true",
        "document.querySelector('.sign.condition').style.width = '100px'",
    ],
)
def test_a_part_that_changes_its_colour_or_is_gone_is_noticed(tab, server, frames, change):
    show(tab, server, frames, 'surely')
    tab.ask(f'{change}; 0')
    parts, _ = seen(tab, *WIDE)
    assert differences(parts, json.loads((KEPT / 'screens.json').read_text())['surely'])


def test_the_pictures_are_few_bytes():
    files = [path for path in KEPT.iterdir() if path.suffix in ('.png', '.json')]
    assert {path.stem for path in files} == {*NAMES, 'screens'}
    assert sum(path.stat().st_size for path in files) < 300_000
