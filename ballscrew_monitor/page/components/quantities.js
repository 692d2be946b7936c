// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Quantities as an operator reads them: unit, digits and conversion of each, in one table.

'use strict';

const Quantities = (() => {
  const TABLE = {
    speed_rpm: { unit: (axis) => axis.unit, factor: feed, digits: 3 },
    turns_rpm: { unit: () => Words.say('unit_turns'), digits: 4 },
    load_N: { unit: 'N', digits: 3 },
    temperature_degC: { unit: '°C', digits: 3 },
    efficiency: { unit: '%', factor: 100, digits: 3 },
    rcs: { unit: '%', factor: 100, digits: 2 },
    film_ratio: { unit: '', digits: 3 },
    torque_N_m: { unit: 'N m', digits: 3 },
    measured_torque_N_m: { unit: 'N m', digits: 3 },
    energy: { unit: 'kJ', factor: 1e-3, digits: 3 },
    hours: { unit: 'h', factor: 1 / 3600, digits: 3 },
    share: { unit: '%', factor: 100, digits: 2 },
    revolutions: { unit: '', digits: 4 },
  };

  /** Return feed in the unit of an axis over the speed of its screw [rev/min]. */
  function feed(axis) {
    const lead = axis.lead_mm ?? NaN;
    return axis.unit === 'm/min' ? lead / 1000 : lead;
  }

  const of = (part, axis) => (typeof part === 'function' ? part(axis) : part);

  const unit = (name, axis) => of(TABLE[name].unit, axis);

  const factor = (name, axis) => of(TABLE[name].factor ?? 1, axis);

  /** Return a value as text in the unit that is shown, with the unit. */
  function text(name, value, axis) {
    const known = value !== null && value !== undefined && Number.isFinite(value);
    const shown = Format.number(known ? value * factor(name, axis) : null, TABLE[name].digits);
    return unit(name, axis) && known ? `${shown} ${unit(name, axis)}` : shown;
  }

  /** Return the opposing load [N] and the speed without sign of a point of the machine frame. */
  function folded(speed, load) {
    return { speed: Math.abs(speed), load: -Math.sign(speed) * load };
  }

  return { unit, factor, text, folded };
})();
