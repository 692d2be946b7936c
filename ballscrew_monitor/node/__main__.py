# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`python -m ballscrew_monitor.node`, and the executable `ballscrew_monitor`."""

import signal
import sys


def main(args: list[str] | None = None) -> int:
    """Run the node until SIGINT or SIGTERM; return 0, or 2 if it cannot start."""
    # First of all: what follows takes a second to import, and a signal may come meanwhile.
    stop: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, frame: stop.append(received))
    from ballscrew_monitor.core.prerequisites import refuse
    from ballscrew_monitor.settings.middleware import check_middleware
    from surrogate.files import InputError

    try:
        check_middleware()
    except InputError as error:
        print(f'ballscrew_monitor: {error}', file=sys.stderr)
        return 2
    try:
        from ballscrew_monitor.node.run import run
    except ImportError as error:
        return refuse('ballscrew_monitor', error)

    return run(args, stop)


if __name__ == '__main__':
    sys.exit(main())
