# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Draw page.png and page_phone.png, the live page of the nominal machine cycle, paused.

Usage: python docs/pictures/draw_page.py. It serves bags/nominal_cycle, goes to a moment with a
warning, and takes pictures with Chromium over its DevTools protocol.

"""

import base64
from collections.abc import Iterator
import contextlib
import json
from pathlib import Path
import re
import shutil
import subprocess
import sys
import tempfile
import time
from typing import Any
from urllib.request import urlopen

from websockets.sync.client import connect

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
MOMENT = 35.0  # of the cycle [s]: creeping, with a warning
PICTURES = {'page': (1440, 1120, 0.75), 'page_phone': (360, 1000, 1.0)}  # [px], [px], [-]
READY = """
    typeof page === 'object' && page.whatIf?.map.over.area && page.player?.clock
    && document.querySelectorAll('.u-over').length === 7
"""
GO = f"page.live.ask({{ do: 'pause' }}).then(() => page.live.ask({{ do: 'seek', s: {MOMENT} }}))"
THERE = f"""
    Math.abs(page.player.clock.at_s - {MOMENT}) < 0.1
    && page.strips.panels.every((one) => one.plot.scales.x.max === page.strips.now)
    && page.whatIf.map.record.temperature_degC > 37
"""


@contextlib.contextmanager
def running(command: list[str], output: Path) -> Iterator[None]:
    """Run a command until the end of the block; what it prints goes to a file."""
    with output.open('w') as file:
        process = subprocess.Popen(command, cwd=ROOT, stdout=file, stderr=subprocess.DEVNULL)
        try:
            yield
        finally:
            process.terminate()
            process.wait()


def until(condition: Any, period: float = 0.2) -> Any:
    """Return what a condition gives as soon as that is true; it is asked in a period [s]."""
    while not (found := condition()):
        time.sleep(period)
    return found


def draw(url: str, socket: Any) -> None:
    """Take the pictures of a page through a socket to the tab of a browser."""

    def call(method: str, **params: Any) -> Any:
        socket.send(json.dumps({'id': 1, 'method': method, 'params': params}))
        while (heard := json.loads(socket.recv())).get('id') != 1:
            pass
        return heard['result']

    def ask(expression: str) -> Any:
        found = call(
            'Runtime.evaluate', expression=f'({expression})', awaitPromise=True, returnByValue=True
        )
        return found['result'].get('value')

    for name, (width, height, scale) in PICTURES.items():
        size = {'width': width, 'height': height, 'deviceScaleFactor': scale, 'mobile': False}
        call('Emulation.setDeviceMetricsOverride', **size)
        call('Page.navigate', url=url)
        until(lambda: ask(f'Boolean({READY})'))
        ask(GO)
        until(lambda: ask(THERE))
        data = call('Page.captureScreenshot', format='png')['data']
        (HERE / f'{name}.png').write_bytes(base64.b64decode(data))


def main() -> None:
    """Serve the cycle, open it in a browser, and draw it."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        sys.exit(f'no picture is drawn: it needs one of {", ".join(BROWSERS)}')
    with tempfile.TemporaryDirectory() as folder:
        said, profile = Path(folder) / 'page.txt', Path(folder) / 'profile'
        served = [sys.executable, '-m', 'ballscrew_monitor', 'page', 'bags/nominal_cycle']
        options = '--headless --no-sandbox --disable-gpu --hide-scrollbars'
        shown = [
            browser,
            *options.split(),
            '--remote-debugging-port=0',
            f'--user-data-dir={profile}',
        ]
        with (
            running([*served, '--port', '0'], said),
            running([*shown, 'about:blank'], Path(folder) / 'browser.txt'),
        ):
            url = until(lambda: re.search(r'http://\S+', said.read_text()))[0]
            port = profile / 'DevToolsActivePort'
            number = until(lambda: port.exists() and port.read_text().split('\n')[0])
            (tab, *_) = json.load(urlopen(f'http://127.0.0.1:{number}/json/list'))
            with connect(tab['webSocketDebuggerUrl'], max_size=None) as socket:
                draw(url, socket)


if __name__ == '__main__':
    main()
