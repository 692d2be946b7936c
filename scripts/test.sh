#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# The checks, the size of the sources, then the tests, whose closing line comes last. Arguments are for pytest.
# Three workers for the two cores of the smallest machine that this is for: a quarter of the time of a
# worker is waiting, for discovery and for children. Each has its share of the files until it helps
# the others. `-n 0` runs all in one process. What ament_flake8 and ament_pep257 find, ruff finds in a
# hundredth of the time; they run on machines with ROS 2, and by `-m linter` here. Tests that are long by
# their nature have a shorter sister, and run by `-m long` or in a job of their own.
set -u
cd "$(dirname "$0")/.."
export ROS_PYTHON_CHECK_FIELDS=1
# Compiled modules are kept: hundreds of processes of the tests would each compile them again.
unset PYTHONDONTWRITEBYTECODE
# Seconds for one test, so that a middleware that hangs is a failure and not an endless run; more
# than the deadlines of the tests, which tell what did not come.
export PYTEST_TIMEOUT="${PYTEST_TIMEOUT:-900}"
# A worker has a core: threads of a numerical library would take that of another.
export MKL_NUM_THREADS=1 OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
failed=''

check() {
    echo "== $*"
    ".venv/bin/$@" || failed="$failed '$*'"
}

check ruff check --quiet --output-format concise
check ruff format --check --quiet --output-format concise
[ -z "$failed" ] || echo "== failed:$failed"
echo '== size'
.venv/bin/python scripts/count.py --summary
.venv/bin/pytest -q -n 3 --dist worksteal -m 'not flake8 and not pep257 and not long' "$@"
code=$?
[ $code != 0 ] || [ -z "$failed" ] || code=1
exit $code
