# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Frames to the browser: a record as JSON, and the arrays that it names.

A frame is the length of the JSON (uint32), the JSON in UTF-8, padded by spaces so that the arrays
begin at a multiple of 8, and the arrays as float64, all of little endian. Numbers of the JSON that
are not finite are null; in an array NaN is not known. Rows have the machine frame; the map has the
amount of the speed and the load that opposes the motion. A sentence is a phrase, `{"key": ...,
"values": {...}}`, of the words of the language, or `{"free": ...}`.

| kind | comes | content |
|---|---|---|
| hello | first, and when nodes, axes or limits change | nodes, axes, words, waiting, notices |
| clock | with a recording, twice a second | at_s, span_s, rate, playing |
| history | after hello | rows of the last ten minutes, 50 a second at most |
| state | 25 times a second at most, else once | standing, level, zone, advice, inputs, new rows |
| map | after hello; when oil, limits, surface or loads change | cells, zone, time spent, lines |
| events | after hello and with each change | the last 100, the newest first |
| progress, answer | for a request | by the id of the request |

A request is JSON, `{"id": 1, "do": "read", ...}`; the last four are refused without
`--allow-acting`:

| do | takes |
|---|---|
| map | axis, quantity, temperature_degC, oil |
| read | axis, speed_rpm, load_N, temperature_degC |
| ghosts | axis, factors: the motion of the last minutes at these parts of its feed |
| play, pause, rate, seek | x; s: for a recording |
| solve, cancel | axis, speed_rpm, load_N, temperature_degC; solve |
| acknowledge | axis, name; reason may be left out |
| shelve | axis, name, minutes, reason |

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
