# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Codes of faults, for a controller or a logbook that reads numbers.

A number keeps its meaning for ever: new faults take new numbers, and those of faults that are gone
stay unused. The hundreds name the status; below 100 a code belongs to several.

"""

from ballscrew_monitor.core.judgement import Code, Worded

STATUSES = (
    *('any of an axis', 'Lubrication', 'Inputs', 'Surface', 'Health'),
    *('State directory', 'Recording', 'Node'),
)
"""The status that a code belongs to, by its hundreds."""


class Fault(Worded):
    """What is wrong, its number and in words; NONE where nothing is."""

    @property
    def status(self) -> str:
        """Return the name of the status that it belongs to."""
        return STATUSES[self // 100]

    NONE = 0, 'nothing is wrong'
    NOT_SET = 1, 'no message was set'
    NOT_CONFIGURED = 2, 'not configured, or shut down'
    INACTIVE = 3, 'the node is inactive, nothing is judged'
    NOTHING_YET = 4, 'nothing has been judged yet'
    CLOCK_STANDS = 5, 'the clock stands still'
    PROGRAM_FAILED = 6, 'the program failed at a message, a tick or a request'

    RCS_HIGH = 101, 'outside the optimal zone: asperities carry too much'
    EFFICIENCY_LOW = 102, 'outside the optimal zone: too much power is lost'
    CAUSE_UNKNOWN = 103, 'outside the optimal zone: cause unknown'
    NOT_MOVED = 111, 'not judged: the screw has not moved yet'
    SPEED_BELOW = 112, 'not judged: speed below the surface'
    SPEED_ABOVE = 113, 'not judged: speed above the surface'
    LOAD_OUTSIDE = 114, 'not judged: load outside the surface'
    TEMPERATURE_OUTSIDE = 115, 'not judged: temperature outside the surface'
    MASKED = 116, 'not judged: the model did not converge here'
    NO_INPUT = 117, 'not judged: an input is missing'
    NO_SURFACE = 118, 'not judged: no surface'
    NOT_DERIVED = 119, 'not judged: the motor torque does not tell the load here'
    TOO_SHORT = 120, 'not judged for long enough yet'

    INPUT_UNKNOWN = 200, 'an input is unknown'
    INPUT_MISSING = 201, 'an input was never received'
    INPUT_OTHER_JOINTS = 202, 'the messages name other joints'
    INPUT_STALE = 203, 'an input is stale'
    INPUT_UNUSABLE = 210, 'an input is not usable'
    INPUT_NOT_A_NUMBER = 211, 'an input is not a finite number'
    INPUT_FUTURE = 212, 'the stamps of an input lie ahead of the clock'
    INPUT_OTHER_CLOCK = 213, 'the stamps of an input are of the wall clock, the node on simulated'
    INPUT_TOO_SHORT = 214, 'the array of an input ends before the element'
    INPUT_IMPLAUSIBLE = 215, 'an input is beyond the plausible range'
    INPUT_NOT_DECODED = 216, 'the messages of an input do not decode'
    INPUT_HOLE = 217, 'the positions of an input come less often than its timeout allows'
    INPUT_NEGATIVE = 218, 'the stamps of an input are negative'
    INPUT_SEVERAL = 219, 'several publishers send an input'
    REFUSED = 231, 'one in a hundred messages or more is refused'
    GLITCHES = 232, 'samples beyond the plausible range were refused'
    LOST = 233, 'messages are lost on the way'
    SIMULATED_STAMPS = 234, 'stamps are of simulated time, the node on the wall clock'
    LAG = 235, 'stamps lag behind their arrival'
    SLOW = 236, 'an input comes less often than its timeout allows'
    SOURCES_UNKNOWN = 237, 'loss is unknown, and whether one source alone sends an input'
    LOSS_UNKNOWN = 238, 'loss is unknown'

    RELOAD_REFUSED = 301, 'kept the old surface, the reload is refused'

    WORSE = 401, 'the axis is worse than its baseline'
    NOT_FOLLOWED = 402, 'the health of the axis is not followed now'
    NOT_KNOWN = 403, 'whether the axis is worse than its baseline is not known'

    NOT_KEPT = 501, 'sums, events or corrections are not kept'

    NOT_RECORDED = 601, 'the recording has a hole, or nothing is recorded'

    BUSY = 701, 'the node uses up one processor'


_CAUSES = {Code.RCS_HIGH: Fault.RCS_HIGH, Code.EFFICIENCY_LOW: Fault.EFFICIENCY_LOW}


def cause_code(cause: Code) -> Fault:
    """Return the code of a stay outside the zone by its cause."""
    return _CAUSES.get(cause, Fault.CAUSE_UNKNOWN)
