// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Warnings of an axis, newest first, to be acknowledged and shelved by a name; sums of the motion.

'use strict';

const SHOWN = 50; // warnings that are listed
const HEADS = ['begin', 'duration', 'worst', 'advice', 'who']; // columns of the table
const SHELF = [15, 60, 480]; // times [min] for which a warning can be shelved

class Events {
  /** Build the list of an axis; `show` is called with begin and end [s] of a warning. */
  constructor(axis, live, acting, show) {
    Object.assign(this, { axis, live, acting, show });
    this.element = Format.element('section', 'events');
    this.list = Format.element('div', 'wide');
    this.message = Format.element('p', 'message');
    this.message.setAttribute('role', 'status');
    this.totals = Format.element('dl', 'tiles');
    this.sums = Format.element('div');
    this.heading = Format.element('h2');
    this.sums.append(this.heading, this.totals);
    this.element.append(
      Words.element('h2', '', 'events_title'), this.form(), this.message, this.list, this.sums,
    );
  }

  /** Return the form by which somebody acts under a name. */
  form() {
    const bar = Format.element('div', 'controls');
    this.name = Controls.field(60);
    this.reason = Controls.field(200);
    const times = SHELF.map((minutes) => [String(minutes), Words.say('shelve_minutes', { minutes })]);
    const shelf = Controls.select('shelve_time', times, () => {});
    this.minutes = shelf.querySelector('select');
    const acknowledge = Controls.button('acknowledge', () => this.act({
      do: 'acknowledge', reason: this.reason.value.trim() || undefined,
    }));
    const shelve = Controls.button('shelve', () => this.act({
      do: 'shelve', minutes: Number(this.minutes.value), reason: this.reason.value,
    }));
    bar.append(
      Controls.labelled('act_name', this.name), acknowledge,
      Controls.labelled('act_reason', this.reason), shelf, shelve,
    );
    for (const control of [this.name, this.reason, this.minutes, acknowledge, shelve]) {
      control.disabled = !this.acting;
    }
    if (!this.acting) {
      this.message.textContent = Words.say('acting_off');
    }
    return bar;
  }

  /** Ask for an act under a name; without name or reason nothing is asked for. */
  async act(request) {
    const missing = !this.name.value.trim() ? 'act_needs_name'
      : request.reason?.trim() === '' && 'act_needs_reason';
    if (missing) {
      this.message.textContent = Words.say(missing);
      return;
    }
    const answer = await this.live.ask({ axis: this.axis.facts.id, name: this.name.value.trim(), ...request });
    const said = answer.message || { key: answer.ok ? 'act_done' : 'act_refused' };
    Words.tell(this.message, said, this.axis.facts);
  }

  draw() {
    const { events, totals } = this.axis;
    this.element.dataset.state = this.axis.level; // how sure the warning is that is on
    if (events !== this.shown) {
      this.shown = events;
      this.list.replaceChildren(events.length ? this.table(events) : Words.element('p', 'muted', 'events_none'));
    }
    const text = (name, value) => Quantities.text(name, value, this.axis.facts);
    this.sums.hidden = totals?.running_time === undefined;
    this.heading.textContent = Words.say(this.axis.recorded ? 'totals_recorded' : 'totals_title');
    this.totals.replaceChildren(...(this.sums.hidden ? [] : [
      Events.tile('hours', totals.running_time < 3600 ? Format.time(totals.running_time)
        : text('hours', totals.running_time)),
      Events.tile('outside', text('share', totals.outside_time / totals.running_time)),
      Events.tile('mixed', text('share', (totals.mixed_time + totals.boundary_time) / totals.running_time)),
      Events.tile('energy', text('energy', totals.energy_lost)),
      Events.tile('revolutions', text('revolutions', totals.revolutions)),
    ]));
  }

  static tile(key, text) {
    const tile = Format.element('div', 'tile');
    tile.append(Format.element('dd', '', text), Words.element('dt', '', `total_${key}`));
    return tile;
  }

  table(events) {
    const table = Format.element('table');
    const head = table.createTHead().insertRow();
    for (const key of HEADS) {
      const cell = Words.element('th', '', `event_${key}`);
      cell.scope = 'col';
      head.append(cell);
    }
    table.createTBody().append(...events.slice(0, SHOWN).map((event) => this.row(event)));
    return table;
  }

  row(event) {
    const row = Format.element('tr', event.usual ? 'usual' : event.active ? 'bad' : '');
    const when = Format.element('button', 'plain', Strips.clock(event.begin));
    when.type = 'button';
    when.title = Words.say('event_show');
    when.addEventListener('click', () => this.show(event.begin - 5, event.begin + event.duration_s + 5));
    const first = Format.element('td', 'short');
    first.append(when);
    const more = ['active', 'usual'].filter((one) => event[one]).map((one) => ` ${Words.say(`event_${one}`)}`);
    const length = Format.time(event.duration_s) + more.join(',');
    const how = ['acknowledged', 'shelved'].find((one) => event[one]);
    const by = [event.acknowledged_by, event.acknowledge_reason].filter(Boolean).join(': ');
    const who = by || (how ? Words.say(`event_${how}`) : '');
    const advice = Format.element('td');
    Words.tell(advice, event.advice, this.axis.facts);
    const texts = [length, this.worst(event), who].map((text) => Format.element('td', '', text));
    row.append(first, ...texts.slice(0, 2), advice, texts[2]);
    HEADS.forEach((key, i) => { row.cells[i].dataset.head = Words.say(`event_${key}`); });
    return row;
  }

  /** Say the worst value of a warning beside the limit that it broke. */
  worst({ quantity, worst, limit }) {
    if (!['rcs', 'efficiency'].includes(quantity)) {
      return Words.say('not_known');
    }
    const [value, bound] = [worst, limit].map((one) => Quantities.text(quantity, one, this.axis.facts));
    return Words.say('event_worst_is', { quantity: Words.say(`short_${quantity}`), value, bound });
  }
}
