#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# The properties among the tests, with random draws: round after round for so many minutes (first
# argument), or until one fails. Further arguments are for pytest.
set -u
cd "$(dirname "$0")/.."
minutes=$1
shift
export HYPOTHESIS_PROFILE=fuzz ROS_PYTHON_CHECK_FIELDS=1
export MKL_NUM_THREADS=1 OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
end=$(($(date +%s) + minutes * 60))
round=0
while left=$((end - $(date +%s))) && [ "$left" -gt 0 ]; do
    round=$((round + 1))
    echo "== round $round: up to 1000 new examples of each property; $left s left"
    timeout --signal=INT --kill-after=30 "$left" \
        .venv/bin/pytest -q -x -n 2 --dist worksteal -m hypothesis "$@"
    code=$?
    # The end of the time is no failure.
    case $code in 124 | 137) break ;; esac
    [ $code = 0 ] || exit $code
done
echo "== no property failed in $minutes min"
