# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Codes of faults, for a controller or a logbook that reads numbers.

A number keeps its meaning for ever: new faults take new numbers, and those of faults that are gone
stay unused. The hundreds name the status; below 100 a code belongs to several.

"""

from typing import Self

from ballscrew_monitor.core.judgement import Code, Worded

STATUSES = (
    *('any of an axis', 'Lubrication', 'Inputs', 'Surface', 'Health'),
    *('State directory', 'Recording', 'Node'),
)
"""The status that a code belongs to, by its hundreds."""


class Fault(Worded):
    """
    What is wrong, its number and in words, and what to do; NONE where nothing is wrong.

    Of an input, `said` follows its name or stands for it, before the cure. `detail` says of one
    refused message why, by the numbers of its refusal, `counted` follows how many were.

    """

    cure: str
    said: str
    detail: str
    counted: str

    def __new__(
        cls,
        number: int,
        text: str,
        cure: str = '',
        said: str = '',
        detail: str = '',
        counted: str = '',
    ) -> Self:
        """Return the member of a number and its texts."""
        member = int.__new__(cls, number)
        member._value_, member.text, member.cure = number, text, cure
        member.said, member.detail, member.counted = said, detail, counted
        return member

    @property
    def status(self) -> str:
        """Return the name of the status that it belongs to."""
        return STATUSES[self // 100]

    NONE = 0, 'nothing is wrong'
    NOT_SET = (1, 'no message was set', 'report it with the log of the node')
    NOT_CONFIGURED = (2, 'not configured, or shut down', 'configure and activate the node')
    INACTIVE = (3, 'the node is inactive, nothing is judged', 'activate the node')
    NOTHING_YET = (4, 'nothing has been judged yet', 'wait for an input; see Inputs')
    CLOCK_STANDS = (5, 'the clock stands still', 'play /clock, or set use_sim_time to false')
    PROGRAM_FAILED = (
        6,
        'the program failed at a message, a tick or a request',
        'a defect: report the message and the trace in the log; the node goes on with the '
        'next message, other axes are not affected, and the error stays until the node is '
        'configured again',
    )
    NOT_BUILT = (
        7,
        'not configured, because a parameter or a file is wrong',
        'correct the parameter or the file that the message names; then configure and activate',
    )

    RCS_HIGH = (
        101,
        'outside the optimal zone: asperities carry too much',
        'check the oil temperature; follow the advice of ~/x/health and, with '
        'advice.speed, of out_of_zone',
    )
    EFFICIENCY_LOW = (
        102,
        'outside the optimal zone: too much power is lost',
        'check preload, oil, and sign and unit of the load; follow the advice',
    )
    CAUSE_UNKNOWN = (103, 'outside the optimal zone: cause unknown', 'report it')
    NOT_MOVED = (
        111,
        'not judged: the screw has not moved yet',
        'nothing: the direction is unknown until the screw moves',
    )
    SPEED_BELOW = (
        112,
        'not judged: speed below the surface',
        'nothing if the axis only passes; if it dwells there, build the surface to slower speeds',
    )
    SPEED_ABOVE = (
        113,
        'not judged: speed above the surface',
        'build the surface to faster speeds, or correct speed.unit',
    )
    LOAD_OUTSIDE = (
        114,
        'not judged: load outside the surface',
        'build a wider surface, or correct sign, unit or scale of the load',
    )
    TEMPERATURE_OUTSIDE = (
        115,
        'not judged: temperature outside the surface',
        'build a wider surface, or correct temperature.unit',
    )
    MASKED = (
        116,
        'not judged: the model did not converge here',
        'a node of the surface beside the point has no number: ballscrew surface info counts them',
    )
    NO_INPUT = (117, 'not judged: an input is missing', 'see Inputs')
    NO_SURFACE = (118, 'not judged: no surface', 'load one; see Surface')
    NOT_DERIVED = (
        119,
        'not judged: the motor torque does not tell the load here',
        'the screw stands still, inertia and drag take too much of the torque, or several '
        'loads give this torque',
    )
    TOO_SHORT = (
        120,
        'not judged for long enough yet',
        'wait for clear_delay; if it stays, the axis is never inside the surface long enough',
    )

    INPUT_UNKNOWN = (200, 'an input is unknown', 'report it')
    INPUT_MISSING = (
        201,
        'an input was never received',
        'check topic, namespace, domain and type, relax a qos_overrides parameter that '
        'asks for more than the publisher offers, start the source; the message says '
        'which',
    )
    INPUT_OTHER_JOINTS = (
        202,
        'the messages name other joints',
        'name a joint in field that the messages hold',
        '',
        '',
        'of other joints',
    )
    INPUT_STALE = (
        203,
        'an input is stale',
        'start the publisher again, or set timeout to the value that the message names',
    )
    INPUT_UNUSABLE = (210, 'an input is not usable', 'read the reason in the message')
    INPUT_NOT_A_NUMBER = (
        211,
        'an input is not a finite number',
        'mend its source or read another field',
        'it is not a finite number',
        'the field holds {first}, it must be a finite number: mend the source',
        'not a number',
    )
    INPUT_FUTURE = (
        212,
        'the stamps of an input lie ahead of the clock',
        'set the clocks alike or raise max_future',
        'its stamps lie ahead of the clock',
        'the stamp is {first:.3g} s ahead of the clock, allowed is max_future, {second:.3g} s: '
        'set the clocks of both machines alike, or raise max_future',
        'stamped in the future',
    )
    INPUT_OTHER_CLOCK = (
        213,
        'the stamps of an input are more than a year ahead of the clock of the node',
        'set the clock of its machine, or in a simulation stamp with /clock or unset use_sim_time',
        'its stamps are more than a year ahead of the clock of the node',
        'the stamps are more than a year ahead of the clock of the node: set the clock of its '
        'machine, or in a simulation set use_sim_time to false, or stamp with /clock',
        'stamped by another clock',
    )
    INPUT_TOO_SHORT = (
        214,
        'the array of an input ends before the element',
        'let the source fill it',
        'its array ends before the element',
        '',
        'too short an array',
    )
    INPUT_IMPLAUSIBLE = (
        215,
        'an input is beyond the plausible range',
        'mend the source, its unit or scale, or raise limits.plausible_speed or '
        'limits.plausible_load',
        'it is beyond the plausible range',
        '{name} {first:.4g} {unit} is beyond the plausible {most:.4g} {unit}: mend the source, '
        'its unit or scale, or raise limits.plausible_{name}',
        'beyond what is plausible',
    )
    INPUT_NOT_DECODED = (
        216,
        'the messages of an input do not decode',
        'record them with the type of their publisher',
        'its messages do not decode',
        'the message does not decode: it is truncated, or of another definition of its type',
        'that do not decode',
    )
    INPUT_HOLE = (
        217,
        'the positions of an input come less often than its timeout allows',
        'raise speed.timeout',
        'its positions come less often than its timeout allows',
        'no position for {first:.3g} s, so no speed follows: send more, or raise speed.timeout',
        'too long after the position before',
    )
    INPUT_NEGATIVE = (
        218,
        'the stamps of an input are negative',
        'mend the clock of its source',
        'its stamps are negative',
        'the stamp is negative: mend the clock of the source',
        'stamped before zero',
    )
    INPUT_SEVERAL = (
        219,
        'several publishers send an input',
        'stop all but one or set one_source to false',
        'several publishers send it',
        'several publishers send this input, and one is allowed: stop all but one, or set '
        'one_source to false',
        'sent by several publishers',
    )
    REFUSED = (
        231,
        'one in a hundred messages or more is refused',
        'the reason and its cure follow; stays for ten seconds after the last refusal',
    )
    GLITCHES = (
        232,
        'samples beyond the plausible range were refused',
        'mend the source, its unit or scale, or raise limits.plausible_speed or '
        'limits.plausible_load',
        'samples beyond the plausible range were refused',
    )
    LOST = (
        233,
        'messages are lost on the way',
        'lower their rate, raise publish_period, or give the node fewer axes or more of the '
        'processor',
        'messages are lost on the way',
    )
    SIMULATED_STAMPS = (
        234,
        'stamps are more than a year behind the clock of the node',
        'set the clock of their source, or use_sim_time if it is a simulation',
        'stamps are more than a year behind the clock of the node',
    )
    LAG = (
        235,
        'stamps lag behind their arrival',
        'set the clocks alike, or raise max_lag',
        'stamps lag behind their arrival',
    )
    SLOW = (
        236,
        'an input comes less often than its timeout allows',
        'set timeout to the value that the message names',
    )
    SOURCES_UNKNOWN = (
        237,
        'loss is unknown, and whether one source alone sends an input',
        'let the topic have one publisher, or a middleware that numbers messages',
        'loss is unknown, and so is whether one source alone sends it',
    )
    LOSS_UNKNOWN = (
        238,
        'loss is unknown',
        'let the topic have one publisher that numbers its messages',
        'loss is unknown',
    )

    RELOAD_REFUSED = (
        301,
        'kept the old surface, the reload is refused',
        'repair the file and reload it',
    )

    WORSE = (
        401,
        'the axis is worse than its baseline',
        'follow the advice in ~/x/health; after an intended change name a new baseline',
    )
    NOT_FOLLOWED = (
        402,
        'the health of the axis is not followed now',
        'the message says why the store cannot be used, or that the program failed; what '
        'was gathered waits in memory',
    )
    NOT_KNOWN = (
        403,
        'whether the axis is worse than its baseline is not known',
        'the message says what is missing, such as a motor torque or motion',
    )

    NOT_KEPT = (
        501,
        'sums, events or corrections are not kept',
        'the message says why: make room, mount the directory, give the user of the node '
        'the right, raise state_limit, or give a second node of this name another name',
    )

    NOT_RECORDED = (
        601,
        'the recording has a hole, or nothing is recorded',
        'the message says why: make room or give the right; relieve the disk or the '
        'processor; a writer that was killed is started again',
    )

    BUSY = (
        701,
        'the node uses up one processor',
        'lower the rate of the inputs, raise publish_period, or give some axes a second node',
    )
    CLOCK_SET = (
        702,
        'the clock of the node was set, forward or back',
        'nothing if somebody meant it: no duration holds the step; otherwise let NTP or PTP hold '
        'the clock',
    )
    TWO_NODES = (
        703,
        'another node of this name publishes on the same topics',
        'give one of both another name or namespace, or another ROS_DOMAIN_ID',
    )
    CLOCK_NOT_SET = (
        704,
        'the clock of the machine shows a time before this version was made',
        'set it, by NTP or PTP: what is kept and recorded is dated by it',
    )


_CAUSES = {Code.RCS_HIGH: Fault.RCS_HIGH, Code.EFFICIENCY_LOW: Fault.EFFICIENCY_LOW}


def cause_code(cause: Code) -> Fault:
    """Return the code of a stay outside the zone by its cause."""
    return _CAUSES.get(cause, Fault.CAUSE_UNKNOWN)
