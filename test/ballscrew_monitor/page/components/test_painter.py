# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Views are drawn when they have news, not oftener than they ask for, and one after a failure."""


def test_news_is_drawn_once_and_a_failure_stops_no_other(tab, greeted):
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    tab.ask("""
      globalThis.failed = [];
      globalThis.drawn = [0, 0];
      globalThis.painter = new Painter((what) => failed.push(String(what)));
      globalThis.broken = painter.add(() => { drawn[0] += 1; throw new Error('no'); }, 0);
      globalThis.sound = painter.add(() => { drawn[1] += 1; }, 1e9);
      0
    """)
    tab.until('drawn[0] === 1 && drawn[1] === 1')
    tab.ask('broken(); sound(); sound(); 0')
    # The sound view is not due again for long, so that the frame after the next has no other.
    tab.until('drawn[0] === 2')
    assert tab.ask('[drawn, failed.length, failed[0].includes("no")]') == [[2, 1], 2, True]
    tab.ask('painter.clear(); 0')


def test_what_a_frame_has_no_time_for_is_drawn_in_the_next(tab, greeted):
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    tab.ask("""
      globalThis.at = [];
      globalThis.painter = new Painter(() => {});
      globalThis.clock = 0;
      performance.now = () => globalThis.clock;
      for (const number of [0, 1]) {
        painter.add(() => {
          globalThis.clock += 5;
          at.push([number, document.timeline.currentTime]);
        }, 1e9);
      }
      0
    """)
    tab.until('at.length === 2')
    assert tab.ask('[at[0][0], at[1][0], at[1][1] > at[0][1]]') == [0, 1, True]
