# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Acts of a browser on a real node, and their refusal where acting is off."""

import asyncio
import contextlib

from action_msgs.msg import GoalStatus, GoalStatusArray
from ballscrew_monitor.node.state_database import read_entries
from ballscrew_monitor.page import acting
from ballscrew_monitor.page.acting import Acting, refusals
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.hub import Browser, Hub
from ballscrew_monitor.page.phrases import english
from ballscrew_monitor.page.ros_side import RosSide
from ballscrew_monitor.settings.qos import LATCHED_QOS, started_node
from ballscrew_msgs.srv import AcknowledgeAlarm, ShelveAlarm
import pytest
from surrogate.files import InputError

NAME = '/ballscrew_monitor/x'
DEADLINE = 600.0  # [s] which only ends a hang
# Hot oil and hardly any speed: it takes long.
LONG = {'speed_rpm': 0.5, 'load_N': 2600.0, 'temperature_degC': 80.0}


class Actor:
    """A browser of a page that hears a node and may act."""

    def __init__(self, node, ros_node, parts):
        self.node, self.parts, self.browser, self.hub = node, parts, Browser(), Hub(acting=True)
        self.ros_node = ros_node
        self.hub.browsers.add(self.browser)
        self.ros = RosSide(ros_node, self.hub, lambda act, *given: act(*given))
        self.acting = Acting(ros_node, self.hub)
        self.ros.start()

    def until(self, condition, what):
        view = self.hub.axes.get
        return self.node.until(lambda: view(NAME) and condition(view(NAME)), what)

    def ask(self, do, **request):
        """Return the record of an answer."""
        return asyncio.run(self.acting.handlers[do](self.browser, self.request(**request)))[0]

    @staticmethod
    def request(**request):
        return {'id': 1, 'axis': NAME, **request}


@pytest.fixture
def actor(node, page_parts, monkeypatch):
    monkeypatch.setattr(acting, 'PATIENCE', DEADLINE)
    with started_node('ballscrew_page', node.domain) as ros_node:
        made = Actor(node, ros_node, page_parts)
        with contextlib.closing(made.ros):
            yield made


def number_active(view):
    """Return the number of the event that is active, 0 for none."""
    return max((number for number, event in view.events.items() if event['active']), default=0)


def test_nothing_is_done_where_acting_is_off(refused):
    handlers = refusals()
    assert set(handlers) == set(acting.ACTS)
    for handler in handlers.values():
        with refused('off'):
            asyncio.run(handler(Browser(), {}))


def test_a_warning_is_shelved_and_acknowledged_by_name(actor, node, tmp_path, says, refused):
    node.start(x__limits__raise_delay=0.0, x__max_future=3600.0, state_dir=tmp_path)
    publish = node.machine()

    def creep():
        publish(0.6, -1500.0)
        node.spin()

    actor.node.wait_for(lambda: NAME in actor.hub.axes, meanwhile=node.spin)
    view = actor.hub.axes[NAME]
    node.wait_for(lambda: number_active(view), meanwhile=creep)
    shelve = {'minutes': 5, 'name': 'Ada', 'reason': 'oil is ordered'}
    assert actor.ask('shelve', **shelve)['message']['key'] == 'shelved_until'
    node.wait_for(lambda: view.state['shelved'], meanwhile=creep)
    assert view.state['shelved']['reason'] == 'oil is ordered (Ada)'
    assert 0.0 < view.state['shelved']['left_s'] <= 300.0
    number = number_active(view)
    seen = {'name': 'Ada', 'reason': 'oil is ordered'}
    assert english(actor.ask('acknowledge', **seen)['message']) == says('acknowledged')
    node.until(lambda: not number_active(view), 'the end of the event')

    def told():
        record, _ = actor.parts.read(view.events_frame())
        keys = 'acknowledged', 'acknowledged_by', 'acknowledge_reason'
        return [tuple(map(event.get, keys)) for event in record['events']]

    assert told() == [(True, 'Ada', 'oil is ordered')]

    def logged():
        entries = [entry.record() for entry in read_entries(tmp_path)]
        return [one for one in entries if one['kind'] == 'acknowledge']

    entry = node.until(logged, 'the entry of the log')[0]
    assert {key: entry[key] for key in ('event', *seen)} == {'event': number, **seen}
    # Who acknowledges the next one does it elsewhere.
    node.wait_for(lambda: number_active(view), meanwhile=creep)
    assert node.call(AcknowledgeAlarm, 'acknowledge_as', axis='x', name='Bo').success
    node.until(lambda: not number_active(view), 'the end of the next event')
    assert told() == [(True, 'Bo', ''), (True, 'Ada', 'oil is ordered')]
    # What the node refuses is refused in its words.
    with refused('too_long'):
        actor.ask('shelve', minutes=1e6, name='Ada', reason='holidays')
    with refused('no_name'):
        actor.ask('acknowledge', name='')
    with refused('no_reason'):
        actor.ask('acknowledge', name='Ada', reason='x' * 201)
    for wanting in ({'name': ''}, {'name': 'Ada', 'minutes': 5, 'reason': None}):
        with refused('no_name' if not wanting['name'] else 'no_reason'):
            actor.ask('shelve', **{'minutes': 5, **wanting})


