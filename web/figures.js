// How much two frames differ, in figures with their meaning.

import { h } from './dom.js';
import { format } from './numbers.js';

export const percent = (value, digits = 2) =>
  `${format(Number((100 * value).toPrecision(digits))).replace('-', '−')} %`;

const FIGURES = [
  ['error', 'Error', percent,
   'The larger of the root mean square of the relative difference and a third of its 99th percentile'],
  ['bias', 'Bias', percent, 'The mean difference: above 0 is brighter'],
  ['p99', '99 % within', percent, 'The difference that 99 of 100 values stay below'],
  ['max', 'Worst', percent, 'The largest difference of any value'],
  ['ciede2000_p99', 'Colour, ΔE₀₀', (value) => format(Number(value.toPrecision(2))),
   'CIEDE2000 as displayed, 99th percentile: 1 is just visible side by side'],
  ['banding', 'Banding', percent, 'Pixels beside contours that the other picture does not have'],
];

/** The answer of /v1/compare as a table. */
export function figuresTable(figures) {
  return h('dl', { className: 'figures' }, FIGURES.filter(([name]) => name in figures)
    .map(([name, title, text, help]) => h('div', { title: help, 'data-figure': name },
      h('dt', {}, title), h('dd', {}, text(figures[name]), interval(name, figures)))));
}

function interval(name, { error_95: interval95 }) {
  if (name !== 'error' || !interval95) return null;
  const [low, high] = interval95;
  return h('span', { className: 'quiet' }, ` (${percent(low)} to ${percent(high)})`);
}
