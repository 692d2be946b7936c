# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files that appear whole or not at all."""

import os
from pathlib import Path
import tempfile


def replace_file(path: str | Path, content: bytes) -> None:
    """
    Write `content` to `path`, making its directory; what was there before is replaced at the end.

    Raises OSError when it cannot be written, or is something else than a regular file; then what
    was there before is as it was and nothing half-written stays.

    """
    path = Path(path)
    if path.exists() and not path.is_file():
        raise OSError(0, 'it is not a regular file', str(path))
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(
        dir=path.parent, prefix=f'.{path.name}.', delete=False
    ) as file:
        temporary = Path(file.name)
        try:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
            temporary.chmod(0o644)
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
