// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Begins the charts of a page; document.body.dataset says what came of it.

'use strict';

(() => {
  const failures = [];

  function fail(what) {
    failures.push(String(what));
    document.body.dataset.errors = failures.join(' | ');
  }

  function begin() {
    const views = [];
    for (const axis of JSON.parse(document.getElementById('data').textContent).axes) {
      const section = document.getElementById(axis.id);
      const series = new TimeSeries(section.querySelector('.series'), axis.course, axis.id);
      const show = (from, to) => {
        series.show(from, to);
        section.querySelector('.series').scrollIntoView({ behavior: 'smooth', block: 'start' });
      };
      const map = new OperatingMap(section.querySelector('.map'), axis.map, show);
      section.querySelectorAll('table.leading').forEach((table) => Table.leading(table, show));
      views.push(() => { series.redraw(); map.draw(); });
    }
    document.querySelectorAll('table.sortable').forEach(Table.sortable);
    Table.tellWidth();
    follow(() => views.forEach((redraw) => redraw()));
    document.body.dataset.charts = String(document.querySelectorAll('canvas').length);
  }

  /** Draw again whenever the colours change: dark and light, screen and paper. */
  function follow(redraw) {
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
    matchMedia('print').addEventListener('change', redraw);
    for (const [name, paper] of [['beforeprint', true], ['afterprint', false]]) {
      window.addEventListener(name, () => {
        document.documentElement.classList.toggle('paper', paper);
        redraw();
      });
    }
  }

  window.addEventListener('error', (event) => fail(event.message));
  document.body.dataset.errors = '';
  try {
    begin();
  } catch (error) {
    fail(error.stack || error);
  }
  requestAnimationFrame(() => { document.body.dataset.ready = 'true'; });
})();
