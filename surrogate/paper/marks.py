# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""All numbers of the comparison with the published study that some rows allow."""

from collections.abc import Mapping
import math

from surrogate.paper.mark import Mark
from surrogate.paper.marks_contact import contact_marks
from surrogate.paper.marks_screw import screw_marks
from surrogate.paper.rows import StudyRow
from surrogate.parameters import Screw


def marks(screw: Screw, rows: Mapping[str, StudyRow]) -> list[Mark]:
    """Return every number that the rows allow: contacts first, then the screw."""
    every = list(rows.values())
    found = contact_marks(every) + screw_marks(screw, every)
    return [mark for mark in found if math.isfinite(mark.value)]
