# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Packed bytes come to what is allowed and no more, whether or not they state their size."""

import shutil

from ballscrew_monitor.recordings.unpacking import unpack_file, unpacked
import lz4.frame
import pytest
import zstandard

DATA = bytes(range(256)) * 40
PACKED = {
    'stated': ('zstd', zstandard.compress(DATA)),
    'endless': ('zstd', zstandard.ZstdCompressor(write_content_size=False).compress(DATA)),
    'lz4': ('lz4', lz4.frame.compress(DATA)),
}


@pytest.mark.parametrize('name', PACKED)
def test_the_last_allowed_byte_is_unpacked(name, refused):
    compression, packed = PACKED[name]
    assert unpacked(packed, len(DATA), compression=compression) == DATA
    refused(name, unpacked, packed, len(DATA) - 1, compression=compression)
    refused('damaged', unpacked, packed[:1] + packed[2:], len(DATA), compression=compression)


def test_what_is_not_packed_is_as_it_is_and_other_compressions_are_named(refused):
    assert unpacked(DATA, 0, compression='') is DATA
    refused('unknown', unpacked, DATA, compression='br')


def test_a_file_comes_to_so_many_times_its_size_and_leaves_half_of_the_disk(
    tmp_path, monkeypatch, refused
):
    file, folder = tmp_path / 'a.mcap.zstd', tmp_path / 'scratch'
    folder.mkdir()
    two = zstandard.compress(bytes(500_000)) + zstandard.compress(bytes(500_000))
    file.write_bytes(two)
    assert unpack_file(file, folder, salvage=False).read_bytes() == bytes(1_000_000)
    usage = shutil.disk_usage(folder)._replace(free=1_999_998)
    monkeypatch.setattr(shutil, 'disk_usage', lambda _: usage)
    refused('disk', unpack_file, file, folder, salvage=True)
    file.write_bytes(two[:4] + b'\xff' * 20)
    monkeypatch.undo()
    refused('cut', unpack_file, file, folder, salvage=False)
