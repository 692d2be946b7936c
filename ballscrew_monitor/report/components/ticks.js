// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Round numbers along an axis.

'use strict';

const Ticks = (() => {
  /** Return round numbers at equal steps between low and high, about so many. */
  function steps({ low, high }, many) {
    const raw = (high - low) / many;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 5, 10].find((first) => first * power >= raw);
    const first = Math.ceil(low / step);
    return Array.from({ length: Math.floor(high / step) - first + 1 }, (none, i) => (first + i) * step);
  }

  /** Return round numbers between low and high, as many as there is room for. */
  function round({ low, high, scale }, most) {
    if (scale === 'linear') {
      return steps({ low, high }, most / 1.5);
    }
    for (const firsts of [[1, 2, 5], [1, 3], [1]]) {
      const found = [];
      for (let power = -5; power < 6; power += 1) {
        found.push(...firsts.map((first) => first * 10 ** power));
      }
      const inside = found.filter((speed) => speed >= low && speed <= high);
      if (inside.length <= most || firsts.length === 1) {
        return inside;
      }
    }
    return [];
  }

  return { steps, round };
})();
