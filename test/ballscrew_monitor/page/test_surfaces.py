# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The surface of the page is that of the node, corrections included, by what the node says."""

import math
from types import SimpleNamespace

from ballscrew_monitor.judge.full_point import answer, SolvedAt
from ballscrew_monitor.messages.state_messages import (
    fill_result,
    read_point,
    surface_info_message,
    TIERS,
)
from ballscrew_monitor.messages.unjudged import reason_of
from ballscrew_monitor.page import records, surfaces
from ballscrew_monitor.page.phrases import english
from ballscrew_monitor.page.surfaces import known_surface, places_of, point_message, SurfaceLink
from ballscrew_msgs.msg import PointResult
from hypothesis import given
from hypothesis import strategies as st
import pytest
from rclpy.task import Future
from surrogate.surface import FIELDS, shipped_surface, Surface

SURFACE = Surface.load(shipped_surface())
# Speed [rad/s], opposing load [N] and temperature [K]; the last one lies on a node of temperature.
PLACES = ((31.0, 700.0, 308.0), (9.0, -2200.0, 341.0), (95.0, 500.0, 313.15))
PARTS = st.tuples(*[st.floats(0.01, 0.99)] * 3)


def at(place):
    return SolvedAt(**dict(zip(('speed', 'opposing_load', 'temperature'), place, strict=True)))


def pulled(places, factor=1.7, surface=SURFACE):
    """Return a surface that solves at places have corrected."""
    for place in places:
        found = surface.lookup(*place)
        solved = {'friction_torque': factor * found.friction_torque, 'rcs': 0.2, 'film_ratio': 0.9}
        surface = surface.with_correction(at(place), SimpleNamespace(**solved))
    return surface


def info_of(surface):
    settings = SimpleNamespace(
        limits=SimpleNamespace(rcs=0.01, efficiency=0.85), default_temperature=313.15
    )
    return surface_info_message('x', surface, settings, stamp=0)


def answered(surface, points):
    """Return what a node with a surface answers to points."""
    results = []
    for point in points:
        asked = read_point(point, default_temperature=math.nan)
        result = PointResult()
        row = answer(asked, surface, rcs_limit=0.01)
        fill_result(result, row, TIERS[surface.tier], reason_of(row, surface))
        results.append(result)
    return results


def rebuilt(theirs, mine=SURFACE):
    """Return the surface of the page by the messages of a node, None if it is another."""
    info = info_of(theirs)
    places = places_of(info, mine)
    answers = zip(places, answered(theirs, map(point_message, places)), strict=True)
    return surfaces.with_corrections(mine, len(info.corrected_speed), list(answers))


@pytest.fixture(scope='module')
def theirs():
    return pulled(PLACES)


@pytest.fixture(scope='module')
def mine(theirs):
    return rebuilt(theirs)


@given(parts=PARTS, place=st.sampled_from(PLACES), is_near=st.booleans())
def test_the_rebuilt_surface_is_that_of_the_node(theirs, mine, parts, place, is_near):
    """At any place of the ranges, and about the corrections."""
    ranges = SURFACE.speed_range, SURFACE.load_range, SURFACE.temperature_range
    if is_near:
        ranges = [sorted((0.98 * value, 1.02 * value)) for value in place]
    drawn = [low + part * (high - low) for part, (low, high) in zip(parts, ranges, strict=True)]
    found, wanted = mine.lookup(*drawn), theirs.lookup(*drawn)
    for name in FIELDS:
        value, target = getattr(found, name), getattr(wanted, name)
        assert value == pytest.approx(target, rel=1e-9, abs=1e-12, nan_ok=True), name
    assert found.corrected == wanted.corrected


def test_at_a_correction_it_says_what_was_solved(mine):
    assert len(mine.corrections) == len(PLACES)
    for place in PLACES:
        assert mine.lookup(*place).rcs == pytest.approx(0.2, rel=1e-9)
        assert mine.lookup(*place).corrected


def test_answers_of_another_surface_are_known(theirs):
    other = Surface.load(shipped_surface(tier='closed_form'))
    assert (other.screw_name, other.oil_name) == (SURFACE.screw_name, SURFACE.oil_name)
    assert rebuilt(theirs, other) is None


