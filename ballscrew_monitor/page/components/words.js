// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// What the page says, in the language of its table: by a key, or by a phrase of a frame.

'use strict';

const Words = (() => {
  let table = {};

  /** Speak by a table from now on; its key `decimal_mark` is how numbers are written. */
  function use(words, language) {
    table = words;
    document.documentElement.lang = language;
    Format.decimalMark(words.decimal_mark);
  }

  /** Return the text of a key, each {name} replaced by its value; the key where there is none. */
  function say(key, values = {}) {
    const text = table[key] ?? key;
    return text.replace(/\{(\w+)\}/g, (whole, name) => String(values[name] ?? whole));
  }

  /** Return the word for a name that a server sends, the name itself where there is none. */
  function named(group, name) {
    return table[`${group}_${String(name).replace(/\W/g, '_')}`] ?? String(name);
  }

  /** Return what a frame says as texts and elements; a free sentence is English. */
  function told(said, facts) {
    if (typeof said === 'string' || 'free' in said) {
      return said ? [free(said.free ?? said)] : [];
    }
    return say(said.key).split(/\{(\w+)\}/)
      .flatMap((piece, i) => (i % 2 ? part(piece, said.values ?? {}, facts) : piece));
  }

  /** Return a sentence that comes in English alone. */
  function free(sentence, kind = '') {
    return Object.assign(Format.element('span', kind, sentence), { lang: 'en' });
  }

  /** Return a value of a phrase by its name; what a surface spans is among the facts. */
  function part(name, values, facts) {
    const value = values[name] ?? Quantities.ends(facts)[name];
    if (Array.isArray(value)) {
      return value.flatMap((one, i) => [...(i ? [', '] : []), ...told(one, facts)]);
    }
    if (typeof value !== 'object') {
      return String(value);
    }
    return 'key' in value || 'free' in value ? told(value, facts) : Quantities.value(value, facts);
  }

  /** Let an element say a phrase of a frame, and leave it alone where it says so already. */
  function tell(element, said, facts) {
    const nodes = told(said, facts);
    if (element.textContent !== nodes.map((one) => one.textContent ?? one).join('')) {
      element.replaceChildren(...nodes);
    }
  }

  /** Return a paragraph with a phrase of a frame. */
  function line(kind, said, facts) {
    const made = Format.element('p', kind);
    tell(made, said, facts);
    return made;
  }

  /** Return an element with a text by its key. */
  function element(tag, kind, key, values = {}) {
    return Format.element(tag, kind, say(key, values));
  }

  return { use, say, free, told, tell, line, named, element };
})();
