# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The record of all comparisons, computed once."""

import pytest
from surrogate.studies import drag
from surrogate.studies.validation import validation_record


@pytest.fixture(scope='session')
def record(one_small_tile):
    """Compute every comparison; at a tenth of C a tile of each shipped size is enough."""
    torques = one_small_tile()(drag._torques)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(drag, '_torques', torques)
        return validation_record()
