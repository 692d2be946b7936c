# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Frames to the browser: a record as JSON, and the arrays that it names.

A frame is the length of the JSON (uint32), the JSON in UTF-8, padded by spaces so that the arrays
begin at a multiple of 8, and the arrays as float64, all of little endian. Numbers of the JSON that
are not finite are null; in an array NaN is not known.

"""

from collections.abc import Mapping
import json
import struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from surrogate.files import to_json

LENGTH = struct.Struct('<I')
ALIGNED = 8  # [byte]


def frame(kind: str, record: Mapping[str, Any], arrays: Mapping[str, ArrayLike] = {}) -> bytes:
    """Return a frame of a `kind`; `arrays` by name, in their order."""
    parts = {name: np.asarray(values, dtype='<f8') for name, values in arrays.items()}
    named = [[name, values.size] for name, values in parts.items()]
    content = to_json({'kind': kind, **record, 'arrays': named})
    text = json.dumps(content, separators=(',', ':'), allow_nan=False).encode()
    text += b' ' * (-(LENGTH.size + len(text)) % ALIGNED)
    return b''.join(
        [LENGTH.pack(len(text)), text, *(values.tobytes() for values in parts.values())]
    )
