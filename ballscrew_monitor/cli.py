# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The `ballscrew` command.

Subcommands that need ROS import it in their handlers, so that the offline ones start fast.

"""

import argparse
import math
import os
from pathlib import Path
import signal
import sys
from typing import Any

from ballscrew_monitor.recordings.interrupts import FAILED, SIGNALLED
from surrogate.cli import add_commands
from surrogate.files import InputError, json_text
from surrogate.surface import SurfaceError
from surrogate.units import RPM

TREE = Path(__file__).resolve().parent.parent
"""The repository, when the package runs from it: the defaults hold in any working directory."""
BAG, PARAMS = TREE / 'bags' / 'nominal_cycle', TREE / 'config' / 'nominal_cycle.yaml'
BAG_TEXT, PARAMS_TEXT = (f'{path.relative_to(TREE)} of the repository' for path in (BAG, PARAMS))
OUT = Path('out')
BAD_INPUT, INTERRUPTED = 2, SIGNALLED + signal.SIGINT
# What some commands need beyond the rest, and how to get it.
NEEDED = {
    'mcap': 'pip install mcap zstandard',
    'zstandard': 'pip install mcap zstandard',
    'rosbags': 'pip install rosbags',
    'apsw': 'pip install rosbags',
    'polars': 'pip install polars',
    'matplotlib': 'pip install matplotlib',
    'rclpy': 'source the set-up file of ROS 2',
    'ballscrew_msgs': 'source the set-up file of the workspace in which it was built',
}


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    args = _parser().parse_args(arguments)
    try:
        return int(args.handler(args))
    except (InputError, SurfaceError) as error:
        print(f'ballscrew: {error}', file=sys.stderr)
        return BAD_INPUT
    except ImportError as error:
        package = (error.name or '').split('.')[0]
        if package not in NEEDED:
            raise
        print(
            f'ballscrew: {package} is not installed, this command needs it: {NEEDED[package]}',
            file=sys.stderr,
        )
        return FAILED
    except BrokenPipeError:
        # The reader, such as `head`, has seen enough; nothing may be written at exit either.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except OSError as error:
        place = error.filename or getattr(args, 'out', None) or 'the output'
        print(f'ballscrew: {place} cannot be read or written, {error.strerror}', file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print('ballscrew: interrupted', file=sys.stderr)
        return INTERRUPTED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog='ballscrew',
        description='Lubrication and efficiency of ball screws: model, surface '
        'files, and the monitor at work on a recorded cycle.',
    )
    subparsers = parser.add_subparsers(required=True, metavar='COMMAND')
    _add_run(
        subparsers.add_parser(
            'run', help='play a bag into the real node over DDS and record what it says'
        )
    )
    _add_replay(
        subparsers.add_parser('replay', help='judge a log without DDS, faster than real time')
    )
    _add_import(
        subparsers.add_parser('import', help='make a bag of a machine log, CSV or Parquet')
    )
    _add_solve(
        subparsers.add_parser('solve', help='ask the running node for a full solve of a point')
    )
    _add_doctor(
        subparsers.add_parser(
            'doctor', help='compare the running ROS graph with a parameter file, and say the cure'
        )
    )
    _add_play(subparsers.add_parser('play', help='play a bag over DDS, with /clock'))
    _add_recover(subparsers.add_parser('recover', help='mend a recording whose writer was killed'))
    add_commands(subparsers, _read_bag)
    return parser


def _add_params(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--params',
        type=Path,
        default=PARAMS,
        metavar='FILE',
        help=f'parameters of the node (default {PARAMS_TEXT})',
    )


def _add_run(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--bag', type=Path, default=BAG, help=f'bag to play (default {BAG_TEXT})')
    _add_params(parser)
    parser.add_argument(
        '--out',
        type=Path,
        default=OUT,
        metavar='DIR',
        help='directory for recording, picture and log (default %(default)s)',
    )
    parser.add_argument(
        '--rate', type=float, default=1.0, help='bag time over wall time (default 1)'
    )
    parser.set_defaults(handler=_run)


def _add_replay(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        'bag', type=Path, metavar='LOG', help='bag directory or file; CSV or Parquet with --map'
    )
    parser.add_argument(
        '--map', type=Path, metavar='FILE', help='map of the columns of a CSV or Parquet file'
    )
    parser.add_argument(
        '--params',
        type=Path,
        metavar='FILE',
        help=f'parameters of the node (default those that the log carries, else {PARAMS_TEXT})',
    )
    parser.add_argument('--json', action='store_true', help='print JSON')
    parser.set_defaults(handler=_replay)


def _add_import(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('log', type=Path, metavar='LOG', help='CSV or Parquet file')
    parser.add_argument(
        '--guess', action='store_true', help='print a first map of the columns, and nothing else'
    )
    parser.add_argument('--config', type=Path, metavar='MAP', help='map of the columns')
    parser.add_argument('--out', type=Path, metavar='BAG', help='directory of the bag to be made')
    parser.set_defaults(handler=_import)


def _add_play(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bag', type=Path, metavar='BAG', help='bag directory or MCAP file')
    parser.add_argument(
        '--rate', type=float, default=1.0, help='bag time over wall time (default 1)'
    )
    parser.add_argument(
        '--wait',
        type=float,
        default=10.0,
        metavar='SECONDS',
        help='longest wait for a subscriber of every topic (default 10)',
    )
    parser.set_defaults(handler=_play)


def _add_recover(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        'file', type=Path, metavar='FILE', help='MCAP file, or the folder of an unfinished one'
    )
    parser.set_defaults(handler=_recover)


def _add_doctor(parser: argparse.ArgumentParser) -> None:
    _add_params(parser)
    parser.add_argument(
        '--seconds',
        type=float,
        default=3.0,
        metavar='T',
        help='how long to listen (default 3); longer for slow topics',
    )
    parser.add_argument('--json', action='store_true', help='print JSON')
    parser.set_defaults(handler=_doctor)


def _add_solve(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--axis', required=True, help='name of the axis, such as x')
    parser.add_argument(
        '--speed-rpm',
        type=float,
        metavar='N',
        help='screw speed [rev/min]; none: the current point',
    )
    parser.add_argument(
        '--load-N',
        type=float,
        dest='load',
        metavar='F',
        help='axial load [N]; it opposes the motion when it has the sign of the speed',
    )
    parser.add_argument(
        '--temperature-degC',
        type=float,
        dest='temperature',
        metavar='T',
        help='oil temperature [degC] (default that of the axis)',
    )
    parser.add_argument(
        '--timeout',
        type=float,
        default=0.0,
        metavar='SECONDS',
        help="longest solve (default the node's)",
    )
    parser.add_argument('--node', default='', help='full name of the node, if there are several')
    parser.add_argument(
        '--wait',
        type=float,
        default=10.0,
        metavar='SECONDS',
        help='longest wait for the node (default 10)',
    )
    parser.add_argument('--json', action='store_true', help='print JSON')
    parser.set_defaults(handler=_solve)


def _run(args: argparse.Namespace) -> int:
    from ballscrew_monitor.cycle.plan import plan
    from ballscrew_monitor.cycle.run import run

    # The log files of ROS belong to this run, not to the home directory.
    os.environ.setdefault('ROS_LOG_DIR', str(args.out.resolve() / 'ros_log'))
    return run(plan(args.bag, args.params, args.out, args.rate))


def _replay(args: argparse.Namespace) -> int:
    from ballscrew_monitor.recordings.log_facts import facts_of, values_for
    from ballscrew_monitor.recordings.opener import opened_log
    from ballscrew_monitor.recordings.replay import replay
    from ballscrew_monitor.recordings.summary import Summarizer

    with opened_log(args.bag, mapping=args.map) as bag:
        values, whose = values_for(bag, args.params, PARAMS)
        facts = facts_of(bag)
        _say(f'parameters: {whose}', *(facts.sentences() if facts else ()))
        summarizers = {axis: Summarizer() for axis in values['axes']}
        reasons = dict.fromkeys(values['axes'], '')
        for judged in replay(bag, values):
            reasons[judged.state.axis] = judged.state.result.reason
            summarizers[judged.state.axis].add_state(judged.state)
            if judged.event is not None:
                summarizers[judged.state.axis].add_event(judged.event)
        results = {axis: made.result() for axis, made in summarizers.items()}
        silent = [axis for axis, made in results.items() if made is None or made.says_nothing]
        _say(*bag.notes, *_silences(bag, values, {axis: reasons[axis] for axis in silent}))
    if args.json:
        print(json_text({axis: made and made.record() for axis, made in results.items()}))
    else:
        for axis, result in results.items():
            _print_summary(axis, result)
    return FAILED if len(silent) == len(results) else 0


def _silences(bag: Any, values: dict[str, Any], silent: dict[str, str]) -> list[str]:
    """Return a sentence for each axis of which nothing was judged, with its last reason."""
    from ballscrew_monitor.node.axis import build_axis
    from ballscrew_monitor.node.topics import with_types
    from ballscrew_monitor.recordings.decoding import silence

    full = with_types(values, bag.types)
    sentences = []
    for axis, last in silent.items():
        reason = silence(bag, build_axis(axis, full))
        if reason or not last:
            last = (
                'topics, fields and joints of its parameters must be those of '
                f'{bag.path}{f"; {reason}" if reason else ""}'
            )
        sentences.append(f'nothing was judged on axis {axis}: {last}')
    return sentences


def _import(args: argparse.Namespace) -> int:
    from ballscrew_monitor.recordings.tables.command import make_bag, print_guess

    if args.guess:
        print_guess(args.log)
    else:
        make_bag(args.log, args.config, args.out)
    return 0


def _say(*sentences: str) -> None:
    for sentence in sentences:
        print(f'ballscrew: {sentence}', file=sys.stderr)


def _print_summary(axis: str, result: Any) -> None:
    if result is None:
        print(f'axis {axis}: no state')
        return
    print(f'axis {axis}: {result.judged} speed samples judged')
    print('\n'.join(f'  {line}' for line in result.lines()))


def _read_bag(args: argparse.Namespace, lead: float) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return torque over speed out of a bag, for `identify`; the lead of the screw [m]."""
    from ballscrew_monitor.core.inputs import Source
    from ballscrew_monitor.recordings import no_load as no_load_bag
    from ballscrew_monitor.recordings.opener import opened_log

    for name in ('speed_topic', 'speed_field', 'torque_field'):
        if getattr(args, name) is None:
            raise InputError(f'--{name.replace("_", "-")} is missing, a bag needs it')
    scale = 1.0 if args.torque_scale is None else args.torque_scale
    channels = {
        Source.SPEED: no_load_bag.speed_channel(
            args.speed_topic, args.speed_field, args.speed_unit or 'rad/s', lead
        ),
        Source.TORQUE: no_load_bag.torque_channel(
            args.torque_topic or args.speed_topic, args.torque_field, scale
        ),
    }
    if args.temperature_topic:
        channels[Source.TEMPERATURE] = no_load_bag.temperature_channel(
            args.temperature_topic, args.temperature_field or 'temperature'
        )
    with opened_log(args.data) as bag:
        columns, notes = no_load_bag.read_no_load(bag, channels)
        return columns, (*bag.notes, *notes)


def _solve(args: argparse.Namespace) -> int:
    from ballscrew_monitor.clients.solve import ask, Question

    question = Question(
        axis=args.axis,
        speed=math.nan if args.speed_rpm is None else args.speed_rpm * RPM,
        load=math.nan if args.load is None else args.load,
        temperature=math.nan if args.temperature is None else args.temperature,
        timeout=args.timeout,
        node=args.node,
    )
    return ask(question, wait=args.wait, as_json=args.json)


def _doctor(args: argparse.Namespace) -> int:
    from ballscrew_monitor.clients.doctor import doctor

    return doctor(args.params, seconds=args.seconds, as_json=args.json)


def _recover(args: argparse.Namespace) -> int:
    from ballscrew_monitor.recordings.recover import recover

    path, count, seconds = recover(args.file)
    print(f'{path}: {count} messages of {seconds:.1f} s')
    return 0


def _play(args: argparse.Namespace) -> int:
    from ballscrew_monitor.recordings.playback import playback

    return playback(args.bag, rate=args.rate, patience=args.wait)


if __name__ == '__main__':
    sys.exit(main())
