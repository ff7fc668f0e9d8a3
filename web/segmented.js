// A choice of a few, all of them seen.

import { h } from './dom.js';

/** { element, value, choose(value) }; `choices`: [[value, title], ...]. */
export function segmented(label, choices, onChange = () => {}) {
  const buttons = choices.map(([value, title]) => h('button', {
    type: 'button', 'data-value': value, onclick: () => control.choose(value) }, title));
  const control = {
    element: h('div', { className: 'segmented', role: 'group', 'aria-label': label }, buttons),
    value: undefined,
    choose(value) {
      mark(value);
      onChange(value);
    },
  };
  const mark = (value) => {
    control.value = value;
    for (const button of buttons) {
      button.setAttribute('aria-pressed', String(button.dataset.value === value));
    }
  };
  mark(choices[0][0]);
  return control;
}
