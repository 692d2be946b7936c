# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Packed messages, chunks and files: none comes to more than its limit, whatever it states."""

import io
from pathlib import Path
import shutil
import tempfile
import weakref

from surrogate.files import InputError, limits
import zstandard

BLOCK = 1 << 20  # [bytes] that are unpacked at a time


class Unpackable(ValueError):
    """Packed bytes that are damaged or come to too much, and why."""


def scratch_folder(owner: object) -> Path:
    """Return a new folder for a file that is not as it is to be read; it goes with its owner."""
    folder = tempfile.mkdtemp(prefix='ballscrew_bag_')
    weakref.finalize(owner, shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def unpacked(packed: bytes, most: int = limits.MESSAGE, *, compression: str = 'zstd') -> bytes:
    """Return bytes that come to `most` bytes at most; raises Unpackable."""
    if not compression:
        return packed
    if compression not in READ:
        raise Unpackable(f'its compression {compression!r} is not known, zstd and lz4 are')
    try:
        data = READ[compression](packed, most)
    except (zstandard.ZstdError, RuntimeError, MemoryError, EOFError) as error:
        raise Unpackable(' '.join(str(error).split())) from None
    if len(data) > most:
        raise Unpackable(f'it comes to more than {most} bytes')
    return data


def _of_zstd(packed: bytes, most: int) -> bytes:
    size = zstandard.frame_content_size(packed)
    if size > most:
        raise Unpackable(f'it states {size} bytes, allowed are {most}')
    if size >= 0:
        return zstandard.ZstdDecompressor().decompress(packed)
    return bytes(zstandard.ZstdDecompressor().stream_reader(packed).read(most + 1))


def _of_lz4(packed: bytes, most: int) -> bytes:
    import lz4.frame

    return bytes(lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=most + 1))


READ = {'zstd': _of_zstd, 'lz4': _of_lz4}


def unpack_file(file: Path, folder: Path, *, salvage: bool) -> Path:
    """
    Return the unpacked copy in `folder` of a zstd file.

    Raises InputError on damage, or if it would come to more than is allowed; with `salvage` what
    comes before damage is kept.

    """
    target = folder / file.name.removesuffix('.zstd')
    most = min(limits.most_unpacked(file.stat().st_size), shutil.disk_usage(folder).free // 2)
    with file.open('rb') as packed, target.open('wb') as stream:
        try:
            _copy(packed, stream, most)
        except zstandard.ZstdError as error:
            if not salvage:
                raise InputError(f'bag {file} is truncated or damaged ({error})') from None
        except Unpackable:
            raise InputError(
                f'bag {file} comes to more than {most / limits.MEGA:.0f} MB when unpacked, '
                f'allowed are {limits.PACKING} times its size and half of the free disk'
            ) from None
    return target


def _copy(packed: io.BufferedReader, stream: io.BufferedWriter, most: int) -> None:
    reader = zstandard.ZstdDecompressor().stream_reader(packed, read_across_frames=True)
    while block := reader.read(BLOCK):
        if stream.tell() + len(block) > most:
            raise Unpackable
        stream.write(block)
