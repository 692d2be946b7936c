# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew page` as the console script."""

import contextlib
import http.client
import io
import json
from pathlib import Path
import re
import signal
import ssl
import struct
import subprocess
import sys
import urllib.request
import zipfile

from ballscrew_monitor import cli
from ballscrew_monitor.page.components import languages
import pytest
from websockets.sync.client import connect

SCRIPT = Path(sys.executable).with_name('ballscrew')
DEADLINE = 600.0  # [s] which only ends a hang
TOKEN = 'correct horse battery staple'


def begin(node, *arguments):
    """Start the command in the domain of a node; return its process and its address."""
    process = subprocess.Popen(
        [SCRIPT, 'page', '--port', '0', *map(str, arguments)],
        env=node.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    line = process.stdout.readline()
    assert line.startswith('page http'), line + process.communicate()[1]
    return process, line.split()[1]


@contextlib.contextmanager
def running(node, *arguments, number=signal.SIGINT):
    """Give the address of a page, which ends with 0 and without a word."""
    process, url = begin(node, *arguments)
    try:
        yield url
    finally:
        process.send_signal(number)
        out, err = process.communicate(timeout=DEADLINE)
    assert (process.returncode, out, err) == (0, '', '')


def frames(url):
    """Yield the records of frames."""
    with connect(
        f'ws{url.removeprefix("http")}live', origin=url.rstrip('/'), max_size=None
    ) as live:
        for made in live:
            (size,) = struct.unpack_from('<I', made)
            end = 4 + size
            yield json.loads(made[4:end])


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_without_a_node_the_page_waits_and_a_signal_ends_it(node, number):
    with running(node, number=number) as url:
        record = next(frames(url))
        assert record['waiting']
        assert record['axes'] == []


def test_a_node_is_shown_with_its_map(node):
    with running(node) as url:
        node.start(x__max_future=3600.0)
        states, publish = node.watched()
        publish(100.0, -500.0)
        node.until(lambda: states and states[-1].judged, 'the judged point')
        found = {}
        for record in frames(url):
            found[record['kind']] = record
            publish(100.0, -500.0)
            if 'map' in found and found.get('state', {}).get('level', 'unknown') != 'unknown':
                break
        assert found['map']['axis'] == '/ballscrew_monitor/x'
        with urllib.request.urlopen(f'{url}metrics') as answer:
            text = answer.read().decode()
        assert re.search(r'ballscrew_level{axis="x",node="/ballscrew_monitor"} [12]\.0', text)


def test_two_pages_on_one_port(node, says):
    with running(node) as url:
        port = url.rstrip('/').rpartition(':')[2]
        done = subprocess.run(
            [SCRIPT, 'page', '--port', port],
            env=node.environment,
            capture_output=True,
            text=True,
            check=False,
        )
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == says('port', port=port)


def test_a_certificate_makes_it_https(node, tmp_path):
    cert, key = tmp_path / 'cert.pem', tmp_path / 'key.pem'
    made = ['openssl', 'req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-subj', '/CN=localhost']
    made += ['-addext', 'subjectAltName=IP:127.0.0.1', '-keyout', key, '-out', cert]
    try:
        subprocess.run(made, check=True, capture_output=True)
    except FileNotFoundError:
        pytest.skip('openssl is not installed')
    token = tmp_path / 'token'
    token.write_text(TOKEN)
    context = ssl.create_default_context(cafile=cert)
    options = ('--cert', cert, '--key', key, '--token-file', token)
    with running(node, *options) as url:
        host = url.removeprefix('https://').rstrip('/')
        connection = http.client.HTTPSConnection(host, context=context)
        with contextlib.closing(connection):
            connection.request('POST', '/login', f'token={TOKEN.replace(" ", "+")}')
            answer = connection.getresponse()
            assert answer.status == 303
            assert 'Secure' in answer.headers['Set-Cookie'].split('; ')


@pytest.mark.parametrize(
    ('arguments', 'key'),
    [
        (['--host', '0.0.0.0'], 'others'),
        (['--cert', 'x'], 'cert_alone'),
        (['--cert', 'x', '--key', 'y'], 'cert_missing'),
        (['--port', '70000'], 'port_range'),
        (['--token-file', 'none'], 'token'),
        (['--oils', 'none.npz'], 'oils'),
        (['--map', 'x'], 'of_recording'),
        (['x.mcap', '--allow-acting'], 'of_nodes'),
        (['x.mcap'], 'no_log'),
        (['--host', '203.0.113.7', '--token-file', 'TOKEN'], 'not_here'),
    ],
)
def test_wrong_options_are_one_sentence(tmp_path, monkeypatch, capsys, says, arguments, key):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'TOKEN').write_text(TOKEN)
    assert cli.main(['page', *arguments]) == 2
    assert capsys.readouterr().err == f'ballscrew: {says(key)}\n'


def test_a_language_that_is_not_there_is_refused(capsys, says):
    assert cli.main(['page', '--language', 'xx']) == 2
    known = ', '.join(sorted(languages()))
    assert capsys.readouterr().err == f'ballscrew: {says("language", known=known)}\n'


def test_only_loopback_is_bound_unless_told(node, bound_addresses):
    process, url = begin(node)
    try:
        port = int(url.rstrip('/').rpartition(':')[2])
        assert ('127.0.0.1', port) in bound_addresses(process.pid)
        assert ('0.0.0.0', port) not in bound_addresses(process.pid)
    finally:
        process.terminate()
        process.communicate(timeout=DEADLINE)


def test_a_recording_is_played(node, short_bag):
    """Without a node, from its begin; the clock says so."""
    process, url = begin(node, short_bag)
    try:
        kinds = {}
        for record in frames(url):
            kinds[record['kind']] = record
            if {'clock', 'state', 'map'} <= kinds.keys():
                break
        assert kinds['clock']['span_s'] == pytest.approx(3.0, abs=0.1)
        assert kinds['hello']['axes'][0]['node'] == short_bag.name
        with urllib.request.urlopen(f'{url}report-fault', b'') as answer:
            archive = zipfile.ZipFile(io.BytesIO(answer.read()))
        known = json.loads(archive.read(f'page_{short_bag.name}_x.json'))
        assert known['parameters']['axes'] == ['x']
        assert {'log_1/log_1.mcap', 'versions.json'} <= {*archive.namelist()}
    finally:
        process.terminate()
        process.communicate(timeout=DEADLINE)
    assert process.returncode == 0


def test_what_is_odd_about_a_recording_is_said_once(node, miscounted_bag):
    process, _ = begin(node, miscounted_bag)
    process.terminate()
    said = process.communicate(timeout=DEADLINE)[1].splitlines()
    lines = [line for line in said if 'counts other messages' in line]
    assert [line.startswith(f'ballscrew: bag {miscounted_bag}: ') for line in lines] == [True]
