# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The sentences that tests ask for by a key, and the nominal cycle as a bag, whole and in part."""

from contextlib import contextmanager
from functools import cache
import gc
import importlib
from importlib.abc import MetaPathFinder
import os
from pathlib import Path
import re
import shutil
from string import Formatter
import sys
import time
import tomllib

from hypothesis import HealthCheck, Phase, settings
from hypothesis.database import DirectoryBasedExampleDatabase
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
DEADLINE = 600.0  # [s] which only ends a hang, in this file as in all others
# No package of a machine with ROS 2.
OPTIONAL = 'contourpy fastexcel mcap mcap_ros2 numba polars rosbags zstandard'.split()
OPTIONAL += 'h11 prometheus_client starlette uvicorn websockets'.split()
# Tests that solve contacts, talk over DDS, start processes, draw many pictures, repeat thousands
# of fits or run linters over the whole tree: folders and files, and fixtures that make any test
# such a one. All others are `fast`.
SLOW = (
    'bags',
    'ballscrew_monitor/cycle/test_domain.py',
    'ballscrew_monitor/cycle/test_node_process.py',
    'ballscrew_monitor/cycle/test_run.py',
    'ballscrew_monitor/clients/test_solve.py',
    'ballscrew_monitor/core/test_prerequisites.py',
    'ballscrew_monitor/judge/test_many.py',
    'ballscrew_monitor/page/test_acting.py',
    'ballscrew_monitor/page/test_command.py',
    'ballscrew_monitor/page/test_ros_side.py',
    'ballscrew_monitor/node/test_clocks.py',
    'ballscrew_monitor/node/test_kept.py',
    'ballscrew_monitor/node/test_loss.py',
    'ballscrew_monitor/node/test_motor_torque.py',
    'ballscrew_monitor/node/test_faults.py',
    'ballscrew_monitor/node/test_heartbeat.py',
    'ballscrew_monitor/settings/test_middleware.py',
    'ballscrew_monitor/node/test_node.py',
    'ballscrew_monitor/node/test_solve.py',
    'ballscrew_monitor/node/test_system.py',
    'ballscrew_monitor/page/components',
    'ballscrew_monitor/recordings/test_axis_run.py',
    'ballscrew_monitor/recordings/test_black_box.py',
    'ballscrew_monitor/recordings/test_player.py',
    'ballscrew_monitor/recordings/test_recorder.py',
    'ballscrew_monitor/report/test_command.py',
    'ballscrew_monitor/report/test_log_page.py',
    'ballscrew_monitor/report/test_memory.py',
    'ballscrew_monitor/report/test_buckets.py',
    'ballscrew_monitor/report/test_time_series.py',
    'ballscrew_monitor/test_cli.py',
    'ballscrew_monitor/test_exit_codes.py',
    'ballscrew_monitor/test_hostile.py',
    'ballscrew_monitor/test_mutations.py',
    'ballscrew_monitor/test_signals.py',
    'config/test_workspace.py',
    'golden',
    'launch',
    'scripts',
    'surrogate/asperities/test_law.py',
    'surrogate/builder',
    'surrogate/commands',
    'surrogate/contact',
    'surrogate/ehl',
    'surrogate/formulas/test_inlet.py',
    'surrogate/formulas/test_line.py',
    'surrogate/identify/test_fit.py',
    'surrogate/identify/test_table.py',
    'surrogate/raceway/test_scaling.py',
    'surrogate/raceway/test_short_waves.py',
    'surrogate/screw',
    'surrogate/studies/test_curves.py',
    'surrogate/studies/test_figures.py',
    'surrogate/studies/test_report.py',
    'surrogate/studies/test_validation.py',
    'surrogate/surface_tools/test_figures.py',
    'surrogate/tasks/test_pool.py',
    'surrogate/tasks/test_child.py',
    'surrogate/tasks/test_store.py',
    'surrogate/commands/test_cli.py',
    'test_conftest.py',
    'test_interfaces.py',
    'test_linters.py',
)
SLOW_FIXTURES = {'nominal_bag', 'short_bag'}

