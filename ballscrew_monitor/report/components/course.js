// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// A recording as columns over time: extremes of buckets, every sample around the worst warnings.

'use strict';

class Course {
  /** Unpack `record`: coarse columns, and stretches of every sample that take their place. */
  constructor(record) {
    this.record = record;
    this.coarse = Course.coarse(record);
    this.fine = record.fine.map((stretch) => ({ ...stretch, time: Course.times(stretch) }));
    this.pieces = this.cut();
    this.time = this.join((piece) => (piece.fine ? piece.fine.time : this.coarse), Float64Array);
  }

  /** Return the times of the coarse columns: two rows to a bucket, or as they are stated. */
  static coarse(record) {
    if (!record.bucket) {
      return Format.doubles(record.time);
    }
    const count = Math.round(2 * record.span / record.bucket);
    return Float64Array.from({ length: count }, (none, i) => (i + 0.5) * record.bucket / 2);
  }

  static times(stretch) {
    if (stretch.time) {
      return Format.packed(stretch.time);
    }
    const step = (stretch.end - stretch.begin) / Math.max(1, stretch.count - 1);
    return Float64Array.from({ length: stretch.count }, (none, i) => stretch.begin + i * step);
  }

  /** Return which part of what stands where: the coarse columns with the fine ones put in. */
  cut() {
    const pieces = [];
    let from = 0;
    for (const fine of this.fine) {
      const begin = Course.first(this.coarse, fine.begin, from);
      pieces.push({ from, to: begin }, { from: 0, to: fine.count, fine });
      from = Course.first(this.coarse, fine.end, begin);
    }
    pieces.push({ from, to: this.coarse.length });
    return pieces;
  }

  static first(times, at, from) {
    let i = from;
    while (i < times.length && times[i] < at) {
      i += 1;
    }
    return i;
  }

  join(source, Kind) {
    const total = this.pieces.reduce((sum, piece) => sum + piece.to - piece.from, 0);
    const joined = new Kind(total);
    let at = 0;
    for (const piece of this.pieces) {
      const values = source(piece);
      joined.set(values.subarray(piece.from, piece.to), at);
      at += piece.to - piece.from;
    }
    return joined;
  }

  /** Return a column by its key, null where there is no number: a gap. */
  column(key) {
    const coarse = Format.floats(this.record.columns[key]);
    const fine = new Map(this.fine.map((one) => [one, Format.packed(one.columns[key])]));
    const values = this.join((piece) => (piece.fine ? fine.get(piece.fine) : coarse), Float64Array);
    return Array.from(values, (value) => (Number.isNaN(value) ? null : value));
  }

  /** Return a value or the least that is drawn; what is none stays none. */
  static atLeast(value, least) {
    return value !== null && value < least ? least : value;
  }

  /** Say how much of the recording is seen between two times [s]. */
  words(begin, end) {
    if (!this.record.bucket) {
      return 'Every sample is drawn.';
    }
    if (this.fine.some((one) => one.begin <= begin && one.end >= end)) {
      return 'Every sample is drawn.';
    }
    const every = Format.number(this.record.bucket, 2);
    return `Smallest and largest value of every ${every} s are drawn${this.around()}.`;
  }

  /** Say around how many of the worst warnings every sample is there. */
  around() {
    const { shown, worst } = this.record;
    const short = shown < worst ? ', for more the page has no room' : '';
    if (!shown) {
      return short && '; for every sample around warnings the page has no room';
    }
    return `, every sample around the ${shown === 1 ? 'worst warning' : `${shown} worst warnings`}${short}`;
  }
}
