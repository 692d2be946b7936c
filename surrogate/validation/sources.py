# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Published values, each declared once with its source, beside which number of ours, and why.

A source counts as read where its abstract or text was; the others are cited as the code has them.

"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from surrogate.validation import ours
from surrogate.validation.ours import ValidationCase

Verdict = Literal['agrees', 'differs', 'not comparable']


@dataclass(frozen=True, kw_only=True, slots=True)
class PublishedValue:
    """
    A published value or range, the function of our numbers, and the reason of the verdict.

    `low` and `high` in `unit`; ours agree where all lie within them, widened by the relative
    `tolerance` [-], unless conditions or definitions are not `comparable`. `read`, what of the
    source was read.

    """

    what: str
    source: str
    read: str
    low: float
    high: float
    ours: Callable[[ValidationCase], list[float]]
    reason: str
    unit: str = ''
    tolerance: float = 0.0
    comparable: bool = True

    def verdict(self, found: Sequence[float]) -> Verdict:
        """Return whether our numbers agree."""
        if not self.comparable:
            return 'not comparable'
        low, high = self.low * (1 - self.tolerance), self.high * (1 + self.tolerance)
        return 'agrees' if all(low <= value <= high for value in found) else 'differs'


PUBLISHED = (
    PublishedValue(
        what='amplitude of a wave after pure rolling, over the curve of a line contact',
        source='Venner, Couhier, Lubrecht, Greenwood 1997',
        read='abstract; curve as the code has it',
        low=1.0,
        high=1.0,
        tolerance=0.15,
        ours=ours.waves_over_curve,
        reason='the curve is a fit that joins its ends; ours changes by 1 % on finer grids',
    ),
    PublishedValue(
        what='amplitude of a short wave after pure rolling, over that before',
        source='Hooke 2000',
        read='abstract: it passes unaltered',
        low=1.0,
        high=1.0,
        tolerance=0.05,
        ours=ours.short_wave,
        reason='a quarter of the half length long; shorter ones lose less',
    ),
    PublishedValue(
        what='film ratio above which little or no contact is found',
        source='Zhu, Wang 2012',
        read='abstract',
        low=0.6,
        high=1.2,
        ours=ours.film_ratio_at_onset,
        reason='RCS 0.01 of a new raceway; the law of contact is fitted to marches, not to this',
    ),
    PublishedValue(
        what='share of the load on the film at film ratios of 0.05 and 0.1',
        source='Zhu, Wang 2012',
        read='abstract: can be more than 10 to 15 %',
        low=0.1,
        high=1.0,
        ours=ours.load_on_film,
        reason='a quarter of the onset speed and slower, where no strip was marched; the law lets '
        'the share of the film fall with the speed',
    ),
    PublishedValue(
        what='speed of full film after running in, over that before',
        source='Hansen, Bjorling, Larsson 2020',
        read='abstract: reduced by 90 %',
        low=0.1,
        high=0.1,
        tolerance=0.1,
        ours=ours.run_in_speeds,
        reason='ours over 2 to 5 GPa, the assumed range of the pressure that cuts summits; theirs '
        'slides much and wears mildly',
    ),
    PublishedValue(
        what='loss of Sq by running in',
        source='Hansen, Bjorling, Larsson 2020',
        read='abstract: up to 17 %',
        low=0.0,
        high=0.17,
        ours=ours.run_in_height,
        reason='cut at 3 GPa',
    ),
    PublishedValue(
        what='film parameter (h_m + f h_c)/Spk at the onset',
        source='Hansen, Prajapati, Bjorling, Larsson 2025; Hansen and others 2021',
        read='abstract: 1, without the formula of f',
        low=1.0,
        high=1.0,
        ours=ours.film_parameter_at_onset,
        comparable=False,
        reason='ours for f of 0 and 1, new raceway: the onset agrees if f is small, and lies at '
        'thicker films if not; Spk of tiles lacks the waves that are longer than they are',
    ),
    PublishedValue(
        what='rolling force of the smooth contact over the formula, 27.6 and 100 N',
        source='Biboulet, Houpert 2010',
        read='not the formula; Balan, Houpert and others 2015 measured that such relations hold',
        low=1.0,
        high=1.0,
        tolerance=0.1,
        ours=ours.rolling_over_formula,
        reason='both isothermal; ours with oil 1.4 semi-axes wide and the meniscus at 1 mm, and '
        'with other widths and menisci it is another',
    ),
    PublishedValue(
        what='rolling force with ripples over the formula, 27.6 and 100 N',
        source='Biboulet, Houpert 2010',
        read='as above',
        low=1.0,
        high=1.0,
        tolerance=0.1,
        ours=ours.rough_rolling_over_formula,
        reason='the formula is that of smooth surfaces; ripples that roll through add the rest, '
        'by the law that is fitted to marches',
    ),
    PublishedValue(
        what='drag torque of the preloaded nut, 100 rev/min',
        source='JIS B 1192',
        read='not the standard; formula as catalogues give it, with the allowed range',
        low=0.16,
        high=0.47,
        unit='N m',
        ours=ours.drag_torque,
        reason='ours are the contacts alone; wipers, recirculation and balls against balls are '
        'the parasitic torque, to be identified',
    ),
)
WITHOUT_NUMBER = (
    'Amplitudes measured in pure rolling: Sperka, Krupka, Hartl 2016 (Tribol. Trans. 59, 267) '
    'report a good correlation with the attenuation theory, and a limiting deformation in thin '
    'films; the abstract has no number.',
    'Breakdown ratio of the film on steel: Maruyama and others (NSK) 2024 (Front. Mech. Eng., '
    'doi 10.3389/fmech.2024.1489311) measure it between steel and steel; the ratio over Lambda '
    'is not in the abstract. Source of a number not found.',
    'Micro-EHL term f of the film parameter of Hansen and others: its formula is not in the '
    'abstracts. Source not found.',
)
"""Published measurements of which no number could be read."""
