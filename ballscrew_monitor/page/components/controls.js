// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// Buttons, fields and lists with their labels.

'use strict';

const Controls = (() => {
  /** Return a button that does something when it is pressed. */
  function button(key, act, kind = '') {
    const made = Words.element('button', kind, key);
    made.type = 'button';
    made.addEventListener('click', act);
    return made;
  }

  /** Return a control below its label. */
  function labelled(key, control) {
    const label = Words.element('label', '', key);
    label.append(control);
    return label;
  }

  /** Return a field for a text of a length. */
  function field(maxLength) {
    return Object.assign(Format.element('input'), { type: 'text', maxLength });
  }

  /** Return a list of pairs, value and text, below its label; `change` gets the chosen value. */
  function select(key, options, change) {
    const made = Format.element('select');
    for (const [value, text] of options) {
      made.append(Object.assign(Format.element('option', '', text), { value }));
    }
    made.addEventListener('change', () => change(made.value));
    return labelled(key, made);
  }

  return { button, labelled, field, select };
})();
