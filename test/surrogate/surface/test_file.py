# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The surface file: whole or refused, with one sentence."""

from dataclasses import replace
import io
import json
import math
import os
import zipfile

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.files import limits
from surrogate.surface import file, shipped_surface

CLOSED_FORM = shipped_surface(tier='closed_form')
SHIPPED = CLOSED_FORM.read_bytes()
WHOLE = file.read(CLOSED_FORM).sha256


def rewrite(path, **changes):
    """Write the shipped file again with changes to its header, keeping the stated hash."""
    with np.load(CLOSED_FORM, allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    header = json.loads(arrays['header'].tobytes())
    header.update(changes)
    arrays['header'] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(path, **arrays)


def test_what_is_written_is_read_and_without_draws_of_the_first_version(tmp_path, surface_data):
    path = tmp_path / 'a' / 'map.npz'
    file.write(path, surface_data)
    back = file.read(path)
    assert back.sha256 == surface_data.sha256
    assert dict(back.header) == json.loads(json.dumps(surface_data.header))
    for name, values in surface_data.fields.items():
        assert np.array_equal(back.fields[name], values)
    assert [found.name for found in path.parent.iterdir()] == ['map.npz']
    assert surface_data.header['format_version'] == file.FORMAT_VERSION
    assert file.read(CLOSED_FORM).deviations == {}


def test_the_hash_covers_content_and_not_provenance(surface_data):
    """Another build time is the same surface; another number is not."""
    later = replace(surface_data, provenance={'built': 'later'})
    assert later.sha256 == surface_data.sha256
    rcs = surface_data.fields['rcs'].copy()
    rcs[3, 3, 3] = np.nextafter(rcs[3, 3, 3], 1)
    other = replace(surface_data, fields={**surface_data.fields, 'rcs': rcs})
    assert other.sha256 != surface_data.sha256
    expected = surface_data.sha256
    assert replace(surface_data, header={**surface_data.header, 'tier': 'full'}).sha256 != expected


@settings(max_examples=30)
@given(st.integers(0, len(SHIPPED) - 1))
def test_a_truncated_file_is_refused(refused, tmp_path_factory, length):
    path = tmp_path_factory.mktemp('cut') / 'cut.npz'
    path.write_bytes(SHIPPED[:length])
    with refused('cut_npz') as caught:
        file.read(path)
    assert '\n' not in str(caught.value)


@settings(max_examples=30)
@given(st.integers(0, len(SHIPPED) - 1), st.integers(1, 255))
def test_a_flipped_byte_is_refused_or_harmless(tmp_path_factory, place, change):
    """A changed byte is found, unless it lies where the archive keeps nothing that is read."""
    damaged = bytearray(SHIPPED)
    damaged[place] ^= change
    path = tmp_path_factory.mktemp('flip') / 'flip.npz'
    path.write_bytes(damaged)
    try:
        digest, sentence = file.read(path).sha256, ''
    except file.SurfaceError as error:
        digest, sentence = WHOLE, str(error)
    assert digest == WHOLE
    assert '\n' not in sentence


def test_a_file_as_large_as_is_allowed_is_read(tmp_path, monkeypatch, refused):
    with zipfile.ZipFile(CLOSED_FORM) as archive:
        unpacked = sum(one.file_size for one in archive.infolist())
    packed = tmp_path / 'small.npz'
    with np.load(CLOSED_FORM, allow_pickle=False) as archive:
        np.savez_compressed(packed, **archive)
    assert packed.stat().st_size < unpacked < len(SHIPPED)
    for path, size, key in (
        (CLOSED_FORM, len(SHIPPED), 'larger_bytes'),
        (packed, unpacked, 'larger_unpacked'),
    ):
        monkeypatch.setattr(limits, 'SURFACE', size)
        assert file.read(path).sha256 == WHOLE
        monkeypatch.setattr(limits, 'SURFACE', size - 1)
        refused(key, file.read, path)


def eight_nodes(data):
    """Return the two outer nodes along each axis of a surface."""
    ends = np.ix_([0, -1], [0, -1], [0, -1])
    axes = {name: getattr(data, name)[[0, -1]] for name in ('speed_coordinate', 'load')}
    return replace(
        data,
        **axes,
        header={**data.header, 'load_breaks': []},
        temperature=data.temperature[[0, -1]],
        log_onset=data.log_onset[np.ix_([0, -1], [0, -1])],
        fields={name: values[ends] for name, values in data.fields.items()},
        errors={name: np.zeros((1, 1, 1)) for name in data.errors},
        worst_contact=data.worst_contact[ends],
        mask=data.mask[ends],
    )


def test_two_nodes_along_an_axis_are_enough_and_one_is_not(surface_data):
    data = eight_nodes(surface_data)
    assert file._has_sound_arrays(data)
    assert file._has_sound_ensemble(data)
    rcs = {name: values[:, :, :1] for name, values in data.fields.items()}
    flat = replace(data, temperature=data.temperature[:1], log_onset=data.log_onset[:, :1])
    flat = replace(flat, fields=rcs, worst_contact=data.worst_contact[:, :, :1])
    flat = replace(flat, errors=dict.fromkeys(data.errors, np.zeros((1, 1, 0))))
    assert not file._has_sound_arrays(replace(flat, mask=data.mask[:, :, :1]))
    for name in ('speed_coordinate', 'load', 'temperature'):
        same = replace(data, **{name: np.zeros(2)})
        assert not file._has_sound_arrays(same)
    tiny = replace(data, temperature=np.array([300.0, math.nextafter(300.0, 301.0)]))
    assert file._has_sound_arrays(tiny)


@pytest.mark.parametrize('end', [0, 1])
@pytest.mark.parametrize(
    ('beyond', 'sound'), [(-1e-6, True), (0.0, True), (1e-9, True), (2e-9, False)]
)
def test_a_range_of_speeds_may_reach_to_the_nodes(surface_data, end, beyond, sound):
    """Within 1e-9 of the logarithm of the speed, whatever the load and the temperature."""
    data = eight_nodes(surface_data)
    s, onset = data.speed_coordinate, data.log_onset
    reach = [s[0] + onset.max(), s[1] + onset.min()]
    reach[end] += (2 * end - 1) * 0.999 * beyond
    speeds = [math.exp(one) for one in reach]
    assert (
        bool(file._has_sound_header(replace(data, **settings_with(data, speed_range=speeds))))
        is sound
    )
    alike = settings_with(data, speed_range=[1.0, 1.0])
    assert not file._has_sound_header(replace(data, **alike))


@pytest.mark.parametrize(('value', 'sound'), [(0.0, True), (0.5, True), (-5e-324, False)])
def test_a_spread_is_nothing_or_more(surface_data, value, sound):
    data = eight_nodes(surface_data)
    spreads = {name: np.full((2, 2, 2), value) for name in data.fields}
    for group in ('deviations', 'standard_errors'):
        assert file._has_sound_ensemble(replace(data, **{group: spreads})) is sound


@pytest.mark.parametrize(
    ('changes', 'sentence'),
    [
        ({'tier': 'full'}, 'content_hash_differs'),
        ({'sha256': '0' * 64}, 'content_hash'),
        ({'format': 'map'}, 'surface_file_header'),
        ({'format_version': file.FORMAT_VERSION + 1}, 'surface_format_version'),
    ],
)
def test_a_changed_header_is_refused(tmp_path, changes, sentence, refused):
    path = tmp_path / 'changed.npz'
    rewrite(path, **changes)
    refused(sentence, file.read, path)


def settings_with(data, **changes):
    """Return the change of the header that changes settings."""
    return {'header': {**data.header, 'settings': {**data.header['settings'], **changes}}}


def unmasked_hole(data):
    """Return fields with a NaN that no mask tells of."""
    rcs = data.fields['rcs'].copy()
    rcs[3, 3, 3] = np.nan
    return {'fields': {**data.fields, 'rcs': rcs}}


def inputs_with(data, kind, **changes):
    """Return the change of the header that changes a sheet."""
    inputs = data.header['inputs']
    sheet = {**inputs[kind], **changes}
    return {'header': {**data.header, 'inputs': {**inputs, kind: sheet}}}


def without(content, path):
    """Return a header, or a part of it, without the key at the end of a path."""
    key, *rest = path
    kept = {name: value for name, value in content.items() if name != key}
    return {**kept, key: without(content[key], rest)} if rest else kept


ROUGHNESS = ('rms', 'lay', 'state', 'traced', 'onset_band')
SCREW = ('name', 'lead', 'preload', 'speed_limit', 'pitch_radius')
DRAG = ('parasitic_torque', 'parasitic_torque_rate')
READ = [
    *(('settings',), ('inputs', 'screw'), ('inputs', 'lubricant'), ('load_breaks',)),
    *(('inputs', 'screw', name) for name in (*SCREW, *DRAG, 'roughness')),
    *(('inputs', 'screw', 'roughness', name) for name in ROUGHNESS),
    *(
        ('inputs', 'lubricant', name)
        for name in ('name', 'reference_temperature', 'kinematic_viscosity_40')
    ),
]


@pytest.mark.parametrize('path', READ, ids='.'.join)
def test_a_header_without_what_is_read_is_refused(tmp_path, surface_data, path, refused):
    header = without(dict(surface_data.header), path)
    file.write(tmp_path / 'part.npz', replace(surface_data, header=header))
    refused('header_lacks', file.read, tmp_path / 'part.npz')


@pytest.mark.parametrize(
    'change',
    [
        lambda data: {'load': data.load[::-1].copy()},
        lambda data: {'fields': {k: v for k, v in data.fields.items() if k != 'rcs'}},
        lambda data: {'mask': data.mask[1:]},
        lambda data: {'mask': data.mask.astype(np.uint8)},
        unmasked_hole,
        lambda data: {'header': {**data.header, 'tier': 'guess'}},
        lambda data: inputs_with(data, 'screw', speed_limit=0.0),
        lambda data: inputs_with(data, 'screw', pitch_radius=None),
        lambda data: inputs_with(data, 'screw', lead=10**400),
        lambda data: inputs_with(data, 'lubricant', kinematic_viscosity_40='68'),
        lambda data: {'header': {**data.header, 'load_breaks': [1.0]}},
        lambda data: settings_with(data, speed_range=[0.0, 100.0]),
        lambda data: settings_with(data, speed_range=[1.0, 1e9]),
        lambda data: settings_with(data, speed_range='all'),
    ],
)
def test_broken_parts_are_refused_with_their_hash(tmp_path, surface_data, change, refused):
    """A file that verifies but whose parts do not fit is refused too."""
    path = tmp_path / 'broken.npz'
    file.write(path, replace(surface_data, **change(surface_data)))
    refused('header_axes_fields', file.read, path)


@pytest.mark.parametrize('content', [b'', b'hello', b'PK\x03\x04'])
def test_something_else_is_not_a_surface(tmp_path, content, refused):
    path = tmp_path / 'else.npz'
    path.write_bytes(content)
    refused('damaged_surface_file', file.read, path)


def test_other_arrays_and_no_file_are_not_a_surface(tmp_path, refused):
    """A plain .npy, an .npz without a header, and a pickle are refused."""
    plain, bare, pickled = (tmp_path / name for name in ('a.npy', 'b.npz', 'c.npz'))
    np.save(plain, np.zeros(3))
    np.savez(bare, a=np.zeros(3))
    np.savez(pickled, header=np.array([{'format': 1}], dtype=object))
    for path in (plain, bare, pickled):
        refused('surface_file', file.read, path)
    refused('such_surface_file', file.read, tmp_path / 'none.npz')


def stored(path, *sizes):
    """Write zeros, which take a thousandth of the room when packed."""
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for number, size in enumerate(sizes):
            with archive.open(f'field_{number}.npy', 'w') as entry:
                for begin in range(0, size, 2**20):
                    entry.write(bytes(min(2**20, size - begin)))


def test_a_small_file_that_unpacks_to_much_is_refused_unread(tmp_path, monkeypatch):
    """By the sum over its arrays: each of them alone would do."""
    path = tmp_path / 'bomb.npz'
    half = limits.SURFACE // 2
    stored(path, half, half + 1)
    assert path.stat().st_size < limits.SURFACE / 100
    with monkeypatch.context() as patch:
        patch.setattr(np, 'load', None)
        with pytest.raises(
            file.SurfaceError, match=f': {2 * half + 1} bytes when unpacked, allowed is'
        ):
            file.read(path)


def test_the_largest_content_is_read_and_one_beyond_all_memory_is_refused(tmp_path, refused):
    """Exactly at the limit it is read, and found to be no surface."""
    path = tmp_path / 'large.npz'
    stored(path, limits.SURFACE)
    refused('surface_file', file.read, path)
    path = tmp_path / 'empty.npz'
    head = io.BytesIO()
    large = {'descr': '<f8', 'fortran_order': False, 'shape': (10**15,)}
    np.lib.format.write_array_header_1_0(head, large)
    with zipfile.ZipFile(path, 'w') as archive:
        archive.writestr('field_0.npy', head.getvalue())
    refused('damaged_surface', file.read, path)


def test_a_pipe_is_not_written_over(surface_data, tmp_path, refused):
    """Nor is a device, which no test risks: it would be gone if this failed."""
    path = tmp_path / 'map.npz'
    os.mkfifo(path)
    refused('regular_file', file.write, path, surface_data)
    assert path.is_fifo()


def test_a_failed_write_leaves_the_old_file(tmp_path, surface_data, monkeypatch, refused):
    """A full disk does not cost the previous surface, and nothing half-written stays."""
    path = tmp_path / 'map.npz'
    file.write(path, surface_data)
    before = path.read_bytes()

    def full(*_, **__):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(np, 'savez', full)
    refused('cannot_written_space', file.write, path, surface_data)
    assert path.read_bytes() == before
    assert [found.name for found in tmp_path.iterdir()] == ['map.npz']


def with_draws(data, **changes):
    """Return the surface with an ensemble of draws."""
    spread = np.full(data.mask.shape, 0.01)
    parts = {'deviations': {'rcs': spread}, 'standard_errors': {'rcs': 0.5 * spread}}
    return replace(data, **{**parts, **changes})


def test_what_draws_leave_uncertain_is_written_read_and_hashed(tmp_path, surface_data):
    """A round trip keeps the arrays; each of their bits is in the hash."""
    path = tmp_path / 'map.npz'
    data = with_draws(surface_data)
    data.deviations['rcs'][3, 3, 3] = np.nan
    file.write(path, data)
    back = file.read(path)
    assert set(back.deviations) == set(back.standard_errors) == {'rcs'}
    assert np.array_equal(back.deviations['rcs'], data.deviations['rcs'], equal_nan=True)
    assert np.array_equal(back.standard_errors['rcs'], data.standard_errors['rcs'])
    other = with_draws(surface_data)
    other.standard_errors['rcs'][3, 3, 3] = np.nextafter(0.005, 1)
    assert len({data.sha256, other.sha256, surface_data.sha256}) == 3


@pytest.mark.parametrize(
    'change',
    [
        lambda data: {'deviations': {'heat': np.zeros(data.mask.shape)}},
        lambda data: {'deviations': {'rcs': np.zeros(3)}},
        lambda data: {'deviations': {'rcs': np.full(data.mask.shape, -0.1)}},
        lambda data: {'standard_errors': {'rcs': np.full(data.mask.shape, np.inf)}},
        lambda data: {'standard_errors': {'rcs': np.zeros(data.mask.shape, dtype=np.float32)}},
    ],
)
def test_impossible_spreads_are_refused(tmp_path, surface_data, change, refused):
    """Of no field, of another shape, below zero, of another type."""
    path = tmp_path / 'broken.npz'
    file.write(path, with_draws(surface_data, **change(surface_data)))
    refused('header_axes_fields', file.read, path)
