# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What `metadata.yaml` of rosbag2 says of a bag of one MCAP file, in its version 9."""

from collections.abc import Mapping, Sequence
from typing import Any

import yaml

METADATA, VERSION = 'metadata.yaml', 9


def metadata_text(
    file: str,
    topics: Sequence[tuple[int, Mapping[str, Any]]],
    *,
    first: int,
    last: int,
    custom: Mapping[str, str],
) -> str:
    """
    Return the text for a `file` with `topics`, each the number of its messages and what it is.

    `first` and `last` [ns] are log times, `custom` what a program says of the bag.

    """
    total = sum(count for count, _ in topics)
    information = {
        'version': VERSION,
        'storage_identifier': 'mcap',
        **_span(first, last),
        'message_count': total,
        'topics_with_message_count': [
            {'topic_metadata': dict(topic), 'message_count': count} for count, topic in topics
        ],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [file],
        'files': [{'path': file, **_span(first, last), 'message_count': total}],
        'custom_data': dict(custom) or None,
        'ros_distro': 'jazzy',
    }
    return yaml.safe_dump({'rosbag2_bagfile_information': information}, sort_keys=False)


def _span(first: int, last: int) -> dict[str, Any]:
    """Return duration and begin; made again each time, or YAML refers to the first one."""
    return {
        'duration': {'nanoseconds': last - first},
        'starting_time': {'nanoseconds_since_epoch': first},
    }