# The machine is shared with others: how long an example takes says nothing about the code.
UNHURRIED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
# `make test` draws the same few examples each time: whoever changed no code sees no failure.
settings.register_profile('same', UNHURRIED, derandomize=True, database=None, max_examples=30)
# `make fuzz` draws others each time, more of them, and begins with those that failed before.
settings.register_profile(
    'fuzz',
    UNHURRIED,
    derandomize=False,
    database=DirectoryBasedExampleDatabase(ROOT / '.hypothesis' / 'examples'),
    max_examples=1000,
    print_blob=True,
)
# `make mutate` asks whether a mutant fails, not for the smallest example of it.
settings.register_profile(
    'mutate', settings.get_profile('same'), phases=[Phase.explicit, Phase.generate]
)
settings.load_profile(os.environ.get('HYPOTHESIS_PROFILE', 'same'))


class Skipper(MetaPathFinder):
    """Skips what imports an optional package, after every other finder has found nothing."""

    def find_spec(self, name, path=None, target=None):
        if name in OPTIONAL:
            pytest.skip(f'{name} is not installed', allow_module_level=True)


# Thousands of tests are a million objects that live on, among which garbage is rarely looked for:
# that took a quarter of the time until the first test began.
gc.set_threshold(50_000, 20, 20)

sys.meta_path.append(Skipper())
sys.path.append(str(ROOT / 'bags'))  # the generators are scripts beside each other
sys.path.append(str(ROOT / 'test' / 'golden'))  # what makes the golden outputs


def pytest_collection_finish():
    """Leave what has been collected out of every later search for garbage."""
    gc.freeze()


def pytest_collection_modifyitems(items):
    """Mark what is fast, all but what is named as slow; linters come first, so long are they."""
    items.sort(key=lambda item: item.get_closest_marker('linter') is None)
    for item in items:
        if not is_slow(item.path) and SLOW_FIXTURES.isdisjoint(item.fixturenames):
            item.add_marker('fast')


@cache
def is_slow(path):
    """Return True if a file of tests, or a folder above it, is named as slow."""
    return any(path.is_relative_to(ROOT / 'test' / name) for name in SLOW)


def _pause():
    """Leave the processor to whoever is waited for."""
    time.sleep(0.005)


def _wait_for(condition, what='the condition', *, meanwhile=_pause, deadline=DEADLINE):
    """
    Call `meanwhile` until `condition` gives something true, and return that.

    The condition has the last word: a machine that stood still past the deadline [s] is well.

    """
    end = time.monotonic() + deadline
    while not (result := condition()):
        assert time.monotonic() < end, f'{what} did not come'
        meanwhile()
    return result


@pytest.fixture(scope='session')
def wait_for():
    """Return the one function by which a test waits; all of it is `_wait_for`."""
    return _wait_for


def _filled(sentence, values):
    """Return a sentence with all of its values, and none that it does not name."""
    assert {name for _, name, *_ in Formatter().parse(sentence) if name} == values.keys(), sentence
    return sentence.format(**values)


@contextmanager
def _refusal(sentence, values):
    """Hold that the block raises just this: an InputError, or what the sentence begins with."""
    with pytest.raises(Exception, match='.') as caught:
        yield caught
    kind, said = type(caught.value).__name__, str(caught.value)
    text = said if kind == 'InputError' else f'{kind}: {said}'
    parts = _filled(sentence.replace('{...}', '\0'), values).split('\0')
    pattern = '.*'.join(map(re.escape, parts))
    assert re.fullmatch(pattern, text, re.DOTALL), f'{text!r} is not {sentence!r}'


