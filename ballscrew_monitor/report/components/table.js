// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Tables that are there already: rows sorted by a column, rows that lead to a moment.

'use strict';

const Table = (() => {
  /** Return what a cell is sorted by: its number if it states one, else its text. */
  function keyOf(row, column) {
    const cell = row.cells[column];
    const stated = cell.dataset.value;
    return stated === undefined ? cell.textContent : Number(stated);
  }

  /** Compare two keys, `sign` 1 for ascending and -1 for descending. */
  function compare(one, other, sign) {
    if (typeof one === 'number' && typeof other === 'number') {
      // What is not known stands last, whichever way the rest is sorted.
      return (Number.isNaN(one) - Number.isNaN(other)) || sign * (one - other) || 0;
    }
    return sign * String(one).localeCompare(String(other));
  }

  function sort(table, column) {
    const head = table.tHead.rows[0].cells;
    const down = head[column].getAttribute('aria-sort') === 'ascending';
    for (const cell of head) {
      cell.removeAttribute('aria-sort');
    }
    head[column].setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const rows = Array.from(table.tBodies[0].rows);
    const sign = down ? -1 : 1;
    rows.sort((one, other) => compare(keyOf(one, column), keyOf(other, column), sign));
    table.tBodies[0].append(...rows);
  }

  function onKey(element, act) {
    element.tabIndex = 0;
    element.addEventListener('click', act);
    element.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' || event.key === ' ') {
        event.preventDefault();
        act();
      }
    });
  }

  /** Let the heads of a table sort it. */
  function sortable(table) {
    Array.from(table.tHead.rows[0].cells).forEach((cell, column) => {
      cell.title = 'sort by this column';
      onKey(cell, () => sort(table, column));
    });
  }

  /** Let rows with data-begin and data-end [s] call `show` with both. */
  function leading(table, show) {
    for (const row of table.querySelectorAll('tr[data-begin]')) {
      row.title = 'show this moment in the charts';
      onKey(row, () => show(Number(row.dataset.begin), Number(row.dataset.end)));
    }
  }

  /** Say of each table on the page that is wider than its place that it can be scrolled. */
  function tellWidth() {
    for (const holder of document.querySelectorAll('.wide')) {
      const note = Format.element('p', 'beyond muted', 'Scroll sideways to see all columns →');
      holder.prepend(note);
      const look = () => holder.classList.toggle('cut', holder.scrollWidth > holder.clientWidth + 1);
      new ResizeObserver(look).observe(holder);
      look();
    }
  }

  return { sortable, leading, tellWidth };
})();
