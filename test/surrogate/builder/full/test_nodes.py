# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Nodes of a full-tier surface: loads beside the idle one, onsets, speeds."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.builder.full.nodes import BESIDE, signed_loads, surface_nodes
from surrogate.builder.full.ratios import solved_grid
from surrogate.builder.full.settings import default_full_settings
from surrogate.formulas.geometry import screw_contact
from surrogate.formulas.inlet import inlet_speed, SPEED_EXPONENT
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.load_sharing import idle_load, normal_force
from surrogate.parameters import load_lubricant
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_speeds, SMOOTH_ONSET

WARM = 313.15
OIL = load_lubricant('iso_vg_68')


@pytest.fixture(name='settings')
def defaults(screw):
    """Return the defaults of the nominal screw."""
    return default_full_settings(screw)


def test_nodes_sit_on_zero_and_on_both_sides_of_idle(screw, settings):
    """They are the breaks; loads of either sign; the ends of the range."""
    nodes, breaks = signed_loads(screw, settings)
    idle = idle_load(screw)
    edges = [(1 - BESIDE) * idle, (1 + BESIDE) * idle]
    assert breaks == pytest.approx([-edges[1], -edges[0], 0.0, *edges])
    assert set(breaks) <= set(nodes.tolist())
    assert nodes.tolist() == (-nodes[::-1]).tolist()
    assert (nodes[0], nodes[-1]) == settings.load_range


def test_loads_crowd_towards_the_idle_one(screw, settings):
    """Each time they halve what is left of the last even cell, and no times change nothing."""
    below = (1 - BESIDE) * idle_load(screw)

    def shared(asked):
        nodes, _ = signed_loads(screw, asked)
        return nodes[(nodes >= 0) & (nodes <= below * (1 + 1e-9))] / below

    settings = replace(settings, load_cells=4)
    assert shared(replace(settings, idle_halvings=0)) == pytest.approx([0, 0.25, 0.5, 0.75, 1])
    crowded = np.array([0, 8, 16, 24, 28, 30, 31, 32]) / 32
    assert shared(settings) == pytest.approx(crowded)
    nodes, _ = signed_loads(screw, replace(settings, load_range=(0.0, 1500.0)))
    assert nodes.tolist() == [0.0, 375.0, 750.0, 1125.0, 1500.0]


def test_oversize_balls_have_nodes_where_their_motion_changes(screw, settings):
    """Steps below 0.3 preloads from 1.5 to 2.9; no break but zero, for nothing jumps."""
    oversize = replace(screw, nut='oversize')
    nodes, breaks = signed_loads(oversize, settings)
    assert breaks == [0.0]
    assert nodes.tolist() == (-nodes[::-1]).tolist()
    changing = nodes[(nodes > 1.5 * screw.preload) & (nodes < 2.9 * screw.preload)]
    assert len(changing) >= 6
    assert np.diff(changing).max() < 0.3 * screw.preload
    assert solved_grid(oversize, OIL, settings).loads.tolist() == nodes[nodes >= 0].tolist()


@pytest.mark.parametrize('ends', [(0.0, 1500.0), (-300.0, 5000.0), (400.0, 900.0), (3e3, 4e3)])
def test_any_range_has_its_ends_as_nodes(screw, settings, ends):
    """One-sided ones too, below and above idle."""
    nodes, breaks = signed_loads(screw, replace(settings, load_range=ends))
    assert nodes[[0, -1]] == pytest.approx(ends)
    assert (np.diff(nodes) > 0).all()
    assert (0.0 in breaks) == (ends[0] <= 0)


@pytest.mark.parametrize('shift', [-0.5, 0.0, 0.5])
def test_a_range_that_ends_beside_idle_is_covered(screw, settings, shift):
    """Its end is a node, whichever side of it."""
    end = (1 + shift * BESIDE) * idle_load(screw)
    for ends in ((0.0, end), (end, 4000.0)):
        nodes, _ = signed_loads(screw, replace(settings, load_range=ends))
        assert nodes[[0, -1]].tolist() == list(ends)


def test_loads_of_a_free_screw_crowd_zero(screw, settings):
    """No idle load; without preload nothing touches at zero, so the nodes nearest it are light."""
    nodes, breaks = signed_loads(replace(screw, preload=0.0), settings)
    assert breaks == [0.0]
    sizes = nodes[nodes > 0]
    assert sizes[0] < 0.005 * sizes[-1]
    assert np.diff(np.log(sizes)) == pytest.approx(np.diff(np.log(sizes))[0])
    assert (nodes == -nodes[::-1]).all()


def test_the_onset_is_that_of_the_law_on_the_faster_side(screw, oil):
    """By the entrainment of the screw before its inlet is heated, under preload; faster hot."""
    found = onset_speeds(Contacts.of(screw), oil, np.array([0.0]), np.array([WARM, 340.0]))
    force, fluid = float(normal_force(screw, screw.preload)), oil_at(oil, WARM)
    fastest, side = max(
        (onset.speed(screw_contact(screw, side), force, fluid, oil.film_floor), side)
        for side, onset in Contacts.of(screw).law.onsets.items()
    )
    entrained = found[0, 0] * no_slip_rates(screw).entrainment
    assert inlet_speed(screw, oil, side, force, entrained, WARM) == pytest.approx(fastest)
    assert entrained > fastest
    assert found[0, 1] > found[0, 0]


def test_a_starved_film_moves_the_onset(screw, oil):
    """To the speed at which the flooded film is that of the onset, divided by the share."""
    place = np.array([0.0, 900.0]), np.array([WARM])
    flooded = onset_speeds(Contacts.of(screw), oil, *place)
    starved = onset_speeds(Contacts.of(screw), replace(oil, film_factor=0.5), *place)
    assert starved == pytest.approx(2 ** (1 / SPEED_EXPONENT) * flooded)


def test_loads_of_either_sign_have_one_onset(screw, oil):
    """The loaded nut counts, whichever it is; a free screw without load has one, too."""
    loads = np.array([-900.0, 900.0])
    found = onset_speeds(Contacts.of(screw), oil, loads, np.array([WARM]))
    assert found[0] == pytest.approx(found[1])
    free = onset_speeds(
        Contacts.of(replace(screw, preload=0.0)), oil, np.zeros(1), np.array([WARM])
    )
    assert free[0, 0] > 0


def test_smooth_raceways_have_a_stand_in(screw, oil):
    """A speed that the logarithm bears."""
    smooth = replace(screw, roughness=replace(screw.roughness, rms=0.0))
    found = onset_speeds(Contacts.of(smooth), oil, np.zeros(1), np.array([WARM]))
    assert found[0, 0] == pytest.approx(SMOOTH_ONSET / no_slip_rates(screw).entrainment)


def test_speeds_of_every_column_cover_the_range(screw, oil, settings):
    """At every load and temperature, to both ends."""
    nodes = surface_nodes(Contacts.of(screw), oil, settings)
    found = nodes.log_speed
    assert found.shape == (len(nodes.s), len(nodes.load), len(nodes.temperature))
    low, high = np.log(settings.speed_range)
    assert (found[0] <= low + 1e-9).all()
    assert (found[-1] >= high - 1e-9).all()
