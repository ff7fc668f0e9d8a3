// Where the error of the method that is chosen comes from, as bars.

import { attribute } from './api.js';
import { bars, lengthOf } from './bars.js';
import { h } from './dom.js';
import { words } from './editors.js';
import { percent } from './figures.js';
import { settingsInWords } from './methods.js';
import { workedBlock } from './worked.js';

const PLAIN = { quadrature: 'Too few nodes and samples', tables: 'Coarse tables', orders: 'Orders of scattering left out',
                model: 'The model', wavelengths: 'Few wavelengths', walks: 'Noise' };

export const attributeBlock = (state, view, methods) => workedBlock(state, view, 'attribute-block', {
  title: 'Causes of the error',
  help: 'The method and settings that render this sky, against random walks, one cause at a time.',
  action: 'Take apart',
  waiting: 'Computing what the method is measured against, and it again with more of everything…',
  label: 'Of the attribution',
}, (scene) => view.asShown(scene), attribute, (found) => draw(found, methods));

function draw({ method, options, error, error_95: [low, high], shares }, methods) {
  const title = methods.find(({ name }) => name === method)?.title ?? words(method);
  const settings = settingsInWords(methods, method, options);
  const rows = [...shares].sort((a, b) => b.error - a.error).map(({ cause, error: share, how }) => ({
    name: PLAIN[cause] ?? words(cause), share: lengthOf(share), text: percent(share), title: how }));
  return h('div', {},
    h('p', { className: 'total' }, `${[title, settings].filter(Boolean).join(', ')}: error ${percent(error)} ` +
      `(${percent(low)} to ${percent(high)}).`),
    bars('Error by cause', rows),
    h('p', { className: 'help' }, 'Bars are logarithmic, from 0.01 % to 100 %. They need not add up: errors may cancel.'));
}
