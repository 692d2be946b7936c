// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The operating map on a canvas: optimal zone, time spent, borders and warnings.

'use strict';

class OperatingMap extends MapFrame {
  /** Draw `record` into `element`; `show` is called with begin and end [s] of a warning. */
  constructor(element, record, show) {
    super(record);
    this.show = show;
    this.unpack(record);
    this.note = Format.element('p', 'readout', this.hint());
    element.replaceChildren(this.canvas, this.note);
    this.canvas.addEventListener('pointermove', (event) => this.read(event));
    this.canvas.addEventListener('pointerleave', () => this.say(this.hint()));
    this.canvas.addEventListener('click', (event) => this.lead(event));
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(element);
    this.draw();
  }

  unpack(record) {
    this.lines = record.lines.map((line) => ({ ...line, points: Format.floats(line.points) }));
    this.zone = Format.packed(record.zone.cells).map(Math.round);
    this.dwell = Format.floats(record.dwell.cells);
  }

  hint() {
    return OperatingMap.HINT;
  }

  draw() {
    this.clear();
    this.inside(() => {
      this.cells(this.record.zone, 'zone', (i) => (this.zone[i] === 1 ? 1 : 0));
      this.cells(this.record.dwell, 'heat', (i) => this.heat(this.dwell[i]));
      this.light();
      this.lines.forEach((line) => this.line(line));
      // The limits come last and are on top; their names come first and keep their places.
      [...this.lines].reverse().forEach((line) => this.name(line));
    });
    this.axes();
    this.record.events.forEach((event) => this.mark(event));
  }

  /** Return how dense a time [s] in a cell is drawn, by its logarithm over three decades. */
  heat(seconds) {
    if (!(seconds > 0)) {
      return 0;
    }
    const part = 1 + Math.log10(seconds / this.record.dwell.longest) / 3;
    return 0.1 + 0.75 * Math.min(1, Math.max(0, part));
  }

  light() {
    const [top, bottom] = [this.y(this.record.light_load), this.y(-this.record.light_load)];
    this.pen.fillStyle = Format.colour('hatch');
    for (let x = this.area.left + 3; x < this.area.left + this.area.width; x += 7) {
      for (let y = Math.max(top, this.area.top) + 3; y < bottom; y += 7) {
        this.pen.fillRect(x, y, 1.3, 1.3);
      }
    }
  }

  line(line) {
    const [colour, width, dash] = OperatingMap.STYLES[line.kind];
    this.stroke(line.points, Format.colour(colour), width, dash);
  }

  /** Write on a line where it is nearest to its height on the map. */
  name(line) {
    if (!line.label || !line.points.length) {
      return;
    }
    const [colour] = OperatingMap.STYLES[line.kind];
    const { low, high } = this.record.load;
    const level = low + line.height * (high - low);
    let best = -1;
    for (let i = 0; i < line.points.length; i += 2) {
      const off = Math.abs(line.points[i + 1] - level);
      if (best < 0 || off < Math.abs(line.points[best + 1] - level)) {
        best = i;
      }
    }
    const x = this.x(line.points[best]);
    this.label(line.label, x, this.y(line.points[best + 1]), Format.colour(colour));
  }

  mark(event) {
    const { pen } = this;
    const [x, y] = [this.x(event.speed), this.y(event.load)];
    pen.beginPath();
    pen.arc(x, y, 9, 0, 2 * Math.PI);
    pen.fillStyle = Format.colour('paper');
    pen.strokeStyle = Format.colour('outside');
    pen.lineWidth = 1.5;
    pen.fill();
    pen.stroke();
    pen.fillStyle = Format.colour('ink');
    pen.font = 'bold 11px system-ui, sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.fillText(String(event.number), x, y);
  }

  read(event) {
    const at = this.place(event);
    if (!at) {
      this.say(this.hint());
      return;
    }
    const { columns, rows } = this.record.dwell;
    const seconds = this.dwell[Math.floor(at.up * rows) * columns + Math.floor(at.across * columns)];
    const words = OperatingMap.ZONES[this.cellOf(at)];
    this.say(`${this.words(at.speed)}, ${Format.number(at.load)} N: ${words}; `
      + `${Format.number(seconds)} s spent in this cell`);
  }

  cellOf(at) {
    const { columns, rows } = this.record.zone;
    return this.zone[Math.floor(at.up * rows) * columns + Math.floor(at.across * columns)];
  }

  lead(event) {
    const at = this.place(event);
    const near = (one) => Math.hypot(this.x(one.speed) - at.x, this.y(one.load) - at.y) < 12;
    const found = at && this.record.events.find(near);
    if (found && this.show) {
      this.show(found.begin, found.end);
    }
  }

  say(text) {
    this.note.textContent = text;
  }

}

OperatingMap.HINT = 'Point at the map to read it; a click on a warning number shows its course.';
OperatingMap.ZONES = ['outside the optimal zone', 'optimal', 'the model gives no number'];
OperatingMap.STYLES = {
  rcs: ['rcs', 2.2, []],
  rcs_other: ['rcs', 1.2, [6, 4]],
  rcs_band: ['rcs', 0.9, [8, 3, 2, 3]],
  efficiency: ['efficiency', 2.2, []],
  efficiency_other: ['efficiency', 0.6, []],
  film: ['muted', 1, [1.5, 2.5]],
};
