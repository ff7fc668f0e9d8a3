// The sky first: asks for its picture with as few modules as that takes, then for all around it.
//
//   the scene       state paths link
//   the daemon      api multipart retry task
//   the picture     view camera projection; over it wipe and overlay
//   all around it   page, which puts together; shortcuts
//     Skies         presets
//     Adjust        panel schema controls editors spectrum numbers methods limits; constituents curves
//                   together; day day_clock day_strip
//     Compare       compare figures chart attribute explain worked bars own exr
//     Probe, Save   probe, save
//   drawing         dom plot polar segmented stale; what is drawn is computed by the daemon

import { inWords } from './api.js';
import { Camera } from './camera.js';
import { bindAddress, readLink } from './link.js';
import { fromPointer } from './paths.js';
import { State } from './state.js';
import { View } from './view.js';

const picture = document.getElementById('picture');
const status = document.getElementById('status');

const state = new State(readLink(location.hash));
const view = new View(picture, () => state.document());
const camera = new Camera(picture, state);
let page;  // once it is there

function say(text, kind = 'note') {
  status.textContent = text;
  status.dataset.kind = kind;
}

function sayRefused(error) {
  const beside = error.pointer && page?.controls?.complain(fromPointer(error.pointer), error.message);
  say(beside ? 'The daemon refuses this scene; the last good picture is still shown.'
             : error.message, 'refused');
}

view.addEventListener('waiting', ({ detail }) => say(inWords(detail), 'waiting'));
view.addEventListener('refused', ({ detail }) => sayRefused(detail));
view.addEventListener('frame', () => {
  if (status.textContent && status.dataset.kind !== 'lost') say('');
  page?.controls?.forgive();
});
state.addEventListener('change', () => view.change());
bindAddress(state);

// What is around the picture must not take its time from it, nor wait for one that is long in coming.
const LONGEST_WAIT_MS = 500;
const begun = new Promise((resolve) => {
  for (const event of ['frame', 'waiting', 'refused']) view.addEventListener(event, resolve, { once: true });
  setTimeout(resolve, LONGEST_WAIT_MS);
});

begun.then(() => import('./page.js')).then(({ Page }) => {
  page = new Page({ state, view, camera, say });
  return page.furnish();
}, () => say('The daemon went away before all of this page was there; reload it.', 'lost'))
  .catch((error) => say(inWords(error), 'refused'));
