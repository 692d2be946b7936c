# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A page in German holds no English: on a recording with a warning, and of what a node sends."""

import json
import re
import subprocess
import sys

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Reason
from ballscrew_monitor.health.records import CauseCode
from ballscrew_monitor.page import phrases, records
from ballscrew_msgs import msg
from ballscrew_msgs.msg import AxisHealth
import pytest
from surrogate.files import to_json

ADVICE = 'Empfehlung: bei dieser Last mit '
READ = """(place) => {
    const walk = document.createTreeWalker(document.querySelector(place), NodeFilter.SHOW_TEXT);
    const found = [document.title];
    while (walk.nextNode()) {
      found.push(walk.currentNode.data);
    }
    for (const one of document.querySelectorAll(`${place} :is([aria-label], [title])`)) {
      found.push(one.ariaLabel ?? '', one.title);
    }
    return found.filter((text) => text.trim());
}"""


def words_in(texts):
    return {word for text in texts for word in re.findall(r'[a-zäöüß]{2,}', text.lower())}


@pytest.fixture
def english(frames):
    """Return the words that are in the English table alone."""
    return words_in(frames.words('en').values()) - words_in(frames.words('de').values())


@pytest.fixture
def played(request, short_bag, tmp_path):
    """Return the address of the page of a recording that begins with a warning, with advice."""
    nominal = request.config.rootpath / 'config' / 'nominal_cycle.yaml'
    params = tmp_path / 'params.yaml'
    params.write_text(nominal.read_text() + '      advice: {speed: true}\n')
    command = [sys.executable, '-m', 'ballscrew_monitor', 'page', short_bag]
    options = ['--language', 'de', '--port', '0', '--params', params]
    process = subprocess.Popen([*command, *options], stdout=subprocess.PIPE, text=True)
    try:
        yield process.stdout.readline().split()[1]
    finally:
        process.terminate()
        process.communicate()


def english_in(tab, place, english):
    texts = tab.ask(f'({READ})({place!r})')
    return [text for text in texts if words_in([text]) & english]


def test_a_warning_of_a_recording_holds_no_english(tab, played, english):
    tab.visit(played)
    tab.until("document.querySelectorAll('.u-over').length === 7")
    tab.ask("page.live.ask({ do: 'pause' }); page.live.ask({ do: 'seek', s: 1.5 }); 0")
    outside = "document.querySelector('.sign.level .word').textContent"
    tab.until(f"{outside}.endsWith('außerhalb des optimalen Bereichs')")
    for place, begin in (('reason', 'Der Ölfilm ist zu dünn: '), ('advice', ADVICE)):
        tab.until(f"document.querySelector('.{place}').textContent.startsWith('{begin}')")
    tab.until("document.querySelector('.legend li') && document.querySelector('.events td')")
    tab.button('.what-if', '80, 100 und 120 % Vorschub probieren')
    tab.until("document.querySelectorAll('.results p').length === 3")
    assert english_in(tab, '.first', english) == []
    assert english_in(tab, 'body', english) == []


def healths():
    """Yield what health may say: each condition, each cause alone and beside another."""
    size = {'unit': 'K', 'value': 4.0, 'low': 3.0, 'high': 5.0}
    drag = msg.HealthQuantity(name='drag change', unit='-', value=-0.2, low=-0.3, high=-0.1)
    preload = msg.HealthQuantity(name='preload', unit='-', value=0.6, low=0.5, high=0.7)
    for condition in (AxisHealth.CONDITION_UNKNOWN, AxisHealth.CONDITION_NORMAL):
        yield AxisHealth(axis='x', condition=condition, quantities=[drag])
    for codes in (
        (),
        *((code,) for code in CauseCode),
        (CauseCode.WIPER, CauseCode.TORQUE_CONSTANT),
    ):
        causes = [
            msg.HealthCause(code=int(code), weight=0.5, size=msg.HealthQuantity(**size))
            for code in codes
        ]
        told = {'axis': 'x', 'condition': AxisHealth.CONDITION_WORSE, 'causes': causes}
        yield AxisHealth(quantities=[drag, preload], **told)


def phrases_of_a_node():
    """Yield what frames say by codes and numbers."""
    yield phrases.missing([one.name.lower() for one in Source])
    yield phrases.violated('rcs', 0.27, 0.01)
    for derived in (False, True):
        yield phrases.violated('efficiency', 0.7, 0.85, derived=derived)
    for reason in Reason:
        yield phrases.unjudged(reason, 640.0, -900.0, 41.5)
    yield phrases.advised(-67.0)
    for health in healths():
        record = records.health_record(health)
        yield from filter(None, (record['verdict'], record['advice']))


@pytest.mark.parametrize('language', ['de', 'en'])
def test_all_that_has_a_code_is_said_whole(tab, greeted, english, language):
    """No value is left out, no sentence is free, and German holds no English."""
    tab.visit(greeted.url, language=language)
    tab.until("document.querySelector('.sign.level .word')?.textContent")
    said = json.dumps(to_json(list(phrases_of_a_node())))
    texts = tab.ask(f"""{said}.map((one) => Words.told(one, page.axis.facts)
        .map((part) => part.lang ? '{{en}}' : part).join(''))""")
    assert len(set(texts)) > 32
    assert not [text for text in texts if re.search('[{}]|undefined|null|object|NaN|–', text)]
    if language == 'de':
        assert not [text for text in texts if words_in([text]) & english]
