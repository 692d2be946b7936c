# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The surface file of an axis on this machine, if it is the one that the node judges with."""

from ballscrew_monitor.page.phrases import free, phrase, Said
from ballscrew_msgs.msg import SurfaceInfo
from surrogate.surface import find_surface, Surface, SurfaceError


def known_surface(info: SurfaceInfo, wanted: str) -> tuple[Surface | None, Said]:
    """
    Return the surface that `info` describes, or None and why there is none.

    `wanted` is the parameter `surface` of the axis. Of a surface that full solves have corrected,
    the file tells what it was before.

    """
    if not info.sha256:
        return None, phrase('no_map_none')
    try:
        path = find_surface(wanted, info.screw, info.oil)
        surface = Surface.load(path, screw=info.screw, oil=info.oil)
    except SurfaceError as error:
        return None, phrase('no_map_no_file', why=free(str(error)))
    if surface.sha256 != info.sha256 and not len(info.corrected_speed):
        return None, phrase('no_map_other', path=str(path), sha256=info.sha256[:16])
    return surface, ''