@pytest.fixture(scope='session')
def golden_sentences():
    """Return every sentence of the golden file: by the file of tests, then by its key."""
    text = (ROOT / 'test' / 'data' / 'sentences.toml').read_text(encoding='utf-8')
    return tomllib.loads(text)


@pytest.fixture(scope='module')
def says(request, golden_sentences):
    """Return the function that gives a sentence of this file of tests by its key and values."""
    sentences = golden_sentences[str(request.path.relative_to(ROOT / 'test'))]
    return lambda key, /, **values: _filled(sentences[key], values)


@pytest.fixture(scope='module')
def refused(request, golden_sentences):
    """
    Return the function that holds that a call, or a block without one, is refused as a key says.

    `refused(key, call, *arguments)` or `with refused(key, **values)`.

    """
    sentences = golden_sentences[str(request.path.relative_to(ROOT / 'test'))]

    def refuse(key, call=None, /, *args, **named):
        if call is None:
            return _refusal(sentences[key], named)
        with _refusal(sentences[key], {}) as caught:
            call(*args, **named)
        return caught

    return refuse


@pytest.fixture(scope='session')
def nominal_cycle():
    """Return the generator as a module."""
    return importlib.import_module('nominal_cycle')


@pytest.fixture(scope='session')
def nominal_bag(nominal_cycle, tmp_path_factory):
    """Return the directory of the whole cycle."""
    directory = tmp_path_factory.mktemp('bags') / 'nominal_cycle'
    nominal_cycle.generate(directory)
    return directory


@pytest.fixture(scope='session')
def short_bag(nominal_bag, tmp_path_factory):
    """
    Return the directory of 3 s of it: creeping with its warning, and a standstill.

    It begins with the oil temperature, as the cycle does: a node on a busy machine may judge a
    speed before it looks for the temperature of the same stamp.

    """
    from ballscrew_monitor.recordings.bag import Bag

    directory = tmp_path_factory.mktemp('bags') / 'short'
    cut(Bag(nominal_bag), directory, 32.9999, 36.005)
    return directory


@pytest.fixture
def miscounted_bag(short_bag, tmp_path):
    """Return a copy of it whose metadata count one message too many of each topic."""
    copy = shutil.copytree(short_bag, tmp_path / 'miscounted')
    metadata = copy / 'metadata.yaml'
    content = yaml.safe_load(metadata.read_text())
    for topic in content['rosbag2_bagfile_information']['topics_with_message_count']:
        topic['message_count'] += 1
    metadata.write_text(yaml.safe_dump(content))
    return copy


@pytest.fixture
def dask_address():
    """Return the address of a Dask scheduler with one worker, a thread of this process."""
    distributed = pytest.importorskip('distributed')
    with distributed.LocalCluster(
        n_workers=1,
        threads_per_worker=1,
        processes=False,
        protocol='tcp',
        dashboard_address='127.0.0.1:0',
        silence_logs='ERROR',
    ) as cluster:
        yield cluster.scheduler_address


def cut(bag, directory, begin, end):
    """Write the messages of `bag` from `begin` to `end` [s] to a bag of their own."""
    low, high = (bag.start_time + round(at * 1e9) for at in (begin, end))
    _copy(bag, directory, lambda one: one.data if low <= one.log_time < high else None)


def _copy(bag, directory, data_of):
    """Write a bag with the data that a function gives for each message, and return it."""
    from ballscrew_monitor.recordings.bag import Bag
    from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic

    with BagWriter(directory, directory.name) as writer:
        for name, info in bag.topics.items():
            writer.add_topic(Topic(name=name, type_name=info.type_name, offer=Offer.SENSOR))
        for message in bag.messages():
            if (data := data_of(message)) is not None:
                times = {'log_time': message.log_time, 'publish_time': message.publish_time}
                writer.write(message.topic, data, **times)
    return Bag(directory)


@pytest.fixture(scope='session')
def copy_bag():
    """Return what copies a bag with some messages damaged or left out."""
    return _copy
