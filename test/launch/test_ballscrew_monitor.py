# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The launch file, with stand-ins for the launch packages, which are not in the wheels.

They record what they are called with, so this shows what the file asks for and not that launch
does it.

"""

import pathlib
import runpy
import sys
import types
from unittest import mock

import pytest
from surrogate.files import InputError

FILE = pathlib.Path(__file__).resolve().parents[2] / 'launch' / 'ballscrew_monitor.launch.py'
NAMES = (
    *'launch launch.actions launch.substitutions launch_ros launch_ros.actions'.split(),
    *'launch_ros.parameter_descriptions'.split(),
)


@pytest.fixture
def launched(monkeypatch):
    """Return a function that runs the file with some arguments; it gives arguments and node."""
    given = dict.fromkeys(('params_file', 'use_sim_time', 'autostart'), '')
    given |= {'respawn': 'false', 'respawn_delay': '2.0', 'page': 'false'}
    recorder = mock.MagicMock()
    recorder.DeclareLaunchArgument.side_effect = lambda name, **facts: (name, facts)
    recorder.OpaqueFunction.side_effect = lambda *, function: function(None)
    recorder.LaunchConfiguration.side_effect = lambda name: types.SimpleNamespace(
        name=name, perform=lambda context: given[name]
    )
    recorder.LaunchDescription.side_effect = list
    recorder.Shutdown.side_effect = lambda *, reason: reason
    recorder.LogInfo.side_effect = lambda *, msg: msg
    for name in NAMES:
        monkeypatch.setitem(sys.modules, name, recorder)

    def run(**arguments):
        given.update(arguments)
        *declared, nodes = runpy.run_path(str(FILE))['generate_launch_description']()
        assert len(nodes) == 1 + (given['page'] == 'true')
        return dict(declared), recorder.LifecycleNode.call_args.kwargs

    return run


def test_arguments_have_defaults_and_descriptions(launched):
    declared, _ = launched(params_file='')
    names = 'params_file namespace use_sim_time log_level autostart respawn page respawn_delay'
    assert list(declared) == names.split()
    for facts in declared.values():
        assert facts['description'].endswith('.')
        assert isinstance(facts['default_value'], str)


@pytest.fixture
def mine(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'mine.yaml').write_text('')
    return 'mine.yaml'


@pytest.mark.parametrize(('file', 'files'), [('', []), ('mine.yaml', ['mine.yaml'])])
def test_the_node_is_the_one_of_the_package(launched, mine, file, files):
    _, node = launched(params_file=file)
    assert {node[name] for name in ('package', 'executable', 'name')} == {'ballscrew_monitor'}
    assert node['parameters'] == files


@pytest.mark.parametrize('name', ['use_sim_time', 'autostart'])
def test_an_argument_overrides_the_file_only_if_it_is_given(launched, mine, name):
    declared, _ = launched()
    assert declared[name]['default_value'] == ''
    _, node = launched(params_file=mine, **{name: 'false'})
    file, switches = node['parameters']
    assert file == mine
    assert list(switches) == [name]


@pytest.mark.parametrize('name', ['yours.yaml', '.'])
def test_a_parameter_file_that_is_not_there_is_an_error(launched, mine, name):
    with pytest.raises(InputError, match=f'^params_file is {name}, there is no such file'):
        launched(params_file=name)


@pytest.fixture
def ended():
    """Return the event of launch at the end of a process."""
    return types.SimpleNamespace(process_name='ballscrew_monitor-1', returncode=0)


def test_the_launch_ends_as_its_node_ends(launched, ended):
    _, node = launched()
    assert node['respawn'] is False
    running = types.SimpleNamespace(is_shutdown=False)
    assert node['on_exit'](ended, running) == 'ballscrew_monitor-1 has ended'
    ended.returncode = 2
    with pytest.raises(RuntimeError, match='^ballscrew_monitor-1 has ended with exit code 2$'):
        node['on_exit'](ended, running)


def test_a_launch_that_is_ending_is_not_ended_again(launched, ended):
    """After Ctrl-C the node ends with 0, and launch fails if it is asked to shut down again."""
    _, node = launched()
    ending = types.SimpleNamespace(is_shutdown=True)
    assert node['on_exit'](ended, ending) is None
    sys.modules['launch.actions'].Shutdown.assert_not_called()
    ended.returncode = -9  # the node did not heed it
    with pytest.raises(RuntimeError, match='^ballscrew_monitor-1 has ended with exit code -9$'):
        node['on_exit'](ended, ending)


def test_a_node_that_is_to_be_started_again_does_not_end_the_launch(launched):
    _, node = launched(respawn='true', respawn_delay='0.5')
    assert (node['respawn'], node['respawn_delay'], node['on_exit']) == (True, 0.5, None)


def test_the_page_is_a_process_beside_the_node(launched):
    launched(page='true')
    command = sys.modules['launch.actions'].ExecuteProcess.call_args.kwargs['cmd']
    assert command == [sys.executable, '-m', 'ballscrew_monitor', 'page']


@pytest.mark.parametrize('code', [0, 1])
def test_a_page_that_ends_is_said_and_ends_nothing(launched, ended, says, code):
    launched(page='true')
    ended.process_name, ended.returncode = 'python3-2', code
    end = sys.modules['launch.actions'].ExecuteProcess.call_args.kwargs['on_exit']
    context = types.SimpleNamespace(is_shutdown=False)
    assert end(ended, context) == says('page_ended', code=code)
    context.is_shutdown = True  # it ends with all others
    assert end(ended, context) is None
    sys.modules['launch.actions'].Shutdown.assert_not_called()
