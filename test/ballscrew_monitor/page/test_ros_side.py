# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Real nodes as the page hears them: they come, warn and go."""

import contextlib
from pathlib import Path
from types import SimpleNamespace
import xml.etree.ElementTree as ElementTree

from ballscrew_monitor.core.conversions import kelvin
from ballscrew_monitor.core.vitals import VitalSigns
from ballscrew_monitor.judge.full_point import SolvedAt
from ballscrew_monitor.messages.diagnostics import of_node, recording
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_records import Corrections
from ballscrew_monitor.page import hub as hubs
from ballscrew_monitor.page.hub import Browser, Hub
from ballscrew_monitor.page.phrases import english
from ballscrew_monitor.page.ros_side import (
    _act_all,
    AxisLink,
    LATE_QOS,
    RosSide,
    sent_hashes,
    version_problem,
)
from ballscrew_monitor.settings.parameters import defaults
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.msg import BallScrewState, OutOfZone, SurfaceInfo
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
import pytest
from rclpy.parameter import Parameter
from std_msgs.msg import Header
from surrogate.surface import shipped_surface, Surface
from surrogate.units import RPM

NAME = '/ballscrew_monitor/x'
DEADLINE = 600.0  # [s] which only ends a hang
POLICY = Path(__file__).resolve().parents[3] / 'config' / 'sros2_policy.xml'


class Turned:
    """A hub that hears what is in the domain of a node, turn by turn as a test wants it."""

    def __init__(self, node, page):
        self.node, self.page, self.hub, self.posts = node, page, Hub(), []
        self.ros = RosSide(page, self.hub, lambda *act: self.posts.append(act))

    def turn(self):
        """Take what has come, and hand it over."""
        self.page.executor.spin_once(timeout_sec=0.0)
        self.ros._drain()
        for act, *given in self.posts:
            act(*given)
        self.posts.clear()

    def until(self, condition, what):
        return self.node.wait_for(condition, what, meanwhile=self.turn)

    def until_axes(self, *names):
        """Look until these axes are heard, and no other one."""

        def look():
            self.ros._look()
            self.turn()

        is_so = lambda: set(self.ros._links) == set(names)  # noqa: E731
        self.node.wait_for(is_so, 'the axes', meanwhile=look)


@pytest.fixture
def turned(node):
    """Return a page whose thread is not begun."""
    with started_node('ballscrew_page', node.domain) as page:
        yield Turned(node, page)


class Heard:
    """A hub that hears what is in the domain of a node."""

    def __init__(self, node, only=''):
        self.node, self.hub, self._only = node, Hub(), only

    def __enter__(self):
        self._stack = contextlib.ExitStack()
        self.page = self._stack.enter_context(started_node('ballscrew_page', self.node.domain))
        ros = RosSide(self.page, self.hub, lambda act, *given: act(*given), only=self._only)
        self._stack.callback(ros.close)
        ros.start()
        return self

    def __exit__(self, *error):
        self._stack.close()

    def view(self):
        return self.hub.axes.get(NAME)

    def until(self, condition, what):
        return self.node.until(lambda: self.view() and condition(self.view()), what)


@pytest.fixture
def heard(node):
    with Heard(node) as one:
        yield one


def warned(node, heard):
    """Let axis x be warned of, creeping."""
    publish = node.machine()

    def move():
        publish(0.6, -1500.0)
        node.spin()

    node.wait_for(lambda: heard.view() and heard.view().state['level'] == 'warn', meanwhile=move)


def test_an_axis_is_heard_from_its_surface_to_its_warning(node, heard):
    advises = {'x__advice__speed': 'true'}
    node.start(x__limits__raise_delay=0.0, x__max_future=3600.0, **advises)
    heard.until(lambda view: view.surface, 'the surface')
    assert heard.view().hello()['lead_mm'] == pytest.approx(10.0)
    assert heard.view().hello()['unit'] == 'm/min'
    warned(node, heard)
    heard.until(lambda view: view.events, 'the event')
    (event,) = heard.view().events.values()
    assert (event['active'], event['id']) == (True, 1)
    row = heard.view().history.since(0)[-1]
    assert row[1] == pytest.approx(0.6 / RPM)
    assert row[2] == -1500.0
    assert event['advice']['key'] == 'advice_speed'
    assert event['advice']['values']['speed']['speed'] > 0.6 / RPM


def test_a_node_that_leaves_is_gone_and_one_that_returns_is_there(node, heard):
    node.start()
    heard.until(lambda view: view.surface, 'the surface')
    node.stop()
    heard.until(lambda view: view.standing == 'gone', 'the leave')
    # Nothing of it is kept open, however often it comes and goes.
    assert list(heard.page.clients) == []
    node.start()
    heard.until(lambda view: view.standing == 'active', 'the return')
    # What is published for late joiners has been heard again.
    heard.until(lambda view: view.limits['rcs_limit'], 'a state')


