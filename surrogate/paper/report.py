# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The report of the comparison with the published study: a page in Markdown from its rows."""

from collections.abc import Mapping
from pathlib import Path

from surrogate.asperities.law import AsperityLaw
from surrogate.files import new_file
from surrogate.paper.marks import marks, table
from surrogate.paper.rows import StudyRow
from surrogate.paper.trends import ERRORS, SAME, summary, trend_table, trends
from surrogate.parameters import Screw
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.full_record import law_sentence
from surrogate.surface.aims import EFFICIENCY_TOLERANCE

REPORT = 'paper.md'
"""Name of the report in the output folder."""


def report(screw: Screw, law: AsperityLaw, rows: Mapping[str, StudyRow]) -> str:
    """Return the page: where its numbers are from, the trends side by side, other numbers."""
    seconds = sum(row.seconds for row in rows.values() if row.status == 'CONVERGED')
    every = trends(screw, law, rows.values())
    parts = (
        '# Numbers beside the published study',
        'Written by `ballscrew figures`; docs/theory/validation.md says what they mean. '
        f'{len(rows)} solves, {seconds:.0f} s of processor time.',
        f'Rolling: {law_sentence(screw, ScrewSettings())}; that speed has a '
        f'standard deviation of {100 * law.deviation:.0f} %.',
        '## Trends',
        'Standing roughness is, in single contacts, that of the study, and in the screw one draw '
        'of its own Rq by the standard. Agrees: the course over all places is the reported one; '
        f'in part: a part of it is. Changes below {100 * SAME:g} %, of efficiencies below '
        f'{EFFICIENCY_TOLERANCE:g}, of means below {ERRORS:g} standard errors, count as none.',
        trend_table(every),
        summary(every),
        '## Other numbers',
        table(marks(screw, rows)),
    )
    return '\n\n'.join(parts) + '\n'


def write_report(folder: Path, text: str) -> Path:
    """Write the report as a whole and return its path."""
    path = folder / REPORT
    with new_file(path) as partial:
        partial.write_text(text, encoding='utf-8')
    return path
