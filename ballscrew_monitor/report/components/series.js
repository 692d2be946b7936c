// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Panels over time by uPlot: one zoom and one cursor for all, warnings and regimes behind.

'use strict';

class TimeSeries {
  /** Draw the panels of `record` into `element`. */
  constructor(element, record, key) {
    this.record = record;
    this.element = element;
    this.sync = uPlot.sync(key);
    this.course = new Course(record);
    this.range = [0, record.span];
    this.strip = new Strip(record, this.course);
    this.title = Format.element('p', 'readout');
    this.build();
    new ResizeObserver(() => this.resize()).observe(element);
  }

  build() {
    this.plots?.forEach((plot) => plot.destroy());
    this.element.replaceChildren(this.controls(), this.title, this.strip.element);
    this.plots = this.record.panels.map((panel) => this.panel(panel));
    this.show(...this.range);
  }

  controls() {
    const bar = Format.element('div', 'controls');
    const add = (text, act) => {
      const button = Format.element('button', '', text);
      button.type = 'button';
      button.addEventListener('click', act);
      bar.append(button);
    };
    add('Whole recording', () => this.show(0, this.record.span));
    add('Zoom in', () => this.zoom(0.5));
    add('Zoom out', () => this.zoom(2));
    add('◀ Earlier', () => this.pan(-0.5));
    add('Later ▶', () => this.pan(0.5));
    return bar;
  }

  width() {
    return Math.max(240, this.element.clientWidth);
  }

  panel(panel) {
    const options = {
      width: this.width(),
      height: panel.height,
      scales: { x: { time: false }, y: Panel.scale(panel) },
      series: [{}, ...panel.series.map((one) => Panel.series(one))],
      axes: [Panel.timeAxis(), Panel.valueAxis(panel)],
      cursor: { sync: { key: this.sync.key }, drag: { x: true, y: false, setScale: false } },
      legend: { show: false },
      hooks: {
        drawClear: [(plot) => Panel.shade(plot, panel, this.record.events)],
        draw: [(plot) => Panel.limits(plot, panel)],
        setSelect: [(plot) => Panel.selected(plot, (begin, end) => this.show(begin, end))],
        setCursor: [(plot) => Panel.read(plot, panel)],
      },
    };
    const holder = Format.element('figure', 'panel');
    holder.append(Panel.caption(panel));
    this.element.append(holder);
    const plot = new uPlot(options, [this.course.time, ...this.columns(panel)], holder);
    plot.over.addEventListener('dblclick', () => this.show(0, this.record.span));
    return plot;
  }

  columns(panel) {
    return panel.series.map((one) => {
      const column = this.course.column(one.key);
      // A logarithmic scale has no zero: what is below its floor is drawn on it.
      return panel.floor ? column.map((value) => Course.atLeast(value, panel.floor)) : column;
    });
  }

  zoom(factor) {
    const [middle, half] = [(this.range[0] + this.range[1]) / 2, (this.range[1] - this.range[0]) / 2];
    this.show(middle - factor * half, middle + factor * half);
  }

  pan(share) {
    const span = this.range[1] - this.range[0];
    const begin = Math.min(Math.max(0, this.range[0] + share * span), this.record.span - span);
    this.show(begin, begin + span);
  }

  /** Show the time from `begin` to `end` [s] in all panels. */
  show(begin, end) {
    const span = this.record.span;
    const [low, high] = [Math.max(0, Math.min(begin, end)), Math.min(span, Math.max(begin, end))];
    this.range = high - low > 0.01 ? [low, high] : [low, Math.min(span, low + 0.01)];
    this.plots.forEach((plot) => plot.setScale('x', { min: this.range[0], max: this.range[1] }));
    this.drawStrip();
    const when = Format.date(this.record.begins, this.range[0]);
    const resolution = (this.range[1] - this.range[0]) / 1000;
    this.title.textContent = `Shown: ${Format.time(this.range[0], resolution)} to `
      + `${Format.time(this.range[1], resolution)}${when ? `, from ${when}` : ''}. `
      + this.course.words(...this.range);
  }

  resize() {
    const width = this.width();
    if (width !== this.plots[0]?.width) {
      this.plots.forEach((plot, i) => plot.setSize({ width, height: this.record.panels[i].height }));
    }
    this.drawStrip();
  }

  drawStrip() {
    const box = this.plots[0]?.bbox;
    if (box) {
      this.strip.draw(this.range, { left: box.left / uPlot.pxRatio, width: box.width / uPlot.pxRatio });
    }
  }

  /** Draw again in the colours that hold now. */
  redraw() {
    this.plots.forEach((plot) => plot.redraw(false, true));
    this.drawStrip();
  }
}
