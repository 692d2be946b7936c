// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// What would be: the map at another temperature or in another oil, a place on it, other feeds.

'use strict';

const FEEDS = [0.8, 1.0, 1.2]; // of the programme that ran last

class WhatIf {
  /** Build the map of an axis with its questions, which `live` is asked. */
  constructor(axis, live, acting) {
    Object.assign(this, { axis, live, temperature: null, oil: null });
    this.element = Format.element('section', 'what-if');
    this.holder = Format.element('div', 'map');
    this.map = new LiveMap(this.holder, axis, (at) => this.point(at));
    this.title = Format.element('h2');
    this.assumed = Format.element('p', 'assumed');
    this.legend = Format.element('ul', 'legend');
    this.results = Format.element('div', 'results');
    this.askMap = live.newest((answer) => this.show(answer));
    this.askPoint = live.newest((answer) => this.told(answer));
    const parts = axis.facts.no_map ? [Format.element('p', 'no-map', axis.facts.no_map)]
      : [this.choices(), this.assumed, this.holder, this.legend, this.questions(acting), this.results];
    this.element.append(this.title, ...parts);
    this.say();
  }

  choices() {
    const { facts } = this.axis;
    const bar = Format.element('div', 'controls');
    const shown = ['zone', ...Object.keys(LiveMap.RAMPS)].map((name) => [name, Words.say(`map_${name}`)]);
    this.slider = Object.assign(Format.element('input'), {
      type: 'range', min: facts.temperature_low_degC, max: facts.temperature_high_degC, step: 1,
    });
    this.slider.addEventListener('input', () => this.warm(Number(this.slider.value)));
    const oils = [['', Words.say('oil_filled', { oil: facts.oil })], ...facts.grades.map((one) => [one, one])];
    this.back = Controls.button('what_if_back', () => this.now());
    bar.append(
      Controls.select('map_shows', shown, (name) => this.quantity(name)),
      Controls.labelled('what_if_temperature', this.slider),
      Controls.select('what_if_oil', oils, (name) => this.pour(name)),
      this.back,
    );
    this.oils = bar.querySelectorAll('select')[1];
    return bar;
  }

  questions(acting) {
    const bar = Format.element('div', 'controls');
    this.solve = Controls.button('what_if_solve', () => this.solved());
    this.stop = Controls.button('what_if_cancel', () => this.live.ask({ do: 'cancel', solve: this.solving }));
    [this.solve.disabled, this.stop.hidden] = [true, true];
    this.acting = acting;
    bar.append(this.solve, this.stop, Controls.button('what_if_ghosts', () => this.haunt()));
    if (!acting) {
      bar.append(Words.element('span', 'muted', 'acting_off'));
    }
    return bar;
  }

  get changed() {
    return this.temperature !== null || this.oil !== null;
  }

  /** Show a map that the server sent by itself, unless something else was asked for. */
  take(map) {
    if (!this.changed && (this.map.quantity === 'zone' || map.quantity === this.map.quantity)) {
      this.show(map);
    } else if (!this.changed) {
      this.ask();
    }
  }

  show(map) {
    if (map.ok === false) {
      this.result(map.message);
      return;
    }
    this.map.take(map);
    if (this.temperature === null) {
      this.slider.value = map.temperature_degC;
    }
    this.say();
  }

  ask() {
    const quantity = this.map.quantity === 'zone' ? 'efficiency' : this.map.quantity;
    const { temperature: temperature_degC, oil } = this;
    this.askMap({ do: 'map', axis: this.axis.facts.id, quantity, temperature_degC, oil });
  }

  quantity(name) {
    this.map.quantity = name;
    this.ask();
  }

  warm(temperature) {
    this.temperature = temperature;
    this.say();
    this.ask();
  }

  pour(name) {
    this.oil = name || null;
    this.say();
    this.ask();
  }

