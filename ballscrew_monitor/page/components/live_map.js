// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The operating map at one temperature: zone or a quantity, limits, and the fog of what is not known.

'use strict';

const STEP = 0.02; // part of the map that a key moves the place

class LiveMap extends OperatingMap {
  /** Prepare the map of an axis in `element`; `place` is called with what is pointed at. */
  constructor(element, axis, place) {
    super(element, null);
    Object.assign(this, { axis, told: place, quantity: 'zone' });
    this.over = new Trail(axis);
    this.canvas.after(this.over.canvas);
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.canvas.addEventListener('keydown', (event) => this.key(event));
    this.note.setAttribute('aria-live', 'polite');
    this.titles = { speed: Words.say('map_speed'), load: Words.say('map_load') };
  }

  /** Nothing is there to be unpacked before the first map comes. */
  unpack() {
    this.lines = [];
  }

  hint() {
    return Words.say('map_hint');
  }

  /** Show a map from now on. */
  take(record) {
    [this.record, this.over.record] = [record, record];
    this.lines = record.lines.map((line) => ({
      ...line, height: line.height ?? 0.5, points: record.arrays[line.array],
    }));
    this.zone = record.arrays.zone;
    this.canvas.setAttribute('aria-label', Words.say('map_label', {
      temperature: Quantities.text('temperature_degC', record.temperature_degC, this.axis.facts),
    }));
    this.draw();
  }

  draw() {
    if (!this.record) {
      return;
    }
    this.clear();
    this.inside(() => {
      this.quantity === 'zone' ? this.cells(this.record, 'zone', (i) => Number(this.zone[i] === 1))
        : this.ramp();
      this.fog();
      this.light();
      const lines = this.lines.filter((line) => OperatingMap.STYLES[line.kind]);
      lines.forEach((line) => this.line(line));
      [...lines].reverse().forEach((line) => this.name(line));
    });
    this.axes();
    this.over.draw();
  }

  light() {
    // Dots are drawn by the map of a recording between its limits.
    this.record.light_load = this.record.light_load_N;
    super.light();
  }

  /** Paint the quantity, each cell a point of a picture that is stretched; hatch what is outside. */
  ramp() {
    const { columns, rows } = this.record;
    const small = Object.assign(Format.element('canvas'), { width: columns, height: rows });
    const pen = small.getContext('2d');
    pen.fillStyle = Format.colour(LiveMap.RAMPS[this.quantity].colour);
    const part = this.part();
    this.record.arrays.cells.forEach((value, i) => {
      pen.globalAlpha = Number.isNaN(value) ? 0 : 0.05 + 0.5 * part(value);
      pen.fillRect(i % columns, rows - 1 - Math.floor(i / columns), 1, 1);
    });
    const { left, top, width, height } = this.area;
    this.pen.drawImage(small, left, top, width, height);
    this.hatch();
  }

  /** Return what gives the part of its range that a value has. */
  part() {
    const { logarithmic, range: [low, high] } = LiveMap.RAMPS[this.quantity];
    const place = logarithmic ? (value) => Math.log(Math.max(value, low)) : (value) => value;
    const span = place(high) - place(low);
    return (value) => Math.min(1, Math.max(0, (place(value) - place(low)) / span));
  }

  hatch() {
    const { columns, rows } = this.record;
    const { left, top, width, height } = this.area;
    const [w, h] = [width / columns, height / rows];
    const { pen } = this;
    pen.save();
    pen.beginPath();
    this.zone.forEach((zone, i) => {
      if (zone === 0) {
        const row = Math.floor(i / columns);
        pen.rect(left + (i % columns) * w, top + height - (row + 1) * h, w + 0.5, h + 0.5);
      }
    });
    pen.clip();
    pen.strokeStyle = Format.colour('outside');
    pen.globalAlpha = 0.55;
    pen.beginPath();
    for (let x = left - height; x < left + width; x += 11) {
      pen.moveTo(x, top + height);
      pen.lineTo(x + height, top);
    }
    pen.stroke();
    pen.restore();
  }

  /** Fill the bands of the limit between their edges; both are seen where they overlap. */
  fog() {
    for (const [kind, density] of Object.entries(LiveMap.FOGS)) {
      const [low, high] = this.lines.filter((line) => line.kind === kind).map((line) => line.points);
      if (high && low.length === high.length) {
        this.pen.globalAlpha = density;
        this.pen.fillStyle = Format.colour('rcs');
        LiveMap.stretches(low).forEach((stretch) => this.fill(low, high, stretch));
        this.pen.globalAlpha = 1;
      }
    }
  }

  /** Return begin and end of the stretches of points without a break. */
  static stretches(points) {
    const found = [];
    let from = 0;
    for (let i = 0; i <= points.length; i += 2) {
      if (i === points.length || Number.isNaN(points[i])) {
        found.push([from, i]);
        from = i + 2;
      }
    }
    return found;
  }

  fill(low, high, [from, to]) {
    const { pen } = this;
    pen.beginPath();
    for (let i = from; i < to; i += 2) {
      pen.lineTo(this.x(low[i]), this.y(low[i + 1]));
    }
    for (let i = to - 2; i >= from; i -= 2) {
      pen.lineTo(this.x(high[i]), this.y(high[i + 1]));
    }
    pen.fill();
  }

  read(event) {
    const at = this.record && this.place(event);
    at ? this.told(at) : this.say(this.hint());
  }

  lead(event) {
    const at = this.record && this.place(event);
    if (at) {
      this.pin(at);
    }
  }

  /** Pin a place, which stays marked until another is. */
  pin(at) {
    this.over.pinned = at;
    this.over.draw();
    this.told(at);
  }

  /** Move the pinned place by the arrow keys, from the middle of the map on. */
  key(event) {
    const [x, y] = LiveMap.KEYS[event.key] ?? [];
    if (x !== undefined && this.record) {
      event.preventDefault();
      const { across, up } = this.over.pinned ?? { across: 0.5, up: 0.5 };
      const inside = (part) => Math.min(0.999, Math.max(0, part));
      const at = { across: inside(across + STEP * x), up: inside(up + STEP * y) };
      this.pin({ ...at, ...this.point(at.across, at.up) });
    }
  }
}

LiveMap.KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
LiveMap.FOGS = { band_unknown: 0.16, band_numerical: 0.3 };
LiveMap.RAMPS = {
  efficiency: { colour: 'efficiency', range: [0.5, 1] },
  rcs: { colour: 'rcs', range: [1e-4, 1], logarithmic: true },
  film_ratio: { colour: 'hydrodynamic', range: [0.1, 10], logarithmic: true },
};
