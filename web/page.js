// All that is around the picture: the panel with its tabs, the facts of the frame, the keys.

import { inWords, list, plan } from './api.js';
import { ChartBlock } from './chart.js';
import { Compare } from './compare.js';
import { Constituents } from './constituents.js';
import { Controls } from './controls.js';
import { Day } from './day.js';
import { attributeBlock } from './attribute.js';
import { explainBlock } from './explain.js';
import { bindFacts } from './facts.js';
import { Limits } from './limits.js';
import { MethodOptions, settingsInWords } from './methods.js';
import { Overlay } from './overlay.js';
import { OwnPicture } from './own.js';
import { bindPanel, buildFolds } from './panel.js';
import { presetGallery } from './presets.js';
import { Probe } from './probe.js';
import { untilAnswered } from './retry.js';
import { savePage } from './save.js';
import { Schema } from './schema.js';
import { bindShortcuts } from './shortcuts.js';

const byId = (id) => document.getElementById(id);

/** What is around `view`, the picture of `state` that `camera` turns; `say(text, kind)` puts words over it. */
export class Page {
  #methods = [];  // once the daemon has listed them
  #methodOptions;
  #showFacts;
  #planning;
  #redraw;

  /** Once the daemon has said what there is to control. */
  controls;

  constructor({ state, view, camera, say }) {
    Object.assign(this, { state, view, camera, say });
    this.panel = bindPanel();
    this.probe = new Probe({ state, view, panel: this.panel, mark: byId('mark') });
    byId('probe').append(this.probe.element);
    this.#showFacts = bindFacts(byId('facts'), view, (...setting) => settingsInWords(this.#methods, ...setting));
    this.limits = new Limits({ view, note: byId('near'), open: () => {
      this.panel.select('adjust');
      byId('adjust').querySelector('[data-group=method]')?.setAttribute('open', '');
    } });
    state.addEventListener('change', () => this.#refresh());
    state.addEventListener('settle', () => {
      this.#refresh();
      this.#resolve();
    });
    byId('undo').addEventListener('click', () => state.undo());
    byId('redo').addEventListener('click', () => state.redo());
    byId('show-help').addEventListener('click', () => byId('help').showModal());
    bindShortcuts(byId('shortcuts'));
    document.addEventListener('keydown', (event) => this.#key(event));
  }

  /** Fills the panel with what the daemon says there is. */
  async furnish() {
    this.#resolve();
    const { state, view } = this;
    const ask = (what) => untilAnswered(() => list(what), (error) => this.say(inWords(error), 'waiting'));
    const [root, { presets }, { methods }] =
      await Promise.all([ask('schema'), ask('presets'), ask('methods')]);
    this.#methods = methods;
    this.#showFacts();
    const schema = new Schema(root, () => {
      const chosen = state.value('spectrum.wavelengths_nm');
      return Array.isArray(chosen) ? chosen.length : undefined;
    });
    state.rivals = (path) => schema.rivals(path);
    this.controls = new Controls(state, schema);
    this.#adjustPage(schema);
    byId('skies').replaceChildren(presetGallery(presets, state, () => this.#idle()));
    byId('compare').replaceChildren(...this.#comparePage());
    byId('save').replaceChildren(...savePage(state, view));
    this.#refresh();
  }

  // ---- The tabs -------------------------------------------------------------------------------

  #adjustPage(schema) {
    const { state, view, camera, controls, limits } = this;
    const constituents = new Constituents(state, schema, controls);
    controls.companions = (path, value, node) =>
      ({ ...constituents.ties.companions(path, value, node), ...camera.companions(path, value) });
    controls.most = (path) => camera.most(path);
    const options = new MethodOptions(this.#methods, state, controls, limits.element);
    this.#methodOptions = options;
    const fold = () => byId('adjust').querySelector('[data-group=day]');
    const day = new Day({ state, view, idle: () => this.#idle(), fold });
    byId('adjust').replaceChildren(...buildFolds(schema, controls, MethodOptions.paths(this.#methods), {
      atmosphere: [constituents.element], method: [options.element], day: [day.element] }));
    fold().addEventListener('toggle', () => day.refresh());
    byId('adjust').addEventListener('shown', () => day.refresh());
    for (const event of ['settle', 'resolve']) {
      state.addEventListener(event, () => {
        constituents.refresh();
        options.refresh();
        this.#refresh();
      });
    }
    constituents.refresh();
  }

  #comparePage() {
    const { state, view, panel } = this;
    const methods = this.#methods;
    const overlay = new Overlay(byId('overlay'));
    const compare = new Compare({ state, view, overlay, methods, handle: byId('wipe'),
                                  otherCanvas: byId('other') });
    const own = new OwnPicture({ state, panel, overlay, compare, curtain: byId('drop') });
    return [compare.element, new ChartBlock(state, methods).element, attributeBlock(state, view, methods),
            explainBlock(state, view), own.element];
  }

  // Resolves when the frame on screen does not need the daemon.
  #idle() {
    return new Promise((resolve) => {
      const look = () => (this.view.settled ? resolve() : setTimeout(look, 100));
      look();
    });
  }

  // ---- The scene ------------------------------------------------------------------------------

  #refresh() {
    this.#redraw ??= requestAnimationFrame(() => {
      this.#redraw = undefined;
      this.controls?.refresh();
      byId('undo').disabled = !this.state.canUndo();
      byId('redo').disabled = !this.state.canRedo();
    });
  }

  // Asks what the daemon makes of the scene: all of its members, and how it is rendered.
  async #resolve() {
    const { state, view } = this;
    this.#planning?.abort();
    this.#planning = new AbortController();
    const { signal } = this.#planning;
    const ask = (scene) => untilAnswered(() => plan(scene, signal), () => {}, signal);
    try {
      if (!state.knowsBase()) {
        const { preset } = state;
        state.learnBase(preset, (await ask({ preset })).scene);
      }
      const scene = state.document();
      const answer = await ask(scene);
      state.resolve(scene, answer.scene);
      const shown = await ask(view.restingScene());
      this.#methodOptions?.explain(shown);
      this.limits.show(shown);
    } catch (error) {
      // A refused scene is told of by its frame, and an aborted question was about an old one.
      if (error.name !== 'AbortError' && error.pointer === undefined) this.say(inWords(error), 'refused');
    }
  }

  // ---- Keys -----------------------------------------------------------------------------------

  #key(event) {
    if (byId('help').open || event.altKey) return;
    const typing = event.target.closest('input[type=text], input[type=number], textarea');
    if (event.ctrlKey || event.metaKey) {
      if (event.key.toLowerCase() !== 'z' || typing) return;
      event.preventDefault();
      if (event.shiftKey) this.state.redo();
      else this.state.undo();
      return;
    }
    if (typing || (event.key.length === 1 && !byId('shortcuts').checked)) return;
    const onPicture = event.target === byId('picture') || event.target === document.body;
    if (event.key === '?') byId('help').showModal();
    else if (event.key.toLowerCase() === 'c' && !event.target.closest('select')) this.panel.toggle();
    else if (onPicture && event.key.toLowerCase() === 'p') this.probe.middle();
    else if (onPicture && this.camera.key(event)) event.preventDefault();
  }
}
