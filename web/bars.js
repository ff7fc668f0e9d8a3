// Bars: one line each, with a name, a length and words.

import { h } from './dom.js';

const LEAST = 1e-4;

/** A share for an error: its logarithm, from 0.01 % to 100 %. */
export const lengthOf = (error) => Math.log(Math.max(error, LEAST) / LEAST) / Math.log(1 / LEAST);

/** `rows`: [{ name, share (0 to 1), text, title }]. */
export function bars(label, rows) {
  return h('ul', { className: 'bars', 'aria-label': label }, rows.map(({ name, share, text, title }) => {
    const bar = h('span', { className: 'bar' });
    bar.style.setProperty('--share', String(Math.min(1, Math.max(0, share))));
    return h('li', { title: title ?? '' }, h('span', { className: 'bar-name' }, name), bar,
             h('span', { className: 'bar-text' }, text));
  }));
}
