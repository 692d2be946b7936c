// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// A canvas with speed over load: axes, cells, lines and labels on it.

'use strict';

class MapFrame {
  /** Prepare a canvas for `record`: ranges of speed, logarithmic if not linear, and of load. */
  constructor(record) {
    this.record = record;
    this.titles = MapFrame.TITLES;
    this.canvas = Format.element('canvas');
  }

  /** Start over, as large as there is room. */
  clear() {
    const width = this.canvas.parentElement.clientWidth;
    const height = Math.round(Math.min(520, Math.max(300, 0.55 * width)));
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.canvas.style.height = `${height}px`;
    const top = this.record.feed ? 46 : 12;
    this.area = { left: 64, top, width: width - 80, height: height - 50 - top };
    this.pen = this.canvas.getContext('2d');
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.pen.clearRect(0, 0, width, height);
    this.labels = [];
  }

  x(speed) {
    const { low, high, scale } = this.record.speed;
    const part = scale === 'linear'
      ? (speed - low) / (high - low) : Math.log(speed / low) / Math.log(high / low);
    return this.area.left + this.area.width * part;
  }

  y(load) {
    const { low, high } = this.record.load;
    return this.area.top + this.area.height * (1 - (load - low) / (high - low));
  }

  inside(work) {
    this.pen.save();
    this.pen.beginPath();
    this.pen.rect(this.area.left, this.area.top, this.area.width, this.area.height);
    this.pen.clip();
    work();
    this.pen.restore();
  }

  /** Fill the cells of a grid, rows from the lowest load up, as densely as `density` says. */
  cells(grid, colour, density) {
    const { width, height, left, top } = this.area;
    const [w, h] = [width / grid.columns, height / grid.rows];
    this.pen.fillStyle = Format.colour(colour);
    for (let i = 0; i < grid.columns * grid.rows; i += 1) {
      this.pen.globalAlpha = density(i);
      if (this.pen.globalAlpha > 0) {
        const [column, row] = [i % grid.columns, Math.floor(i / grid.columns)];
        // A little more than the cell: no seams between cells.
        const overlap = this.pen.globalAlpha === 1 ? 0.6 : 0;
        this.pen.fillRect(left + column * w, top + height - (row + 1) * h, w + overlap, h + overlap);
      }
    }
    this.pen.globalAlpha = 1;
  }

  stroke(points, colour, width, dash) {
    this.pen.strokeStyle = colour;
    this.pen.lineWidth = width;
    this.pen.setLineDash(dash);
    this.pen.beginPath();
    let on = false;
    for (let i = 0; i < points.length; i += 2) {
      if (Number.isNaN(points[i]) || Number.isNaN(points[i + 1])) {
        on = false;
      } else {
        this.pen[on ? 'lineTo' : 'moveTo'](this.x(points[i]), this.y(points[i + 1]));
        on = true;
      }
    }
    this.pen.stroke();
    this.pen.setLineDash([]);
  }

  /** Write on the map, where no label is yet. */
  label(text, x, y, colour) {
    const pen = this.pen;
    pen.font = '11px system-ui, sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    const half = pen.measureText(text).width / 2 + 3;
    const { left, width, top, height } = this.area;
    const at = Math.min(Math.max(x, left + half), left + width - half);
    const up = Math.min(Math.max(y, top + 9), top + height - 9);
    if (this.labels.some((one) => Math.abs(one.at - at) < one.half + half && Math.abs(one.up - up) < 14)) {
      return;
    }
    this.labels.push({ at, up, half });
    pen.fillStyle = Format.colour('paper');
    pen.globalAlpha = 0.85;
    pen.fillRect(at - half, up - 8, 2 * half, 16);
    pen.globalAlpha = 1;
    pen.fillStyle = colour;
    pen.fillText(text, at, up);
  }

  axes() {
    const { pen, area } = this;
    pen.strokeStyle = Format.colour('ink');
    pen.fillStyle = Format.colour('ink');
    pen.lineWidth = 1;
    pen.strokeRect(area.left, area.top, area.width, area.height);
    pen.font = '12px system-ui, sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'top';
    const bottom = area.top + area.height;
    const { feed } = this.record;
    this.speeds(feed || 1, bottom, 4);
    const title = feed ? 'feed, either direction [m/min]' : this.titles.speed;
    pen.fillText(title, area.left + area.width / 2, bottom + 30);
    if (feed) {
      pen.textBaseline = 'bottom';
      this.speeds(1, area.top, -4);
      pen.fillText('screw speed [rev/min]', area.left + area.width / 2, area.top - 24);
    }
    this.loads();
  }

  /** Write round speeds, `unit` of which are 1 rev/min, along a line at `y`, `out` of the map. */
  speeds(unit, y, out) {
    const { low, high, scale } = this.record.speed;
    const span = { low: low * unit, high: high * unit, scale };
    for (const value of Ticks.round(span, this.area.width / 48)) {
      const x = this.x(value / unit);
      this.pen.fillRect(x, Math.min(y, y + out), 1, Math.abs(out));
      this.pen.fillText(Format.number(value), x, y + 1.75 * out);
    }
  }

  /** Return a speed in words: as a feed if the log speaks of that, the speed of the screw beside. */
  words(speed) {
    const turns = `${Format.number(speed)} rev/min`;
    return this.record.feed ? `${Format.number(speed * this.record.feed)} m/min (${turns})` : turns;
  }

  loads() {
    const { pen, area } = this;
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    for (const load of Ticks.steps(this.record.load, 6)) {
      pen.fillRect(area.left - 4, this.y(load), 4, 1);
      pen.fillText(Format.number(load, 4), area.left - 7, this.y(load));
    }
    pen.save();
    pen.translate(12, area.top + area.height / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = 'center';
    pen.fillText(this.titles.load, 0, 0);
    pen.restore();
    pen.globalAlpha = 0.4;
    pen.fillRect(area.left, this.y(0), area.width, 1);
    pen.globalAlpha = 1;
  }

  /** Return speed, load and place of a pointer on the map, nothing beside it. */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const across = (x - this.area.left) / this.area.width;
    const up = 1 - (y - this.area.top) / this.area.height;
    if (across < 0 || across >= 1 || up < 0 || up >= 1) {
      return null;
    }
    return { x, y, across, up, ...this.point(across, up) };
  }

  /** Return speed and load at parts of width and height. */
  point(across, up) {
    const { speed, load } = this.record;
    return {
      speed: speed.scale === 'linear'
        ? speed.low + across * (speed.high - speed.low)
        : speed.low * (speed.high / speed.low) ** across,
      load: load.low + up * (load.high - load.low),
    };
  }
}

MapFrame.TITLES = {
  speed: 'screw speed, either direction [rev/min]',
  load: 'axial load [N]: assists | opposes',
};
