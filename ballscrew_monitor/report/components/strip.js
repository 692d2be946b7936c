// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Coloured bars over time: zone, warning and regime.

'use strict';

const ROW = 18; // height of a bar [px]

class Strip {
  /** Prepare the bars of `record`. */
  constructor(record) {
    this.record = record;
    this.time = Course.coarse(record);
    this.bars = record.bars.map((bar) => ({ ...bar, codes: Format.bytes(bar.codes) }));
    this.canvas = Format.element('canvas', 'strip');
    this.element = Format.element('figure', 'panel');
    this.element.append(Format.element('figcaption', '', 'Zone, warning and regime'), this.canvas);
  }

  /** Draw a range of time [s] across `area`, left and width [px], that of the panels below. */
  draw([begin, end], area) {
    const width = Math.max(240, this.element.clientWidth);
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(ROW * this.bars.length * ratio);
    this.canvas.style.height = `${ROW * this.bars.length}px`;
    const pen = this.canvas.getContext('2d');
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.font = '11px system-ui, sans-serif';
    pen.textBaseline = 'middle';
    pen.textAlign = 'right';
    const at = (seconds) => area.left
      + area.width * ((Math.min(Math.max(seconds, begin), end) - begin) / (end - begin));
    this.bars.forEach((bar, i) => {
      pen.fillStyle = Format.colour('ink');
      pen.fillText(bar.title, area.left - 6, ROW * (i + 0.5));
      const colours = bar.colours.map((name) => Format.colour(name));
      for (const run of Strip.runs(this.time, bar.codes, this.record.span)) {
        if (run.end > begin && run.begin < end) {
          const [left, right] = [at(run.begin), at(run.end)];
          pen.fillStyle = colours[run.code];
          pen.fillRect(left, ROW * i + 1, Math.max(0.7, right - left), ROW - 2);
        }
      }
    });
  }

  /** Yield runs of equal code: code, begin and end [s]. */
  static* runs(times, codes, span) {
    let from = 0;
    for (let i = 1; i <= codes.length; i += 1) {
      if (i === codes.length || codes[i] !== codes[from]) {
        yield { code: codes[from], begin: times[from], end: i < codes.length ? times[i] : span };
        from = i;
      }
    }
  }
}
