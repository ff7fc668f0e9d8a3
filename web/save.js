// Saving a scene: as a file of a chosen size, as a link, as JSON, curl or Python.

import { inWords, render } from './api.js';
import { copyText, h, saveFile } from './dom.js';
import { texts } from './link.js';
import { untilAnswered } from './retry.js';

// `image` is what the format asks of the scene's image; `camera`, where it is not the one on screen.
const SPHERE = { projection: 'equirectangular', pitch_deg: 0, roll_deg: 0, fov_deg: null };
const FORMATS = {
  png: { title: 'PNG, to look at', image: { format: 'png' } },
  jpeg: { title: 'JPEG, small', image: { format: 'jpeg' } },
  exr: { title: 'OpenEXR, linear light', image: { format: 'exr' } },
  hdr: { title: 'Radiance HDR', image: { format: 'hdr' } },
  npy: { title: 'NumPy array', image: { format: 'npy' } },
  sphere_hdr: { title: 'Environment map, HDR', image: { format: 'hdr' }, camera: SPHERE },
  sphere_exr: { title: 'Environment map, EXR', image: { format: 'exr' }, camera: SPHERE },
};
const LAYERS = [['inscatter', 'Light of the air'], ['ground', 'Ground'], ['sun', 'Sun and stars'],
                ['transmittance', 'Transmittance']];
const EXTENSIONS = { jpeg: 'jpg' };
const WIDTHS = [1280, 1920, 3840];

/** The page of the last tab. `view` knows the window's size and shape. */
export function savePage(state, view) {
  return [downloads(state, view), ...Object.keys(texts).map((kind) => snippet(kind, state))];
}

function downloads(state, view) {
  const format = h('select', { id: 'format' },
                   Object.entries(FORMATS).map(([value, { title }]) => h('option', { value }, title)));
  const boxes = LAYERS.map(([name, title]) => [name, h('input', { type: 'checkbox' }), title]);
  const spectral = h('input', { type: 'checkbox' });
  const layers = h('div', { className: 'checklist', role: 'group', 'aria-label': 'Layers apart' },
    boxes.map(([, box, title]) => h('label', {}, box, title)),
    h('label', { title: 'One channel a wavelength, in radiance units' }, spectral, 'Every wavelength'));
  const chosen = () => FORMATS[format.value];
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
  const isSphere = () => (chosen().camera ?? state.value('camera'))?.projection === 'equirectangular';
  // A whole sphere is twice as wide as high.
  const columns = () => (isSphere() ? 2 * Math.ceil(pixels(width) / 2) : pixels(width));
  const size = () => ({ width: columns(), height: pixels(height) });
  const shape = () => (chosen().camera ? 2 : view.shape());
  // The height follows the window's shape until somebody types one; panoramas have their own.
  const showHeight = () => {
    height.value = Math.max(1, Math.round(columns() / shape()));
  };
  const showFormat = () => {
    const hadOwnShape = height.disabled;
    height.disabled = view.hasOwnShape() || chosen().camera !== undefined;
    if (isSphere()) width.value = columns();
    if (height.disabled || hadOwnShape) showHeight();
    layers.hidden = chosen().image.format !== 'exr';
  };
  // What of an EXR's layers and channels is asked for.
  const parts = () => {
    if (layers.hidden) return {};
    const apart = boxes.filter(([, box]) => box.checked).map(([name]) => name);
    return { ...(apart.length ? { layers: apart } : {}), ...(spectral.checked ? { channels: 'spectral' } : {}) };
  };
  const button = h('button', { type: 'submit', className: 'primary' }, 'Download');
  const save = async (event) => {
    event.preventDefault();
    button.disabled = true;
    say.textContent = 'Rendering…';
    try {
      const { image, camera } = chosen();
      await download(state, { ...size(), ...image, ...parts() }, camera, (error) => {
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
  width.addEventListener('change', showFormat);
  format.addEventListener('change', showFormat);
  state.addEventListener('change', showFormat);
  showHeight();
  showFormat();
  return h('form', { className: 'download', onsubmit: save },
    h('h2', {}, 'Picture'),
    h('div', { className: 'row' }, h('label', { for: 'format' }, 'As'), format), layers,
    h('div', { className: 'row' }, h('label', { for: 'width' }, 'Width'),
      width),
    h('div', { className: 'row' }, h('label', { for: 'height' }, 'Height'), height),
    sizes, button, say);
}

async function download(state, image, camera, onWait) {
  const scene = state.document();
  const { channels, layers, ...look } = scene.image ?? {};
  const asked = { ...scene, image: { ...look, ...image } };
  if (camera) asked.camera = { ...scene.camera, ...camera };
  const { blob } = await untilAnswered(() => render(asked), onWait);
  saveFile(blob, `${scene.preset}.${EXTENSIONS[image.format] ?? image.format}`);
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
