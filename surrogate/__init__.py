# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Offline half: from datasheets to a lookup surface of ball-screw efficiency and asperity contact.

The chain of the full tier, in the order the data flows; the closed-form tier goes from formulas to
builder at once::

    parameters -> raceway, formulas -> ehl -> asperities -> screw -> builder -> surface

=============  ====================================================================
folder         what it holds
=============  ====================================================================
files          files in and out: limits, YAML, datasheets, tables on disk
formulas       closed-form tier, a published law a function, author and year in it
raceway        rough surfaces: fractal, measured, identified
ehl            one contact, smooth, mixed, dry or rolling; kernels: arrays alone
asperities     what touches as roughness rolls: summits that yield, onset, law
catalogue      sheets out of a catalogue: given, derived or typical
contact        a contact as a file: case, record, pictures
screw          one point of the full tier: contacts, balance of the balls, torque
builder        datasheet to surface: tiers, sweeps; full: nodes, errors
surface        all that the node loads: lookup and file, numpy alone
surface_tools  what people do with a surface file: check, query, compare, draw
plotting       the one style of all pictures
tasks          solves kept by content, on processes or a cluster; progress
identify       parasitic torque from measured torque
studies        results beside those of the published study
commands       the offline subcommands
data           datasheets, contact cases, shipped surfaces
=============  ====================================================================

Beside them: parameters and datasheet_writer (checked inputs), results (numbers with an error),
units. Nothing here imports ROS.

"""
