# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records whose fields declare how a file names them, and records as JSON keeps them."""

from collections.abc import Callable, Mapping, Sequence
import dataclasses
import enum
import functools
import math
import types
from typing import Any, get_args, get_origin, get_type_hints, TypeVar

Record = TypeVar('Record')


def written(
    unit: str = '',
    *,
    key: str = '',
    because: str = '',
    form: Callable[[Any], Any] | None = None,
    **more: Any,
) -> Any:
    """
    Declare a field that is written by its name, or by `key`, with the unit as suffix.

    `because` names the attribute that says why its number is missing; `form` makes plain data of
    its value; `more` is what `dataclasses.field` takes.

    """
    metadata = {'unit': unit, 'key': key, 'because': because, 'form': form or plain}
    return dataclasses.field(metadata=metadata, **more)


def unwritten(**more: Any) -> Any:
    """Declare a field that no file holds; `more` is what `dataclasses.field` takes."""
    return dataclasses.field(metadata={'unwritten': True}, **more)


def keys(record: Any) -> dict[str, 'dataclasses.Field[Any]']:
    """Return the fields of a record, or of a class of records, that are written, by their keys."""
    names = {}
    for spec in dataclasses.fields(record):
        if 'unwritten' not in spec.metadata:
            name, unit = spec.metadata.get('key') or spec.name, spec.metadata.get('unit')
            names[f'{name}_{unit}' if unit else name] = spec
    return names


def plain(record: Any) -> Any:
    """
    Return a record as plain data: its fields by their keys, records within it alike.

    A number that is not known has its reason beside it where one is declared. Keys that are
    members of an enumeration become their names.

    """
    if dataclasses.is_dataclass(record):
        content: dict[str, Any] = {}
        for key, spec in keys(record).items():
            value = getattr(record, spec.name)
            content[key] = spec.metadata.get('form', plain)(value)
            if spec.metadata.get('because') and not _is_known(value):
                content[f'{key}_reason'] = getattr(record, spec.metadata['because'])
        return content
    if isinstance(record, Mapping):
        return {_name(key): plain(value) for key, value in record.items()}
    return [plain(part) for part in record] if isinstance(record, list | tuple) else record


def _is_known(value: Any) -> bool:
    return math.isfinite(value) if isinstance(value, int | float) else value is not None


def _name(key: Any) -> Any:
    return key.name.lower() if isinstance(key, enum.Enum) else key


def record_of(kind: Callable[..., Record], content: Mapping[str, Any] | Sequence[Any]) -> Record:
    """
    Return a record of a `kind` out of what `dataclasses.asdict` and JSON leave of it.

    A tuple with names may be a list of its fields. A null in the place of a float is NaN. Raises
    KeyError or TypeError for what is no such record.

    """
    readers = _readers(kind)
    fields = content if isinstance(content, Mapping) else dict(zip(readers, content, strict=True))
    return kind(**{name: readers[name](value) for name, value in fields.items()})


@functools.cache
def _readers(kind: Callable[..., Any]) -> dict[str, Callable[[Any], Any]]:
    return {name: _reader(hint) for name, hint in get_type_hints(kind).items()}


def _reader(hint: Any) -> Callable[[Any], Any]:
    """Return what makes a value of a declared type out of plain data."""
    origin, parts = get_origin(hint), get_args(hint)
    if hint is float:
        return lambda value: math.nan if value is None else value
    if origin is types.UnionType:  # a type or None
        known = _reader(parts[0])
        return lambda value: None if value is None else known(value)
    if origin in (Sequence, tuple):
        item, form = _reader(parts[0]), tuple if origin is tuple else list
        return lambda values: form(map(item, values))
    if isinstance(hint, type) and issubclass(hint, enum.Enum):
        return hint
    if dataclasses.is_dataclass(hint) or hasattr(hint, '_fields'):
        return functools.partial(record_of, hint)
    return lambda value: value
