#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# Make sure of git, make, g++ and a Python 3.11 to 3.14 with venv and headers, and print the path
# of that Python. What is missing is installed by apt-get when root; otherwise one line says what
# to type, and the exit code is 2. PYTHON names the one Python to use.
set -eu

# A Python is judged by running it: a name on PATH may be a shim that fails. The answer is the
# interpreter underneath, so that the choice is the same inside any activated environment.
probe='
import os, sys, sysconfig
assert (3, 11) <= sys.version_info[:2] <= (3, 14)
assert sys.implementation.name == "cpython" and not sysconfig.get_config_var("Py_GIL_DISABLED")
import ctypes, ensurepip, ssl, venv
assert os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h"))
print(os.path.realpath(sys._base_executable))
'

usable() {
    "$1" -I -S -c "$probe" 2>/dev/null
}

# The one that .venv was made of comes first: another order on PATH is no reason to start again.
find_python() {
    if [ -n "${PYTHON:-}" ]; then
        usable "$PYTHON"
        return
    fi
    made_of=$(sed -n 's/^executable = //p' .venv/pyvenv.cfg 2>/dev/null || true)
    for candidate in "$made_of" python3 python3.12 python3.11 python3.13 python3.14; do
        if [ -n "$candidate" ] && usable "$candidate"; then
            return
        fi
    done
    return 1
}

# Packages of the first Python in range that apt-get knows.
python_packages() {
    for name in python3 python3.12 python3.11 python3.13 python3.14; do
        case $(apt-cache show --no-all-versions "$name" 2>/dev/null | sed -n 's/^Version: //p') in
        3.11.* | 3.12.* | 3.13.* | 3.14.*)
            echo "$name $name-venv $name-dev"
            return
            ;;
        esac
    done
    echo 'python3 python3-venv python3-dev'
}

missing_packages() {
    for tool in git make g++; do
        command -v "$tool" >/dev/null || printf '%s ' "$tool"
    done
    find_python >/dev/null || python_packages
}

refuse() {
    echo "set-up: $1" >&2
    exit 2
}

if [ -n "${PYTHON:-}" ] && ! find_python >/dev/null; then
    refuse "PYTHON=$PYTHON is not a Python 3.11 to 3.14 with venv and headers"
fi
missing=$(missing_packages)
if [ -n "$missing" ]; then
    # A list of packages is meant to be split.
    # shellcheck disable=SC2086
    set -- $missing
    if ! command -v apt-get >/dev/null; then
        refuse "install git, make, g++ and Python 3.11 to 3.14 with venv and headers; missing: $*"
    elif [ "$(id -u)" != 0 ]; then
        refuse "type this, then repeat: sudo apt-get update && sudo apt-get install -y $*"
    fi
    echo "set-up: installing $*" >&2
    export DEBIAN_FRONTEND=noninteractive
    mkdir -p log
    if ! { apt-get update && apt-get install -y --no-install-recommends "$@"; } \
        >log/apt.log 2>&1; then
        tail -n 5 log/apt.log >&2
        refuse "apt-get could not install $*; its output is in log/apt.log"
    fi
    missing=$(missing_packages)
    [ -z "$missing" ] || refuse "still missing after apt-get: $missing"
fi
find_python
