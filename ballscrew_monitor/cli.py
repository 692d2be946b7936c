# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The `ballscrew` command.

Subcommands that need ROS import it in their handlers, so that the offline ones start fast.

"""

import argparse
import json
import math
import os
from pathlib import Path
import shlex
import signal
import sys
import tempfile
import traceback
from typing import Any

from ballscrew_monitor import options
from ballscrew_monitor.core.interrupts import (
    BAD_INPUT,
    FAILED,
    leave_to_python,
    raise_signals,
    SIGNALLED,
)
from ballscrew_monitor.core.prerequisites import refuse, require
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.settings.middleware import check_middleware
from surrogate.commands.cli import add_commands, Parser
from surrogate.files import InputError, printable
from surrogate.surface import SurfaceError
from surrogate.units import RPM

BUG, INTERRUPTED = 70, SIGNALLED + signal.SIGINT
NODE = 'ballscrew_monitor'  # the default name of the node
# Facts of the event log that are sentences or words: the first that is not empty is printed.
EXIT_CODES = {
    0: 'done',
    1: 'ran, but a check failed, a solve did not converge, nothing could be judged, or there are '
    'findings',
    BAD_INPUT: 'bad input: one sentence says what, where and what is allowed; or a package is '
    'missing: the sentence says how to get it',
    BUG: 'a fault of the program: one sentence names the file, which `report-fault` makes ready '
    'to be sent',
    INTERRUPTED: 'ended by SIGINT (Ctrl-C); the node itself and `ballscrew page` end with 0',
    SIGNALLED
    + signal.SIGTERM: 'ended by SIGTERM; the node itself and `ballscrew page` end with 0',
}
"""Meaning of the exit codes of all commands."""
TOLD = ('text', 'ending', 'advice', 'reason', 'until', 'result', 'sha256')


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    args = command_parser().parse_args(arguments)
    try:
        return _ended(args)
    except Exception:  # noqa: BLE001 whatever it is, a person reads one sentence
        return _failed()


def _failed() -> int:
    """Write what went wrong to a file, and say where it is."""
    text = f'{shlex.join(sys.argv)}\nPython {sys.version}\n{traceback.format_exc()}'
    number, path = tempfile.mkstemp(prefix='ballscrew_failure_', suffix='.txt')
    with os.fdopen(number, 'w', encoding='utf-8', errors='backslashreplace') as file:
        file.write(text)
    line = text.strip().splitlines()[-1][:300]
    say(
        f'this is a fault of the program ({line}): ballscrew report-fault makes one file to send '
        f'of it and of {path}'
    )
    return BUG


def _ended(args: argparse.Namespace) -> int:
    """Run a command; return the exit code that belongs to how it ended."""
    try:
        if args.handler in WITH_ROS:
            # It is loaded with rclpy, and what does not suit it ends the process without a word.
            check_middleware(discovers=args.handler in DISCOVERING)
        else:
            leave_to_python()
        return int(args.handler(args))
    except (InputError, SurfaceError) as error:
        say(str(error))
        return BAD_INPUT
    except ImportError as error:
        return refuse('ballscrew', error)
    except BrokenPipeError:
        # The reader, such as `head`, has seen enough; nothing may be written at exit either.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except OSError as error:
        place = error.filename or getattr(args, 'out', None) or 'the output'
        say(f'{place} cannot be read or written, {error.strerror}')
        return FAILED
    except KeyboardInterrupt:
        say('interrupted')
        return INTERRUPTED


def command_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    parser = Parser(
        prog='ballscrew',
        description='Lubrication and efficiency of ball screws: model, surface '
        'files, and the monitor at work on a recorded cycle.',
    )
    subparsers = parser.add_subparsers(required=True, metavar='COMMAND')
    for name, (handler, text) in COMMANDS.items():
        command = subparsers.add_parser(name, help=text, epilog=options.ENDINGS.get(name))
        command.set_defaults(handler=handler)
        getattr(options, f'add_{name.replace("-", "_")}')(command)
    add_commands(subparsers, {'bag': _read_bag, 'table': _read_table})
    return parser


def _run(args: argparse.Namespace) -> int:
    from ballscrew_monitor.cycle.outcome import plan
    from ballscrew_monitor.cycle.run import run

    # The log files of ROS belong to this run, not to the home directory.
    os.environ.setdefault('ROS_LOG_DIR', str(args.out.resolve() / 'ros_log'))
    return run(plan(args.bag, args.params, args.out, args.rate))


def _replay(args: argparse.Namespace) -> int:
    from ballscrew_monitor.report.command import replay_command

    raise_signals()
    return replay_command(args, options.PARAMS)


def _check(args: argparse.Namespace) -> int:
    from ballscrew_monitor.report.check import check_command

    raise_signals()
    return check_command(args, options.PARAMS)


def _health(args: argparse.Namespace) -> int:
    from ballscrew_monitor.report.health_command import health_command

    raise_signals()
    return health_command(args, options.PARAMS)


def _fingerprint(args: argparse.Namespace) -> int:
    from ballscrew_monitor.report.fingerprint_command import fingerprint_command

    return fingerprint_command(args)


def _import(args: argparse.Namespace) -> int:
    from ballscrew_monitor.recordings.tables.convert import make_bag, print_guess

    raise_signals()
    if args.guess:
        print_guess(args.log)
    else:
        make_bag(args.log, args.config, args.out)
    return 0


def _read_bag(args: argparse.Namespace, lead: float) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return torque over speed out of a bag, for `identify`; the lead of the screw [m]."""
    from ballscrew_monitor.recordings import no_load
    from ballscrew_monitor.recordings.opener import opened_log

    check_middleware(discovers=False)
    for name in ('speed_topic', 'speed_field', 'torque_field'):
        if getattr(args, name) is None:
            raise InputError(f'--{name.replace("_", "-")} is missing, a bag needs it')
    scale = 1.0 if args.torque_scale is None else args.torque_scale
    unit, torque_topic = args.speed_unit or 'rad/s', args.torque_topic or args.speed_topic
    channels = [
        no_load.speed_channel(args.speed_topic, args.speed_field, unit, lead),
        no_load.torque_channel(torque_topic, args.torque_field, scale),
    ]
    if args.temperature_topic:
        field = args.temperature_field or 'temperature'
        channels.append(no_load.temperature_channel(args.temperature_topic, field))
    bag = opened_log(args.data)
    columns, notes = no_load.read_no_load(bag, channels)
    return columns, (*bag.notes, *notes)


