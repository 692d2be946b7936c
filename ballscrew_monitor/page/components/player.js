// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The player of a recording: run, stand still, faster or slower, another moment.

'use strict';

const RATES = [0.1, 0.5, 1, 2, 5, 10, 50];

class Player {
  /** Build the bar, which shows itself with the first time of a recording. */
  constructor(live) {
    this.live = live;
    this.element = Format.element('section', 'player');
    this.element.setAttribute('aria-label', Words.say('player_title'));
    this.element.hidden = true;
    this.button = Controls.button('player_play', () => live.ask({ do: this.clock.playing ? 'pause' : 'play' }));
    this.place = Object.assign(Format.element('input'), { type: 'range', min: 0, step: 0.1 });
    this.place.setAttribute('aria-label', Words.say('player_place'));
    const seek = live.newest(() => {});
    this.place.addEventListener('input', () => seek({ do: 'seek', s: Number(this.place.value) }));
    const rates = RATES.map((rate) => [String(rate), `${Format.number(rate)} ×`]);
    const rate = Controls.select('player_rate', rates, (x) => live.ask({ do: 'rate', x: Number(x) }));
    this.rate = rate.querySelector('select');
    this.time = Format.element('span', 'time');
    this.element.append(this.button, this.place, this.time, rate);
  }

  /** Show a time of the recording. */
  take(clock) {
    this.clock = clock;
    this.element.hidden = false;
    this.button.textContent = Words.say(clock.playing ? 'player_pause' : 'player_play');
    this.place.max = clock.span_s;
    if (document.activeElement !== this.place) {
      this.place.value = clock.at_s;
    }
    if (document.activeElement !== this.rate) {
      this.rate.value = String(clock.rate);
    }
    this.time.textContent = `${Format.time(clock.at_s)} / ${Format.time(clock.span_s)}`;
  }
}
