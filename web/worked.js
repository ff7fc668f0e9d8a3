// A block whose button has the daemon work something out about the sky that is seen: how far it is, then
// what it found.

import { inWords } from './api.js';
import { h } from './dom.js';
import { equal } from './paths.js';
import { markStale } from './stale.js';
import { Task } from './task.js';

const WIDTH = 160;

/**
 * The block with its button.
 * @param words  { title, help, action: on the button, waiting: while it works, label: of the progress }
 * @param asked  scene => the scene as the daemon is asked about it
 * @param ask  (scene, onProgress, signal) => what was found; the scene's picture is small
 * @param draw  what was found => element
 */
export function workedBlock(state, view, id, words, asked, ask, draw) {
  const task = new Task();
  let shown;  // the scene that what was found is about
  const place = h('div', { className: 'result', 'aria-live': 'polite' });
  const mark = () => markStale(place, shown !== undefined && !equal(shown, state.document()));
  const put = (element, scene) => {
    shown = scene;
    place.replaceChildren(element);
    mark();
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
    const waiting = h('div', {}, h('p', { className: 'help' }, words.waiting), done);
    put(waiting);
    const onProgress = (share) => {
      if (!waiting.isConnected) put(waiting);  // the daemon was busy, and is no longer
      done.value = share;
    };
    const { width, height } = view.fullSize();
    const scene = state.document();
    const { channels, layers, ...image } = scene.image ?? {};
    const small = { ...image, width: WIDTH, height: Math.max(2, Math.round((WIDTH * height) / width)) };
    const question = asked({ ...scene, image: small });
    try {
      const found = await task.run((signal) => ask(question, onProgress, signal), (error) => say(inWords(error)));
      if (!found) return;  // it was stopped, and the next may be under way
      put(draw(found), scene);
    } catch (error) {
      say(inWords(error));
    }
    idle();
  });
  state.addEventListener('change', mark);
  return h('section', { className: 'block', id },
    h('div', { className: 'row' }, h('h2', {}, words.title), button),
    h('p', { className: 'help' }, words.help), place);
}
