// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// What moves on the map, on a canvas above it: time spent, the last minutes, where the axis is.

'use strict';

const TRAIL = 120; // age [s] of the oldest point of the trail
const APART = 3; // least distance [px] between two points of the trail

class Trail extends MapFrame {
  /** Prepare the canvas of an axis; its record is set with that of the map below. */
  constructor(axis) {
    super(null);
    Object.assign(this, { axis, ghosts: [], pinned: null });
    this.canvas.className = 'over';
    this.canvas.setAttribute('aria-hidden', 'true');
  }

  /** Add the time from each row to the next to the cell in which it was. */
  spend(columns) {
    const { stamp, speed_rpm: speeds, load_N: loads } = columns;
    for (let i = 0; i < (this.area && stamp ? stamp.length : 0); i += 1) {
      const step = stamp[i] - this.before?.stamp;
      if (this.before?.cell !== null && step > 0 && step < GAP) {
        this.record.arrays.dwell[this.before.cell] += step;
      }
      this.before = { stamp: stamp[i], cell: this.cell(speeds[i], loads[i]) };
    }
  }

  /** Return the number of the cell of a point of the machine frame, null beside the map. */
  cell(speed, load) {
    const { record: { columns, rows }, area } = this;
    const folded = Quantities.folded(speed, load);
    const across = (this.x(folded.speed) - area.left) / area.width;
    const up = 1 - (this.y(folded.load) - area.top) / area.height;
    const inside = across >= 0 && across < 1 && up >= 0 && up < 1;
    return inside ? Math.floor(up * rows) * columns + Math.floor(across * columns) : null;
  }

  /** Draw all of it: time spent, ghosts, trail, the pinned place, and where the axis is now. */
  draw() {
    if (!this.record) {
      return;
    }
    this.clear();
    this.inside(() => {
      this.spent();
      this.ghosts.forEach((ghost) => this.ghost(ghost));
      this.trail();
      this.marks();
    });
  }

  spent() {
    const { pen, area, record: { columns, rows } } = this;
    const { dwell } = this.record.arrays;
    const longest = dwell.reduce((most, one) => Math.max(most, one), 0.5);
    const size = Math.min(area.width / columns, area.height / rows);
    pen.fillStyle = Format.colour('heat');
    pen.globalAlpha = 0.55;
    dwell.forEach((seconds, i) => {
      if (seconds > 0) {
        const side = size * Math.min(1, Math.max(0.3, 1 + Math.log10(seconds / longest) / 4));
        const x = area.left + ((i % columns) + 0.5) * area.width / columns;
        const y = area.top + area.height - (Math.floor(i / columns) + 0.5) * area.height / rows;
        pen.fillRect(x - side / 2, y - side / 2, side, side);
      }
    });
    pen.globalAlpha = 1;
  }

  ghost({ points, label }) {
    const { pen } = this;
    pen.fillStyle = Format.colour('ink');
    pen.globalAlpha = 0.5;
    let [x, y] = [NaN, NaN];
    for (let i = 0; i < points.length; i += 2) {
      const [nextX, nextY] = [this.x(points[i]), this.y(points[i + 1])];
      if (!(Math.hypot(nextX - x, nextY - y) < APART)) {
        [x, y] = [nextX, nextY];
        pen.fillRect(x - 1, y - 1, 2, 2);
      }
    }
    pen.globalAlpha = 1;
    this.label(label, x, y - 12, Format.colour('ink'));
  }

  /** Draw the points of the last minutes, the fainter the older, no two on one place. */
  trail() {
    const { pen } = this;
    const [stamps, speeds, loads] = ['stamp', 'speed_rpm', 'load_N']
      .map((name) => this.axis.rows.column(name));
    const now = this.axis.rows.last('stamp');
    pen.fillStyle = Format.colour('ink');
    let [lastX, lastY] = [NaN, NaN];
    for (let i = this.axis.rows.first(now - TRAIL); i < stamps.length; i += 1) {
      const folded = Quantities.folded(speeds[i], loads[i]);
      const [x, y] = [this.x(folded.speed), this.y(folded.load)];
      if (folded.speed > 0 && !(Math.hypot(x - lastX, y - lastY) < APART)) {
        [lastX, lastY] = [x, y];
        pen.globalAlpha = 0.08 + 0.72 * (1 - (now - stamps[i]) / TRAIL) ** 3;
        pen.fillRect(x - 1.5, y - 1.5, 3, 3);
      }
    }
    pen.globalAlpha = 1;
  }

  marks() {
    const { rows, level } = this.axis;
    const now = Quantities.folded(rows.last('speed_rpm'), rows.last('load_N'));
    if (this.axis.fresh && now.speed >= this.record.speed.low) {
      this.ring(now, 10, Trail.LEVELS[level]);
    }
    if (this.pinned) {
      this.ring(this.pinned, 7, 'measured');
    }
  }

  ring({ speed, load }, radius, colour) {
    const { pen } = this;
    for (const [width, name] of [[7, 'paper'], [4, colour]]) {
      pen.beginPath();
      pen.arc(this.x(speed), this.y(load), radius, 0, 2 * Math.PI);
      pen.lineWidth = width;
      pen.strokeStyle = Format.colour(name);
      pen.stroke();
    }
  }
}

Trail.LEVELS = {
  ok: 'good', warn: 'bad', surely: 'bad', perhaps: 'amber', usual: 'unknown', rest: 'unknown', unknown: 'unknown',
};
