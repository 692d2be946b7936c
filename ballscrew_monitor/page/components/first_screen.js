// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// What is read from two metres away: is it normal, is it outside the zone, what to do; and how old it all is.

'use strict';

const SIGNS = {
  ok: '✓', surely: '▲', perhaps: '△', warn: '▲', usual: '–', rest: '–', unknown: '?',
  normal: '✓', worse: '▲', slightly_changed: '△',
};

const FINE = { usual: 'nothing_usual', ok: 'nothing_to_do', rest: 'nothing_to_do', perhaps: 'nothing_to_do' };

class FirstScreen {
  /** Build the screen of an axis. */
  constructor(axis) {
    this.axis = axis;
    this.element = Format.element('section', 'first');
    this.element.setAttribute('aria-label', Words.say('first_title', { axis: axis.facts.axis }));
    this.parts = {};
    this.element.append(this.signs(), this.told(), this.numbers(), this.inputs());
  }

  part(name, tag, kind = name) {
    this.parts[name] = Format.element(tag, kind);
    return this.parts[name];
  }

  /** Return the two signs: the condition, which changes within weeks, and the zone, in seconds. */
  signs() {
    const holder = Format.element('div', 'signs');
    for (const name of ['condition', 'level']) {
      const sign = this.part(`${name}_sign`, 'div', `sign ${name}`);
      const glyph = this.part(`${name}_glyph`, 'span', 'glyph');
      glyph.setAttribute('aria-hidden', 'true');
      const word = this.part(name, 'span', 'word');
      word.setAttribute('role', name === 'level' ? 'alert' : 'status');
      sign.append(glyph, word);
      holder.append(sign);
    }
    return holder;
  }

  told() {
    const holder = Format.element('div', 'told');
    holder.append(...['change', 'reason', 'advice', 'shelved'].map((name) => this.part(name, 'p')));
    return holder;
  }

  numbers() {
    const list = this.part('numbers', 'dl');
    for (const name of FirstScreen.NUMBERS) {
      const pair = Format.element('div');
      const more = this.part(`${name}_more`, 'dd', 'more');
      pair.append(Words.element('dt', '', `name_${name}`), this.part(name, 'dd', 'big'), more);
      list.append(pair);
    }
    return list;
  }

  inputs() {
    const holder = Format.element('div', 'health-of-inputs');
    holder.append(this.part('age', 'p'), this.part('inputs', 'ul'), this.part('faults', 'div'));
    return holder;
  }

  /** Write a text where it differs: what stays is not read out again. */
  write(name, text) {
    if (this.parts[name].textContent !== text) {
      this.parts[name].textContent = text;
    }
  }

  draw() {
    const { axis } = this;
    this.sign('level', axis.level, Words.say(`level_${axis.level}`));
    const condition = axis.health?.condition ?? 'unknown';
    this.sign('condition', condition, Words.say(`condition_${condition}`));
    this.tell('reason', this.reason());
    const advice = axis.fresh && this.advice(condition);
    this.tell('advice', advice ? { key: 'what_to_do', values: { advice } } : '');
    this.tell('change', condition === 'normal' ? '' : axis.health?.verdict ?? { key: 'health_none' });
    this.write('shelved', FirstScreen.shelved(axis));
    this.drawNumbers();
    this.drawInputs();
  }

  sign(name, state, word) {
    this.parts[`${name}_sign`].dataset.state = state;
    this.write(`${name}_glyph`, SIGNS[state]);
    this.write(name, word);
  }

  tell(name, said) {
    Words.tell(this.parts[name], said, this.axis.facts);
  }

  /** Return the reason of the level: of old data, that they are old. */
  reason() {
    const { axis } = this;
    if (axis.gone) {
      return { key: 'node_left', values: { node: axis.facts.node } };
    }
    if (!axis.state) {
      return { key: 'waits_for_data' };
    }
    if (!axis.fresh) {
      return axis.state.standing === 'inactive'
        ? { key: 'node_inactive', values: { node: axis.facts.node } }
        : { key: 'data_old', values: { age: Format.time(axis.age) } };
    }
    const { level, zone, headline } = axis.state;
    const held = level === 'warn' && zone !== 'outside';
    const reason = held ? { key: 'warning_held', values: { reason: headline } } : headline;
    return axis.state.outside === 'unbanded'
      ? { key: 'first_second', values: { first: reason, second: { key: 'no_bands' } } } : reason;
  }

