// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The legend of the operating map: a sample and words for each thing that is drawn.

'use strict';

const MapLegend = (() => {
  /** Return the entries for what a map draws. */
  function entries(map) {
    const { facts } = map.axis;
    const kinds = new Set(map.lines.map((line) => line.kind));
    const range = (LiveMap.RAMPS[map.quantity]?.range ?? []).map((value) => Quantities.text(map.quantity, value, facts));
    const first = map.quantity === 'zone' ? [['zone', 'legend_zone']]
      : [[`ramp-${map.quantity}`, 'legend_ramp'], ['hatched', 'legend_outside']];
    const values = {
      what: Words.say(`map_${map.quantity}`), low: range[0], high: range[1],
      rcs: Quantities.text('rcs', facts.rcs_limit, facts),
      efficiency: Quantities.text('efficiency', facts.efficiency_limit, facts),
    };
    return [...first, ['dwell', 'legend_dwell'], ['rcs', 'legend_rcs'], ['efficiency', 'legend_efficiency'],
      ['band_unknown', 'legend_unknown'], ['band_numerical', 'legend_numerical'], ['light', 'legend_light']]
      .filter(([kind]) => !OperatingMap.STYLES[kind] && !LiveMap.FOGS[kind] || kinds.has(kind))
      .map(([kind, key]) => {
        const entry = Format.element('li');
        entry.append(Format.element('span', `sample sample-${kind}`), Words.say(key, values));
        return entry;
      });
  }

  return { entries };
})();
