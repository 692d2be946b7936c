// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The last minutes as panels over time: they run on, or stand still to be looked at.

'use strict';

const SPAN = 120; // time [s] that is shown at first
const SHORTEST_RUN = 20; // time [s] that is shown while there are fewer rows
const LEAST_SPAN = 1; // shortest time [s] that is shown
const KEPT = 600; // longest time [s] that is shown
const EVERY = 200; // time [ms] between two drawings of a panel

class Strips {
  /** Build the panels of an axis; each is a view of the painter. */
  constructor(axis, painter) {
    Object.assign(this, { axis, span: SPAN, end: null });
    this.element = Format.element('section', 'strips');
    this.title = Format.element('p', 'readout');
    this.figures = Format.element('div', 'panels');
    const heading = Words.element('h2', '', 'strips_title');
    this.element.append(heading, this.controls(), this.title, this.figures);
    this.sync = uPlot.sync(axis.facts.id);
    this.panels = StripPanels.of(axis.facts);
    for (const panel of this.panels) {
      panel.holder = Format.element('figure', 'panel');
      panel.holder.append(Panel.caption(panel));
      this.figures.append(panel.holder);
      panel.news = painter.add(() => this.draw(panel), EVERY);
    }
    this.observer = new ResizeObserver(() => this.news());
    this.observer.observe(this.figures);
  }

  /** Say that there is something to draw. */
  news() {
    this.panels.forEach((panel) => panel.news());
  }

  controls() {
    const bar = Format.element('div', 'controls');
    this.hold = Controls.button('strips_pause', () => this.pause());
    bar.append(
      this.hold,
      Controls.button('strips_in', () => this.zoom(0.5)),
      Controls.button('strips_out', () => this.zoom(2)),
      Controls.button('strips_earlier', () => this.move(-0.5)),
      Controls.button('strips_later', () => this.move(0.5)),
    );
    return bar;
  }

  get now() {
    return this.axis.rows.last('stamp');
  }

  /** Return the shown range of time [s]; what runs on begins with the first row there is. */
  get range() {
    const end = this.end ?? this.now;
    const first = this.end === null ? this.axis.rows.column('stamp')[0] : -Infinity;
    return [Math.max(end - this.span, Math.min(first, end - SHORTEST_RUN)), end];
  }

  /** Stand still, or run on with what comes. */
  pause() {
    this.stop(this.end === null ? this.now : null);
  }

  stop(end) {
    this.end = end;
    this.hold.textContent = Words.say(end === null ? 'strips_pause' : 'strips_run');
    this.hold.setAttribute('aria-pressed', String(end !== null));
    this.news();
  }

  zoom(factor) {
    const [begin, end] = this.range;
    const span = Math.min(KEPT, Math.max(LEAST_SPAN, factor * this.span));
    this.end &&= (begin + end + span) / 2;
    this.span = span;
    this.news();
  }

  move(share) {
    const end = this.range[1] + share * this.span;
    this.stop(end < this.now ? end : null);
  }

  /** Show a range of time [s], standing still. */
  show(begin, end) {
    this.span = Math.max(LEAST_SPAN, end - begin);
    this.stop(begin + this.span);
  }

  draw(panel) {
    const [begin, end] = this.range;
    if (!Number.isFinite(end)) {
      return;
    }
    panel.plot ??= this.plot(panel);
    if (panel.plot.width !== this.width()) {
      panel.plot.setSize({ width: this.width(), height: panel.height });
    }
    const columns = this.axis.rows.during(begin, this.span, panel.keys, 2 * this.width());
    const [times, ...lines] = columns;
    panel.plot.batch(() => {
      panel.plot.setData([times, ...lines.map((line, i) => this.shown(panel, i, line))], false);
      panel.plot.setScale('x', { min: begin, max: end });
    });
    this.title.textContent = Words.say(this.end === null ? 'strips_running' : 'strips_standing', {
      span: Format.time(end - begin), from: Strips.clock(begin), to: Strips.clock(end),
    });
  }

  /** Return values in the unit of a panel; a logarithmic scale begins at its floor. */
  shown(panel, i, values) {
    const factor = Quantities.factor(panel.keys[i], this.axis.facts);
    const floor = panel.floor || -Infinity;
    return values.map((value) => (value === null ? null : Math.max(floor, value * factor)));
  }

  width() {
    return Math.max(240, this.figures.clientWidth);
  }

  plot(panel) {
    const made = new uPlot({
      width: this.width(),
      height: panel.height,
      scales: { x: { time: false }, y: Panel.scale(panel) },
      series: [{}, ...panel.series.map((one) => Panel.series(one))],
      axes: [this.timeAxis(panel), Panel.valueAxis(panel)],
      cursor: { sync: { key: this.sync.key }, drag: { x: true, y: false, setScale: false } },
      legend: { show: false },
      hooks: {
        drawClear: [(plot) => Panel.shade(plot, panel, this.events())],
        draw: [(plot) => Panel.limits(plot, panel)],
        setSelect: [(plot) => Panel.selected(plot, (begin, end) => this.show(begin, end))],
        setCursor: [(plot) => Panel.read(plot, panel, Strips.clock)],
      },
    }, [[], ...panel.keys.map(() => [])], panel.holder);
    made.over.addEventListener('dblclick', () => this.stop(null));
    return made;
  }

  /** Return the axis of time, which only the last panel writes at. */
  timeAxis(panel) {
    const last = panel === this.panels.at(-1);
    const axis = { ...Panel.timeAxis(last ? Strips.clock : () => ''), space: 84 };
    return last ? axis : { ...axis, size: 4 };
  }

  events() {
    return this.axis.events.map(({ begin, duration_s: length }) => ({ begin, end: begin + length }));
  }

  /** Draw again in the colours that hold now. */
  recolour() {
    this.panels.forEach(({ plot }) => plot?.redraw(false, true));
  }

  /** Let go of what the browser would keep. */
  remove() {
    this.observer.disconnect();
    this.panels.forEach(({ plot }) => plot?.destroy());
  }

  /** Return a stamp [s] as the time of day here, or as a time where it has no calendar. */
  static clock(stamp) {
    if (!(stamp > 9e8)) {
      return Format.time(stamp);
    }
    const date = new Date(1000 * stamp);
    return [date.getHours(), date.getMinutes(), date.getSeconds()]
      .map((part) => String(part).padStart(2, '0')).join(':');
  }
}
