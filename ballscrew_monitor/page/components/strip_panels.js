// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The panels over the last minutes: what each shows, in which unit, colour and range.

'use strict';

const StripPanels = (() => {
  const PANELS = [
    { keys: ['speed_rpm'], colours: ['measured'], show: [0] },
    { keys: ['load_N'], colours: ['measured'], show: [0] },
    { keys: ['temperature_degC'], colours: ['measured'] },
    {
      keys: ['efficiency'], colours: ['efficiency'], most: 100,
      of: (facts) => limited('efficiency', facts, facts.efficiency_limit),
    },
    {
      keys: ['rcs'], colours: ['rcs'], floor: 0.01, most: 100,
      of: (facts) => limited('rcs', facts, facts.rcs_limit),
    },
    {
      keys: ['film_ratio'], colours: ['ink'], floor: 0.1, show: [1, 3],
      bands: [
        { low: 0.001, high: 1, colour: 'boundary-band' },
        { low: 1, high: 3, colour: 'mixed-band' },
        { low: 3, high: 1e6, colour: 'hydrodynamic-band' },
      ],
    },
    { keys: ['measured_torque_N_m', 'torque_N_m'], colours: ['measured', 'modelled'], show: [0] },
  ];

  /** Return the limit of a panel as a line with its name, and that it is to be seen. */
  function limited(name, facts, limit) {
    const value = limit * Quantities.factor(name, facts);
    const label = Words.say('limit_at', { limit: Quantities.text(name, limit, facts) });
    return { limits: [{ value, label, colour: name }], show: [value] };
  }

  /** Return a panel with its limits, texts and unit for an axis. */
  function described(panel, facts) {
    const unit = Quantities.unit(panel.keys[0], facts);
    const title = Words.say(`name_${panel.keys[0]}`);
    return {
      floor: 0, most: null, bands: [], limits: [], show: [], height: 96, unit,
      ...panel,
      ...panel.of?.(facts),
      title: unit ? `${title} [${unit}]` : title,
      series: panel.keys.map((key, i) => ({
        label: Words.say(`line_${key}`), colour: panel.colours[i], dashed: false,
      })),
    };
  }

  /** Return the panels for an axis by its facts. */
  function of(facts) {
    return PANELS.map((panel) => described(panel, facts));
  }

  return { of };
})();
