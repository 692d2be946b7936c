# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Phrases say by codes and numbers what the node says in words, in every language."""

import math
import re

from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.inputs import InputState, Source
from ballscrew_monitor.core.judgement import Level, Reason, Zone
from ballscrew_monitor.health.assess import DRAG, SMALLEST
from ballscrew_monitor.health.energy import AGAINST, BEYOND, LOST
from ballscrew_monitor.health.life import NAMES as LIVES
from ballscrew_monitor.health.peers import NAME as PEERS
from ballscrew_monitor.health.records import CauseCode, Condition
from ballscrew_monitor.health.spectrum import CLASSES
from ballscrew_monitor.health.words import Certainty
from ballscrew_monitor.page import phrases
from ballscrew_monitor.page.axis_view import TOLD_FAULTS
from ballscrew_monitor.page.components import languages
from ballscrew_monitor.page.phrases import advised, phrase
from ballscrew_monitor.page.records import QUANTITIES
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.units import RPM

ENUMERATED = {
    'change': CauseCode,
    'condition': Condition,
    'input': Source,
    'level': Level,
    'reason': Reason,
    'remedy': CauseCode,
    'state': InputState,
    'why': Certainty,
    'zone': Zone,
}
LUBRICATION = ('lubrication part of the burn rate', 'severity shift')
SEVERITIES = (f'severity class {place}' for place in range(CLASSES))
QUANTITIES_OF_HEALTH = (
    DRAG,
    SMALLEST,
    'preload',
    *LUBRICATION,
    *SEVERITIES,
    LOST,
    AGAINST,
    BEYOND,
    *LIVES,
    PEERS,
)
NUMBERS = st.one_of(st.just(float('nan')), st.floats(-1e5, 1e5))


@pytest.mark.parametrize('language', languages())
def test_every_code_has_words(language):
    """One that is added has none at first, and fails here."""
    wanted = {f'{group}_{one.name.lower()}' for group, kind in ENUMERATED.items() for one in kind}
    wanted |= {f'fault_{one}' for one in TOLD_FAULTS}
    wanted |= {f'cause_{name}{end}' for name in QUANTITIES.values() for end in ('', '_derived')}
    wanted |= {f'quantity_{name.replace(" ", "_")}' for name in QUANTITIES_OF_HEALTH}
    assert not wanted - {'cause_rcs_derived'} - languages()[language].keys()


def test_faults_are_named_as_the_diagnostics_name_them():
    words = languages()['en']
    told = {f'fault_{int(one)}': one.text for one in Fault if one in TOLD_FAULTS}
    assert told == {key: word for key, word in words.items() if re.match(r'fault_\d', key)}


@given(speed=NUMBERS)
def test_an_advice_is_told_from_its_speed_without_a_sign(speed):
    said = advised(speed)
    if math.isnan(speed):
        assert said == ''
        return
    assert said == phrase('advice_speed', speed={'speed': abs(speed) / RPM})
    assert said['key'] in languages()['de']


@pytest.mark.parametrize('language', languages())
def test_no_words_of_an_advice_have_a_place_for_a_load(language):
    words = languages()[language]
    advice = {key: text for key, text in words.items() if key.startswith('advice_')}
    assert set(advice) == {'advice_speed'}
    assert not [text for text in advice.values() if '{load' in text]


def test_a_refusal_is_raised_in_english_and_keeps_its_phrase(refused):
    said = phrase('with_detail', what=phrase('no_limits'), why=phrases.free('no state yet'))
    with refused('limits') as caught:
        raise phrases.Refused(said)
    assert caught.value.sentence == said
