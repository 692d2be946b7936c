// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Views drawn when they have something new, a few milliseconds of them in a frame of the screen.

'use strict';

const BUDGET = 4; // time [ms] in a frame after which no further view is begun

class Painter {
  /** Begin without views; `fail` hears what goes wrong in one. */
  constructor(fail) {
    this.fail = fail;
    this.views = [];
  }

  /** Add a view, drawn at most every so many milliseconds; return what says that it has news. */
  add(draw, every) {
    const view = { draw, every, due: 0, news: true };
    this.views.push(view);
    this.ask();
    return () => {
      view.news = true;
      this.ask();
    };
  }

  /** Forget all views. */
  clear() {
    this.views = [];
  }

  ask() {
    this.asked ??= requestAnimationFrame((now) => this.paint(now));
  }

  /** Draw the views that are due, the one that waits the longest first. */
  paint(now) {
    this.asked = undefined;
    const due = this.views.filter((view) => view.news && view.due <= now);
    due.sort((one, other) => one.due - other.due);
    const begin = performance.now();
    for (const view of due) {
      if (performance.now() - begin < BUDGET) {
        [view.news, view.due] = [false, now + view.every];
        this.draw(view);
      }
    }
    if (this.views.some((view) => view.news)) {
      this.ask();
    }
  }

  draw(view) {
    try {
      view.draw();
    } catch (error) {
      this.fail(error.stack ?? error);
    }
  }
}
