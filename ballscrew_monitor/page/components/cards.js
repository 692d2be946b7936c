// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Axes as cards, where there are several: one is chosen.

'use strict';

class Cards {
  /** Build a card for each axis; `choose` is called with the id of the one that is pressed. */
  constructor(axes, choose) {
    this.axes = axes;
    this.element = Format.element('nav', 'cards');
    this.element.setAttribute('aria-label', Words.say('axes'));
    this.element.hidden = axes.length < 2;
    this.cards = axes.map((axis) => {
      const card = Format.element('button', 'card');
      card.type = 'button';
      card.append(...['glyph', 'name', 'word', 'speed'].map((kind) => Format.element('span', kind)));
      card.children[0].setAttribute('aria-hidden', 'true');
      card.addEventListener('click', () => choose(axis.facts.id));
      return card;
    });
    this.element.append(...this.cards);
  }

  draw(chosen) {
    this.axes.forEach((axis, i) => {
      const card = this.cards[i];
      card.dataset.state = axis.level;
      card.setAttribute('aria-pressed', String(axis.facts.id === chosen));
      const speed = Quantities.text('speed_rpm', axis.rows.last('speed_rpm'), axis.facts);
      const texts = [SIGNS[axis.level], axis.facts.axis, Words.say(`level_${axis.level}`), speed];
      texts.forEach((text, at) => { card.children[at].textContent = text; });
    });
  }
}
