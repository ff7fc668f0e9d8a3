// Taking a scene away: as a file of a chosen size, as a link, as JSON, curl or Python.

import { inWords, render } from './api.js';
import { copyText, h, saveFile } from './dom.js';
import { texts } from './link.js';
import { untilAnswered } from './retry.js';

const FORMATS = {
  png: 'PNG, to look at', jpeg: 'JPEG, small', exr: 'OpenEXR, linear light', hdr: 'Radiance HDR',
  npy: 'NumPy array',
};
const EXTENSIONS = { jpeg: 'jpg' };
const WIDTHS = [1280, 1920, 2560, 3840];

/** The page of the third tab. `view` knows the window's size and shape. */
export function takeAway(state, view) {
  return [downloads(state, view), ...Object.keys(texts).map((kind) => snippet(kind, state))];
}

function downloads(state, view) {
  const format = h('select', { id: 'format' },
                   Object.entries(FORMATS).map(([value, title]) => h('option', { value }, title)));
  const width = h('input', { type: 'number', id: 'width', min: 1, max: 16384, step: 1, value: 1920 });
  const height = h('input', { type: 'number', id: 'height', min: 1, max: 16384 * 6, step: 1 });
  const say = h('p', { className: 'help', role: 'status' });
  const sizes = h('div', { className: 'adders', role: 'group', 'aria-label': 'Usual widths' },
    [['Window', () => view.fullSize().width], ...WIDTHS.map((w) => [String(w), () => w])]
      .map(([title, pick]) => h('button', { type: 'button', className: 'chip', onclick: () => {
        width.value = pick();
        showHeight();
      } }, title)));
  const pixels = (field) => Math.max(1, Math.round(field.valueAsNumber || 1));
  const size = () => ({ width: pixels(width), height: pixels(height) });
  // The height follows the window's shape until somebody types one; panoramas have their own.
  const showHeight = () => {
    height.disabled = view.hasOwnShape();
    height.value = Math.max(1, Math.round(pixels(width) / view.shape()));
  };
  const button = h('button', { type: 'submit', className: 'primary' }, 'Download');
  const save = async (event) => {
    event.preventDefault();
    button.disabled = true;
    say.textContent = 'Rendering…';
    try {
      await download(state, { ...size(), format: format.value }, (error) => {
        say.textContent = inWords(error);
      });
      say.textContent = 'Saved.';
    } catch (error) {
      say.textContent = inWords(error);
    } finally {
      button.disabled = false;
    }
  };
  width.addEventListener('input', showHeight);
  state.addEventListener('change', () => { if (view.hasOwnShape() || height.disabled) showHeight(); });
  showHeight();
  return h('form', { className: 'download', onsubmit: save },
    h('h2', {}, 'Picture'),
    h('div', { className: 'row' }, h('label', { for: 'format' }, 'As'), format),
    h('div', { className: 'row' }, h('label', { for: 'width' }, 'Width'),
      width),
    h('div', { className: 'row' }, h('label', { for: 'height' }, 'Height'), height),
    sizes, button, say);
}

async function download(state, image, onWait) {
  const scene = state.document();
  const { channels, layers, ...look } = scene.image ?? {};
  const { blob } = await untilAnswered(
    () => render({ ...scene, image: { ...look, ...image } }), onWait);
  saveFile(blob, `${state.preset}.${EXTENSIONS[image.format] ?? image.format}`);
}

function snippet(kind, state) {
  const text = h('pre', { tabIndex: 0, 'aria-label': `The scene: ${kind}` });
  const button = h('button', { type: 'button', className: 'chip', 'aria-label': `Copy ${kind}`,
                               onclick: async () => {
    const copied = await copyText(text.textContent);
    button.textContent = copied ? 'Copied' : 'Select and copy';
    if (!copied) getSelection().selectAllChildren(text);
    setTimeout(() => { button.textContent = 'Copy'; }, 1500);
  } }, 'Copy');
  const refresh = () => { text.textContent = texts[kind](state); };
  state.addEventListener('settle', refresh);
  refresh();
  return h('section', { className: 'snippet' },
           h('div', { className: 'row' }, h('h2', {}, kind), button), text);
}
