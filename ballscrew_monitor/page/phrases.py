# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Phrases of frames: a key of the table of words and its values, said in the language of a browser.

A value is a text, a number of a quantity of `quantities.js`, a number with a unit, a phrase or a
list of these. What a node says as a sentence alone is free: it stays as it is, in English.

"""

from collections.abc import Sequence
import math
from typing import Any

from ballscrew_monitor.core.judgement import Reason
from ballscrew_monitor.page.components import ENGLISH, languages
from surrogate.files import InputError
from surrogate.units import RPM

Phrase = dict[str, Any]
Said = str | Phrase
"""A phrase, or an empty text where nothing is said."""
KEYS_OF_REASON = {int(reason): f'reason_{reason.name.lower()}' for reason in Reason}


def phrase(key: str, **values: Any) -> Phrase:
    """Return what a key of the table of words says of some values."""
    return {'key': key, 'values': values}


def free(sentence: str) -> Phrase:
    """Return a sentence that has no key."""
    return {'free': sentence}


class Refused(InputError):
    """A refusal that has words in each language."""

    def __init__(self, sentence: Said) -> None:
        """Refuse by a phrase whose values are texts and free sentences."""
        self.sentence = sentence
        super().__init__(english(sentence))


def english(sentence: Said) -> str:
    """Return a sentence in English; the values of a phrase are texts and free sentences."""
    if isinstance(sentence, str):
        return sentence
    if 'free' in sentence:
        return str(sentence['free'])
    values = {name: english(value) for name, value in sentence['values'].items()}
    return languages()[ENGLISH][sentence['key']].format(**values)


def violated(quantity: str, value: float, limit: float, *, derived: bool = False) -> Phrase:
    """Return that `rcs` or `efficiency` breaks its limit [-], the load maybe `derived`."""
    key = f'cause_{quantity}_derived' if derived else f'cause_{quantity}'
    return phrase(key, value={quantity: value}, limit={quantity: limit})


def unjudged(reason: int, turns: float, load: float, temperature: float) -> Phrase:
    """Return why a point is not judged: |speed| [rev/min], opposing load [N], oil [degC]."""
    return phrase(
        KEYS_OF_REASON[reason],
        speed={'speed': turns},
        load={'load_N': load},
        temperature={'temperature_degC': temperature},
    )


def missing(names: Sequence[str]) -> Phrase:
    """Return which inputs have no valid sample."""
    return phrase('reason_missing', inputs=[phrase(f'input_{name}') for name in names])


def detailed(what: Phrase, why: str) -> Phrase:
    """Return a phrase with a free sentence that tells more, if there is one."""
    return phrase('with_detail', what=what, why=free(why)) if why else what


def advised(target_speed: float) -> Said:
    """Return an advice by its speed [rad/s], NaN for none."""
    if not math.isfinite(target_speed):
        return ''
    return phrase('advice_speed', speed={'speed': abs(target_speed) / RPM})
