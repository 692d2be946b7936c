# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Golden outputs by the doors that others use: commands, files, messages, pages.

Three functions know more of the program than that, `rows`, `page_frames` and `page_records`: each
is the one place to change where what it calls moves.

"""

import asyncio
import contextlib
import functools
from html.parser import HTMLParser
import importlib
import io
import json
import math
import struct
import zlib

from ballscrew_monitor import cli
from ballscrew_monitor.messages.diagnostics import code_of
from ballscrew_monitor.page import records
from ballscrew_monitor.page.hub import Browser, Hub
from ballscrew_monitor.page.recording import recorded_axes, Recording
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.report.parameters import parameters_for
from golden.compare import masked, ROUNDING
from mcap.reader import make_reader
import numpy as np
import polars as pl
from rclpy.serialization import deserialize_message
import yaml

EVERY = 100  # states of which one is shown
LONGEST = 64  # letters of a word that is shown, and no array that is packed
MANY, SHOWN = 24, 8  # numbers of an array that are shown one by one, and of a longer one
EDGES = (
    *(
        'level',
        'message',
        'Code',
        'zone',
        'event_id',
        'active_gates',
        'shelved',
        'point.direction',
    ),
    *('result.validity', 'result.reason', 'result.regime', 'result.corrected'),
)
"""Parts of a state or status of which each change is shown."""
EDGES_OF_INPUT = ('state', 'refusal')
EDGES_OF_FINDING = ('code', 'severity')
HIDDEN = {'script', 'style'}
BLOCKS = {'div', 'li', 'p', 'section', 'table', 'text', 'title', 'tr', 'ul', 'h1', 'h2', 'h3'}
CELLS = {'td', 'th'}


def command(folder, *arguments):
    """Return exit code and words of a command, as one text."""
    out, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
        try:
            code = cli.main([str(one) for one in arguments])
        except SystemExit as end:
            code = end.code
    text, words = out.getvalue(), errors.getvalue()
    if '--json' in arguments and text.startswith('{'):
        text = '\n'.join(plain_lines(one) for one in documents(text))
    said = ' '.join(map(str, arguments))
    return masked(
        f'$ ballscrew {said}\n{text}--- standard error\n{words}--- code {code}\n', folder
    )


def documents(text):
    """Yield all that a text holds of JSON."""
    while text:
        one, end = json.JSONDecoder().raw_decode(text)
        yield one
        text = text[end:].lstrip()


def plain_lines(value, place=''):
    """Return plain data as lines, each with a place and a value."""
    return ''.join(f'{at} = {json.dumps(one, ensure_ascii=False)}\n' for at, one in leaves(value))


def leaves(value, place=''):
    """Yield place and value of all that plain data hold; of many numbers some and their sums."""
    if isinstance(value, dict) and value:
        for key, one in value.items():
            yield from leaves(one, f'{place}.{key}' if place else str(key))
    elif isinstance(value, list) and len(value) > MANY and is_numbers(value):
        yield f'{place}, {len(value)} numbers', value[:: len(value) // SHOWN + 1]
        sums = Sums()
        for one in value:
            sums.add({'': one})
        yield from sums.totals(place)
    elif isinstance(value, list) and value:
        for number, one in enumerate(value):
            yield from leaves(one, f'{place}[{number}]')
    else:
        yield place, None if isinstance(value, float) and math.isnan(value) else value


def is_numbers(values):
    """Return True if all values are numbers, or not known."""
    return all(one is None or isinstance(one, int | float) for one in values)


def rows(report):
    """Return all judged rows of a report as a table."""
    frame = pl.read_parquet(report / 'states.parquet')
    table = {}
    for name in frame.columns:
        values = frame[name]
        words = values.dtype in (pl.String, pl.Enum, pl.Categorical)
        table[name] = np.array(values.cast(pl.String).to_list() if words else values.to_numpy())
    return table


def report(folder, out, *arguments, words=True):
    """Return the outputs of `ballscrew replay --out` and, if asked for, its words, by name."""
    outputs = {'report_said': command(folder, 'replay', *arguments, '--out', out)}
    if words:
        outputs['words'] = command(folder, 'replay', *arguments)
    if (out / 'report.html').is_file():
        outputs |= {
            'summary': json_text(folder, out / 'summary.json'),
            'events': masked((out / 'events.csv').read_text(), folder),
            'page': page_of(folder, out / 'report.html'),
            'rows': rows(out),
            'messages': bag_text(folder, out / 'judged'),
        }
    return outputs


class PageReader(HTMLParser):
    """Collects what a reader sees of a page, and the data of its scripts."""

    def __init__(self):
        """Begin with nothing read."""
        super().__init__()
        self.lines, self.data, self._line, self._hidden = [], [], [], ''

    def handle_starttag(self, tag, attributes):
        """Begin a line or a cell."""
        given = dict(attributes)
        if tag in HIDDEN:
            self._hidden = 'data' if given.get('type') == 'application/json' else 'hidden'
        if tag in BLOCKS:
            self._end_line()
        if tag in CELLS:
            self._line.append('|')
        for name in ('data-value', 'data-begin', 'data-end'):
            if name in given:
                self._line.append(f'({name[5:]} {given[name]})')

    def handle_endtag(self, tag):
        """End a line."""
        if tag in HIDDEN:
            self._hidden = ''
        if tag in BLOCKS:
            self._end_line()

    def handle_data(self, data):
        """Take a piece of text."""
        if self._hidden == 'data':
            self.data.append(data)
        elif not self._hidden and data.strip():
            self._line.append(' '.join(data.split()))

    def _end_line(self):
        if self._line:
            self.lines.append(' '.join(self._line))
            self._line = []


def json_text(folder, path):
    """Return a file of JSON as lines."""
    return masked(plain_lines(json.loads(path.read_text('utf-8'))), folder)


def page_of(folder, path):
    """Return the words of a page line by line, and the data that it draws."""
    reader = PageReader()
    reader.feed(path.read_text('utf-8'))
    lines = [f'{line}\n' for line in reader.lines]
    for text in reader.data:
        lines.append('--- data\n')
        lines += [f'{place} = {packed(one)}\n' for place, one in leaves(json.loads(text))]
    return masked(''.join(lines), folder)


def packed(value):
    """Return a value of a page as text, an array that is packed as its length and checksum."""
    if isinstance(value, str) and len(value) > LONGEST and ' ' not in value:
        return f'{len(value)} letters, checksum {zlib.crc32(value.encode())}'
    return json.dumps(value, ensure_ascii=False)


def page_frames(log, parameters, shares):
    """Yield what browsers are sent of a recording at some shares of it [-]: records and arrays."""
    bag = opened_log(log)
    axes = recorded_axes(bag, parameters_for(bag, parameters, parameters), lambda share: None)

    async def frames():
        found, hub = [], Hub()
        playing = Recording(hub, axes)
        span = playing.clock()['span_s']
        browser = Browser()
        hub.join(browser, 0.0)
        for number, share in enumerate(shares):
            await playing.handlers['seek'](browser, {'s': share * span})
            playing.advance(0.0, float(number))
            hub.tick(float(number))
            while True:
                taking = asyncio.ensure_future(browser.take())
                await asyncio.sleep(0)
                if not taking.done():
                    taking.cancel()
                    break
                found.append(taking.result())
        return found

    for made in asyncio.run(frames()):
        yield read_frame(made)


def page_records(message):
    """Yield what the page makes of a message of a node: records by their names."""
    kind = type(message).__name__
    if kind == 'BallScrewState':
        yield 'row', list(records.row_of(message))
        yield 'state', records.state_record(message)
        yield 'limits', records.limits_record(message)
    elif kind == 'OutOfZone':
        yield 'event', records.event_record(message)
    elif kind == 'AxisHealth':
        yield 'health', records.health_record(message)
    elif kind == 'SurfaceInfo':
        yield 'surface', records.surface_record(message, 'm/min')
    elif kind == 'DiagnosticArray':
        for status in message.status:
            place = records.place_of(status.name)
            yield 'code', [*(place or ()), code_of(status)]


def read_frame(made):
    """Return the record and the arrays of a frame to a browser."""
    (size,) = struct.unpack_from('<I', made)
    at = 4 + size
    record = json.loads(made[4:at])
    arrays = {}
    for name, count in record.pop('arrays'):
        arrays[name] = np.frombuffer(made, '<f8', count, at)
        at += 8 * count
    return record, arrays


def frames_text(log, parameters, shares=(0.0, 0.2, 0.6, 1.0, 0.1)):
    """Return what browsers are sent of a recording as text, of long arrays some numbers."""
    lines = []
    for record, arrays in page_frames(log, parameters, shares):
        record.pop('words', None)  # those of a language
        lines.append(f'--- {record.pop("kind")}\n{plain_lines(record)}')
        for name, values in arrays.items():
            some = values[:: len(values) // SHOWN + 1]
            lines.append(f'{name}: {len(values)} numbers {some.tolist()}\n')
    return ''.join(lines)


def fields_of(message, place=''):
    """Yield place and value of each field of a message; those of sequences are numbered."""
    for name in message.get_fields_and_field_types():
        yield from _field(getattr(message, name), f'{place}.{name}' if place else name)


def _field(value, place):
    if hasattr(value, 'get_fields_and_field_types'):
        yield from fields_of(value, place)
    elif isinstance(value, list) and value and hasattr(value[0], 'get_fields_and_field_types'):
        for number, one in enumerate(value):
            yield from fields_of(one, f'{place}[{number}]')
    elif isinstance(value, str | bool | int | float):
        yield place, value
    elif isinstance(value, bytes):
        yield place, value.hex()
    else:
        yield place, list(value)


def type_of(name):
    """Return the class of messages of a type by its full name."""
    package, part, kind = name.split('/')
    return getattr(importlib.import_module(f'{package}.{part}'), kind)


def bag_text(folder, bag):
    """Return a bag as text: its files, its metadata, and what a node says in it."""
    known = yaml.safe_load((bag / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    lines = [f'{one}\n' for one in sorted(path.name for path in bag.iterdir())]
    for entry in known['topics_with_message_count']:
        topic = entry['topic_metadata']
        lines.append(f'{topic["name"]} {topic["type"]} {entry["message_count"]}\n')
    for key, text in (known['custom_data'] or {}).items():
        lines.append(plain_lines({key: yaml.safe_load(text)}))  # where lines end depends on names
    said = SaidByNode(folder)
    for file in known['relative_file_paths']:
        with (bag / file).open('rb') as stream:
            for schema, channel, message in make_reader(stream).iter_messages():
                if schema.name.startswith(('ballscrew_msgs', 'diagnostic_msgs')):
                    content = deserialize_message(message.data, type_of(schema.name))
                    said.take(channel.topic, message.log_time, content)
    return masked(''.join(lines), folder) + said.text()


class SaidByNode:
    """
    What a node says, as text.

    Of states and diagnostics some are shown whole and the others by what has changed since; all
    of them count in sums of their numbers and in a checksum of the rest.

    """

    def __init__(self, folder, every=EVERY):
        """Mask a folder; of `every` so many states or diagnostics one is shown whole."""
        self._mask = functools.cache(functools.partial(masked, folder=folder))
        self._every, self._lines = every, []
        self._shown, self._edges, self._counts, self._sums = {}, {}, {}, {}

    def take(self, topic, log_time, message):
        """Take a message of a topic, said at `log_time` [ns]."""
        kind = type(message).__name__
        if kind == 'DiagnosticArray':
            for status in message.status:
                name = f'{topic} {status.name}'
                self._take(name, log_time, self._masked(status_fields(status)))
        elif kind == 'BallScrewState' or 'data' in message.get_fields_and_field_types():
            self._take(topic, log_time, self._masked(dict(fields_of(message))))
        else:
            self.show(topic, log_time, self._masked(dict(fields_of(message))))

    def _masked(self, fields):
        return {
            place: self._mask(value) if isinstance(value, str) else value
            for place, value in fields.items()
        }

    def _take(self, name, log_time, fields):
        edge = {place: value for place, value in fields.items() if is_edge(place)}
        self._sums.setdefault(name, Sums()).add(fields)
        count = self._counts[name] = self._counts.get(name, -1) + 1
        if count % self._every == 0:
            self.show(name, log_time, fields)
        elif edge != self._edges.get(name):
            self.show(name, log_time, edge, is_part=is_edge)
        self._edges[name] = edge

    def show(self, name, log_time, fields, is_part=lambda place: True):
        """Show what of some fields has changed since a message of a name was shown."""
        before = self._shown.setdefault(name, {})
        self._lines.append(f'{log_time} {name}\n')
        for place, value in fields.items():
            if place not in before or repr(before[place]) != repr(value):
                self._lines.append(f'    {place} = {value!r}\n')
        for place in [one for one in before if is_part(one) and one not in fields]:
            self._lines.append(f'    {place} is gone\n')
            del before[place]
        before |= fields

    def text(self):
        """Return all of it."""
        sums = (line for name, one in self._sums.items() for line in one.lines(name))
        return ''.join([*self._lines, *sums])


def status_fields(status):
    """Return a diagnostic status as fields by name."""
    fields = {'level': status.level.hex(), 'message': status.message}
    return (
        fields
        | {'hardware_id': status.hardware_id}
        | {one.key: one.value for one in status.values}
    )


def is_edge(place):
    """Return True for a part of a state or status of which each change is shown."""
    if place.startswith('inputs'):
        return place.endswith(EDGES_OF_INPUT)
    return place in EDGES or place.startswith('findings') and place.endswith(EDGES_OF_FINDING)


class Sums:
    """
    Sums of the numbers of many messages, and a checksum of all that is no number.

    A sum is that of amounts, each of a weight of its own, so that it does not cancel out.

    """

    def __init__(self):
        """Begin with no message."""
        self._count, self._checksum, self._numbers = 0, 0, {}

    def add(self, fields):
        """Add the fields of a message."""
        weight = 1.0 + (self._count % 97) / 97
        self._count += 1
        for place, value in fields.items():
            if isinstance(value, float) and math.isfinite(value):
                self._numbers.setdefault(place, ([], []))[value < -ROUNDING].append(weight * value)
            else:
                self._checksum = zlib.crc32(f'{place} {value!r}'.encode(), self._checksum)

    def lines(self, name):
        """Yield them as lines."""
        yield f'all {self._count} of {name}: checksum {self._checksum}\n'
        for place, (counts, sums) in self.totals():
            yield f'    {place}: {counts}, sums {sums}\n'

    def totals(self, name=''):
        """Yield place, counts and sums of the numbers above and below zero."""
        for place, parts in self._numbers.items():
            counts = ' and '.join(str(len(part)) for part in parts)
            sums = ' and '.join(repr(math.fsum(part)) for part in parts)
            yield name + place, (counts, sums)
