# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A real browser driven over the DevTools protocol, and a server that speaks in frames by hand."""

import asyncio
import base64
import collections
import contextlib
from http import HTTPStatus
import json
from pathlib import Path
import shutil
import struct
import subprocess
import threading
import types

from ballscrew_monitor.page.history import COLUMNS
import numpy as np
import pytest

DEADLINE = 600.0  # [s] which only ends a hang
ROOT = Path(__file__).resolve().parents[4]
OWN = ROOT / 'ballscrew_monitor' / 'page' / 'components'
LANGUAGES = ROOT / 'ballscrew_monitor' / 'page' / 'languages'
BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
# The clock by which data grow old goes slowly: none do while a machine is busy elsewhere.
WATCHED = """
    {
      const clock = performance.now.bind(performance);
      performance.now = () => clock() / 1000;
    }
    window.violations = [];
    document.addEventListener('securitypolicyviolation', (event) => {
      window.violations.push(`${event.violatedDirective} ${event.blockedURI}`);
    });
"""
KEYS = {'Enter': 13, 'ArrowLeft': 37, 'ArrowUp': 38, 'ArrowRight': 39, 'ArrowDown': 40, 'Tab': 9}
BEGIN = 1_767_600_000.0
"""Stamp of the first row [s]."""


class Tab:
    """A tab of the browser, by its session."""

    def __init__(self, browser, wait_for):
        self.browser, self.wait_for = browser, wait_for
        target = browser.call('Target.createTarget', url='about:blank')['targetId']
        attached = browser.call('Target.attachToTarget', targetId=target, flatten=True)
        self.target, self.session = target, attached['sessionId']
        self.call('Page.enable')
        self.call('Page.bringToFront')
        self.call('Page.addScriptToEvaluateOnNewDocument', source=WATCHED)

    def call(self, method, **params):
        return self.browser.call(method, self.session, **params)

    def close(self):
        self.browser.call('Target.closeTarget', targetId=self.target)

    def visit(self, url, *, width=1280, height=900, dark=False, language='en'):
        """Open a page in a window of a size, light or dark, for a reader of a language."""
        scheme = {'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}
        self.call('Emulation.setEmulatedMedia', features=[scheme])
        self.resize(width, height)
        self.call('Network.enable')
        self.call('Network.setExtraHTTPHeaders', headers={'Accept-Language': language})
        self.call('Page.navigate', url=url)

    def resize(self, width, height):
        size = {'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': width < 600}
        self.call('Emulation.setDeviceMetricsOverride', **size)

    def ask(self, expression):
        """Return the value of an expression in the page."""
        result = self.call(
            'Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True
        )
        assert 'exceptionDetails' not in result, result['exceptionDetails']
        return result['result'].get('value')

    def until(self, expression):
        """Wait until an expression gives something true."""
        self.wait_for(lambda: self.ask(f'Boolean({expression})'), expression)

    def text(self, selector):
        return self.ask(f'document.querySelector({json.dumps(selector)})?.textContent')

    def texts(self, selector):
        """Return the texts of all elements that match."""
        return self.ask(f"""[...document.querySelectorAll({json.dumps(selector)})]
            .map((one) => one.textContent)""")

    def button(self, place, text):
        """Press the button of a text in a place of the page."""
        self.ask(f"""[...document.querySelectorAll({json.dumps(place + ' button')})]
            .find((one) => one.textContent === {json.dumps(text)}).click()""")

    def reads(self, selector, text):
        """Wait until an element reads so."""
        self.until(
            f'document.querySelector({json.dumps(selector)})?.textContent === {json.dumps(text)}'
        )

    def click(self, selector):
        self.ask(f'document.querySelector({json.dumps(selector)}).click()')

    def press(self, key):
        code = {'key': key, 'code': key, 'windowsVirtualKeyCode': KEYS[key]}
        typed = {'text': '\r'} if key == 'Enter' else {}
        self.call('Input.dispatchKeyEvent', type='keyDown', **code, **typed)
        self.call('Input.dispatchKeyEvent', type='keyUp', **code)

    def failures(self):
        return self.ask('document.body?.dataset.errors')

    def picture(self, path):
        """Write what the window shows as a PNG."""
        data = self.call('Page.captureScreenshot', format='png')['data']
        path.write_bytes(base64.b64decode(data))


class Browser:
    """The connection to a running browser: calls with their results, events left aside."""

    def __init__(self, socket):
        self.socket, self.number = socket, 0
        self.events = collections.deque(maxlen=100)

    def call(self, method, session=None, **params):
        self.number += 1
        sent = {'id': self.number, 'method': method, 'params': params}
        self.socket.send(json.dumps(sent | ({'sessionId': session} if session else {})))
        while (heard := json.loads(self.socket.recv())).get('id') != self.number:
            self.events.append(heard)
        assert 'error' not in heard, heard
        return heard['result']


@pytest.fixture(scope='session')
def browser(tmp_path_factory, wait_for):
    """Return a browser without a window."""
    client = pytest.importorskip('websockets.sync.client')
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        pytest.skip('no chromium to open the page in, install the package of that name')
    profile = tmp_path_factory.mktemp('browser')
    options = '--headless --no-sandbox --disable-gpu --hide-scrollbars --remote-debugging-port=0'
    command = [found, *options.split(), f'--user-data-dir={profile}', 'about:blank']
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    port = profile / 'DevToolsActivePort'
    try:
        lines = wait_for(lambda: port.exists() and len(port.read_text().split('\n')) > 1, 'a port')
        lines = port.read_text().split('\n')
        address = f'ws://127.0.0.1:{lines[0]}{lines[1]}'
        with client.connect(address, max_size=None) as socket:
            yield Browser(socket)
    finally:
        process.terminate()
        process.wait()


@pytest.fixture
def tab(browser, wait_for):
    """Return a tab, of which the page neither failed nor broke its policy."""
    made = Tab(browser, wait_for)
    try:
        yield made
        assert made.failures() in ('', None)
        assert made.ask('window.violations') in ([], None)
    finally:
        made.close()


def encoded(record, arrays=None):
    """Return a frame: the length of its JSON, the JSON padded, and arrays of float64."""
    arrays = {name: np.asarray(one, dtype='<f8').ravel() for name, one in (arrays or {}).items()}
    record = record | {'arrays': [[name, one.size] for name, one in arrays.items()]}
    text = json.dumps(record, allow_nan=False).encode()
    text += b' ' * (-(4 + len(text)) % 8)
    return struct.pack('<I', len(text)) + text + b''.join(one.tobytes() for one in arrays.values())


class FakeServer:
    """A server of the page that sends the frames it is given and keeps what it is asked."""

    def __init__(self):
        self.loop = asyncio.new_event_loop()
        self.thread = threading.Thread(target=self.loop.run_forever, daemon=True)
        self.thread.start()
        self.port, self.server, self.requests, self.greeting = 0, None, [], []
        self.clients, self.answers = set(), {}
        self.language = 'en'
        self.start()

    def run(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self.loop).result()

    @property
    def url(self):
        return f'http://127.0.0.1:{self.port}/'

    def start(self):
        self.server = self.run(self._serve())
        self.port = self.server.sockets[0].getsockname()[1]

    async def _serve(self):
        from websockets.asyncio.server import serve

        return await serve(self._speak, '127.0.0.1', self.port, process_request=self._get)

    def stop(self):
        """Let go of every client, as a server does that ends."""
        self.server.close()
        self.run(self.server.wait_closed())

    def end(self):
        self.stop()
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()
        self.loop.close()

    def _get(self, connection, request):
        """Serve the files of the real page; None lets a socket open."""
        from ballscrew_monitor.page import components

        if request.path == '/live':
            return None
        if request.path == '/':
            # A tab of some browsers has its language for the page alone, and not for the socket.
            self.language = components.language_of(request.headers.get('Accept-Language', ''))
            return self._respond(connection, components.index(self.language), 'text/html')
        known = components.table().get(request.path.removeprefix('/components/'))
        if known is None:
            return connection.respond(HTTPStatus.NOT_FOUND, '')
        return self._respond(connection, known[0].decode(), known[1])

    def _respond(self, connection, text, kind):
        from ballscrew_monitor.page.guard import POLICY

        response = connection.respond(HTTPStatus.OK, text)
        del response.headers['Content-Type']
        response.headers['Content-Type'] = kind
        response.headers['Content-Security-Policy'] = POLICY
        return response

    async def _speak(self, connection):
        from websockets import ConnectionClosed

        for record, arrays in self.greeting:
            more = {'language': self.language, 'words': words(self.language)}
            greets = record['kind'] == 'hello'
            await connection.send(encoded(record | (more if greets else {}), arrays))
        self.clients.add(connection)
        with contextlib.suppress(ConnectionClosed):
            async for text in connection:
                request = json.loads(text)
                self.requests.append(request)
                for record, arrays in self.answers.get(request['do'], lambda one: [])(request):
                    await connection.send(encoded({'id': request['id']} | record, arrays))
        self.clients.discard(connection)

    def send(self, record, arrays=None):
        """Send a frame to every client."""
        self.run(self._send(encoded(record, arrays)))

    async def _send(self, data):
        for client in tuple(self.clients):
            await client.send(data)


def words(language):
    return json.loads((LANGUAGES / f'{language}.json').read_text(encoding='utf-8'))


@pytest.fixture
def server():
    """Return a server that greets with nothing."""
    pytest.importorskip('websockets')
    made = FakeServer()
    yield made
    made.end()


def make_axis(name='x', **changes):
    """Return what a hello says of an axis."""
    facts = {
        'id': f'/ballscrew_monitor/{name}',
        'node': '/ballscrew_monitor',
        'axis': name,
        'screw': 'nominal',
        'oil': 'ISO VG 68',
        'lead_mm': 10.0,
        'unit': 'm/min',
        'efficiency_limit': 0.85,
        'rcs_limit': 0.01,
        'light_load_N': 250.0,
        'standstill_rpm': 5.0,
        'grades': ['ISO VG 46', 'ISO VG 100'],
        'temperature_low_degC': 20.0,
        'temperature_high_degC': 60.0,
        'speed_low_rpm': 20.0,
        'speed_high_rpm': 2100.0,
        'load_low_N': -4000.0,
        'load_high_N': 4000.0,
        'no_map': '',
    }
    return facts | changes


def make_hello(*axes, **changes):
    hello = {'kind': 'hello', 'version': 1, 'acting': False, 'nodes': [], 'notices': []}
    return hello | {'waiting': '', 'axes': list(axes)} | changes, None


def make_rows(count, begin=0.0, rate=50.0, **changes):
    """Return columns of so many rows from a time on [s]; the speed [rev/min] swings."""
    time = begin + np.arange(count) / rate
    speed = 1200.0 * np.sin(0.3 * time)
    rows = {
        'stamp': BEGIN + time,
        'speed_rpm': speed,
        'load_N': -900.0 * np.sign(speed) + 200.0 * np.cos(0.7 * time),
        'temperature_degC': 35.0 + 0.01 * time,
        'efficiency': 0.93 + 0.03 * np.sin(time),
        'rcs': 10.0 ** (-3.0 + 0.9 * np.cos(0.3 * time)),
        'film_ratio': 1.5 + 1.2 * np.abs(np.sin(0.3 * time)),
        'torque_N_m': 1.5 * np.sign(speed),
        'measured_torque_N_m': 1.55 * np.sign(speed) + 0.02 * np.sin(9.0 * time),
        'level': np.ones(count),
    }
    rows |= {name: np.broadcast_to(value, count) for name, value in changes.items()}
    return {name: rows[name] for name in COLUMNS}


def make_state(axis='x', rows=None, **changes):
    """Return the frame of a state in the optimal zone."""
    record = {
        'kind': 'state',
        'axis': f'/ballscrew_monitor/{axis}',
        'level': 'ok',
        'zone': 'optimal',
        'headline': 'The oil film carries the load and little is lost to friction.',
        'advice': '',
        'age_s': 0.02,
        'inputs': [
            {'name': name, 'state': 'ok', 'age_s': 0.01, 'words': ''}
            for name in ('speed', 'load', 'temperature')
        ],
        'shelved': None,
        'event': None,
        'totals': make_totals(),
        'limit': {'speed_rpm': 590.0},
    }
    return record | changes, make_rows(1) if rows is None else rows


def make_totals():
    return {
        'running_time': 46.2 * 3600,
        'unjudged_time': 0.0,
        'boundary_time': 3600.0,
        'mixed_time': 36 * 3600.0,
        'hydrodynamic_time': 9.2 * 3600,
        'optimal_time': 40 * 3600.0,
        'outside_time': 6.2 * 3600,
        'revolutions': 842_800.0,
        'energy_lost': 1_259_000.0,
        'since': BEGIN,
    }


def make_health(condition='normal', **changes):
    """Return what a state says of the condition."""
    known = {'low': 0.92, 'high': 1.04, 'unit': '-', 'known': True}
    health = {
        'condition': condition,
        'notes': [],
        'verdict': 'The friction is as it was in the reference run.',
        'advice': '',
        'quantities': [
            {'name': 'preload', 'value': 0.98} | known,
            {'name': 'drag change', 'value': 0.03} | known | {'low': -0.02, 'high': 0.08},
            {'name': 'hours left at this programme', 'value': 8200.0, 'low': 6100.0}
            | {'high': 11000.0, 'unit': 'h', 'known': True},
            {'name': 'share of life used', 'value': None, 'low': None, 'high': None}
            | {'unit': '-', 'known': False, 'words': {'free': 'not known yet: no whole day'}},
        ],
    }
    return health | changes


def make_map(axis='x', **changes):
    """Return the frame of a map whose limit leans to higher speeds with the load."""
    columns, rows = 72, 48
    low, high, least, most = 5.0, 2100.0, -1900.0, 3400.0
    speed = low * (high / low) ** ((np.arange(columns) + 0.5) / columns)
    load = least + (most - least) * (np.arange(rows) + 0.5) / rows
    limit = 250.0 + 0.02 * np.abs(load)
    efficiency = np.clip(
        1.0 - 30.0 * (1 + speed[None] / 1500.0) / (60 + np.abs(load[:, None])), 0, 1
    )
    rcs = np.clip(0.01 * (limit[:, None] / speed[None]) ** 3, 1e-6, 1.0)
    light = np.abs(load[:, None]) < 250.0
    zone = ((rcs < 0.01) & (light | (efficiency >= 0.85))).astype(float)
    along = np.linspace(least, most, 60)
    edge = 250.0 + 0.02 * np.abs(along)
    arrays = {
        'cells': {'rcs': rcs, 'film_ratio': speed[None] / 200.0 + 0.0 * rcs}.get(
            changes.get('quantity'), efficiency
        ),
        'zone': zone,
        'dwell': np.zeros((rows, columns)),
    }
    lines = []
    for kind, factor in (
        ('band_unknown', 0.6),
        ('band_unknown', 1.4),
        ('band_numerical', 0.93),
        ('band_numerical', 1.07),
        ('rcs', 1.0),
    ):
        name = f'line{len(lines)}'
        label = '35 °C' if kind == 'rcs' else ''
        lines.append({'kind': kind, 'label': label, 'array': name, 'height': 0.88})
        arrays[name] = np.column_stack([factor * edge, along])
    record = {
        'kind': 'map',
        'axis': f'/ballscrew_monitor/{axis}',
        'quantity': 'efficiency',
        'temperature_degC': 35.0,
        'speed': {'low': low, 'high': high, 'scale': 'log'},
        'load': {'low': least, 'high': most},
        'columns': columns,
        'rows': rows,
        'lines': lines,
        'light_load_N': 250.0,
        'without': 0,
    }
    return record | changes, arrays


def make_events(axis='x', *events):
    common = {
        'id': 3,
        'begin': BEGIN + 20.0,
        'duration_s': 8.4,
        'quantity': 'rcs',
        'worst': 0.12,
        'limit': 0.01,
        'advice': 'At this load run at 6.4 m/min (640 rev/min) or faster.',
        'active': False,
        'acknowledged': False,
        'acknowledged_by': '',
        'acknowledge_reason': '',
        'shelved': False,
    }
    listed = [common | event for event in events]
    return {'kind': 'events', 'axis': f'/ballscrew_monitor/{axis}', 'events': listed}, None


@pytest.fixture(scope='session')
def frames():
    """Make the frames that a server sends."""
    return types.SimpleNamespace(
        begin=BEGIN,
        columns=COLUMNS,
        encoded=encoded,
        own=OWN,
        languages=LANGUAGES,
        words=words,
        axis=make_axis,
        hello=make_hello,
        rows=make_rows,
        state=make_state,
        health=make_health,
        map=make_map,
        events=make_events,
    )


@pytest.fixture
def greeted(server, frames):
    """Return the server, which greets with one axis, its history, map, warnings and state."""
    history = {'kind': 'history', 'axis': '/ballscrew_monitor/x'}
    server.greeting = [
        frames.hello(frames.axis()),
        (history, frames.rows(3000, -60.0)),
        frames.map(),
        frames.events('x', {}),
        frames.state(health=frames.health()),
    ]
    return server
