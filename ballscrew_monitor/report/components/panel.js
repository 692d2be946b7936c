// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// How a panel over time looks: scales, axes, lines, limits, and what is shaded behind them.

'use strict';

const Panel = (() => {
  function scale(panel) {
    const range = (plot, low, high) => reach(panel, low, high);
    return panel.floor ? { distr: 3, range } : { range };
  }

  /** Return the range of a panel: its data with a margin, and what it must show. */
  function reach(panel, low, high) {
    const seen = [low, high, ...panel.show].filter((value) => Number.isFinite(value));
    if (!seen.length) {
      return panel.floor ? [panel.floor, 10] : [0, 1];
    }
    let [least, most] = [Math.min(...seen), Math.max(...seen)];
    if (panel.floor) {
      return [firstDigit(Math.max(panel.floor, least) / 1.3), Math.max(most, 2 * panel.floor) * 1.3];
    }
    const margin = 0.06 * (most - least) || 0.05 * Math.abs(most) || 1;
    return [least - margin, panel.most === null ? most + margin : Math.min(most + margin, panel.most)];
  }

  /** Return a number down to its first digit: from another, uPlot steps beside decades for ever. */
  function firstDigit(value) {
    const power = 10 ** Math.floor(Math.log10(value));
    return Math.floor(value / power) * power;
  }

  function series(one) {
    return {
      label: one.label,
      stroke: () => Format.colour(one.colour),
      width: 1,
      dash: one.dashed ? [5, 3] : undefined,
      points: { show: false },
    };
  }

  /** Return the axis of time; `say` writes a time [s] to a resolution [s]. */
  function timeAxis(say = Format.time) {
    return {
      ...inked(),
      size: 30,
      values: (plot, at) => at.map((value) => say(value, (at[1] ?? 1) - (at[0] ?? 0))),
    };
  }

  function valueAxis(panel) {
    const values = (plot, splits) => splits.map((value) => (value === null ? '' : Format.number(value, 6)));
    const axis = { ...inked(), size: 64, space: 24, values };
    if (!panel.floor) {
      return axis;
    }
    const filter = (plot, splits) => splits.map((value) => marked(value, panel.bands));
    return { ...axis, filter, grid: { ...axis.grid, filter }, ticks: { ...axis.ticks, filter } };
  }

  function inked() {
    const grid = { stroke: () => Format.colour('grid'), width: 1 };
    return { stroke: () => Format.colour('ink'), grid, ticks: grid, font: '11px system-ui, sans-serif' };
  }

  /** Shade the warnings, and the regimes by film ratio where a panel has bands. */
  function shade(plot, panel, events) {
    const { ctx, bbox } = plot;
    for (const band of panel.bands) {
      const [top, bottom] = [plot.valToPos(band.high, 'y', true), plot.valToPos(band.low, 'y', true)];
      const [high, low] = [Math.max(top, bbox.top), Math.min(bottom, bbox.top + bbox.height)];
      ctx.fillStyle = Format.colour(band.colour);
      ctx.fillRect(bbox.left, high, bbox.width, Math.max(0, low - high));
    }
    // A shade would change the colours of bands: over these, warnings are a bar at the top.
    const height = panel.bands.length ? 5 * uPlot.pxRatio : bbox.height;
    // One path: where events are closer than the pixels, their shades do not add up.
    ctx.beginPath();
    for (const event of events) {
      const begin = Math.max(bbox.left, plot.valToPos(event.begin, 'x', true));
      const end = Math.min(bbox.left + bbox.width, plot.valToPos(event.end, 'x', true));
      if (end >= bbox.left && begin <= bbox.left + bbox.width) {
        ctx.rect(begin, bbox.top, Math.max(1, end - begin), height);
      }
    }
    ctx.fillStyle = Format.colour(panel.bands.length ? 'outside' : 'warning-shade');
    ctx.fill();
  }

  function limits(plot, panel) {
    const { ctx, bbox } = plot;
    for (const limit of panel.limits) {
      const at = plot.valToPos(limit.value, 'y', true);
      ctx.strokeStyle = ctx.fillStyle = Format.colour(limit.colour);
      ctx.lineWidth = 1.5 * uPlot.pxRatio;
      ctx.beginPath();
      ctx.moveTo(bbox.left, at);
      ctx.lineTo(bbox.left + bbox.width, at);
      ctx.stroke();
      ctx.font = `${11 * uPlot.pxRatio}px system-ui, sans-serif`;
      ctx.textAlign = 'right';
      ctx.textBaseline = 'bottom';
      ctx.fillText(limit.label, bbox.left + bbox.width - 4, at - 2);
    }
  }

  /** Return the title of a panel, with a place for the values under the cursor. */
  function caption(panel) {
    const made = Format.element('figcaption', '', panel.title);
    for (const one of panel.series) {
      const value = Format.element('span', 'value');
      value.dataset.label = panel.series.length > 1 ? one.label : '';
      value.style.color = `var(--${one.colour})`;
      value.textContent = value.dataset.label;
      made.append(value);
    }
    return made;
  }

  /** Write the values under the cursor beside the titles; `say` writes a time [s]. */
  function read(plot, panel, say = Format.time) {
    const at = plot.cursor.idx;
    const { beside: other } = panel;
    const beside = (value) => (other ? ` (${Format.number(other.factor * value, 4)} ${other.unit})` : '');
    const fields = plot.root.parentElement.querySelectorAll('.value');
    fields.forEach((field, i) => {
      const value = at === null || at === undefined ? null : plot.data[i + 1][at];
      const text = value === null || value === undefined ? ''
        : `${Format.number(value, 4)} ${panel.unit}${beside(value)}`;
      const time = text && i === 0 ? ` · ${say(plot.data[0][at], 0.001)}` : '';
      field.textContent = `${field.dataset.label} ${text}${time}`;
    });
  }

  /** Call `show` with begin and end [s] of what was selected, and select nothing. */
  function selected(plot, show) {
    if (plot.select.width > 3) {
      const begin = plot.posToVal(plot.select.left, 'x');
      const end = plot.posToVal(plot.select.left + plot.select.width, 'x');
      plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
      show(begin, end);
    }
  }

  /** Return a value that begins a decade or a band, null for others. */
  function marked(value, bands) {
    const near = (one) => Math.abs(value - one) < 1e-6;
    const decade = value / 10 ** Math.floor(Math.log10(value) + 1e-9);
    return Math.abs(decade - 1) < 1e-6 || bands.some((band) => near(band.low)) ? value : null;
  }

  return { scale, series, timeAxis, valueAxis, shade, limits, caption, read, selected };
})();
