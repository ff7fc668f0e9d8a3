// A block whose button has the daemon work something out about the sky that is seen: how far it is, then
// what it found.

import { inWords } from './api.js';
import { h } from './dom.js';
import { Task } from './task.js';

const WIDTH = 160;

/**
 * The block with its button.
 * @param words  { title, help, action: on the button, waiting: while it works, label: of the progress }
 * @param ask  (scene, onProgress, signal) => what was found; the scene's picture is small
 * @param draw  what was found => element
 */
export function workedBlock(state, view, id, words, ask, draw) {
  const task = new Task();
  const place = h('div', { className: 'result', 'aria-live': 'polite' });
  const put = (element) => {
    place.classList.remove('stale');
    place.replaceChildren(element);
  };
  const say = (text) => put(h('p', { className: 'help' }, text));
  const button = h('button', { type: 'button', className: 'chip' }, words.action);
  const idle = () => { button.textContent = words.action; };
  button.addEventListener('click', async () => {
    if (task.running) {
      task.stop();
      say('Stopped.');
      return idle();
    }
    button.textContent = 'Stop';
    const done = h('progress', { max: 1, 'aria-label': words.label });
    put(h('div', {}, h('p', { className: 'help' }, words.waiting), done));
    const { width, height } = view.fullSize();
    const scene = state.document();
    const { channels, layers, ...image } = scene.image ?? {};
    const small = { ...image, width: WIDTH, height: Math.max(2, Math.round((WIDTH * height) / width)) };
    try {
      const found = await task.run((signal) => ask({ ...scene, image: small }, (share) => { done.value = share; }, signal),
                                   (error) => say(inWords(error)));
      if (found) put(draw(found));
    } catch (error) {
      say(inWords(error));
    }
    idle();
  });
  state.addEventListener('change', () => {
    if (!task.running && place.firstElementChild) place.classList.add('stale');
  });
  return h('section', { className: 'block', id },
    h('div', { className: 'row' }, h('h2', {}, words.title), button),
    h('p', { className: 'help' }, words.help), place);
}
