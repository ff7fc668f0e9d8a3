// What each ingredient of the sky is worth: the error of leaving it out, as bars.

import { explain, inWords } from './api.js';
import { bars } from './bars.js';
import { h } from './dom.js';
import { words } from './editors.js';
import { percent } from './figures.js';
import { format } from './numbers.js';
import { Task } from './task.js';

const WIDTH = 160;
const ERROR = 0.03;   // of the frames that are compared, where the method is the daemon's to choose
const LEAST = 1e-4;  // a bar's length is the logarithm from here to 1

const PLAIN = { multiple_scattering: 'Light scattered more than once', ground: 'The ground’s light',
                curvature: 'The planet’s curvature' };

function plainName(name) {
  const order = name.match(/^order_(\d+)$/);
  const wavelength = name.match(/^wavelength_(\d+)$/);
  if (order) return `Order ${order[1]} of scattering`;
  if (wavelength) return `Wavelength ${wavelength[1]}`;
  return PLAIN[name] ?? words(name.replace(/^constituent\./, ''));
}

/** The block with its button. */
export function explainBlock(state, view) {
  const task = new Task();
  const place = h('div', { className: 'result', 'aria-live': 'polite' });
  const put = (element) => {
    place.classList.remove('stale');
    place.replaceChildren(element);
  };
  const say = (text) => put(h('p', { className: 'help' }, text));
  const button = h('button', { type: 'button', className: 'chip' }, 'Explain');
  const idle = () => { button.textContent = 'Explain'; };
  button.addEventListener('click', async () => {
    if (task.running) {
      task.stop();
      say('Stopped.');
      return idle();
    }
    button.textContent = 'Stop';
    const done = h('progress', { max: 1, 'aria-label': 'Of the explanation' });
    put(h('div', {}, h('p', { className: 'help' }, 'Leaving out one thing after the other…'), done));
    const { width, height } = view.fullSize();
    const { method, ...scene } = state.document();
    const { channels, layers, ...image } = scene.image ?? {};
    const small = { ...image, width: WIDTH, height: Math.max(2, Math.round((WIDTH * height) / width)) };
    try {
      const asked = { ...scene, image: small, method: { max_error: ERROR, ...method } };
      const worth = await task.run((signal) => explain(asked, (share) => { done.value = share; }, signal),
                                   (error) => say(inWords(error)));
      if (worth) put(draw(worth));
    } catch (error) {
      say(inWords(error));
    }
    idle();
  });
  state.addEventListener('change', () => {
    if (!task.running && place.firstElementChild) place.classList.add('stale');
  });
  return h('section', { className: 'block', id: 'explain-block' },
    h('div', { className: 'row' }, h('h2', {}, 'What each part is worth'), button),
    h('p', { className: 'help' }, 'How wrong this picture would be without it.'), place);
}

const short = (value) => format(Number(value.toPrecision(2)));

function draw(worth) {
  const rows = Object.entries(worth).sort(([, a], [, b]) => b.error - a.error)
    .map(([name, { error, ciede2000, ms_saved: saved }]) => ({
      name: plainName(name),
      share: Math.log(Math.max(error, LEAST) / LEAST) / Math.log(1 / LEAST),
      text: percent(error),
      title: `${ciede2000 === null ? '' : `Colour difference ΔE₀₀ ${short(ciede2000)}; `}` +
        `device time saved ${short(saved)} ms`,
    }));
  return h('div', {}, bars('Error of leaving out', rows),
           h('p', { className: 'help' }, 'Bars are logarithmic, from 0.01 % to 100 %.'));
}