def test_what_comes_in_one_turn_is_handed_over_at_once_and_all_of_it(node, turned):
    """Each state and event; and the hub shows it in that turn, not in the next of its own."""
    states = node.node.create_publisher(BallScrewState, '/fast/x/state', 10)
    events = node.node.create_publisher(OutOfZone, '/fast/x/out_of_zone', LATE_QOS)
    turned.until_axes('/fast/x')
    topics = [topic.subscription for topic, _ in turned.ros._links['/fast/x']._topics]
    turned.until(lambda: all(one.get_publisher_count() for one in topics[:2]), 'the publishers')
    browser, count = Browser(), 20
    turned.hub.join(browser, 0.0)
    for number in range(count):
        states.publish(BallScrewState(header=Header(stamp=Time(sec=number))))
        events.publish(OutOfZone(event_id=number + 1))
    view = turned.hub.axes['/fast/x']
    turned.until(lambda: view.history.count == len(view.events) == count, 'all of them')
    assert view.history.since(0)[:, 0].tolist() == list(range(count))
    assert turned.hub.missed == 0
    assert b'"kind":"state"' in browser._waiting[-1]
    states.publish(BallScrewState(header=Header(stamp=Time(sec=count))))
    states.publish(BallScrewState(header=Header(stamp=Time(sec=count + 1))))
    turned.until(lambda: view.history.count == count + 2, 'two more')
    turned.ros._drain()
    assert turned.posts == []  # nothing has come, nothing is handed over


def test_the_executor_is_woken_only_where_an_answer_may_come(turned, monkeypatch):
    woken = []

    def wake(timeout_sec):
        woken.append(timeout_sec)
        turned.ros._stopped.set()

    monkeypatch.setattr(turned.page.executor, 'spin_once', wake)
    turned.ros._pause(0.001)
    assert woken == []
    turned.ros._links['/fast/x'] = SimpleNamespace(is_asking=True)
    turned.ros._pause(DEADLINE)
    turned.ros._links.clear()
    turned.ros._stopped.clear()
    turned.hub.acting = True
    turned.ros._pause(DEADLINE)
    assert len(woken) == 2
    assert 0.0 < max(woken) <= DEADLINE


def test_a_message_that_is_lost_on_the_way_is_counted(node, turned):
    states = node.node.create_publisher(BallScrewState, '/fast/x/state', 10)
    turned.until_axes('/fast/x')
    topic, _ = turned.ros._links['/fast/x']._topics[0]
    turned.until(topic.subscription.get_publisher_count, 'the publisher')
    view = turned.hub.axes['/fast/x']
    states.publish(BallScrewState(header=Header(stamp=Time(sec=0))))
    turned.until(lambda: view.history.count == 1, 'the first state')
    for number in (1, 2):
        states.publish(BallScrewState(header=Header(stamp=Time(sec=number))))
        node.wait_for(topic.waiting, 'what the page does not get')
    states.publish(BallScrewState(header=Header(stamp=Time(sec=3))))
    turned.until(lambda: view.history.count == 2, 'the last state')
    assert turned.hub.missed == 2


def test_axes_that_come_and_go_are_bounded(node, turned, monkeypatch, says, capfd):
    monkeypatch.setattr('ballscrew_monitor.page.ros_side.MOST_AXES', 2)
    for at, name in enumerate(('/fast/c', '/fast/b', '/fast/a')):
        states = node.node.create_publisher(BallScrewState, f'{name}/state', 10)
        turned.until_axes(name)
        assert name in turned.hub.axes
        assert len(turned.hub.axes) == min(2, at + 1)
        node.node.destroy_publisher(states)
        turned.until_axes()
    assert set(turned.ros._gone) == {'/fast/b', '/fast/a'} == set(turned.hub.axes)
    assert says('forgotten') in capfd.readouterr().err
    view = turned.hub.axes['/fast/b']
    states = node.node.create_publisher(BallScrewState, '/fast/b/state', 10)
    turned.until_axes('/fast/b')
    assert turned.hub.axes['/fast/b'] is view  # with its history
    assert list(turned.ros._gone) == ['/fast/a']


def test_an_axis_for_which_there_is_no_room_is_not_followed(node, turned, monkeypatch):
    made = [node.node.create_publisher(BallScrewState, f'/fast/{name}/state', 10) for name in 'ab']
    monkeypatch.setattr('ballscrew_monitor.page.ros_side.MOST_AXES', 1)
    topics = {one.topic_name for one in made}
    known = lambda: topics <= dict(turned.page.get_topic_names_and_types()).keys()  # noqa: E731
    node.wait_for(known, 'both axes')
    turned.until_axes('/fast/a')
    assert list(turned.hub.axes) == ['/fast/a']


