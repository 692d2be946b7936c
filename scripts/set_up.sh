#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# Everything that `make run` and `make test` need: prerequisites, then the environment in .venv.
set -eu
cd "$(dirname "$0")/.."
# Another ROS or another environment must not reach into this one.
unset _ROS_WHEELS_BOOTSTRAP_COMPLETE LD_LIBRARY_PATH PYTHONPATH PYTHONHOME VIRTUAL_ENV
unset AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH
python=$(sh scripts/prerequisites.sh)
exec "$python" -I scripts/set_up.py
