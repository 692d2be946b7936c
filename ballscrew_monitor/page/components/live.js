// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// The connection to the server: frames in, requests out, and again when it was lost.

'use strict';

const FIRST_PAUSE = 500; // time [ms] to the first try after the connection was lost
const LONGEST_PAUSE = 8000; // time [ms] between tries in the long run
const BETWEEN_REQUESTS = 100; // least time [ms] between requests that follow a pointer

class Live {
  /** Connect to `address`; `hear` gets each frame, `lost` is called when the connection ends. */
  constructor(address, hear, lost) {
    Object.assign(this, { address, hear, lost });
    this.tries = 0;
    this.number = 0;
    this.waiting = new Map();
    this.connect();
  }

  connect() {
    this.socket = new WebSocket(this.address);
    this.socket.binaryType = 'arraybuffer';
    this.socket.addEventListener('message', (event) => this.take(Live.decode(event.data)));
    this.socket.addEventListener('close', () => this.closed());
  }

  /** Return a frame: its JSON, in which the arrays stand by their names. */
  static decode(buffer) {
    const size = new DataView(buffer).getUint32(0, true);
    const frame = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
    const arrays = {};
    let at = 4 + size;
    for (const [name, count] of frame.arrays ?? []) {
      arrays[name] = new Float64Array(buffer, at, count);
      at += 8 * count;
    }
    return { ...frame, arrays };
  }

  take(frame) {
    if (frame.kind === 'hello') {
      this.tries = 0;
    }
    const asked = this.waiting.get(frame.id);
    if (!asked) {
      this.hear(frame);
    } else if (frame.kind === 'progress') {
      asked.progress(frame);
    } else {
      this.waiting.delete(frame.id);
      asked.resolve(frame);
    }
  }

  closed() {
    this.waiting.forEach((asked) => asked.resolve(this.refusal()));
    this.waiting.clear();
    this.lost();
    setTimeout(() => this.connect(), Live.pause(this.tries));
    this.tries += 1;
  }

  /** Return how long to wait [ms] before another try: each time twice as long, up to a limit. */
  static pause(tries) {
    return Math.min(LONGEST_PAUSE, FIRST_PAUSE * 2 ** tries);
  }

  refusal() {
    return { ok: false, message: { key: 'link_needed' }, arrays: {} };
  }

  /** Send a request and return its answer to come, under `id` of the promise. */
  ask(request, progress = () => {}) {
    this.number += 1;
    const id = this.number;
    const answer = new Promise((resolve) => {
      if (this.socket.readyState === WebSocket.OPEN) {
        this.waiting.set(id, { resolve, progress });
        this.socket.send(JSON.stringify({ id, ...request }));
      } else {
        resolve(this.refusal());
      }
    });
    return Object.assign(answer, { id });
  }

  /** Return a function that asks for the newest of what it is given, one request at a time. */
  newest(heard) {
    let [busy, next] = [false, null];
    const ask = async (request) => {
      if (busy) {
        next = request;
        return;
      }
      busy = true;
      heard(await this.ask(request), request);
      await new Promise((resolve) => { setTimeout(resolve, BETWEEN_REQUESTS); });
      busy = false;
      if (next) {
        [request, next] = [next, null];
        ask(request);
      }
    };
    return ask;
  }
}
