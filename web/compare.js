// The scene against another: one that was pinned, or the same by another method. A wipe or the error
// picture on the window, the figures beside it.

import { compare, compareAsPicture, inWords } from './api.js';
import { h, icon } from './dom.js';
import { words } from './editors.js';
import { figuresTable } from './figures.js';
import { segmented } from './segmented.js';
import { Task } from './task.js';
import { View } from './view.js';
import { Wipe } from './wipe.js';

const FIGURES_WIDTH = 384;
const LOOK_MS = 250;

/** Event: `chosen` when there is something to compare with. */
export class Compare extends EventTarget {
  #pinned;
  #settling;
  #exposure;
  #asked = new Task();
  #pictured = new Task();

  constructor({ state, view, overlay, methods, handle, otherCanvas }) {
    super();
    Object.assign(this, { state, view, overlay });
    this.other = new View(otherCanvas, () => this.#otherScene());
    this.other.hold();
    this.wipe = new Wipe(handle, otherCanvas);
    this.against = h('select', { id: 'against', onchange: () => this.#choose() },
      h('option', { value: '' }, 'Nothing'),
      h('option', { value: 'pinned', disabled: true }, 'The pinned sky'),
      methods.map(({ name }) => h('option', { value: name }, `By ${words(name)}`)));
    this.pin = h('button', { type: 'button', className: 'chip with-icon', onclick: () => this.#pin() },
                 icon('pin'), 'Pin this sky');
    this.modes = segmented('Shown as', [['wipe', 'Wipe'], ['error', 'Error picture']],
                           () => this.#refresh());
    this.place = h('div', { className: 'result', 'aria-live': 'polite' });
    this.element = h('section', { className: 'block', id: 'against-block' },
      h('div', { className: 'row' }, h('h2', {}, 'Side by side'), this.pin),
      h('p', { className: 'help' }, 'Pin a sky, change anything, and wipe between the two; or see this '
        + 'one by another method.'),
      h('div', { className: 'row' }, h('label', { for: 'against' }, 'Against'), this.against),
      this.modes.element, this.place);
    view.addEventListener('frame', () => this.#matchExposure());
    state.addEventListener('change', () => this.#changed());
    this.other.addEventListener('refused', ({ detail }) => this.#say(inWords(detail)));
    this.#refresh();
  }

  #pin() {
    this.#pinned = this.state.document();
    const option = this.against.querySelector('[value=pinned]');
    option.disabled = false;
    this.against.value = 'pinned';
    this.#choose();
  }

  /** Stops comparing. */
  end() {
    this.against.value = '';
    this.#choose();
  }

  #choose() {
    this.#asked.stop();
    this.#pictured.stop();
    clearTimeout(this.#settling);
    if (this.against.value) this.dispatchEvent(new Event('chosen'));
    this.#refresh();
  }

  // Both are seen by the same camera, with the same exposure: what differs is the light.
  #otherScene() {
    const scene = this.state.document();
    const { image } = scene;
    const chosen = this.against.value === 'pinned'
      ? { ...this.#pinned, camera: this.#cameraFor(this.#pinned), image }
      : { ...scene, method: { name: this.against.value, scattering_orders: scene.method?.scattering_orders } };
    if (this.#exposure === undefined) return chosen;
    return { ...chosen, image: { ...image, exposure_ev: this.#exposure } };
  }
  // Another preset has another camera of its own, so that it is told all of this one's.
  #cameraFor({ preset }) {
    const { preset: own, camera } = this.state.document();
    return preset === own ? camera : this.state.value('camera');
  }
  #matchExposure() {
    const exposure = Number(this.view.facts.exposure);
    if (exposure === this.#exposure || !Number.isFinite(exposure)) return;
    this.#exposure = exposure;
    if (this.#wiping) this.other.change();
  }

  #changed() {
    if (!this.against.value) return;
    this.#asked.stop();
    this.#pictured.stop();
    this.other.change();
    this.overlay.hide();
    this.#wait();
  }

  get #wiping() {
    return this.against.value !== '' && this.modes.value === 'wipe';
  }

  #refresh() {
    const on = this.against.value !== '';
    this.modes.element.hidden = !on;
    this.place.replaceChildren();
    this.overlay.hide();
    if (this.#wiping) {
      this.wipe.show('This sky', this.against.selectedOptions[0].textContent);
      this.other.release();
    } else {
      this.wipe.hide();
      this.other.hold();
    }
    if (on) this.#wait();
  }

  // Figures cost two frames: they are asked for when both pictures are there and the hand rests.
  #wait() {
    clearTimeout(this.#settling);
    this.#settling = setTimeout(() => {
      if (this.view.settled && (!this.#wiping || this.other.settled)) this.#measure();
      else this.#wait();
    }, LOOK_MS);
  }

  async #measure() {
    const { width, height } = this.#size();
    const sized = (scene) => {
      const { channels, layers, ...image } = scene.image ?? {};
      return { ...scene, image: { ...image, width, height, format: 'png' } };
    };
    const a = sized(this.view.asShown(this.state.document()));
    const b = sized(this.other.asShown(this.#otherScene()));
    this.#say('Measuring…');
    try {
      const onWait = (error) => this.#say(inWords(error));
      const figures = await this.#asked.run((signal) => compare(a, b, signal), onWait);
      if (!figures) return;
      this.place.replaceChildren(figuresTable(figures));
      if (this.modes.value !== 'error') return;
      const picture = await this.#pictured.run(
        async (signal) => createImageBitmap(await compareAsPicture(a, b, signal)), onWait);
      if (!picture || this.modes.value !== 'error' || !this.against.value) return;
      const scale = this.overlay.showErrors(
        picture, { width, height }, 'The error by pixel: blue too dark, red too bright');
      this.place.append(scale);
    } catch (error) {
      this.#say(inWords(error));
    }
  }
  #size() {
    const { width, height } = this.view.fullSize();
    const share = Math.min(1, FIGURES_WIDTH / width);
    return { width: Math.round(width * share), height: Math.max(2, Math.round(height * share)) };
  }
  #say(text) {
    this.place.replaceChildren(h('p', { className: 'help' }, text));
  }
}
