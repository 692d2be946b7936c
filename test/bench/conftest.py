# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parts of the benches, which are scripts beside the packages, as modules."""

from pathlib import Path
import sys

# Last, so that no script hides a module.
sys.path.append(str(Path(__file__).resolve().parents[2] / 'bench'))
