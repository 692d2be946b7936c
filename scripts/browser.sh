#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# Make sure of a browser for the tests that open a page in one. Without it they are skipped, so
# nothing here is an error: when root, apt-get installs Chromium; otherwise one line says what to
# type.
for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null; then
        exit 0
    fi
done
without='no page is opened in a browser by the tests'
if ! command -v apt-get >/dev/null; then
    echo "set-up: $without: install Chromium" >&2
elif [ "$(id -u)" != 0 ]; then
    echo "set-up: $without, or type: sudo apt-get update && sudo apt-get install -y chromium" >&2
else
    echo 'set-up: installing chromium for the tests of the pages' >&2
    export DEBIAN_FRONTEND=noninteractive
    mkdir -p log
    if ! { apt-get update && apt-get install -y --no-install-recommends chromium; } \
        >log/apt.log 2>&1; then
        echo "set-up: $without: apt-get could not install chromium, see log/apt.log" >&2
    fi
fi
exit 0
