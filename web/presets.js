// Presets as thumbnails, rendered by the daemon one at a time and only when somebody looks.

import { renderAddress } from './api.js';
import { h } from './dom.js';

const WIDTH = 160;
const HEIGHT = 90;
const RETRY_MS = 3000;

/** Buttons with pictures; `idle()` resolves when the frame on screen does not need the daemon. */
export function presetGallery(presets, state, idle) {
  const queue = thumbnailQueue(idle);
  const cards = presets.map((preset) => {
    const image = h('img', { loading: 'lazy', alt: '', width: WIDTH, height: HEIGHT, draggable: false });
    queue.add(image, renderAddress({ preset: preset.name, image: thumbnailSize(preset) }));
    return h('button', {
      type: 'button', className: 'preset', title: preset.source ?? '', 'data-preset': preset.name,
      onclick: () => state.load({ preset: preset.name, patch: {} }),
    }, h('span', { className: 'picture' }, image), h('span', { className: 'caption' },
                                                    preset.title ?? preset.name));
  });
  const mark = () => cards.forEach((card) =>
    card.setAttribute('aria-pressed', String(card.dataset.preset === state.preset)));
  state.addEventListener('change', mark);
  mark();
  return h('div', { className: 'gallery' }, cards);
}

function thumbnailSize(preset) {
  const projection = preset.scene?.camera?.projection;
  if (projection === 'equirectangular') return { width: WIDTH, height: WIDTH / 2 };
  if (projection === 'cubemap') return { width: 15, height: 90 };
  return { width: WIDTH, height: HEIGHT };
}

// Loads what is in sight, one after the other, behind the frame on screen.
function thumbnailQueue(idle) {
  const waiting = new Set();
  let running = false;
  const addresses = new WeakMap();
  const sight = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (isIntersecting) waiting.add(target);
      else waiting.delete(target);
    }
    if (!running) run();
  });
  async function run() {
    running = true;
    for (await idle(); waiting.size; await idle()) {
      const [image] = waiting;
      waiting.delete(image);
      sight.unobserve(image);
      if (!(await load(image, addresses.get(image)))) {
        setTimeout(() => sight.observe(image), RETRY_MS);
      }
    }
    running = false;
  }
  return {
    add(image, address) {
      addresses.set(image, address);
      sight.observe(image);
    },
  };
}

function load(image, address) {
  return new Promise((resolve) => {
    image.onload = () => {
      image.classList.add('there');
      resolve(true);
    };
    image.onerror = () => {
      image.removeAttribute('src');
      resolve(false);
    };
    image.src = address;
  });
}
