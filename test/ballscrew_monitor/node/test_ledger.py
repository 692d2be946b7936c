# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What is written when: at once, but never in a flood, and again until it works."""

import json

from ballscrew_monitor.core.memory import Memory
from ballscrew_monitor.core.tally import Totals
from ballscrew_monitor.node import ledger as ledger_module
from ballscrew_monitor.node.event_log import EventLog
from ballscrew_monitor.node.ledger import Ledger, LINES, MEMORIES, Scribe
from ballscrew_monitor.node.memory_store import MemoryStore
from ballscrew_monitor.node.state_folder import StateFolder
import pytest


@pytest.fixture(name='folder')
def make_folder(tmp_path):
    folder = StateFolder(tmp_path)
    yield folder
    folder.close()


def memory(time):
    return Memory(totals=Totals(running_time=time))


def logged(folder):
    path = folder.path / 'events.jsonl'
    return path.read_text().split() if path.exists() else []


def kept(folder):
    return MemoryStore(folder).load('x').totals.running_time


def test_a_flood_is_written_in_turns(folder):
    ledger = Ledger(folder)
    assert ledger.work(0.0) is None
    ledger.note('1')
    ledger.remember('x', memory(1))
    assert ledger.work(10.0) is None
    assert (logged(folder), kept(folder)) == (['1'], 1)
    ledger.note('2')
    ledger.remember('x', memory(2))
    ledger.remember('x', memory(3))
    assert ledger.work(10.0) == 10.0 + LINES
    assert ledger.waiting('x') == memory(3)
    assert ledger.work(10.0 + LINES) == 10.0 + MEMORIES
    assert (logged(folder), kept(folder)) == (['1', '2'], 1)
    ledger.note('3')
    assert ledger.work(10.0 + MEMORIES) is None
    assert (logged(folder), kept(folder)) == (['1', '2', '3'], 3)
    assert ledger.waiting('x') is None


def spoil(folder):
    """Let the folder be where nothing can be written; return where it was."""
    place, folder.path = folder.path, folder.path / 'file'
    folder.path.write_text('no directory')
    return place


def test_what_cannot_be_written_waits(folder):
    ledger = Ledger(folder)
    place = spoil(folder)
    ledger.note('1')
    ledger.remember('x', memory(1))
    assert ledger.work(0.0) == MEMORIES
    assert ledger.problem == f'{place}/file cannot be written, Not a directory'
    ledger.note('2')
    ledger.remember('x', memory(2))
    assert ledger.flush() == ledger.problem
    folder.path = place
    assert ledger.work(MEMORIES) is None
    assert ledger.problem == ''
    assert (logged(folder), kept(folder)) == (['1', '2'], 2)


def test_what_waits_is_bounded_and_the_oldest_go(folder, monkeypatch):
    monkeypatch.setattr(ledger_module, 'MOST_LINES', 3)
    ledger = Ledger(folder)
    place = spoil(folder)
    for number in range(5):
        ledger.note(str(number))
        ledger.flush()
    folder.path = place
    ledger.flush()
    assert logged(folder) == ['2', '3', '4']


def test_a_thread_writes_what_comes(folder):
    ledger = Ledger(folder)
    scribe = Scribe(ledger)
    scribe.start()
    for number in range(100):
        ledger.note(json.dumps(number))
    scribe.stop()
    assert not scribe.is_alive()
    ledger.flush()
    assert logged(folder) == [str(number) for number in range(100)]


def test_what_fails_unexpectedly_waits_is_told_and_ends_no_thread(folder, monkeypatch):
    def fail(*_):
        raise ValueError('surprise')

    ledger = Ledger(folder)
    ledger.note('1')
    ledger.remember('x', memory(1))
    with monkeypatch.context() as broken:
        broken.setattr(EventLog, 'append', fail)
        broken.setattr(MemoryStore, 'save', fail)
        assert ledger.work(0.0) == MEMORIES
        told = 'what is to be kept cannot be written, ValueError: surprise'
        assert ledger.flush() == ledger.problem == told
    assert ledger.flush() == ''
    assert (logged(folder), kept(folder)) == (['1'], 1)


def test_a_scribe_that_never_began_stops(folder):
    Scribe(Ledger(folder)).stop()
