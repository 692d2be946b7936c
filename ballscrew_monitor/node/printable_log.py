# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A log of ROS in which no text of a file or a request steers a terminal or poses as a record."""

from typing import Any

from rclpy.impl import rcutils_logger
from rclpy.impl.rcutils_logger import RcutilsLogger
from surrogate.files import printable

# A record names who logs, not this file.
rcutils_logger._internal_callers.append(__file__)
BELOW = '\n    '
"""Begin of a further line of a record."""


class PrintableLogger(RcutilsLogger):
    """A logger that escapes control characters, and indents all lines but the first."""

    def log(self, message: Any, severity: Any, **kwargs: Any) -> Any:
        """Log a message as `RcutilsLogger` does."""
        return super().log(BELOW.join(printable(str(message)).split('\n')), severity, **kwargs)

    def get_child(self, name: str) -> RcutilsLogger:
        """Return a logger below this one."""
        return printable_logger(super().get_child(name))


def printable_logger(logger: RcutilsLogger) -> RcutilsLogger:
    """Let a logger be a `PrintableLogger` from now on; return it."""
    logger.__class__ = PrintableLogger
    return logger
