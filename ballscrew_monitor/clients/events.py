# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew events`: the event log of a node, out of its state directory."""

import json
from pathlib import Path

from ballscrew_monitor.node.restart_state import AUTO, state_directory
from ballscrew_monitor.node.state_database import read_entries

NODE = 'ballscrew_monitor'  # its default name
TOLD = ('text', 'ending', 'advice', 'reason', 'until', 'result', 'sha256')
"""Facts that are sentences or words; the first of an entry that is not empty is printed."""


def print_events(folder: Path | None, *, as_json: bool) -> int:
    """Print the event log of a `folder`, else that of the node by its default name."""
    for entry in read_entries(folder or state_directory(AUTO, NODE) or Path()):
        record = entry.record()
        if as_json:
            print(json.dumps(record))
            continue
        event = f'event {record["event"]}' if 'event' in record else ''
        told = next((str(record[name]) for name in TOLD if record.get(name)), '')
        words = ': '.join(filter(None, (event, told)))
        print(f'{entry.time}  {entry.axis or "-":<8}  {entry.kind:<14}  {words}'.rstrip())
    return 0