def _read_table(args: argparse.Namespace, lead: float) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return torque over speed out of a table, for `identify`; the lead of the screw [m]."""
    from ballscrew_monitor.recordings.tables.points import PointColumns, read_points

    asked = PointColumns(
        lead=lead,
        torque_constant=args.torque_constant,
        speed_column=args.speed_column,
        torque_column=args.torque_column,
    )
    return read_points(args.data, asked)


def _solve(args: argparse.Namespace) -> int:
    from ballscrew_monitor.clients.solve import ask, goal_of

    goal = goal_of(
        args.axis,
        speed=math.nan if args.speed_rpm is None else args.speed_rpm * RPM,
        load=math.nan if args.load is None else args.load,
        temperature=math.nan if args.temperature is None else args.temperature,
        timeout=args.timeout,
    )
    return ask(goal, args.node, wait=args.wait, as_json=args.json)


def _doctor(args: argparse.Namespace) -> int:
    from ballscrew_monitor.clients.doctor import doctor

    require('ballscrew_msgs')  # the node does not start without it
    return doctor(args.params, seconds=args.seconds, as_json=args.json)


def _events(args: argparse.Namespace) -> int:
    """Print the event log of a folder, else that of the node by its default name."""
    from ballscrew_monitor.node.restart_state import AUTO, state_directory
    from ballscrew_monitor.node.state_database import read_entries

    for entry in read_entries(args.folder or state_directory(AUTO, NODE) or Path()):
        record = entry.record()
        if args.json:
            print(json.dumps(record))
            continue
        event = f'event {record["event"]}' if 'event' in record else ''
        subject = next((str(record[name]) for name in TOLD if record.get(name)), '')
        by = f'by {record["name"]}' if record.get('name') else ''
        words = ': '.join(filter(None, (event, by, subject)))
        line = f'{entry.time}  {entry.axis or "-":<8}  {entry.kind!s:<14}  {words}'
        print(printable(line.rstrip()))
    return 0


def _report_fault(args: argparse.Namespace) -> int:
    from ballscrew_monitor.clients.fault_report import report_command

    require('ballscrew_msgs')
    return report_command(args)


def _recover(args: argparse.Namespace) -> int:
    from ballscrew_monitor.recordings.recover import recover

    path, count, seconds, lost = recover(args.file)
    print('; '.join(filter(None, [f'{path}: {count} messages of {seconds:.1f} s', lost])))
    return 0


def _play(args: argparse.Namespace) -> int:
    from ballscrew_monitor.recordings.player import playback

    return playback(
        args.bag,
        args.params,
        args.topics,
        every=args.all,
        rate=args.rate,
        patience=args.wait,
        loop=args.loop,
    )


def _page(args: argparse.Namespace) -> int:
    from ballscrew_monitor.page.command import page_command

    return page_command(args, options.PARAMS)


COMMANDS = {
    'run': (_run, 'play a bag into the real node over DDS and record what it says'),
    'replay': (_replay, 'judge a log without DDS, faster than real time'),
    'check': (_check, 'go from a folder of logs and a datasheet to one page'),
    'health': (_health, 'tell whether axes are normal or worse, by their logs over months'),
    'fingerprint': (_fingerprint, 'print a reference run for `health` as a part program'),
    'import': (_import, 'make a bag of a machine log: CSV, Parquet or xlsx'),
    'solve': (_solve, 'ask the running node for a full solve of a point'),
    'doctor': (_doctor, 'compare the running ROS graph with a parameter file, and say the cure'),
    'events': (_events, 'print the event log of a node out of its state_dir'),
    'play': (_play, 'play the inputs of the node from a bag over DDS, with /clock'),
    'page': (_page, 'serve a live page of all axes to browsers'),
    'report-fault': (_report_fault, 'make one file to send when something fails'),
    'recover': (_recover, 'mend a recording whose writer was killed'),
}
"""Handler and help of each command; `options` adds what it may be told."""
DISCOVERING = (_solve, _doctor, _play, _page)
"""Commands that need others in the ROS graph."""
WITH_ROS = (_run, _replay, _check, _health, _import, _report_fault, *DISCOVERING)
"""Commands that need ROS; they put in order themselves what a signal would leave behind."""
