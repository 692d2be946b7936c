# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`python -m ballscrew_monitor`, and the executable `ballscrew`."""

import io
import signal
import sys

from ballscrew_monitor.core.interrupts import end_at_once
from ballscrew_monitor.core.prerequisites import refuse


def main() -> int:
    """Run the command line; return the exit code."""
    end_at_once()  # before the imports that take long
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # not every terminal has all characters
            stream.reconfigure(errors='replace')
    try:
        from ballscrew_monitor import cli
    except ImportError as error:
        return refuse('ballscrew', error)

    code = cli.main()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # it has ended; Python clears up
    return code


if __name__ == '__main__':
    sys.exit(main())
