#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# The checks, then the tests, whose closing line comes last. Arguments are for pytest.
set -u
cd "$(dirname "$0")/.."
export ROS_PYTHON_CHECK_FIELDS=1
# Seconds for one test, so that a middleware that hangs is a failure and not an endless run.
export PYTEST_TIMEOUT="${PYTEST_TIMEOUT:-120}"
failed=''

check() {
    echo "== $*"
    ".venv/bin/$@" || failed="$failed '$*'"
}

check ruff check --quiet --output-format concise
check ruff format --check --quiet --output-format concise
check mypy
[ -z "$failed" ] || echo "== failed:$failed"
.venv/bin/pytest -q "$@"
code=$?
[ $code != 0 ] || [ -z "$failed" ] || code=1
exit $code
