# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The cases: each makes its outputs, texts and tables by name, in an empty folder."""

import functools

from golden import doors, inputs, tables


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


CASES = {name: functools.partial(scenario, name) for name in inputs.RECORDINGS}
CASES |= {name: functools.partial(table, write) for name, write in tables.TABLES.items()}
CASES |= {'refused_tables': refused_tables}
"""What makes the outputs of each case in a folder."""
