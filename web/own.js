// A picture of the person's own: an EXR, judged against the scene that is seen; with distances (Z),
// the scene's air laid over it.

import { composite, inWords, judge, judgeAsPicture } from './api.js';
import { h } from './dom.js';
import { readExrHead } from './exr.js';
import { figuresTable } from './figures.js';
import { segmented } from './segmented.js';
import { markStale } from './stale.js';
import { Task } from './task.js';

export class OwnPicture {
  #task = new Task();
  #reading = new Task();
  #file;  // { name, bytes, width, height, channels }

  constructor({ state, panel, overlay, compare, curtain }) {
    Object.assign(this, { state, panel, overlay, compare });
    this.input = h('input', { type: 'file', accept: '.exr,image/x-exr', id: 'own-file', className: 'unseen',
                              onchange: () => this.#take(this.input.files[0]) });
    this.modes = segmented('Shown as', [['figures', 'Figures'], ['error', 'Error picture'],
                                        ['air', 'Air over it']], () => this.#show());
    this.place = h('div', { className: 'result', 'aria-live': 'polite' });
    this.back = h('button', { type: 'button', className: 'chip', onclick: () => {
      this.#putAway();
      this.input.focus();
    } }, 'Back to the sky');
    this.element = h('section', { className: 'block', id: 'own-block' },
      h('div', { className: 'row' }, h('h2', {}, 'Your own picture'),
        h('label', { className: 'chip', for: 'own-file' }, 'Choose an EXR')),
      this.input,
      h('p', { className: 'help' }, 'Or drop one anywhere: linear R, G, B of this view are judged against '
        + 'the converged sky; with Z, km along each ray, the air is laid over it.'),
      this.modes.element, this.place, this.back);
    this.#putAway();
    this.#bindDrop(curtain);
    compare.addEventListener('chosen', () => { if (this.#file) this.#putAway(); });
    state.addEventListener('change', () => {
      this.#task.stop();
      if (!this.#file) return;
      markStale(this.place, true);
      if (this.modes.value !== 'figures') overlay.hide();
    });
    state.addEventListener('settle', () => {
      if (this.#file && this.place.classList.contains('stale')) this.#show();
    });
  }

  #bindDrop(curtain) {
    const carriesFile = (event) => event.dataTransfer?.types.includes('Files');
    document.addEventListener('dragover', (event) => {
      if (!carriesFile(event)) return;
      event.preventDefault();
      curtain.hidden = false;
    });
    document.addEventListener('dragleave', (event) => {
      if (!event.relatedTarget) curtain.hidden = true;
    });
    document.addEventListener('drop', (event) => {
      if (!carriesFile(event)) return;
      event.preventDefault();
      curtain.hidden = true;
      this.#take(event.dataTransfer.files[0]);
    });
  }

  async #take(file) {
    if (!file) return;
    this.input.value = '';
    this.panel.select('compare');
    this.element.scrollIntoView({ block: 'nearest' });
    this.#putAway();
    try {
      const bytes = await this.#reading.run(() => file.arrayBuffer());
      if (!bytes) return;
      const head = readExrHead(bytes);
      this.#file = { name: file.name, bytes, ...head };
    } catch (error) {
      return this.#say(error.message);
    }
    this.compare.end();
    const hasAir = this.#file.channels.includes('Z');
    this.modes.element.hidden = this.back.hidden = false;
    this.modes.element.querySelector('[data-value=air]').hidden = !hasAir;
    this.modes.choose(hasAir ? 'air' : 'figures');
  }

  // As large as the picture, which must be the frame's size.
  #scene() {
    const { image, ...scene } = this.state.document();
    const { channels, layers, ...look } = image ?? {};
    const { width, height } = this.#file;
    return { ...scene, image: { ...look, width, height, format: 'png' } };
  }

  async #show() {
    if (!this.#file) return;
    const { name, bytes, width, height } = this.#file;
    const mode = this.modes.value;
    this.overlay.hide();
    this.#say(mode === 'air' ? 'Laying the air over it…' : 'Judging it…');
    const scene = this.#scene();
    const onWait = (error) => this.#say(inWords(error));
    const title = h('p', { className: 'help' }, `${name}, ${width} × ${height}`);
    try {
      if (mode === 'figures') {
        const figures = await this.#task.run((signal) => judge(scene, bytes, signal), onWait);
        if (figures) this.#put(title, figuresTable(figures));
        return;
      }
      const ask = mode === 'air' ? composite : judgeAsPicture;
      const picture = await this.#task.run(
        async (signal) => createImageBitmap(await ask(scene, bytes, signal)), onWait);
      if (!picture) return;
      if (mode === 'air') {
        this.overlay.show(picture, 'Your picture with the air of this sky over it');
        this.#put(title);
      } else {
        const scale = this.overlay.showErrors(
          picture, { width, height }, 'The error of your picture: blue too dark, red too bright');
        this.#put(title, scale);
      }
    } catch (error) {
      this.#say(inWords(error));
    }
  }

  #putAway() {
    this.#task.stop();
    this.#file = undefined;
    this.overlay.hide();
    this.modes.element.hidden = this.back.hidden = true;
    this.#put();
  }
  #put(...elements) {
    this.place.replaceChildren(...elements);
    markStale(this.place, false);
  }
  #say(text) {
    this.#put(h('p', { className: 'help' }, text));
  }
}