def test_an_axis_that_returns_in_another_version_is_not_forgotten(node, turned, monkeypatch):
    states = node.node.create_publisher(BallScrewState, '/fast/x/state', 10)
    turned.until_axes('/fast/x')
    view = turned.hub.axes['/fast/x']
    turned.ros._let_go('/fast/x')
    monkeypatch.setattr('ballscrew_monitor.page.ros_side.version_problem', lambda *given: 'old')
    turned.ros._take_up('/fast/x')
    assert turned.ros._gone == {'/fast/x': view}
    node.node.destroy_publisher(states)


def test_a_warning_of_a_node_is_one_of_each_of_its_axes(node, turned, page_parts):
    names = ('/monitor/x', '/monitor/y', '/other/x')
    views = [page_parts.axis(*name.rsplit('/', 1)) for name in names]
    turned.ros._links = {one.name: SimpleNamespace(view=one, drain=lambda: 0) for one in views}
    warned_of = [recording('/monitor', 'the disk is full'), recording('/stranger', 'hole')]
    turned.ros._on_diagnostics(DiagnosticArray(status=warned_of))
    turned.turn()
    turned.ros._links = {}
    shown = [page_parts.read(one.news(0.0, 0.0)[-1])[0]['faults'] for one in views]
    assert shown == [[601], [601], []]


def test_what_fails_of_one_turn_does_not_take_the_rest_with_it(caplog):
    done = []
    _act_all([(lambda: 1 / 0,), (done.append, 1)])
    assert done == [1]
    assert 'ZeroDivisionError' in caplog.text


def test_a_node_that_is_configured_again_between_two_looks_is_asked_again(node, turned):
    node.start()
    turned.until_axes(NAME)
    about = lambda: turned.hub.axes[NAME].about.get('unit')  # noqa: E731
    turned.until(lambda: about() == 'm/min', 'the surface')
    for step in ('deactivate', 'cleanup'):
        node.transition(step)
    node.set_parameters(x__speed__unit='mm/min')
    for step in ('configure', 'activate'):
        node.transition(step)
    turned.until(lambda: about() == 'mm/min', 'the surface again')


def test_an_inactive_node_says_so(node, heard):
    node.start()
    heard.until(lambda view: view.surface, 'the surface')
    node.transition('deactivate')
    heard.until(lambda view: view.standing == 'inactive', 'the state of the node')
    node.transition('activate')
    heard.until(lambda view: view.standing == 'active', 'the state of the node')


def test_without_the_file_there_is_no_map_but_all_else(node, heard, quick_surface, says):
    """The node has read the file; it is not here any more, or another one is."""
    path = quick_surface.rename(quick_surface.with_name('gone.npz'))
    node.start(x__surface=path)
    heard.until(lambda view: view.surface, 'the surface')
    path.rename(quick_surface)
    with Heard(node) as later:
        later.until(lambda view: view.no_map['key'] == 'no_map_no_file', 'the reason')
        assert english(later.view().no_map).startswith(says('no_file'))
        assert later.view().hello()['screw'] == 'nominal'


def test_the_corrections_of_a_node_are_heard(node, heard, tmp_path):
    """Those of a run before, which the node takes up."""
    surface = Surface.load(shipped_surface())
    place = SolvedAt(speed=103.0, opposing_load=500.0, temperature=kelvin(40.0))
    corrected = surface.with_correction(place, SimpleNamespace(rcs=0.2))
    state = RestartState(tmp_path / 'kept')
    state.keep_corrections(Corrections.of('x', surface.sha256, corrected.corrections))
    state.close()
    node.start(state_dir=tmp_path / 'kept')
    heard.until(lambda view: view.surface and view.surface.corrections, 'the corrections')
    assert heard.view().without == 0
    assert heard.view().surface.lookup(103.0, 500.0, kelvin(40.0)).rcs == pytest.approx(0.2)


def test_other_nodes_are_left_out_if_one_is_named(node, heard):
    with Heard(node, only='/other') as other:
        node.start()
        heard.until(lambda view: view.surface, 'the surface')
        assert other.hub.axes == {}
        assert other.hub.hello()['waiting'] == hubs.NO_NODE


def test_a_node_of_another_version_is_named_and_not_heard(node, heard, monkeypatch, says):
    hashes = iter([({'RIHS01_0'}, {'RIHS01_1'})])
    last = ({'RIHS01_1'}, {'RIHS01_1'})
    monkeypatch.setattr(
        'ballscrew_monitor.page.ros_side.AxisLink.hashes', lambda self: next(hashes, last)
    )
    node.start()
    node.until(lambda: heard.hub.notices, 'the notice')
    heard.until(lambda view: view.surface, 'the surface')
    # It has been mended meanwhile: the notice is gone.
    assert heard.hub.hello()['notices'] == []


