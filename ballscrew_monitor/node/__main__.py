# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`python -m ballscrew_monitor.node`, and the executable `ballscrew_monitor`."""

import sys

from ballscrew_monitor.node.node import main

if __name__ == '__main__':
    sys.exit(main())
