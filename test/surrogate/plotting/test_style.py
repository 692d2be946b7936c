# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pictures are whole and in one style, which is that of no other program's pictures."""

import pytest

style = pytest.importorskip('surrogate.plotting.style')
matplotlib = pytest.importorskip('matplotlib')


def test_a_picture_is_in_the_style_and_nothing_else_is(tmp_path):
    """The style sheet holds while the figure is made, and no longer."""
    seen = []

    def make():
        seen.append(matplotlib.rcParams['legend.edgecolor'])
        return style.new_figure(2.0, 1.0)

    path = style.draw_picture(tmp_path / 'new' / 'one.png', make)
    assert seen == ['none']
    assert matplotlib.rcParams['legend.edgecolor'] != 'none'
    assert path.read_bytes().startswith(b'\x89PNG')
    assert [one.name for one in path.parent.iterdir()] == ['one.png']


def test_a_picture_that_fails_leaves_the_old_one(tmp_path):
    """Neither half a picture nor none."""
    path = tmp_path / 'one.png'
    path.write_text('old')
    with pytest.raises(ZeroDivisionError):
        style.draw_picture(path, lambda: 1 / 0)
    assert path.read_text() == 'old'
