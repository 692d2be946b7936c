# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The hub between what is heard of the axes and the browsers that look at them.

All of it belongs to one thread, that of the server. A frame is made once for all browsers. A
browser that does not keep up loses all that waits for it, which is counted, and is greeted again
when it reads again: what waits is bounded, and what it shows is whole.

"""

import asyncio
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ballscrew_monitor.page.axis_view import ACTIVE, AxisView, GONE
from ballscrew_monitor.page.components import ENGLISH, languages
from ballscrew_monitor.page.frames import frame
from ballscrew_monitor.page.phrases import Phrase, phrase, Said
from surrogate.files import InputError

VERSION = 1  # of the frames
PERIOD = 0.04  # [s] between two frames of an axis
IDLE_PERIOD = 1.0  # [s] without news
MOST_WAITING = 512  # frames for a browser
MOST_REPLIES = 64
MOST_AXES = 64
MOST_BROWSERS = 100
NO_NODE = phrase('waits_for_node')


class Browser:
    """What waits for one browser."""

    def __init__(self, language: str = ENGLISH) -> None:
        self.language = language
        self.is_behind = False
        self.dropped = 0
        self._waiting: deque[bytes] = deque()
        self._replies: deque[bytes] = deque(maxlen=MOST_REPLIES)
        self._wakes = asyncio.Event()
        self._reads = False

    @property
    def is_ready(self) -> bool:
        """Return True if it has read all and waits for more."""
        return self._reads and not self._waiting

    def greet(self, frames: Iterable[bytes]) -> None:
        """Let frames with all that is known wait, in place of those that wait."""
        self.is_behind = False
        self._waiting.clear()
        self._waiting.extend(frames)
        self._wakes.set()

    def put(self, data: bytes) -> None:
        """Let a frame wait; of one that does not keep up nothing waits."""
        if len(self._waiting) >= MOST_WAITING:
            self.dropped += len(self._waiting)
            self._waiting.clear()
            self.is_behind = True
        if self.is_behind:
            self.dropped += 1
            return
        self._waiting.append(data)
        self._wakes.set()

    def reply(self, data: bytes) -> None:
        """Let an answer wait, which goes before all else and is not superseded."""
        self._replies.append(data)
        self._wakes.set()

    async def take(self) -> bytes:
        """Wait for the next frame."""
        while not self._replies and not self._waiting:
            self._wakes.clear()
            self._reads = True
            await self._wakes.wait()
        self._reads = False
        return (self._replies or self._waiting).popleft()


class Hub:
    """Axes and browsers; `acting` tells whether a browser may change something."""

    def __init__(self, *, acting: bool = False, waiting: Phrase = NO_NODE) -> None:
        """Begin with nobody; `waiting` is said while there is no axis."""
        self.acting, self._waiting = acting, waiting
        self.axes: dict[str, AxisView] = {}
        self.browsers: set[Browser] = set()
        self.notices: dict[str, Said] = {}  # why a node is not shown
        self.clock: Callable[[], Mapping[str, Any]] | None = None  # of a recording
        self.missed = 0  # messages of nodes that were lost on the way here
        self._is_changed = False
        self._dropped = 0  # of browsers that have left

    @property
    def dropped(self) -> int:
        """Return how many frames did not reach a browser."""
        return self._dropped + sum(browser.dropped for browser in self.browsers)

    def add(self, view: AxisView) -> None:
        """Show an axis from now on, if there are not too many."""
        if view.name in self.axes or len(self.axes) < MOST_AXES:
            self.axes[view.name] = view
            view.standing, view.is_changed = ACTIVE, True

    def view(self, name: str) -> AxisView:
        """Return an axis by its name; raises InputError for an unknown one."""
        if name not in self.axes:
            known = ', '.join(sorted(self.axes)) or 'none yet'
            raise InputError(f'axis {name!r} is unknown, known are: {known}')
        return self.axes[name]

    def lose(self, name: str) -> None:
        """Say that an axis is gone; what was heard of it stays, with its age."""
        if name in self.axes:
            self.axes[name].stand(GONE)

    def forget(self, name: str) -> None:
        """Show an axis no more."""
        self._is_changed |= self.axes.pop(name, None) is not None

    def miss(self, count: int) -> None:
        """Count messages that were lost on the way here."""
        self.missed += count

    def notice(self, node: str, words: Said) -> None:
        """Say why a node is not shown, or with empty words nothing of it."""
        if self.notices.pop(node, '') != words:
            self._is_changed = True
        if words:
            self.notices[node] = words

    def tell(self, data: bytes) -> None:
        """Send a frame to every browser."""
        for browser in self.browsers:
            browser.put(data)

    def join(self, browser: Browser, now: float) -> bool:
        """Greet a browser at `now` [s] of a steady clock; return True if there is room for it."""
        if len(self.browsers) >= MOST_BROWSERS:
            return False
        self.browsers.add(browser)
        browser.greet(self._greeting(browser.language, now))
        return True

    def leave(self, browser: Browser) -> None:
        """Forget a browser."""
        self.browsers.discard(browser)
        self._dropped += browser.dropped

    def tick(self, now: float) -> None:
        """Send what is new at `now` [s] of a steady clock."""
        for view in self.axes.values():
            for data in view.news(now, IDLE_PERIOD):
                self.tell(data)
            self._is_changed |= view.is_changed
            view.is_changed = False
        for browser in self.browsers:
            is_back = browser.is_behind and browser.is_ready
            if is_back or (self._is_changed and not browser.is_behind):
                browser.greet(self._greeting(browser.language, now))
        self._is_changed = False

    def _greeting(self, language: str, now: float) -> Iterable[bytes]:
        yield frame('hello', self.hello(language))
        if self.clock is not None:
            yield frame('clock', self.clock())
        for view in self.axes.values():
            yield from view.greeting(now)

    def hello(self, language: str = ENGLISH) -> dict[str, Any]:
        """Return who is there, and the words of a language."""
        nodes: dict[str, str] = {}
        for view in self.axes.values():
            if nodes.get(view.node, GONE) == GONE:
                nodes[view.node] = view.standing
        return {
            'version': VERSION,
            'acting': self.acting,
            'language': language,
            'words': languages()[language],
            'waiting': '' if self.axes else self._waiting,
            'notices': [words for _, words in sorted(self.notices.items())],
            'nodes': [{'name': name, 'state': state} for name, state in sorted(nodes.items())],
            'axes': [self.axes[name].hello() for name in sorted(self.axes)],
        }
