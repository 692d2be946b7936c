# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A browser without a window that shows the page, and what its main thread does meanwhile."""

from collections.abc import Iterator
import contextlib
import dataclasses
import json
from pathlib import Path
import shutil
import subprocess
import tempfile
import time
from typing import Any

import numpy as np
from websockets.sync.client import ClientConnection, connect

BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
PATIENCE = 60.0  # [s] for a browser to start
WARM_UP = 5.0  # [s] until the page shows every axis
MEGABYTE = 1e6
# A frame begins with the callback that was asked for first, this one, and a message that is posted
# there arrives once scripts, styles, layout and painting of the frame are done.
WATCH = """
    globalThis.frameTimes = [];
    const [channel, begins] = [new MessageChannel(), []];
    channel.port1.onmessage = () => frameTimes.push(performance.now() - begins.shift());
    const watch = () => {
      requestAnimationFrame(watch);
      begins.push(performance.now());
      channel.port2.postMessage(0);
    };
    watch();
"""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Shown:
    """What a browser did while it showed the page."""

    frames: np.ndarray  # main thread at each frame of the screen [ms]
    busy: float  # share of time in which the main thread worked [-]
    heap: tuple[float, float]  # before and after, garbage collected [MB]


class Tab:
    """The tab of a browser, by the DevTools protocol."""

    def __init__(self, socket: ClientConnection) -> None:
        """Open a tab."""
        self._socket, self._number, self._session = socket, 0, {}
        target = self.call('Target.createTarget', url='about:blank')['targetId']
        found = self.call('Target.attachToTarget', targetId=target, flatten=True)
        self._session = {'sessionId': found['sessionId']}

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """Return the result of a method."""
        self._number += 1
        sent = {'id': self._number, 'method': method, 'params': params, **self._session}
        self._socket.send(json.dumps(sent))
        while (heard := json.loads(self._socket.recv())).get('id') != self._number:
            pass
        return dict(heard['result'])

    def ask(self, expression: str) -> Any:
        """Return the value of an expression in the page."""
        made = self.call('Runtime.evaluate', expression=expression, returnByValue=True)
        return made['result'].get('value')

    def times(self) -> dict[str, float]:
        """Return the times that the browser counts [s]."""
        found = self.call('Performance.getMetrics')['metrics']
        return {one['name']: one['value'] for one in found}

    def heap(self) -> float:
        """Return what scripts hold, arrays included, once garbage is collected [MB]."""
        self.call('HeapProfiler.collectGarbage')
        found = self.call('Runtime.getHeapUsage')
        return float(found['usedSize'] + found['backingStorageSize']) / MEGABYTE


def found_browser() -> str:
    """Return the path of a browser, empty without one."""
    return next(filter(None, map(shutil.which, BROWSERS)), '')


@contextlib.contextmanager
def opened(browser: str) -> Iterator[Tab]:
    """Start a browser and give a tab of it."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = '--headless --no-sandbox --disable-gpu --remote-debugging-port=0'
        command = [browser, *options.split(), f'--user-data-dir={profile}', 'about:blank']
        quiet = subprocess.DEVNULL
        process = subprocess.Popen(command, stdout=quiet, stderr=quiet)
        try:
            with connect(_address(Path(profile, 'DevToolsActivePort')), max_size=None) as socket:
                yield Tab(socket)
        finally:
            process.terminate()
            process.wait()


def _address(path: Path) -> str:
    """Wait for the file in which a browser says where it listens; return that."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        with contextlib.suppress(FileNotFoundError, ValueError):
            port, place = path.read_text().split()
            return f'ws://127.0.0.1:{port}{place}'
        time.sleep(0.05)
    raise TimeoutError('the browser did not start')


def watch(tab: Tab, url: str, seconds: float) -> Shown:
    """Show a page for some `seconds` [s] after a warm-up."""
    for domain in ('Page', 'Performance'):
        tab.call(f'{domain}.enable')
    tab.call('Page.navigate', url=url)
    time.sleep(WARM_UP)
    heap, before = tab.heap(), tab.times()
    tab.ask(WATCH)
    time.sleep(seconds)
    frames, after = tab.ask('frameTimes.splice(0)'), tab.times()
    spent = {name: after[name] - before[name] for name in ('TaskDuration', 'Timestamp')}
    return Shown(
        frames=np.array(frames),
        busy=spent['TaskDuration'] / spent['Timestamp'],
        heap=(heap, tab.heap()),
    )
