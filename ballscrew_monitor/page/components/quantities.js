// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Quantities as an operator reads them: unit, digits and conversion of each, in one table.

'use strict';

const Quantities = (() => {
  const TABLE = {
    speed_rpm: { unit: (axis) => axis.unit, factor: feed, digits: 3 },
    turns_rpm: { unit: () => Words.say('unit_turns'), digits: 3 },
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

  /** Return a value of a phrase: {value, unit}, or the number of a quantity by its name. */
  function value(given, axis) {
    if ('unit' in given) {
      return measured(given.value, given.unit);
    }
    const [[name, number]] = Object.entries(given);
    return name === 'speed' ? speed(number, axis) : text(name, number, axis);
  }

  /** Return a speed [rev/min] as feed and turns, as turns alone where the lead is not known. */
  function speed(turns, axis) {
    const names = axis.lead_mm ? ['speed_rpm', 'turns_rpm'] : ['turns_rpm'];
    return names.map((name) => text(name, turns, axis)).join(', ');
  }

  /** Return a number with its unit as it is told, a share in percent. */
  function measured(number, told) {
    return told === '-' ? `${Format.number(100 * (number ?? NaN))} %` : `${Format.number(number)} ${told}`;
  }

  /** Return between what the surface of an axis is known, as texts. */
  function ends(axis) {
    return {
      speed_low: speed(axis.speed_low_rpm, axis), speed_high: speed(axis.speed_high_rpm, axis),
      load_low: text('load_N', axis.load_low_N, axis), load_high: text('load_N', axis.load_high_N, axis),
      temperature_low: text('temperature_degC', axis.temperature_low_degC, axis),
      temperature_high: text('temperature_degC', axis.temperature_high_degC, axis),
    };
  }

  /** Return the opposing load [N] and the speed without sign of a point of the machine frame. */
  function folded(speed, load) {
    return { speed: Math.abs(speed), load: -Math.sign(speed) * load };
  }

  return { unit, factor, text, value, measured, ends, folded };
})();
