# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Phrases of health follow from codes and numbers of its message as its sentences do."""

from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.health.causes import BEARING_DRAG
from ballscrew_monitor.health.records import Cause, CauseCode, Condition, Health, Quantity
from ballscrew_monitor.health.words import advice_of, Certainty, explained, verdict_of
from ballscrew_monitor.messages.health_messages import health_message
from ballscrew_monitor.page.components import languages
from ballscrew_monitor.page.health_phrases import advice_phrase, verdict_phrase
from ballscrew_monitor.page.phrases import english
from ballscrew_msgs.msg import AxisHealth, HealthCause, HealthQuantity
from hypothesis import given
from hypothesis import strategies as st
import pytest

CODES = st.lists(st.sampled_from(CauseCode), unique=True, max_size=5)
SIZE = Quantity(name='size', unit='K', value=4.0, low=3.0, high=5.0)


def quantity(name, value):
    return Quantity(name=name, value=value, low=value - 0.05, high=value + 0.05)


def cause(code, excluded, weight=0.5):
    return Cause(code=code, size=SIZE, weight=weight, excluded=excluded, text='T')


def message_of(condition, causes, drag, preload, since=0):
    """Return the message of a health, and its sentences."""
    said = verdict_of('x', condition, drag, causes, since), advice_of(condition, causes)
    health = Health(
        axis='x',
        stamp=1,
        since=since,
        condition=condition,
        verdict=said[0],
        advice=said[1],
        quantities=(drag, preload),
        causes=causes,
    )
    return health_message(health, surface_id='', policy=WarningPolicy.BOTH)


@given(
    condition=st.sampled_from(Condition),
    codes=CODES,
    unfit=st.sets(st.sampled_from(CauseCode)),
    change=st.sampled_from((-0.2, 0.2)),
    known=st.booleans(),
)
def test_phrases_say_what_the_sentences_say(condition, codes, unfit, change, known):
    """Advice to the letter, a verdict by how sure its cause is, and by its numbers."""
    preload = quantity('preload', 0.6) if known else Quantity(name='preload')
    causes = [cause(code, code in unfit, 0.5**at) for at, code in enumerate(codes)]
    message = message_of(condition, causes, quantity('drag change', change), preload)
    advice, verdict = advice_phrase(message), verdict_phrase(message)
    assert english(advice) == message.advice
    kind = {
        Condition.UNKNOWN: 'unsure',
        Condition.NORMAL: 'normal',
        Condition.SLIGHTLY_CHANGED: 'slight',
        Condition.WORSE: 'worse',
    }
    assert verdict['key'] == f'verdict_{kind[condition]}'
    assert verdict['values']['value'] == {'value': change, 'unit': '-'}
    if condition in (Condition.WORSE, Condition.SLIGHTLY_CHANGED):
        why = verdict['values']['why']
        begin = Certainty[why['key'].removeprefix('why_').upper()].value.partition('{}')[0]
        assert f'; {begin}' in message.verdict
        _, likely = explained(causes)
        assert ('cause' in why['values']) is bool(likely)
        told = joined(why['values']['cause']) if likely else []
        assert [one['key'] for one in told] == [
            f'change_{one.code.name.lower()}' for one in likely
        ]
        for one, phrase in zip(likely, told, strict=True):
            of_preload = one.code is CauseCode.PRELOAD_LOST and known
            assert phrase['values']['value']['value'] == (0.6 if of_preload else SIZE.value)


def joined(phrase):
    """Return the phrases that are said together."""
    if phrase['key'] != 'cause_or':
        return [phrase]
    return [*joined(phrase['values']['first']), phrase['values']['second']]


def test_a_change_has_its_day():
    drag = quantity('drag change', -0.2)
    day = 1_752_451_200 * 10**9  # 14 July 2025
    dated = message_of(Condition.WORSE, (), drag, Quantity(name='preload'), day + 1)
    assert dated.since.sec == 1_752_451_200
    verdict = verdict_phrase(dated)
    assert (verdict['key'], verdict['values']['since']) == ('verdict_worse_since', '2025-07-14')
    undated = verdict_phrase(message_of(Condition.WORSE, (), drag, Quantity(name='preload')))
    assert (undated['key'], 'since' in undated['values']) == ('verdict_worse', False)


def test_what_is_not_known_has_the_reason_of_the_node():
    drag = Quantity(name='drag change', reason='not known yet: no baseline')
    message = message_of(Condition.UNKNOWN, (), drag, Quantity(name='preload'))
    said = verdict_phrase(message)
    assert said['values']['why'] == {'free': 'not known yet: no baseline'}
    assert english(said) == message.verdict


def test_words_of_another_version_stay():
    """So do an advice on oil and feed, and a verdict without its numbers."""
    told = {'verdict': 'V', 'advice': 'A'}
    assert verdict_phrase(AxisHealth(**told)) == {'free': 'V'}
    assert advice_phrase(AxisHealth(**told)) == {'free': 'A'}
    assert verdict_phrase(AxisHealth()) == advice_phrase(AxisHealth()) == ''
    drag = HealthQuantity(name='drag change', value=0.2, low=0.1, high=0.3)
    causes = [HealthCause(code=99, weight=1.0, text='T')]
    worse = {'condition': AxisHealth.CONDITION_WORSE, 'quantities': [drag], 'causes': causes}
    message = AxisHealth(**worse, **told)
    assert verdict_phrase(message)['values']['why']['values']['cause'] == {'free': 'T'}
    assert advice_phrase(message) == {'free': 'A'}


@pytest.mark.parametrize('language', languages())
def test_a_support_bearing_with_play_is_no_wiper(language):
    size = Quantity(name=BEARING_DRAG, unit='N m', value=-0.12, low=-0.2, high=-0.05)
    bearing = Cause(code=CauseCode.WIPER, size=size, weight=0.5, excluded=False, text='T')
    changed = Condition.WORSE, [bearing], quantity('drag change', -0.2), Quantity(name='preload')
    message = message_of(*changed)
    assert 'wiper' not in message.advice
    assert advice_phrase(message)['key'] == 'remedy_bearing_play'
    assert english(advice_phrase(message)) == message.advice
    why = verdict_phrase(message)['values']['why']
    assert why['values']['cause']['key'] == 'change_bearing_play'
    assert {'change_bearing_play', 'remedy_bearing_play'} <= set(languages()[language])