  /** Return what to do: against a warning, against a change, or nothing where that is known. */
  advice(condition) {
    const { axis } = this;
    const changed = ['worse', 'slightly_changed'].includes(condition);
    const fine = condition === 'normal' && FINE[axis.level];
    return axis.state.advice || (changed && axis.health.advice) || (fine ? { key: fine } : '');
  }

  static shelved({ state }) {
    const minutes = Math.ceil((state?.shelved?.left_s ?? 0) / 60);
    return state?.shelved ? Words.say('shelved_for', { minutes, reason: state.shelved.reason }) : '';
  }

  drawNumbers() {
    const { axis: { rows, facts, state } } = this;
    this.parts.numbers.hidden = !rows.count; // the reason says what is missing
    for (const name of FirstScreen.NUMBERS.filter((one) => one !== 'limit')) {
      this.write(name, Quantities.text(name, rows.last(name), facts));
    }
    this.write('speed_rpm_more', Quantities.text('turns_rpm', rows.last('speed_rpm'), facts));
    this.write('load_N_more', FirstScreen.sense(rows.last('speed_rpm'), rows.last('load_N')));
    this.write('efficiency_more', Words.say('limit_at', {
      limit: Quantities.text('efficiency', facts.efficiency_limit, facts),
    }));
    this.write('temperature_degC_more', state?.temperature_assumed ? Words.say('temperature_assumed') : '');
    const limit = state?.limit?.speed_rpm ?? NaN;
    const speed = Math.abs(rows.last('speed_rpm'));
    this.write('limit', FirstScreen.distance(speed >= facts.standstill_rpm ? speed / limit - 1 : NaN));
    this.write('limit_more', Number.isFinite(limit) ? Words.say('limit_speed', {
      feed: Quantities.text('speed_rpm', limit, facts),
      turns: Quantities.text('turns_rpm', limit, facts),
    }) : '');
  }

  /** Say whether the load opposes the motion. */
  static sense(speed, load) {
    const opposing = Quantities.folded(speed, load).load;
    return opposing ? Words.say(opposing > 0 ? 'load_opposes' : 'load_assists') : '';
  }

  /** Say how far the speed is from the limit of contact. */
  static distance(margin) {
    if (!Number.isFinite(margin)) {
      return Format.number(null);
    }
    if (margin > 1) {
      return Words.say('limit_times', { times: Format.number(1 + margin, 2) });
    }
    const percent = Format.number(100 * Math.abs(margin), 2);
    return Words.say(margin < 0 ? 'limit_below' : 'limit_above', { percent });
  }

  drawInputs() {
    const { axis } = this;
    const age = Format.time(axis.age, axis.age < 10 ? 0.1 : 1);
    const told = axis.recorded ? Words.say('data_recorded') : Words.say('data_age', { age });
    this.write('age', axis.rows.count ? told : '');
    const { inputs = [], faults = [] } = axis.state ?? {};
    const listed = JSON.stringify([faults, inputs.map(({ name, state, words }) => [name, state, words])]);
    if (listed !== this.shown) {
      this.shown = listed;
      this.parts.inputs.replaceChildren(...inputs.map(FirstScreen.input));
      this.parts.faults.replaceChildren(...faults.map((code) => Words.line('fault', {
        key: 'fault_is', values: { code, fault: { key: `fault_${code}` } },
      })));
    }
  }

  static input({ name, state, words }) {
    const item = Format.element('li', 'input');
    item.dataset.state = state;
    item.append(Format.element('b', '', Words.named('input', name)), ' ', Words.named('state', state));
    if (words) {
      item.append(Words.free(words, 'words'));
    }
    return item;
  }
}

FirstScreen.NUMBERS = ['speed_rpm', 'load_N', 'temperature_degC', 'efficiency', 'limit'];
