// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// One file to send when something fails, made by the server and saved by the browser.

'use strict';

class Fault {
  constructor() {
    this.element = Format.element('section', 'fault-report');
    this.button = Controls.button('fault_make', () => this.make());
    this.message = Words.element('p', 'muted', 'fault_hint');
    this.message.setAttribute('role', 'status');
    this.element.append(this.button, this.message);
  }

  say(key, values) {
    this.message.textContent = Words.say(key, values);
  }

  async make() {
    this.button.disabled = true;
    this.say('fault_runs');
    try {
      const answer = await fetch('/report-fault', { method: 'POST' });
      if (answer.ok) {
        this.save(await answer.blob());
      } else {
        this.say('fault_refused', { why: await answer.text() });
      }
    } catch {
      this.say('link_needed');
    }
    this.button.disabled = false;
  }

  save(content) {
    const link = Object.assign(Format.element('a'), {
      href: URL.createObjectURL(content), download: 'ballscrew_fault.zip',
    });
    link.click();
    URL.revokeObjectURL(link.href);
    this.say('fault_made', { size: Format.number(content.size / 1000, 3) });
  }
}
