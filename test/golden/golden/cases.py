# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The cases: each makes its outputs, texts and tables by name, in an empty folder."""

import functools
from unittest import mock

from ballscrew_monitor.report import health_collect
from golden import bags, doors, graph, inputs, live, tables


def scenario(name, folder):
    """Return what is said of a scenario of `bags/`."""
    bag, parameters = inputs.scenario(folder, name)
    given = (bag, '--params', parameters)
    outputs = doors.report(folder, folder / 'report', *given)
    return outputs | {'json': doors.command(folder, 'replay', *given, '--json')}


def table(write, folder):
    """Return what is said of a table: its guessed map, its report, and the bag made of it."""
    log, text = write(folder)
    mapping, bag = folder / 'map.yaml', folder / 'bag'
    mapping.write_text(text, 'utf-8')
    outputs = doors.report(folder, folder / 'report', log, '--map', mapping)
    guessed = doors.command(folder, 'import', log, '--guess')
    made = doors.command(folder, 'import', log, '--config', mapping, '--out', bag)
    judged = doors.command(folder, 'replay', bag, '--json')
    return outputs | {
        'guess': guessed,
        'import': made + judged,
        'bag': doors.bag_text(folder, bag),
    }


def refused_tables(folder):
    """Return what is said of tables that cannot be judged, or not as their maps ask."""
    said = []
    for name, (log, mapping) in tables.REFUSED.items():
        log_file, map_file = folder / f'{name}.csv', folder / f'{name}.yaml'
        log_file.write_text(log, 'utf-8')
        map_file.write_text(mapping, 'utf-8')
        said.append(doors.command(folder, 'replay', log_file, '--map', map_file))
    said.append(doors.command(folder, 'import', log_file, '--guess'))
    said.append(doors.command(folder, 'import', map_file, '--guess'))
    said.append(doors.command(folder, 'replay', log_file))
    return {'said': ''.join(said)}


def foreign_bag(write, folder):
    """Return what is said of a bag of another program, also where the parameters do not suit."""
    bag, parameters = write(folder)
    given = (bag, '--params', parameters)
    nominal = folder / 'nominal.yaml'
    nominal.write_text(inputs.changed(inputs.NOMINAL_PARAMETERS.read_text()))
    outputs = doors.report(folder, folder / 'report', *given)
    other = doors.command(folder, 'replay', bag, '--params', nominal)
    return outputs | {'json': doors.command(folder, 'replay', *given, '--json'), 'other': other}


def damaged_bag(folder):
    """Return what is said of a bag whose writer was killed, before and after it is mended."""
    part, parameters = bags.truncated_mcap(folder)
    before = doors.command(folder, 'replay', part, '--params', parameters)
    mended = doors.command(folder, 'recover', part)
    after = doors.command(folder, 'replay', part.with_suffix(''), '--params', parameters)
    again = doors.command(folder, 'recover', part)
    empty = folder / 'empty.mcap'
    empty.write_bytes(b'')
    other = [
        doors.command(folder, 'replay', path, '--params', parameters)
        for path in (empty, folder / 'none', folder)
    ]
    return {'said': ''.join([before, mended, after, again, *other])}


def health(folder):
    """Return what is said of the health of an axis over months, and of many logs at once."""
    logs = inputs.months(folder / 'logs')
    out, reports = folder / 'health', folder / 'reports'
    given = ('--baseline', '2026-01-05', '2026-02-16')
    with mock.patch.object(health_collect, 'FEW', inputs.PLAN.logs):  # in this process
        kept = doors.command(folder, 'health', logs, *given, '--out', out, '--json')
        words = doors.command(folder, 'health', logs)
    many = doors.command(folder, 'replay', logs, '--out', reports, '--workers', '1')
    return {
        'words': words,
        'json': kept,
        'file': doors.json_text(folder, out / 'health.json'),
        'many_said': many + doors.command(folder, 'replay', logs),
        'many_page': doors.page_of(folder, reports / 'index.html'),
        'one_page': doors.page_of(folder, reports / 'month_9' / 'report.html'),
    }


def page(folder):
    """Return what browsers are sent of recordings."""
    bag, parameters = inputs.scenario(folder, 'vertical_axis')
    press, both = bags.sqlite_bag(folder)
    return {
        'one_axis': doors.frames_text(bag, parameters),
        'two_axes': doors.frames_text(press, both),
    }


def node_runs(folder):
    """Return what the node says in two runs, its event log and the tables that it keeps."""
    outputs = {f'{name}_first': one for name, one in live.first_run(folder).items()}
    outputs |= {f'{name}_second': one for name, one in live.second_run(folder).items()}
    state = folder / 'state'
    return outputs | {
        'events': doors.command(folder, 'events', state),
        'events_json': doors.command(folder, 'events', state, '--json'),
        'kept': live.kept(folder),
    }


def live_node(folder):
    """Return what the node says in two runs, and what is left of them: kept and recorded."""
    outputs = node_runs(folder)
    state, given = folder / 'state', ('--params', folder / 'node.yaml')
    recordings = sorted((state / 'recordings').iterdir())
    long, short = recordings[-2:]  # with and after all that happens; one before it is cut off
    reported = doors.report(folder, folder / 'report', long, words=False)
    outputs |= {f'recording_{name}': one for name, one in reported.items()}
    other = doors.command(folder, 'replay', short) + doors.command(folder, 'replay', long, *given)
    health = doors.command(folder, 'health', state, *given)
    return outputs | {
        'health': health + doors.command(folder, 'health', state, *given, '--json'),
        'recording_other': other,
    }


CASES = {name: functools.partial(scenario, name) for name in inputs.RECORDINGS}
CASES |= {name: functools.partial(table, write) for name, write in tables.TABLES.items()}
CASES |= {name: functools.partial(foreign_bag, write) for name, write in bags.FOREIGN.items()}
CASES |= {
    'damaged_bag': damaged_bag,
    'doctor': graph.doctor,
    'health': health,
    'live': live_node,
    'page': page,
    'refused_tables': refused_tables,
}
"""What makes the outputs of each case in a folder."""