  /** Return to the oil and the temperature that are there. */
  now() {
    [this.temperature, this.oil, this.oils.value, this.map.over.ghosts] = [null, null, '', []];
    this.ask();
  }

  /** Say what the map shows, and loudly if that is not what is there. */
  say() {
    const { record, axis: { facts } } = this.map;
    const shown = this.temperature ?? record?.temperature_degC;
    const temperature = Quantities.text('temperature_degC', shown, facts);
    this.title.textContent = record ? Words.say('map_title', { temperature }) : Words.say('map_none');
    const oil = this.oil ?? facts.oil;
    this.assumed.textContent = [this.changed && Words.say('what_if_assumed', { temperature, oil }),
      record?.without && Words.say('map_without', { count: record.without })].filter(Boolean).join(' ');
    if (this.back) {
      this.back.disabled = !this.changed;
    }
    this.legend.replaceChildren(...(record ? MapLegend.entries(this.map) : []));
  }

  /** Ask the surface about a place of the map; a pinned one may be solved. */
  point(at) {
    this.solve.disabled = !(this.acting && this.map.over.pinned);
    this.askPoint({ do: 'read', ...this.place(at) });
  }

  /** Return a place of the map as requests name it: speed without sign, opposing load. */
  place({ speed, load }) {
    return {
      axis: this.axis.facts.id, speed_rpm: speed, load_N: load,
      temperature_degC: this.temperature ?? this.map.record.temperature_degC,
    };
  }

  told(answer) {
    this.map.say(answer.ok ? this.sentence(answer) : answer.message);
  }

  /** Say what a point is like. */
  sentence(answer) {
    const { facts } = this.axis;
    const text = (name, value) => Quantities.text(name, value, facts);
    return Words.say('point_is', {
      feed: text('speed_rpm', answer.speed_rpm), turns: text('turns_rpm', answer.speed_rpm),
      load: text('load_N', answer.load_N), temperature: text('temperature_degC', answer.temperature_degC),
      zone: Words.say(`zone_${answer.zone ?? 'unknown'}`), efficiency: text('efficiency', answer.efficiency),
      rcs: text('rcs', answer.rcs), film: text('film_ratio', answer.film_ratio),
      torque: text('torque_N_m', answer.torque_N_m),
    }) + (answer.words ? ` ${answer.words}` : '');
  }

  result(...texts) {
    this.results.replaceChildren(...texts.map((text) => Format.element('p', '', text)));
  }

  /** Ask for a full solve of the pinned place, and say how far it is. */
  async solved() {
    const tell = ({ share, words }) => this.result(Words.say('solve_runs', {
      share: Quantities.text('share', share, this.axis.facts), words: words ?? '',
    }));
    const answer = this.live.ask({ do: 'solve', ...this.place(this.map.over.pinned) }, tell);
    [this.solving, this.stop.hidden, this.solve.disabled] = [answer.id, false, true];
    tell({ share: 0 });
    const found = await answer;
    [this.stop.hidden, this.solve.disabled] = [true, false];
    this.result(found.ok ? Words.say('solve_done', { point: this.sentence(found) }) : found.message);
  }

  /** Ask what the programme of the last minutes would be at other feeds. */
  async haunt() {
    const answer = await this.live.ask({ do: 'ghosts', axis: this.axis.facts.id, factors: FEEDS });
    if (!answer.ok) {
      this.result(answer.message);
      return;
    }
    const text = (name, value) => Quantities.text(name, value, this.axis.facts);
    this.result(...answer.ghosts.map((ghost) => `${Words.say('ghost_is', {
      feed: text('share', ghost.factor), outside: text('share', ghost.outside_share),
      lost: text('energy', ghost.lost_J), time: Format.time(ghost.duration_s),
    })} ${ghost.words}`.trim()));
    this.map.over.ghosts = answer.ghosts.map((ghost) => ({
      points: answer.arrays[ghost.array], label: text('share', ghost.factor),
    }));
    this.map.over.draw();
  }
}
