# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the node itself; those of its axes are in `axis_parameters`."""

from ballscrew_monitor.settings.parameter_row import Change, ParameterRow

RECORD_ROWS = (
    ParameterRow(
        name='record',
        default='off',
        choices=('off', 'around_events', 'always'),
        text='What the node records of itself: inputs, states, warnings and all a replay needs.',
    ),
    ParameterRow(
        name='record_dir',
        default='auto',
        text='Directory of the recordings; auto: recordings in state_dir.',
    ),
    ParameterRow(
        name='record_before',
        default=60.0,
        unit='s',
        low=20.0,
        high=3600.0,
        text='How much of the time before an event is recorded around it.',
    ),
    ParameterRow(
        name='record_after',
        default=10.0,
        unit='s',
        low=1.0,
        high=3600.0,
        text='How much of the time after the begin or the end of an event is recorded.',
    ),
    ParameterRow(
        name='record_longest',
        default=3600.0,
        unit='s',
        low=10.0,
        high=86400.0,
        text='Length after which a recording is finished and the next one begins.',
    ),
    ParameterRow(
        name='record_largest',
        default=256.0,
        unit='MB',
        low=1.0,
        high=65536.0,
        text='Size after which a recording is finished, before compression.',
    ),
    ParameterRow(
        name='record_total',
        default=2048.0,
        unit='MB',
        low=2.0,
        high=1e6,
        text='Size of all recordings; the oldest make room for new ones.',
    ),
)

NODE_ROWS = (
    ParameterRow(
        name='axes',
        default=['x'],
        change=Change.NEVER,
        text='Names of the axes, lower case; each has parameters and topics under its name.',
    ),
    ParameterRow(
        name='autostart',
        default=True,
        change=Change.NEVER,
        text='Configure and activate at start; false under a lifecycle manager.',
    ),
    ParameterRow(
        name='localhost',
        default=False,
        change=Change.NEVER,
        text='Bind every port of the node to 127.0.0.1: no other machine reaches it.',
    ),
    ParameterRow(
        name='tick_period',
        default=0.1,
        unit='s',
        low=0.01,
        high=10.0,
        change=Change.NEVER,
        text='Grid of stamps on which a state is published while the speed is missing.',
    ),
    ParameterRow(
        name='state_dir',
        default='auto',
        change=Change.NEVER,
        text='Directory for what outlives the node, for this node alone; auto: '
        '$XDG_STATE_HOME/ballscrew_monitor/<name of the node>; empty: nothing is kept.',
    ),
    ParameterRow(
        name='state_limit',
        default=64.0,
        unit='MB',
        low=1.0,
        high=1e6,
        change=Change.NEVER,
        text='Limit of what is kept in state_dir; the oldest entries of the event log go first.',
    ),
    ParameterRow(
        name='diagnostics_period',
        default=1.0,
        unit='s',
        low=0.1,
        high=60.0,
        change=Change.NEVER,
        text='Period of /diagnostics; a change is published at once.',
    ),
    *RECORD_ROWS,
)
