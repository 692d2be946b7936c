// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// What the page says, in the language of its table.

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

  /** Return an element with a text by its key. */
  function element(tag, kind, key, values = {}) {
    return Format.element(tag, kind, say(key, values));
  }

  return { use, say, named, element };
})();
