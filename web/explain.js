// What each ingredient of the sky is worth: the error of leaving it out, as bars.

import { explain } from './api.js';
import { bars, lengthOf } from './bars.js';
import { h } from './dom.js';
import { words } from './editors.js';
import { percent } from './figures.js';
import { format } from './numbers.js';
import { workedBlock } from './worked.js';

const ERROR = 0.03;   // of the frames that are compared, where the method is the daemon's to choose

const PLAIN = { multiple_scattering: 'Light scattered more than once', ground: 'The ground’s light',
                curvature: 'The planet’s curvature' };

function plainName(name) {
  const order = name.match(/^order_(\d+)$/);
  const wavelength = name.match(/^wavelength_(\d+)$/);
  if (order) return `Order ${order[1]} of scattering`;
  if (wavelength) return `Wavelength ${wavelength[1]}`;
  return PLAIN[name] ?? words(name.replace(/^constituent\./, ''));
}

export const explainBlock = (state, view) => workedBlock(state, view, 'explain-block', {
  title: 'What each part is worth',
  help: 'How wrong this picture would be without it.',
  action: 'Explain',
  waiting: 'Leaving out one thing after the other…',
  label: 'Of the explanation',
}, (scene) => ({ ...scene, method: { max_error: ERROR, ...scene.method } }), explain, draw);

const short = (value) => format(Number(value.toPrecision(2)));

function draw(worth) {
  const rows = Object.entries(worth).sort(([, a], [, b]) => b.error - a.error)
    .map(([name, { error, ciede2000, ms_saved: saved }]) => ({
      name: plainName(name),
      share: lengthOf(error),
      text: percent(error),
      title: `${ciede2000 === null ? '' : `Colour difference ΔE₀₀ ${short(ciede2000)}; `}` +
        `device time saved ${short(saved)} ms`,
    }));
  return h('div', {}, bars('Error of leaving out', rows),
           h('p', { className: 'help' }, 'Bars are logarithmic, from 0.01 % to 100 %.'));
}
