# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One parameter of the node: its default, what is allowed, a sentence, and its check."""

from collections.abc import Callable
import dataclasses
import enum
import math
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from surrogate.files import InputError

Value = str | float | bool | list[str]
_TYPE_NAMES = {
    bool: 'true or false',
    float: 'a number with a decimal point',
    str: 'a text',
    list: 'a list of texts',
}
BARE_LETTERS = {'y': True, 'Y': True, 'n': False, 'N': False}
BARE_WORDS = "ROS reads a bare y, n, yes, no, on or off as true or false: quote it, such as 'y'"


class Change(enum.Enum):
    """When a parameter may change."""

    LIVE = 'any time'
    UNCONFIGURED = 'while unconfigured'
    NEVER = 'at start only'


LIVE, NEVER = Change.LIVE, Change.NEVER


@dataclasses.dataclass(frozen=True, slots=True)
class ParameterRow:
    """
    One parameter: numbers lie from `low` to `high`, texts are one of `choices` if there are.

    A `rule` raises InputError for a text that has not the form it must have.

    """

    name: str
    default: Value
    unit: str = ''
    low: float = -math.inf
    high: float = math.inf
    change: Change = Change.UNCONFIGURED
    _: dataclasses.KW_ONLY
    choices: tuple[str, ...] = ()
    nonzero: bool = False
    rule: Callable[[Any], None] | None = None
    text: str = ''

    def says(self, text: str) -> 'ParameterRow':
        """Return the row with the sentence that describes it."""
        return dataclasses.replace(self, text=text)

    @property
    def allowed(self) -> str:
        """Return what is allowed, in words; empty if anything of the type is."""
        if self.choices:
            return 'one of ' + ', '.join(self.choices)
        if not isinstance(self.default, float):
            return ''
        return f'{self.low:g} to {self.high:g}' + (', not 0' if self.nonzero else '')

    def read(self, value: Any) -> Any:
        """Return `value`, or the choice for which ROS reads it: `N` without quotes is false."""
        if not isinstance(value, bool):
            return value
        return next((word for word in self.choices if BARE_LETTERS.get(word) is value), value)

    def check(self, name: str, value: Any) -> None:
        """Raise InputError unless `value` is allowed for the parameter `name`."""
        value = self.read(value)
        parts = value if isinstance(value, list) else [value]
        of_texts = not isinstance(value, list) or all(isinstance(part, str) for part in parts)
        if type(value) is not type(self.default) or not of_texts:
            texts = isinstance(self.default, (str, list))
            bare = texts and any(isinstance(part, bool) for part in parts)
            allowed = _TYPE_NAMES[type(self.default)] + (f', {BARE_WORDS}' if bare else '')
            raise InputError(f'parameter {name} is {value!r}, it must be {allowed}')
        good = not self.choices or value in self.choices
        if isinstance(value, float):
            good = self.low <= value <= self.high and not (self.nonzero and value == 0.0)
        if not good:
            unit = f' {self.unit}' if self.unit else ''
            raise InputError(
                f'parameter {name} is {value!r}{unit}, allowed is {self.allowed}{unit}'
            )
        try:
            if self.rule is not None:
                self.rule(value)
        except InputError as error:
            raise InputError(f'parameter {name}: {error}') from None

    def descriptor(self) -> ParameterDescriptor:
        """Return the descriptor that ROS tools show and that rclpy enforces."""
        descriptor = ParameterDescriptor(
            description=f'{self.text} [{self.unit}]' if self.unit else self.text,
            read_only=self.change is Change.NEVER,
        )
        if isinstance(self.default, float):
            descriptor.floating_point_range = [
                FloatingPointRange(from_value=self.low, to_value=self.high)
            ]
        changes = f'changes {self.change.value}' if self.change is not Change.NEVER else ''
        descriptor.additional_constraints = '; '.join(filter(None, (self.allowed, changes)))
        return descriptor
