// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The page: a connection, the axes that it tells of, and the views of the one that is chosen.

'use strict';

class LivePage {
  /** Begin in an element that holds the first words of the server. */
  constructor(element) {
    this.element = element;
    this.link = element.querySelector('.link');
    this.axes = new Map();
    this.failures = [];
    document.body.dataset.errors = '';
    window.addEventListener('error', (event) => this.fail(event.message));
    window.addEventListener('unhandledrejection', (event) => this.fail(event.reason));
    this.painter = new Painter((what) => this.fail(what));
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    this.live = new Live(`${scheme}://${location.host}/live`, (frame) => this.hear(frame), () => this.lost());
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.recolour());
    setInterval(() => this.news?.(), 1000);
  }

  fail(what) {
    this.failures = [...this.failures, String(what)].slice(-5);
    document.body.dataset.errors = this.failures.join(' | ');
  }

  hear(frame) {
    if (frame.kind === 'hello') {
      this.begin(frame);
    } else if (frame.kind === 'clock') {
      this.player?.take(frame);
      this.axes.forEach((axis) => { axis.recorded = true; });
    } else {
      this.tell(frame);
    }
  }

  /** Tell an axis, and its views if it is the one that is chosen, of a frame. */
  tell(frame) {
    const axis = this.axes.get(frame.axis);
    axis?.take(frame);
    this.news?.();
    if (axis && axis === this.axis) {
      this.reveal();
      if (frame.kind === 'map') {
        this.whatIf.take(frame);
      } else {
        this.whatIf.map.over.spend(frame.kind === 'state' ? frame.arrays : {});
      }
      this.views.forEach((news) => news());
      this.strips.news();
    }
  }

  /** Begin with a hello; where it says nothing new, all that is on the page stays as it is. */
  begin(hello) {
    this.since = undefined;
    Words.use(hello.words, hello.language);
    this.linked(...[hello.waiting, ...hello.notices].filter(Boolean));
    const told = JSON.stringify({ ...hello, nodes: [] });
    if (told !== this.told) {
      this.told = told;
      this.rebuild(hello);
    }
  }

  rebuild(hello) {
    this.acting = hello.acting;
    this.axes = new Map(hello.axes.map((facts) => [facts.id, new Axis(facts)]));
    document.title = Words.say('title');
    this.player = new Player(this.live);
    this.cards = new Cards([...this.axes.values()], (id) => this.choose(id));
    this.detail = Format.element('div', 'detail');
    const heading = Words.element('h1', 'unseen', 'title');
    this.element.replaceChildren(
      heading, this.link, this.cards.element, this.detail, new Fault().element, this.player.element,
    );
    this.choose(this.axes.has(this.axis?.facts.id) ? this.axis.facts.id : hello.axes[0]?.id);
  }

  /** Show the views of an axis. */
  choose(id) {
    this.strips?.remove();
    [this.strips, this.whatIf] = [undefined, undefined];
    this.painter.clear();
    this.news = this.painter.add(() => this.cards.draw(id), 500);
    this.axis = this.axes.get(id);
    this.detail.replaceChildren();
    if (this.axis) {
      this.build(this.axis);
    }
  }

  build(axis) {
    const first = new FirstScreen(axis);
    this.whatIf = new WhatIf(axis, this.live, this.acting);
    this.strips = new Strips(axis, this.painter);
    const events = new Events(axis, this.live, this.acting, (begin, end) => this.show(begin, end));
    const health = new Health(axis);
    this.detail.append(first.element, this.whatIf.element, this.strips.element, events.element, health.element);
    this.reveal();
    const cards = this.news;
    this.views = [
      this.painter.add(() => first.draw(), 200),
      this.painter.add(() => this.whatIf.map.over.draw(), 100),
      this.painter.add(() => events.draw(), 1000),
      this.painter.add(() => health.draw(), 1000),
    ];
    this.news = () => {
      cards();
      this.views[0]();
    };
    if (axis.map) {
      this.whatIf.take(axis.map);
    }
  }

  /** Show map and charts as soon as there is something to draw. */
  reveal() {
    const { rows, map } = this.axis;
    this.strips.element.hidden = !rows.count;
    this.whatIf.element.hidden = !rows.count && !map;
  }

  show(begin, end) {
    this.strips.show(begin, end);
    this.strips.element.scrollIntoView({ block: 'start' });
  }

  /** Say that the connection is lost, since when, and that nobody needs to do anything. */
  lost() {
    this.since ??= Date.now() / 1000;
    if (this.told) {
      this.linked({ key: 'link_lost', values: { since: Strips.clock(this.since) } });
    }
    this.news?.();
  }

  linked(...told) {
    this.link.replaceChildren(...told.flatMap((said, i) => [...(i ? [' '] : []), ...Words.told(said)]));
    this.link.hidden = !told.length;
  }

  recolour() {
    this.whatIf?.map.draw();
    this.strips?.recolour();
  }
}

const page = new LivePage(document.getElementById('page'));
