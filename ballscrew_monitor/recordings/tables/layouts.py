# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Layouts of tables as controls write them: the words of their heads, each an entry of a table.

A property is what a head says of the file or of a column: its name, unit, period or start.

"""

from collections.abc import Mapping
import dataclasses
import math
import re

PROPERTIES: dict[str, frozenset[str]] = {
    'name': frozenset(
        'name names channel channelname signal signalname variable variablename tracename '
        'kanal kanalname bezeichnung messgröße messgroesse'.split()
    ),
    'symbol': frozenset('symbolname symbol'.split()),
    'unit': frozenset('unit units einheit einheiten yunitlabel dimension vunit'.split()),
    'period': frozenset(
        'sampletime sampleperiod samplingperiod samplingtime sampleinterval samplinginterval '
        'sampling samplingcycle deltax dx dt deltat ts cycletimems timestep timeincrement '
        'xincrement wfincrement hresolution recordinterval recordinginterval loginterval '
        'logginginterval traceinterval '
        'acquisitioninterval abtastzeit abtastintervall abtastperiode abtastung messtakt '
        'messintervall aufzeichnungsintervall'.split()
    ),
    'rate': frozenset(
        'samplerate samplingrate samplefrequency samplingfrequency fs abtastrate '
        'abtastfrequenz messrate aufzeichnungsrate samplespersecond recordrate recordingrate '
        'recordingfrequency lograte loggingrate loggingfrequency tracerate tracefrequency '
        'scanrate acquisitionrate acquisitionfrequency'.split()
    ),
    'start': frozenset(
        'starttime start startdate startdatetime starttimestamp startoftrace startofrecord '
        'startofmeasurement begin begintime begindate recordstart recordingstart recordingtime '
        'measurementstart measurementbegin measurementtime teststart testbegin logstart '
        'tracestart trigger triggertime triggerdate startzeit startdatum startuhrzeit '
        'startzeitpunkt beginn messbeginn messstart messzeit testbeginn aufnahmezeit aufnahme '
        'aufnahmestart aufnahmebeginn aufzeichnungsstart aufzeichnungsbeginn'.split()
    ),
    'date': frozenset(
        'date datum timestamp datetime recorded recordedat recordingdate measurementdate '
        'testdate messdatum aufnahmedatum prüfdatum pruefdatum'.split()
    ),
    'saved': frozenset(
        'created createdat createdon creationdate creationtime datecreated exported exportedat '
        'exportdate exporttime saved savedat filedate printed printedat erstellt erstelldatum '
        'erstellungsdatum exportiert exportdatum gespeichert gedruckt druckdatum'.split()
    ),
    'clock': frozenset('time uhrzeit zeit'.split()),
    'decimal': frozenset('decimalseparator dezimaltrennzeichen decimal decimalsign'.split()),
}
"""Words of each property, without blanks and signs."""
STARTS = ('start', 'date', 'saved')
"""What dates a log: its start itself, its date, and when a file of it was written, if no other."""
ZERO_OF_TIME = re.compile(r'\W*t_?0\W*', re.I)
"""What names the start of a measurement, as catman does."""
COLUMN = re.compile(
    r'(?:column|col|channel|chan|ch|signal|kanal|spalte|curve|kurve)\W*(\d+)', re.I
)
"""The number of a column that a line of its own names."""
REMARK = re.compile(
    r'(?:^\W*|[,;]\s*)sampl(?:e|ing) (?:time|period|cycle|interval|rate|frequency)(?: is|:| =)? *'
    r'(?P<number>\d[\d.,]*)\s*(?P<unit>[num]?s|[µμ]s|[num]sec|sec(?:onds?)?|k?Hz)(?=\W*$|[,;])',
    re.I,
)
"""A period or rate that a remark plainly states of the rows."""
MAY_BE_PERIOD = re.compile(
    r'(?:sampl|abtast|cycle|zyklus|takt|period|interval|schritt|frequen|rate\b)\D*?\d[\d.,]*\s*'
    r'(?:[num]?s|[µμ]s|[num]sec|sec(?:onds?)?|k?Hz)\b|'
    r'(?:cycle|period|interval|zyklus)\w* *[\[(][numµμ]?s[\])]\W*\d|'
    r'^\W*(?:rate|frequency|frequenz|period|interval|cycle time)\W*\d',
    re.I,
)
"""A period or rate that may be one of rows or of something else."""
OTHER_PERIOD = re.compile(
    r'trigger|control|regel|interpol|every|jede|\b(?:of|von|der|des)\b|\d\s*[x*/]\s*\d', re.I
)
"""What makes a stated period one of something else than rows."""
OTHER_ROWS = re.compile(
    r'decimat|dezim|(?:down|over|under|sub|re)[- ]?sampl|averag|mittel(?:ung|wert)|gemittelt|'
    r'untersetz|unterabtast|überabtast|(?:record|logg?|sav|stor|writ|keep)\w* (?:every|each)|'
    r'\beach \d|\bjede[nrs]?\b|\bevery \d|'
    r'(?:reduc|reduz|thin|compress|verdicht|export|output|display|archiv|stor)\w* '
    r'(?:rate|frequency|interval|period|time|cycle)',
    re.I,
)
"""What in a line of its own makes rows other than the samples of which a period is stated."""
LONGEST_PERIOD = 1.0  # [s], above which a stated period is rather that of a cycle or of the log
IN_SECONDS = frozenset('deltax dx dt deltat xincrement wfincrement hresolution'.split())
"""Labels of a period that need no unit."""
THOUSANDS = re.compile(r'[1-9]\d{0,2}[.,]\d{3}')
STATED = re.compile(r'([\d.,]+(?:e[-+]?\d+)?)\s*[\[(]?\s*([^\s\d\[\]()]*)[\])]?', re.I)
PERIOD = re.compile('([nuµμm]?)s(?:ec(?:onds?)?|ek(?:unden?)?)?')
RATE = re.compile('(k?)hz')
"""A number with its unit; units of a period and of a rate."""
PER_SECOND = re.compile(
    r'\s*[\[(]?\s*(?:1\s*/\s*|(?:(?:samples|values|rows|points)\s*)?(?:/|\bper\b)\s*)'
    r's(?:ec(?:ond)?)?'
    r'\s*[\])]?$',
    re.I,
)
"""What stands for Hz."""
PART_OF_SECOND = re.compile(r'1\s*/\s*(?P<rate>\d+(?:[.,]\d+)?)\s*s(?:ec(?:ond)?)?', re.I)
PERIODS = {'n': 1e-9, 'u': 1e-6, 'µ': 1e-6, 'μ': 1e-6, 'm': 1e-3, 's': 1.0}
RATES = {'': 1.0, 'k': 1e3}
"""Units [s] of a period and [Hz] of a rate by their first letter."""
NUMBER_AND_UNIT = re.compile(r'=?\s*(?P<number>\d+(?:[.,]\d+)?)\s*[\[(]?(?P<unit>[^\])]*)[\])]?')
SEPARATED = re.compile(r'^\s*"?sep=(?P<sign>.)', re.I)
"""The line by which a spreadsheet tells what separates cells."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class OfMachine:
    """
    What a head may say of the machine: plain `words` of it, and `units` in that of the map.

    A text in which `hint` is found may say it in another form.

    """

    words: frozenset[str]
    units: Mapping[str, float]
    hint: re.Pattern[str]

    def value_of(self, label: str, text: str) -> float:
        """Return the value that a text states below a plain label, NaN for any other."""
        match = NUMBER_AND_UNIT.fullmatch(text.strip())
        if not match:
            return math.nan
        words = re.findall(r'[^\W\d_]+', re.sub(r'[\[(].*?[\])]', '', label).lower())
        unit = match['unit'] or ''.join(re.findall(r'[\[(](.*?)[\])]', label))
        if not unit and words[-1:] and words[-1] in self.units:
            *words, unit = words
        factor = self.units.get(re.sub(r'[\s·*]+', '', unit).lower(), math.nan)
        number = float(match['number'].replace(',', '.'))
        return number * factor if ''.join(words) in self.words else math.nan