def test_two_nodes_of_one_name_are_both_named(node, turned, says):
    """As long as one of them says so; the statuses of both name the same hosts."""
    signs, hosts = VitalSigns(), ['left (process 1)', 'right (process 2)']
    both = [of_node('/old', signs, 0, one) for one in (hosts, hosts[::-1])]
    for status in both:
        turned.ros._on_diagnostics(DiagnosticArray(status=[status]))
    turned.turn()
    (notice,) = turned.hub.hello()['notices']
    assert english(notice) == says('two_nodes')
    turned.ros._on_diagnostics(DiagnosticArray(status=[of_node('/old', signs, 0, hosts[:1])]))
    turned.turn()
    assert turned.hub.hello()['notices'] == []


def test_the_notice_of_a_node_leaves_with_it(node, turned, monkeypatch):
    monkeypatch.setattr('ballscrew_monitor.page.ros_side.version_problem', lambda *given: 'old')
    states = node.node.create_publisher(BallScrewState, '/old/x/state', 10)

    def look():
        turned.ros._look()
        turned.turn()

    node.wait_for(lambda: turned.hub.notices == {'/old': 'old'}, 'the notice', meanwhile=look)
    node.node.destroy_publisher(states)
    node.wait_for(lambda: not turned.hub.notices, 'its end', meanwhile=look)
    assert not turned.ros._refused


def test_versions_are_told_apart_by_the_hashes_of_their_types(says):
    assert version_problem('/m', ({'a'}, {'a'})) == ''
    assert version_problem('/m', (set(), {'a'})) == ''
    assert english(version_problem('/m', ({'a', 'b'}, {'a'}))) == says('version')


def test_events_of_another_version_count_where_the_states_are_of_ours():
    hashes = {f'{NAME}/state': 'a', f'{NAME}/out_of_zone': 'b'}
    graph = SimpleNamespace(
        get_publishers_info_by_topic=lambda topic: [
            SimpleNamespace(topic_type_hash=hashes[topic]) for one in hashes if one == topic
        ]
    )
    assert sent_hashes(graph, NAME) == {'a', 'b'}


def test_the_policy_of_sros2_allows_all_that_the_page_has(node, heard):
    node.start()
    heard.until(lambda view: view.surface, 'the surface')
    profile = ElementTree.parse(POLICY).find(".//profile[@node='ballscrew_page']")
    for kind, use, found in (
        ('topics', 'subscribe', {one.topic_name for one in heard.page.subscriptions}),
        ('topics', 'publish', {one.topic_name for one in heard.page.publishers}),
        ('services', 'request', {one.srv_name for one in heard.page.clients}),
        ('services', 'reply', {one.service_name for one in heard.page.services}),
    ):
        assert found == {one.text for one in profile.findall(f'{kind}[@{use}="ALLOW"]/*')}


def test_the_hashes_of_a_node_and_of_the_page_are_those_of_the_interface(node, heard):
    node.start()
    heard.until(lambda view: view.surface, 'the surface')
    infos = node.until(
        lambda: node.node.get_publishers_info_by_topic(f'{NAME}/state'), 'the publisher'
    )
    read = node.node.get_subscriptions_info_by_topic(f'{NAME}/state')
    assert len({str(one.topic_type_hash) for one in (*infos, *read)}) == 1
    assert 'RIHS01' in str(infos[0].topic_type_hash)


class Declared:
    """A service of parameters, which answers with nothing if it is asked for one it has not."""

    def __init__(self, values):
        self._values = values

    def call(self, request, hear):
        known = all(name in self._values for name in request.names)
        names = request.names if known else []
        values = [Parameter('x', value=self._values[name]).get_parameter_value() for name in names]
        hear(SimpleNamespace(result=lambda: SimpleNamespace(values=values)))


@pytest.mark.parametrize('missing', [set(), {'record_dir'}])
def test_a_node_without_a_parameter_still_has_a_surface(missing):
    values = {name: '' for name in defaults(['x']) if name not in missing}
    values['x.surface'] = 'here.npz'
    link, told, heard = object.__new__(AxisLink), [], {}
    link.view = SimpleNamespace(axis='x', hear_parameters=heard.update)
    link._post = lambda act, *given: act(*given)
    link._surface = SimpleNamespace(
        ask=lambda: None, is_asking=False, tell=lambda about, info, path: told.append(path)
    )
    link._parameters, link._info, link._is_due = Declared(values), SurfaceInfo(), True
    link.ask()
    assert (told, link.is_asking) == (['here.npz'], False)
    assert heard.keys() == ({'x.surface', 'x.speed.unit'} if missing else values.keys())