def test_a_node_of_an_older_version_is_named(actor, node, refused, monkeypatch):
    """One that is not there at all does not answer."""
    monkeypatch.setattr(acting, 'PATIENCE', 1.0)
    for name in ('/older/x', '/nobody/x'):
        actor.hub.add(AxisView(*name.rsplit('/', 1)))
    with started_node('older', node.domain), refused('older'):
        names = actor.ros_node.get_fully_qualified_node_names
        node.wait_for(lambda: '/older' in names(), 'the older node in the graph')
        actor.ask('acknowledge', axis='/older/x', name='Ada')
    with refused('nobody'):
        actor.ask('acknowledge', axis='/nobody/x', name='Ada')


def test_what_ros_refuses_is_raised_and_the_page_goes_on(actor, node):
    node.start()
    actor.until(lambda view: view.surface, 'the surface')
    asked = ShelveAlarm.Request(reason='\ud800')  # half a character
    with pytest.raises(UnicodeEncodeError):
        asyncio.run(actor.acting._call(actor.hub.axes[NAME], ShelveAlarm, 'shelve', asked))
    assert actor.ros.failure is None
    assert actor.ask('acknowledge', name='Ada')['message']


def test_a_solve_tells_its_progress_and_its_result(actor, node):
    node.start(x__correct_surface=False)
    actor.until(lambda view: view.surface, 'the surface')
    view = actor.hub.axes[NAME]
    view.limits = actor.parts.limits
    place = {'speed_rpm': 955.0, 'load_N': 500.0, 'temperature_degC': 40.0}
    record = actor.ask('solve', **place)
    assert {name: record[name] for name in place} == pytest.approx(place)
    surface = view.surface.lookup(100.0, 500.0, 313.15)
    assert record['efficiency'] == pytest.approx(surface.efficiency, abs=0.03)
    assert english(record['words']).startswith('Solved')
    frames = [actor.parts.read(made)[0] for made in actor.browser._replies]
    assert {(one['kind'], one['id']) for one in frames} == {('progress', 1)}
    assert 0.0 <= frames[-1]['share'] <= 1.0


def test_a_solve_is_taken_back_by_request_and_with_its_browser(actor, node, refused):
    node.start()
    actor.until(lambda view: view.surface, 'the surface')
    solve, cancel = (actor.acting.handlers[name] for name in ('solve', 'cancel'))

    async def solving(end):
        under_way = asyncio.create_task(solve(actor.browser, actor.request(**LONG)))
        while not node.solvers():
            await asyncio.sleep(0.02)
        await end()
        await under_way

    async def by_request():
        """Try until the page has heard of its goal, maybe after the solve has begun."""
        with refused('twice'):
            await solve(actor.browser, actor.request(**LONG))
        while True:
            with contextlib.suppress(InputError):
                return await cancel(actor.browser, {'id': 2, 'solve': 1})
            await asyncio.sleep(0.02)

    async def by_leaving():
        actor.hub.browsers.clear()

    goals = node.listen(GoalStatusArray, '/ballscrew_monitor/solve/_action/status', LATCHED_QOS)
    for number, (end, key) in enumerate(
        ((by_request, 'cancelled'), (by_leaving, 'left')), start=1
    ):
        with refused(key):
            asyncio.run(asyncio.wait_for(solving(end), DEADLINE))
        all_back = [GoalStatus.STATUS_CANCELED] * number
        node.until(
            lambda all_back=all_back: (
                goals and [one.status for one in goals[-1].status_list] == all_back
            ),
            'the end of the solve',
        )
    with refused('no_solve'):
        actor.ask('cancel', solve=1)