MACHINE: dict[str, OfMachine] = {
    'lead_mm': OfMachine(
        words=frozenset(
            'lead screwlead ballscrewlead leadofscrew ballscrewpitch screwpitch spindelsteigung '
            'steigung gewindesteigung'.split()
        ),
        units={'mm': 1.0, 'm': 1e3, 'mm/rev': 1.0, 'mm/u': 1.0, 'mm/turn': 1.0},
        hint=re.compile(
            r'(?:\blead|pitch|steigung)(?![a-z]*time)[^\d,;]{0,20}\d|'
            r'(?:screw|spindel|spindle|kgt)\b.*\d\s*[x×]\s*\d',
            re.I,
        ),
    ),
    'torque_constant_Nm_per_A': OfMachine(
        words=frozenset(
            'torqueconstant motortorqueconstant kt drehmomentkonstante momentenkonstante'.split()
        ),
        units={'nm/a': 1.0},
        hint=re.compile(
            r'(?:torque constant|motor constant|\bkt\b|momente?n?konstante)\D{0,20}\d', re.I
        ),
    ),
    'gear': OfMachine(
        words=frozenset('gearratio gear getriebeübersetzung übersetzung'.split()),
        units={'': 1.0, ':': 1.0, ':1': 1.0},
        hint=re.compile(
            r'(?:\bgear|getriebe|übersetzung|uebersetzung|transmission ratio|belt ratio)\D*\d',
            re.I,
        ),
    ),
    'temperature_degC': OfMachine(
        words=frozenset('oiltemperature öltemperatur oeltemperatur lubricanttemperature'.split()),
        units={'°c': 1.0, 'degc': 1.0, 'c': 1.0},
        hint=re.compile(r'(?:\boil|\böl|oel|lubricant|schmier)\w*[ -]?temp\D*\d', re.I),
    ),
    'oil': OfMachine(
        words=frozenset(),
        units={},
        hint=re.compile(r'\b(?:oil|öl|oel|lubricant|grease|fett|schmierstoff)\b|\bvg ?\d', re.I),
    ),
    'screw': OfMachine(
        words=frozenset(),
        units={},
        hint=re.compile(r'(?:ball|lead)[ -]?screw|kugelgewinde|screw type', re.I),
    ),
}
"""What the head may say of the machine, by the keys of an axis in a map, and its gear."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Format:
    """
    A program that writes tables: how its heads are recognised, and what it leaves unsaid.

    `mark` is found in the head; `times` are units of columns of the time by their names, and
    `labelled` is that of a column of which the head says no more than the word for a name; loads
    without a sign `are_amounts` and lengths are `metric` by the standard that it follows.

    """

    program: str
    mark: re.Pattern[str]
    times: tuple[tuple[str, str], ...] = ()
    labelled: str = ''
    are_amounts: bool = False
    metric: bool = False


FORMATS = (
    Format(
        program='LabVIEW measurement file',
        mark=re.compile('^LabVIEW Measurement', re.M),
        times=(('X_Value', 's'),),
    ),
    Format(
        program='TwinCAT Scope',
        mark=re.compile(r'^"?(?:SymbolName|NetId|SymbolBased|SampleTime\[ms\])"?[\t;,]', re.M),
        labelled='ms',
    ),
    Format(
        program='WinCC',
        mark=re.compile('^(?=.*TimeString).*Time_ms', re.M),
        times=(('Time_ms', 'spreadsheet_microdays'),),
    ),
    Format(program='rostopic echo -p', mark=re.compile('^%time,', re.M), times=(('%time', 'ns'),)),
    Format(
        program='FANUC SERVO GUIDE',
        mark=re.compile(r'^"?SERVO GUIDE|\b(?:TCMD|VCMD|POSF|SPEED|ERR)\b.*\(', re.M),
    ),
)
"""Programs that are recognised by their heads."""
NO_MARK = re.compile('(?!)')
ADAPTER = Format(program='an MTConnect adapter', mark=NO_MARK, are_amounts=True, metric=True)
"""What writes SHDR: MTConnect states a load as a part of the rated one, without a sign."""
RECORDER = Format(program='a data recorder of SINUMERIK', mark=NO_MARK, metric=True)


def property_of(label: str) -> str:
    """Return the property that a label of a head means, empty for any other."""
    plain = re.sub(r'[\W\d_]+', '', re.sub(r'[\[(].*?[\])]', '', label).lower())
    if ZERO_OF_TIME.fullmatch(label):
        return STARTS[0]
    return next((kind for kind, words in PROPERTIES.items() if plain in words), '')


def unit_of_period(label: str) -> str:
    """Return the unit of a period whose label states none, empty where it may be any."""
    plain = re.sub(r'[\W\d_]+', '', label.lower())
    return 's' if plain in IN_SECONDS else 'ms' if plain.endswith('timems') else ''


def format_of(head: str) -> Format | None:
    """Return the program that wrote a head, None for one that is not known."""
    return next((one for one in FORMATS if one.mark.search(head)), None)


def period_of(text: str, unit: str = '') -> float:
    """
    Return the period [s] that a text states, in its own unit or another; NaN for none.

    Nothing else may stand beside number and unit, which would make them another period, nor a sign
    before three digits, which may be of thousands.

    """
    text, unit = text.strip(), PER_SECOND.sub('Hz', unit)
    if match := PART_OF_SECOND.fullmatch(text):
        text, unit = match['rate'], 'Hz'
    match = STATED.fullmatch(PER_SECOND.sub(' Hz', text))
    if match and THOUSANDS.fullmatch(match[1]):
        return math.nan  # thousands, or three decimals
    try:
        number = float(match[1].replace(',', '.')) if match else 0.0
    except ValueError:
        number = 0.0
    stated = (match[2] if match else '').lower() or unit.lower()
    if number <= 0.0 or not stated:
        return math.nan
    if match := RATE.fullmatch(stated):
        return 1.0 / (number * RATES[match[1]])
    match = PERIOD.fullmatch(stated)
    return number * PERIODS[match[1] or 's'] if match else math.nan
