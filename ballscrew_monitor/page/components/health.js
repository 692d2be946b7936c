// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The condition of an axis against its baseline: verdict, advice, and each quantity with its interval.

'use strict';

const BAR = { width: 160, height: 14 }; // size of the picture of an interval [px]
const SVG = 'http://www.w3.org/2000/svg';

class Health {
  /** Build the section of an axis. */
  constructor(axis) {
    this.axis = axis;
    this.element = Format.element('section', 'health');
    this.sentence = Format.element('div');
    this.sentence.append(Words.element('p', 'muted', 'health_none'));
    this.table = Format.element('div', 'wide');
    this.element.append(Words.element('h2', '', 'health_title'), this.sentence, this.table);
  }

  draw() {
    const { health } = this.axis;
    if (!health || health === this.shown) {
      return;
    }
    this.shown = health;
    const kind = { normal: 'good', worse: 'bad' }[health.condition] ?? '';
    const verdict = Format.element('div', `verdict ${kind}`);
    const sentence = Words.line('sentence', health.verdict, this.axis.facts);
    sentence.prepend(Words.element('strong', '', `condition_${health.condition}`), ' ');
    const notes = health.notes.map((note) => Words.line('muted', note, this.axis.facts));
    verdict.append(sentence, Words.line('', health.advice, this.axis.facts), ...notes);
    this.sentence.replaceChildren(verdict);
    const [known, missing] = [true, false].map((is) => health.quantities.filter((one) => one.known === is));
    this.table.replaceChildren(...(known.length ? [Health.rows(known)] : []), ...Health.unknown(missing));
  }

  static rows(quantities) {
    const table = Format.element('table');
    const head = table.createTHead().insertRow();
    for (const key of ['quantity', 'value', 'interval', 'picture']) {
      const cell = Words.element('th', '', `health_${key}`);
      cell.scope = 'col';
      head.append(cell);
    }
    table.createTBody().append(...quantities.map(Health.row));
    return table;
  }

  /** Say in one line that some quantities are not known; opened, it tells why of each. */
  static unknown(quantities) {
    if (!quantities.length) {
      return [];
    }
    const more = Format.element('details');
    const line = Words.element('summary', 'muted', 'health_unknown', { count: quantities.length });
    more.append(line, Health.rows(quantities));
    return [more];
  }

  static row(one) {
    const row = Format.element('tr', one.known ? '' : 'muted');
    const name = Format.element('td', '', Words.named('quantity', one.name));
    row.append(name, ...(one.known ? Health.measured(one) : Health.missing(one)));
    return row;
  }

  /** Return cells with value, interval and its picture. */
  static measured({ value, low, high, unit }) {
    const share = unit === '-';
    const number = (one) => Format.number(share ? 100 * one : one, 3);
    const shown = share ? '%' : unit;
    const texts = [
      `${number(value)} ${shown}`, Words.say('health_from_to', { low: number(low), high: number(high) }),
    ];
    const picture = Format.element('td');
    if (share && [value, low, high].every(Number.isFinite)) {
      picture.append(Health.bar(value, low, high));
    }
    return [...texts.map((text) => Format.element('td', 'short', text)), picture];
  }

  /** Return cells with why a quantity is not known. */
  static missing({ words }) {
    const why = Format.element('td');
    why.colSpan = 2;
    why.append(...Words.told(words));
    return [Format.element('td', 'short', Words.say('not_known')), why];
  }

  /** Return a picture of an interval over 0 and 100 %, which are marked. */
  static bar(value, low, high) {
    const [least, most] = [Math.min(0, low), Math.max(1, high)];
    const at = (one) => BAR.width * (0.02 + 0.96 * (one - least) / (most - least));
    const picture = Health.shape('svg', {
      ...BAR, viewBox: `0 0 ${BAR.width} ${BAR.height}`, class: 'interval', 'aria-hidden': 'true',
    });
    const line = (x, other, kind, y, end) => Health.shape('line', { x1: x, x2: other, y1: y, y2: end, class: kind });
    picture.append(
      line(at(0), at(0), 'tick', 0, BAR.height), line(at(1), at(1), 'tick', 0, BAR.height),
      line(at(low), at(high), 'line-interval', 7, 7),
      Health.shape('circle', { cx: at(value), cy: 7, r: 4, class: 'fill-heat' }),
    );
    return picture;
  }

  static shape(name, attributes) {
    const made = document.createElementNS(SVG, name);
    Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, value));
    return made;
  }
}
