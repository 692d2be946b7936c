// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// What is known of an axis: newest state, judged rows of the last minutes, events, map.

'use strict';

const ROWS = 36000; // rows that are kept, 10 min at 60 Hz
const GAP = 2.5; // time without rows [s] that interrupts a line
const NEAR = 1e-6; // what times since 1970 are rounded to, at most [s]
const STALE = 5; // age of data [s] from which on nothing is concluded from them

class Rows {
  /** Keep the newest rows of some columns; `stamp` [s] is one of them. */
  constructor(names) {
    this.names = names;
    this.clear();
  }

  clear() {
    // Twice the room: the newest rows stand one after the other, and are moved seldom.
    this.room ??= Object.fromEntries(this.names.map((name) => [name, new Float64Array(2 * ROWS)]));
    [this.begin, this.end] = [0, 0];
  }

  get count() {
    return this.end - this.begin;
  }

  /** Return the kept values of a column. */
  column(name) {
    return this.room[name].subarray(this.begin, this.end);
  }

  /** Return the newest value of a column, NaN without any. */
  last(name) {
    return this.count ? this.room[name][this.end - 1] : NaN;
  }

  /** Add rows that are newer; if time went back, they are all there is. */
  append(columns) {
    const given = columns.stamp?.length ?? 0;
    if (!given) {
      return;
    }
    if (columns.stamp[0] < this.last('stamp')) {
      this.clear();
    }
    const from = Math.max(0, given - ROWS);
    this.makeRoom(given - from);
    for (const name of this.names) {
      const values = columns[name]?.subarray(from);
      const place = this.room[name].subarray(this.end, this.end + given - from);
      values ? place.set(values) : place.fill(NaN);
    }
    this.end += given - from;
    this.begin = Math.max(this.begin, this.end - ROWS);
  }

  makeRoom(count) {
    if (this.end + count > 2 * ROWS) {
      const kept = Math.max(this.begin, this.end + count - ROWS);
      this.names.forEach((name) => this.room[name].copyWithin(0, kept, this.end));
      [this.begin, this.end] = [0, this.end - kept];
    }
  }

  /** Return the number of the first kept row at or after a time [s]. */
  first(stamp) {
    const stamps = this.column('stamp');
    let [low, high] = [0, stamps.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      [low, high] = stamps[middle] < stamp ? [middle + 1, high] : [low, middle];
    }
    return low;
  }

  /**
   * Return times and columns from a time on [s], null where a line is interrupted.
   *
   * Where there are more than `most` rows, the least and the largest of each bucket of time.
   */
  during(begin, span, names, most) {
    // The newest row is at the end itself, to which a sum of times only comes near.
    const [from, to] = [this.first(begin), this.first(begin + span + NEAR)];
    return to - from > most
      ? this.buckets(from, to, names, 2 * span / most) : this.each(from, to, names);
  }

  each(from, to, names) {
    const stamps = this.column('stamp');
    const columns = names.map((name) => this.column(name));
    const made = [[], ...names.map(() => [])];
    for (let i = from; i < to; i += 1) {
      if (i > from && stamps[i] - stamps[i - 1] > GAP) {
        made.forEach((one, at) => one.push(at ? null : stamps[i - 1] + GAP));
      }
      made[0].push(stamps[i]);
      columns.forEach((column, at) => made[at + 1].push(Rows.known(column[i])));
    }
    return made;
  }

  /** Buckets keep their places while time goes on, so that a line does not flicker. */
  buckets(from, to, names, width) {
    const stamps = this.column('stamp');
    const columns = names.map((name) => this.column(name));
    const made = [[], ...names.map(() => [])];
    let at = from;
    while (at < to) {
      const number = Math.floor(stamps[at] / width);
      let next = at;
      while (next < to && stamps[next] < (number + 1) * width) {
        next += 1;
      }
      next = Math.max(next, at + 1);
      made[0].push((number + 0.25) * width, (number + 0.75) * width);
      columns.forEach((column, i) => made[i + 1].push(...Rows.extremes(column, at, next)));
      if (next < to && stamps[next] - stamps[next - 1] > GAP) {
        made.forEach((one, i) => one.push(i ? null : (number + 1) * width));
      }
      at = next;
    }
    return made;
  }

  /** Return the least and the largest value of some rows in the order in which they came. */
  static extremes(column, from, to) {
    let [least, most] = [from, from];
    for (let i = from; i < to; i += 1) {
      least = column[i] < column[least] || Number.isNaN(column[least]) ? i : least;
      most = column[i] > column[most] || Number.isNaN(column[most]) ? i : most;
    }
    return [Math.min(least, most), Math.max(least, most)].map((i) => Rows.known(column[i]));
  }

  static known(value) {
    return Number.isNaN(value) ? null : value;
  }
}

class Axis {
  /** Begin without data; `facts` are those of hello. */
  constructor(facts) {
    this.facts = facts;
    this.rows = new Rows(Axis.COLUMNS);
    this.events = [];
    this.recorded = false;
  }

  /** Take a frame about this axis. */
  take(frame) {
    if (frame.kind === 'history') {
      this.rows.clear();
      this.rows.append(frame.arrays);
    } else if (frame.kind === 'state') {
      this.health = frame.health ?? this.health;
      this.totals = frame.totals ?? this.totals;
      [this.state, this.arrived] = [frame, performance.now()];
      this.rows.append(frame.arrays);
    } else if (frame.kind === 'map') {
      this.map = frame;
    } else if (frame.kind === 'events') {
      this.events = frame.events;
    }
  }

  /** Return True if the node of this axis has left. */
  get gone() {
    return this.state?.standing === 'gone';
  }

  /** Return the age of the newest data [s], NaN before the first. */
  get age() {
    return this.state ? (this.state.age_s ?? NaN) + (performance.now() - this.arrived) / 1000 : NaN;
  }

  /** Return True if the newest state says something about now, or about the place of a recording. */
  get fresh() {
    return !this.gone && (this.age < STALE || Boolean(this.state && this.recorded));
  }

  /** Return the level that may be shown: of old data none, no good one at standstill, and of a warning how sure it is. */
  get level() {
    if (!this.fresh) {
      return 'unknown';
    }
    const { level, zone, at_rest: rests, usual, outside } = this.state;
    if (level !== 'warn') {
      return rests ? 'rest' : level;
    }
    const certainty = zone === 'outside' && ['surely', 'perhaps'].includes(outside) ? outside : 'warn';
    return usual ? 'usual' : certainty;
  }
}

Axis.COLUMNS = ['stamp', 'speed_rpm', 'load_N', 'temperature_degC', 'efficiency', 'rcs',
  'film_ratio', 'torque_N_m', 'measured_torque_N_m', 'level'];
