#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# The nominal machine cycle again and again: the node, what plays it, and the page, until Ctrl-C.
# Arguments are those of `ballscrew page`.
set -eu
cd "$(dirname "$0")/.."
ROS_DOMAIN_ID=$(.venv/bin/python -c 'from ballscrew_monitor.cycle.domain import free_domain
with free_domain() as domain: print(domain)')
export ROS_DOMAIN_ID ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST
mkdir -p log
.venv/bin/python -m ballscrew_monitor.node --ros-args --params-file config/nominal_cycle.yaml \
    -p use_sim_time:=true -p "state_dir:=''" >log/page_node.log 2>&1 &
node=$!
.venv/bin/ballscrew play bags/nominal_cycle --loop --wait 60 >log/page_play.log 2>&1 &
player=$!
trap 'kill "$node" "$player" 2>/dev/null || :; wait' EXIT
trap : INT TERM
.venv/bin/ballscrew page "$@"
