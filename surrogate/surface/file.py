# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The surface file: one self-describing .npz with a JSON header, never a pickle.

The hash covers the header without its provenance and every array in name order, little-endian, C
order. A file that does not verify is refused with one sentence.

"""

from collections.abc import Iterator, Mapping
import contextlib
from dataclasses import dataclass, field
import hashlib
import io
import math
from pathlib import Path
import tokenize
from typing import Any
import zipfile
import zlib

import numpy as np
from numpy.typing import NDArray
from surrogate.files import canonical_json, limits, replace_file
from surrogate.surface.fields import FIELDS

Array = NDArray[np.float64]
Arrays = dict[str, NDArray[Any]]

FORMAT = 'ballscrew_surface'
FORMAT_VERSION = 4
TIERS = ('closed_form', 'full')
DAMAGE = (
    OSError,
    MemoryError,
    ValueError,
    KeyError,
    TypeError,
    OverflowError,
    EOFError,
    SyntaxError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
    NotImplementedError,
)
"""What numpy and zipfile raise on a damaged file."""


class SurfaceError(ValueError):
    """One sentence about a surface file or its use: what, where, allowed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SurfaceData:
    """
    Content of a surface file.

    Axes: speed coordinate s [-], opposing load [N], temperature [K]. `log_onset` [load,
    temperature] is the logarithm of the onset speed [rad/s]. Fields [speed, load, temperature] in
    SI; `worst_contact` 0 to 3 counts loaded nut on screw, on nut, relieved nut on screw, on nut;
    `mask` marks unconverged nodes; `errors` hold the measured interpolation error of each field
    per cell. `deviations` and `standard_errors`, of any of the fields in its unit, hold the
    standard deviation between strips of the raceway and the standard error of the mean on the
    nodes, NaN where not known; a tier without strips has none. `header` has the keys format,
    format_version, tier, inputs, settings and load_breaks; `provenance` is not hashed.

    """

    header: Mapping[str, Any]
    speed_coordinate: Array
    load: Array
    temperature: Array
    log_onset: Array
    fields: Mapping[str, Array]
    errors: Mapping[str, Array]
    worst_contact: NDArray[np.uint8]
    mask: NDArray[np.bool_]
    deviations: Mapping[str, Array] = field(default_factory=dict)
    standard_errors: Mapping[str, Array] = field(default_factory=dict)
    provenance: Mapping[str, Any] = field(default_factory=dict)

    @property
    def sha256(self) -> str:
        """Content hash, 64 hexadecimal digits."""
        digest = hashlib.sha256(canonical_json(self.header))
        for name, array in _arrays(self):
            shape = f'{name} {array.dtype.str} {array.shape}'
            digest.update(shape.encode() + np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()


def write(path: str | Path, data: SurfaceData) -> None:
    """Write the file whole or not at all; raises SurfaceError when it cannot be written."""
    try:
        replace_file(path, to_bytes(data))
    except OSError as error:
        raise SurfaceError(f'{path}: the surface cannot be written, {error.strerror}') from None


def to_bytes(data: SurfaceData) -> bytes:
    """Return the content of the file."""
    head = {**data.header, 'sha256': data.sha256, 'provenance': data.provenance}
    arrays = dict(_arrays(data))
    arrays['header'] = np.frombuffer(canonical_json(head), dtype=np.uint8)
    file = io.BytesIO()
    np.savez(file, **arrays)  # type: ignore[arg-type]
    return file.getvalue()


def read(path: str | Path) -> SurfaceData:
    """Read and verify a file; raises SurfaceError with one sentence."""
    path = Path(path)
    if not path.is_file():
        raise SurfaceError(f'{path}: no such surface file')
    if path.stat().st_size > limits.SURFACE:
        raise SurfaceError(f'{path}: {path.stat().st_size} bytes, allowed is {limits.SURFACE}')
    try:
        content = path.read_bytes()
    except OSError as error:
        raise SurfaceError(f'{path}: cannot be read, {error.strerror}') from None
    return from_bytes(path, content)


def from_bytes(path: str | Path, content: bytes) -> SurfaceData:
    """Verify the content of a file, called `path` in the sentence of a SurfaceError."""
    unpacked = 0
    with contextlib.suppress(*DAMAGE), zipfile.ZipFile(io.BytesIO(content)) as archive:
        # A small file may fill the memory; a damaged one is refused when it is read.
        unpacked = sum(entry.file_size for entry in archive.infolist())
    if unpacked > limits.SURFACE:
        raise SurfaceError(f'{path}: {unpacked} bytes when unpacked, allowed is {limits.SURFACE}')
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        header = limits.read_json(arrays.pop('header').tobytes())
    except DAMAGE:
        raise SurfaceError(
            f'{path}: damaged or not a surface file (an .npz that `surface build` wrote)'
        ) from None
    except AttributeError:
        raise SurfaceError(f'{path}: not a surface file (.npz with a header)') from None
    if not isinstance(header, dict) or header.get('format') != FORMAT:
        raise SurfaceError(f'{path}: not a surface file, its header is of another format')
    version = header.get('format_version')
    if version != FORMAT_VERSION:
        raise SurfaceError(
            f'{path}: surface format version {version}, this program reads version '
            f'{FORMAT_VERSION}: build it again (ballscrew surface build)'
        )
    stated, provenance = header.pop('sha256', ''), header.pop('provenance', {})
    try:
        data = _assemble(header, provenance, arrays)
    except DAMAGE as error:
        raise SurfaceError(f'{path}: damaged surface, {error}') from None
    if data.sha256 != stated:
        raise SurfaceError(
            f'{path}: damaged surface, content hash {data.sha256[:16]} differs '
            f'from the stated {str(stated)[:16]}'
        )
    _check(path, data)
    return data


def _assemble(header: dict[str, Any], provenance: Any, arrays: Arrays) -> SurfaceData:
    def group(prefix: str) -> dict[str, Array]:
        return {
            name.removeprefix(prefix): array
            for name, array in arrays.items()
            if name.startswith(prefix)
        }

    return SurfaceData(
        header=header,
        provenance=provenance,
        speed_coordinate=arrays['axis_speed_coordinate'],
        load=arrays['axis_load'],
        temperature=arrays['axis_temperature'],
        log_onset=arrays['log_onset'],
        fields=group('field_'),
        errors=group('error_'),
        worst_contact=arrays['worst_contact'],
        mask=arrays['mask'],
        deviations=group('std_'),
        standard_errors=group('stderr_'),
    )


def _check(path: str | Path, data: SurfaceData) -> None:
    """Refuse a file that verifies but was written by a program that broke the format."""
    try:
        sound = _has_sound_arrays(data) and _has_sound_ensemble(data) and _has_sound_header(data)
    except KeyError as error:
        raise SurfaceError(f'{path}: its header lacks {error}, build it again') from None
    except DAMAGE:
        sound = False
    if not sound:
        raise SurfaceError(
            f'{path}: damaged surface, its header, axes and fields do not fit together'
        )


def _has_sound_arrays(data: SurfaceData) -> bool:
    axes = (data.speed_coordinate, data.load, data.temperature)
    nodes = tuple(len(axis) for axis in axes)
    cells = tuple(count - 1 for count in nodes)
    return (
        all(axis.ndim == 1 and len(axis) > 1 and bool(np.all(np.diff(axis) > 0)) for axis in axes)
        and data.log_onset.shape == nodes[1:]
        and bool(np.all(np.isfinite(data.log_onset)))
        and data.mask.shape == data.worst_contact.shape == nodes
        and data.mask.dtype == bool
        and data.worst_contact.dtype == np.uint8
        and set(FIELDS) <= set(data.fields)
        and set(FIELDS) <= set(data.errors)
        and all(values.shape == cells for values in data.errors.values())
        and all(values.shape == nodes for values in data.fields.values())
        and all(np.all(np.isfinite(values[~data.mask])) for values in data.fields.values())
    )


def _has_sound_ensemble(data: SurfaceData) -> bool:
    """Return True if spreads are of known fields and at least 0 or NaN."""
    spreads = [*data.deviations.values(), *data.standard_errors.values()]
    return (
        set(data.deviations) | set(data.standard_errors) <= set(FIELDS)
        and all(values.shape == data.mask.shape for values in spreads)
        and all(values.dtype == np.float64 for values in spreads)
        and not any(np.any((values < 0) | np.isinf(values)) for values in spreads)
    )


def _has_sound_header(data: SurfaceData) -> bool:
    """Return True if the lookup finds what it needs, and no more speeds than there are nodes."""
    screw, oil = (data.header['inputs'][kind] for kind in ('screw', 'lubricant'))
    raceway = screw['roughness']
    numbers = (
        screw['lead'],
        screw['preload'],
        screw['parasitic_torque'],
        screw['parasitic_torque_rate'],
        raceway['rms'],
        1.0 if raceway['onset_band'] is None else raceway['onset_band'],
        oil['reference_temperature'],
        oil['kinematic_viscosity_40'],
    )
    above_zero = screw['speed_limit'], screw['pitch_radius']
    slowest, fastest = (math.log(speed) for speed in data.header['settings']['speed_range'])
    s, rounding = data.speed_coordinate, 1e-9
    return (
        data.header['tier'] in TIERS
        and all(isinstance(sheet['name'], str) for sheet in (screw, oil))
        and all(isinstance(raceway[word], str) for word in ('lay', 'state', 'traced'))
        and all(math.isfinite(number) for number in numbers)
        and all(0 < number < math.inf for number in above_zero)
        and isinstance(data.header['load_breaks'], list)
        and set(data.header['load_breaks']) <= set(data.load.tolist())
        and slowest < fastest
        and s[0] + data.log_onset.max() <= slowest + rounding
        and fastest - rounding <= s[-1] + data.log_onset.min()
    )


def _arrays(data: SurfaceData) -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield every array under its name on file, in name order."""
    named: Arrays = {
        'axis_speed_coordinate': data.speed_coordinate,
        'axis_load': data.load,
        'axis_temperature': data.temperature,
        'log_onset': data.log_onset,
        'worst_contact': data.worst_contact,
        'mask': data.mask,
        **{f'field_{name}': values for name, values in data.fields.items()},
        **{f'error_{name}': values for name, values in data.errors.items()},
        **{f'std_{name}': values for name, values in data.deviations.items()},
        **{f'stderr_{name}': values for name, values in data.standard_errors.items()},
    }
    for name in sorted(named):
        array = named[name]
        yield name, array.astype(array.dtype.newbyteorder('<'), copy=False)
