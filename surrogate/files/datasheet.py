# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Declaration, check and reading of a datasheet.

Every quantity is declared once, as a field with the unit on file, the factor to SI and the allowed
range; keys, checks and error sentences all derive from that declaration.

"""

from dataclasses import field, fields, MISSING, replace
import math
from pathlib import Path
import re
from typing import Any, ClassVar, TypeVar

from surrogate.files import InputError
from surrogate.files.limits import read_text
from surrogate.files.plain_yaml import plain_values

DATA = Path(__file__).parents[1] / 'data'

Sheet = TypeVar('Sheet')


def quantity(
    unit: str,
    factor: float,
    low: float,
    high: float,
    *,
    shift: float = 0.0,
    default: Any = MISSING,
    means: str = '',
) -> Any:
    """
    Declare a number: SI = (file + shift) * factor, allowed range in file units.

    The key on file is the name of the field with the unit as its suffix. What it `means` stands in
    the reference.

    """
    return field(
        default=default,
        metadata={
            'unit': unit,
            'factor': factor,
            'shift': shift,
            'low': low,
            'high': high,
            'means': means,
        },
    )


def count(low: int, high: int, *, default: Any = MISSING, means: str = '') -> Any:
    """Declare a whole number and its range."""
    spec = quantity('', 1, low, high, shift=0, default=default, means=means)
    return field(default=default, metadata={**spec.metadata, 'whole': True})


def quantities(unit: str, factor: float, low: float, high: float, *, means: str = '') -> Any:
    """Declare a list of numbers, empty by default; one number alone is a list too."""
    spec = quantity(unit, factor, low, high, means=means)
    return field(default=(), metadata={**spec.metadata, 'many': True})


def text(
    pattern: str = r'(?s).*\S.*',
    allowed: str = 'a text that is not empty',
    *,
    default: Any = MISSING,
    means: str = '',
) -> Any:
    """Declare a text that matches `pattern`, which `allowed` puts in words."""
    metadata = {'text': pattern, 'allowed': allowed, 'means': means}
    return field(default=default, metadata=metadata)


def choice(*allowed: str, default: Any = MISSING, means: str = '') -> Any:
    """Declare a word out of those allowed."""
    return field(default=default, metadata={'choice': allowed, 'means': means})


def same(cls: type, name: str, *, default: Any = None, means: str = '') -> Any:
    """
    Declare a field as another sheet declares it, absent by default.

    What it `means` is the same too, unless another meaning is given.

    """
    rules = next(spec for spec in fields(cls) if spec.name == name).metadata
    return field(default=default, metadata={**rules, 'means': means or rules['means']})


def block(cls: type, *, default: Any = MISSING, means: str = '') -> Any:
    """Declare a nested block of quantities; a list of all its values in order will do too."""
    return field(default=default, metadata={'block': cls, 'means': means})


def key_of(spec: Any) -> str:
    """Return the key on file of a declared field."""
    unit = spec.metadata.get('unit')
    return f'{spec.name}_{unit}' if unit else str(spec.name)


class Checked:
    """
    Base of all datasheets: quantities are finite and in their range, words are those allowed.

    `WHERE` names the sheet in sentences, by default the class does.

    """

    __slots__ = ()
    WHERE: ClassVar[str] = ''

    def __post_init__(self) -> None:
        where = self.WHERE or type(self).__name__.lower()
        for spec in fields(self):  # type: ignore[arg-type]
            value, rules = getattr(self, spec.name), spec.metadata
            if value is None and spec.default is not None:
                raise InputError(f'{where}: {key_of(spec)} is missing, a value is needed')
            if 'text' in rules and not isinstance(value, str | None):
                raise InputError(f'{where}: {spec.name} is {value!r}, allowed is a text')
            if value is not None and 'low' in rules:
                for number in value if 'many' in rules else (value,):
                    _check_range(where, spec, number / rules['factor'] - rules['shift'])
            if value is not None and 'choice' in rules:
                _check_choice(where, spec, value)


def check_likely(sheet: Checked, where: str, low: str, name: str, high: str) -> None:
    """Raise InputError where fields `low` and `high` are one alone or do not hold that `name`d."""
    specs = {spec.name: spec for spec in fields(sheet)}  # type: ignore[arg-type]
    keys = {each: key_of(specs[each]) for each in (low, name, high)}
    least, value, most = (getattr(sheet, each) for each in (low, name, high))
    if least is most is None:
        return
    if least is None or most is None:
        alone = keys[low] if most is None else keys[high]
        raise InputError(
            f'{where}: {alone} is given alone, allowed are both of {keys[low]} and {keys[high]} '
            'or neither'
        )
    slack = 1 + 1e-9  # the rounding of the conversion must not refuse the bound itself
    if not least / slack <= value <= most * slack:
        rules = specs[name].metadata
        shown = [f'{each / rules["factor"]:g}' for each in (value, least, most)]
        raise InputError(
            f'{where}: {keys[name]} is {shown[0]} {rules["unit"]}, allowed is {shown[1]} to '
            f'{shown[2]} {rules["unit"]} ({keys[low]} to {keys[high]} of the sheet)'
        )


def read_yaml(path: Path) -> Any:
    """Return the plain values of a YAML file; raises InputError, also for a key twice."""
    try:
        return plain_values(read_text(path), strict=True)
    except (OSError, UnicodeDecodeError, InputError) as error:
        reason = ' '.join(str(error).split())
        raise InputError(f'{path}: cannot be read as YAML, {reason}') from None


def read_sheet(cls: type[Sheet], path: Path) -> Sheet:
    """Read a YAML file whose keys are those that `cls` declares; raises InputError."""
    return sheet_of(cls, read_yaml(path), str(path))


def changed_sheet(sheet: Sheet, content: dict[str, Any], where: str) -> Sheet:
    """Return a sheet with some values changed, by their keys on file; raises InputError."""
    specs = {key_of(spec): spec for spec in fields(sheet)}  # type: ignore[arg-type]
    for key in content:
        if key not in specs:
            raise InputError(f'{where}: {_unknown_key(str(key), specs)}')
    values = {specs[key].name: _value(specs[key], raw, where) for key, raw in content.items()}
    return replace(sheet, **values)  # type: ignore[type-var]


def find_sheet(name_or_path: str, folder: str) -> Path:
    """Return the path of a shipped datasheet or of a file; raises InputError."""
    shipped = sorted(path.stem for path in (DATA / folder).glob('*.yaml'))
    if name_or_path in shipped:
        return DATA / folder / f'{name_or_path}.yaml'
    path = Path(name_or_path)
    if path.is_file():
        return path
    raise InputError(
        f'{folder}: {name_or_path!r} is neither a file nor one of the shipped '
        f'datasheets ({", ".join(shipped)})'
    )


def sheet_of(cls: type[Sheet], content: Any, where: str) -> Sheet:
    """Return a sheet out of its keys and values; raises InputError, which says `where`."""
    if not isinstance(content, dict):
        raise InputError(
            f'{where}: must be a mapping of keys to values, got {type(content).__name__}'
        )
    specs = {key_of(spec): spec for spec in fields(cls)}  # type: ignore[arg-type]
    _check_keys(specs, content, where)
    values = {specs[key].name: _value(specs[key], raw, where) for key, raw in content.items()}
    try:
        return cls(**values)
    except InputError as error:
        # A block is named by both the place and the sentence.
        name = f'{where.rpartition(": ")[2]}: '
        raise InputError(f'{where}: {str(error).removeprefix(name)}') from None


def _check_keys(specs: dict[str, Any], content: dict[Any, Any], where: str) -> None:
    for key in content:
        if key not in specs:
            raise InputError(f'{where}: {_unknown_key(str(key), specs)}')
    missing = [
        key for key, spec in specs.items() if key not in content and spec.default is MISSING
    ]
    if missing:
        raise InputError(
            f'{where}: missing key {", ".join(missing)} (all of {", ".join(specs)} belong here)'
        )


def _unknown_key(key: str, specs: dict[str, Any]) -> str:
    """Tell a wrong unit suffix from an unknown name."""
    meant = [
        known
        for known, spec in specs.items()
        if spec.metadata.get('unit') and (key == spec.name or key.startswith(f'{spec.name}_'))
    ]
    if meant:
        return f'{key} has a wrong unit, the key is {max(meant, key=len)}'
    return f'unknown key {key}, allowed are {", ".join(specs)}'


def _value(spec: Any, raw: Any, where: str) -> Any:
    key, rules = key_of(spec), spec.metadata
    if 'block' in rules:
        keys = [key_of(entry) for entry in fields(rules['block'])]
        if isinstance(raw, list) and len(raw) == len(keys):
            raw = dict(zip(keys, raw, strict=True))
        return sheet_of(rules['block'], raw, f'{where}: {key}')
    if 'text' in rules:
        if not isinstance(raw, str) or not re.fullmatch(rules['text'], raw.strip()):
            raise InputError(f'{where}: {key} is {raw!r}, allowed is {rules["allowed"]}')
        return raw.strip()
    if 'choice' in rules:
        _check_choice(where, spec, raw)
        return raw
    if 'many' in rules:
        return tuple(
            _number(spec, entry, where) for entry in (raw if isinstance(raw, list) else [raw])
        )
    return _number(spec, raw, where)


def _number(spec: Any, raw: Any, where: str) -> Any:
    key, rules = key_of(spec), spec.metadata
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        exponent = isinstance(raw, str) and re.fullmatch(r'[-+.\d]+e[-+]?\d+', raw, re.I)
        hint = ' (write 1.0e-8, not 1e-8)' if exponent else ''
        raise InputError(
            f'{where}: {key} is {raw!r}, allowed is a number '
            f'from {rules["low"]:g} to {rules["high"]:g}{hint}'
        )
    _check_range(where, spec, raw)
    return raw if rules.get('whole') else (raw + rules['shift']) * rules['factor']


def _check_choice(where: str, spec: Any, word: Any) -> None:
    allowed = spec.metadata['choice']
    if word not in allowed:
        raise InputError(f'{where}: {spec.name} is {word!r}, allowed is {" or ".join(allowed)}')


def _check_range(where: str, spec: Any, value: float) -> None:
    """Compare in file units; a rounding of the conversion must not refuse the limit itself."""
    rules = spec.metadata
    low, high, whole = rules['low'], rules['high'], rules.get('whole', False)
    slack = 1e-12 * max(abs(low), abs(high))
    inside = math.isfinite(value) and low - slack <= value <= high + slack
    if not inside or (whole and value != int(value)):
        kind = 'a whole number from ' if whole else ''
        raise InputError(
            f'{where}: {key_of(spec)} is {value:g}, allowed is {kind}{low:g} to {high:g}'
        )
