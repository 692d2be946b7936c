#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# Clone the last commit into a directory of its own and run there what a stranger would.
set -eu
clone=$(mktemp -d)/ballscrew_monitor
unset MAKEFLAGS MFLAGS MAKELEVEL
git clone -q "$(dirname "$0")/.." "$clone"
echo "fresh-test: in $clone, which stays there when something fails"
make -C "$clone" --no-print-directory run RATE="${RATE:-1}"
make -C "$clone" --no-print-directory test
rm -rf "$(dirname "$clone")"
