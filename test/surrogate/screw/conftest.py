# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The way to `coulomb`, the friction law that the tests of the ball share."""

from pathlib import Path
import sys

sys.path.append(str(Path(__file__).parent))
