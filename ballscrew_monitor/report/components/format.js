// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Numbers, times and colours as people read them, and arrays as pages carry them.

'use strict';

const Format = (() => {
  const NONE = '–';
  let mark = '.';

  /** Write numbers with this decimal mark from now on. */
  function decimalMark(sign) {
    mark = sign;
  }

  /** Return the bytes of a base64 text. */
  function bytes(text) {
    return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  }

  /** Return numbers of a base64 text of little-endian float32. */
  function floats(text) {
    return new Float32Array(bytes(text).buffer);
  }

  /** Return numbers of a base64 text of little-endian float64. */
  function doubles(text) {
    return new Float64Array(bytes(text).buffer);
  }

  /** Return numbers of {low, high, data}: base64 uint16, 0 is none, 1 to 65535 are low to high. */
  function packed(column) {
    const codes = column.runs ? repeated(column) : new Uint16Array(bytes(column.data).buffer);
    const step = (column.high - column.low) / 65534;
    return Float64Array.from(codes, (code) => (code ? column.low + (code - 1) * step : NaN));
  }

  /** Return codes of which each stands as often as its run tells. */
  function repeated(column) {
    const runs = new Uint32Array(bytes(column.runs).buffer);
    const codes = new Uint16Array(bytes(column.data).buffer);
    return Array.from(runs).flatMap((count, i) => new Array(count).fill(codes[i]));
  }

  /** Return a number with some digits that count, a dash where there is none. */
  function number(value, digits = 3) {
    if (value === null || value === undefined || !Number.isFinite(value)) {
      return NONE;
    }
    return marked(Number(value.toPrecision(digits)));
  }

  function marked(number) {
    const text = String(number);
    const plain = { useGrouping: false, maximumFractionDigits: 20 };
    return (text.includes('e') ? number.toLocaleString('en', plain) : text).replace('.', mark);
  }

  /** Return a time since the start [s], as 1:02:03.4 or 12.34 s. */
  function time(seconds, resolution = 1) {
    if (!Number.isFinite(seconds)) {
      return NONE;
    }
    const digits = Math.min(3, Math.max(0, Math.ceil(-Math.log10(resolution))));
    if (Math.abs(seconds) < 60) {
      return `${marked(seconds.toFixed(digits))} s`;
    }
    const rounded = Number(seconds.toFixed(digits));
    const [hours, minutes] = [Math.floor(rounded / 3600), Math.floor((rounded % 3600) / 60)];
    const rest = marked((rounded % 60).toFixed(digits)).padStart(digits ? digits + 3 : 2, '0');
    return hours ? `${hours}:${String(minutes).padStart(2, '0')}:${rest}` : `${minutes}:${rest}`;
  }

  /** Return the date and time of a moment, UTC, empty where the log has no calendar. */
  function date(begins, seconds) {
    if (!begins) {
      return '';
    }
    const text = new Date(1000 * (begins + seconds)).toISOString();
    return `${text.slice(0, 10)} ${text.slice(11, 23)} UTC`;
  }

  /** Return a colour of the style sheet by the name of its variable. */
  function colour(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  }

  /** Return an element with a class and a text, which is never read as markup. */
  function element(tag, kind = '', text = '') {
    const made = document.createElement(tag);
    made.className = kind;
    made.textContent = text;
    return made;
  }

  return { bytes, floats, doubles, packed, decimalMark, number, time, date, colour, element };
})();