def test_a_correction_says_nothing_new_of_an_axis(theirs):
    """A page that is told the same keeps what its reader has asked for."""
    one, other = (records.surface_record(info_of(each), 'mm/min') for each in (SURFACE, theirs))
    assert one == other


class Node:
    """A node whose answers come when a test gives them."""

    def __init__(self):
        self.is_ready, self.asked, self.given_up = True, [], []

    def create_client(self, kind, name):
        assert name == '/monitor/evaluate'
        return self

    def service_is_ready(self):
        return self.is_ready

    def call_async(self, request):
        self.asked.append((request, Future()))
        return self.asked[-1][1]

    def remove_pending_request(self, future):
        self.given_up.append(future)

    def answer(self, surface, *, success=True):
        """Answer the last question as a node with a surface."""
        request, future = self.asked[-1]
        results = answered(surface, request.points)
        future.set_result(SimpleNamespace(success=success, results=results))


class Told:
    """The axis x of a page, and what it knows of its surface."""

    def __init__(self, parts):
        self.node, self.view = Node(), parts.axis()
        self.link = SurfaceLink(self.node, self.view, lambda act, *given: act(*given))

    def tell(self, surface):
        self.link.tell({}, info_of(surface), '')

    @property
    def corrections(self):
        return len(self.view.surface.corrections), self.view.without


@pytest.fixture
def told(page_parts):
    return Told(page_parts)


def test_a_surface_without_corrections_is_not_asked_about(told):
    told.tell(SURFACE)
    told.link.ask()
    assert told.corrections == (0, 0)
    assert told.node.asked == []


def test_until_the_node_answers_the_surface_is_told_without_them(told, theirs):
    told.node.is_ready = False
    told.tell(theirs)
    assert told.corrections == (0, 3)
    assert told.node.asked == []
    told.node.is_ready = True
    told.link.ask()
    assert told.corrections == (0, 3)
    told.node.answer(theirs, success=False)
    assert told.corrections == (0, 3)
    told.link.ask()
    told.node.answer(theirs)
    assert told.corrections == (3, 0)
    told.link.ask()
    assert len(told.node.asked) == 2
    # What was asked before is given up, so that no answer is waited for twice.
    assert told.node.given_up == [told.node.asked[0][1]]


def test_an_answer_has_its_time_before_it_is_asked_for_again(told, theirs, monkeypatch):
    told.tell(theirs)
    told.link.ask()
    assert len(told.node.asked) == 1
    monkeypatch.setattr(surfaces, 'PATIENCE', 0.0)
    told.link.ask()
    assert len(told.node.asked) == 2
    assert told.node.given_up == [told.node.asked[0][1]]


def test_an_answer_to_the_question_before_is_not_taken(told, theirs):
    told.tell(theirs)
    _, late = told.node.asked[0]
    told.tell(pulled(PLACES[:1]))
    late.set_result(SimpleNamespace(success=True, results=[]))
    assert told.corrections == (0, 1)
    told.node.answer(pulled(PLACES[:1]))
    assert told.corrections == (1, 0)


def test_another_file_than_that_of_the_node_is_said(told, theirs, says):
    told.tell(theirs)
    told.node.answer(pulled(PLACES, surface=Surface.load(shipped_surface(tier='closed_form'))))
    assert told.view.surface is None
    assert english(told.view.no_map) == says('another', path=shipped_surface())


def test_without_corrections_the_hash_tells_the_file(says):
    info = info_of(SURFACE)
    assert known_surface(info, '')[0].sha256 == SURFACE.sha256
    other = shipped_surface(tier='closed_form')
    sentence = says('hash', path=other, begins=SURFACE.sha256[:16])
    surface, no_map = known_surface(info, str(other))
    assert (surface, english(no_map)) == (None, sentence)


def test_what_corrects_nothing_leaves_the_surface_as_it_was(told, theirs):
    told.tell(theirs)
    results = [PointResult() for _ in told.node.asked[0][0].points]
    told.node.asked[0][1].set_result(SimpleNamespace(success=True, results=results))
    assert told.corrections == (0, 3)
    told.link.ask()
    assert len(told.node.asked) == 1


def test_a_link_that_is_closed_leaves_no_client(told):
    told.node.destroy_client = told.node.given_up.append
    told.link.close()
    assert told.node.given_up == [told.node]
