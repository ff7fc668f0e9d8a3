// Puts the page together: the scene, its picture, its controls.
//
//   the scene       state paths link
//   the daemon      api multipart retry task
//   the picture     view camera projection; over it wipe and overlay
//   Skies           presets
//   Adjust          panel schema controls editors spectrum numbers methods limits; constituents curves
//                   together; day day_clock day_strip
//   Compare         compare figures chart explain bars own exr
//   Probe, Save     probe, save
//   drawing         dom plot polar segmented; what is drawn is computed by the daemon

import { inWords, list, plan } from './api.js';
import { Camera } from './camera.js';
import { ChartBlock } from './chart.js';
import { Compare } from './compare.js';
import { Constituents } from './constituents.js';
import { Controls } from './controls.js';
import { Day } from './day.js';
import { explainBlock } from './explain.js';
import { bindFacts } from './facts.js';
import { Limits } from './limits.js';
import { bindAddress, readLink } from './link.js';
import { MethodOptions, settingsInWords } from './methods.js';
import { Overlay } from './overlay.js';
import { OwnPicture } from './own.js';
import { bindPanel, buildFolds } from './panel.js';
import { fromPointer } from './paths.js';
import { presetGallery } from './presets.js';
import { Probe } from './probe.js';
import { untilAnswered } from './retry.js';
import { savePage } from './save.js';
import { Schema } from './schema.js';
import { State } from './state.js';
import { View } from './view.js';

const byId = (id) => document.getElementById(id);

const state = new State(readLink(location.hash));
const view = new View(byId('picture'), () => state.document());
const camera = new Camera(byId('picture'), state);
const panel = bindPanel();
const probe = new Probe({ state, view, panel, mark: byId('mark') });
byId('probe').append(probe.element);
let controls;
let methodOptions;
let methods = [];  // once the daemon has listed them

// ---- Words for the person ---------------------------------------------------------------------

function say(text, kind = 'note') {
  byId('status').textContent = text;
  byId('status').dataset.kind = kind;
}

function sayRefused(error) {
  const beside = error.pointer && controls?.complain(fromPointer(error.pointer), error.message);
  say(beside ? 'The daemon refuses this scene; the last good picture is still shown.'
             : error.message, 'refused');
}

view.addEventListener('waiting', ({ detail }) => say(inWords(detail), 'waiting'));
view.addEventListener('refused', ({ detail }) => sayRefused(detail));
view.addEventListener('frame', () => {
  if (byId('status').textContent) say('');
  controls?.forgive();
});
bindFacts(byId('facts'), view, (...setting) => settingsInWords(methods, ...setting));
const limits = new Limits({ view, note: byId('near'), open: () => {
  panel.select('adjust');
  byId('adjust').querySelector('[data-group=method]')?.setAttribute('open', '');
} });

// ---- What the daemon makes of the scene -------------------------------------------------------

let planning;

async function resolveScene() {
  planning?.abort();
  planning = new AbortController();
  const { signal } = planning;
  const ask = (scene) => untilAnswered(() => plan(scene, signal), () => signal.throwIfAborted());
  try {
    if (!state.knowsBase()) {
      const { preset } = state;
      state.learnBase(preset, (await ask({ preset })).scene);
    }
    const scene = state.document();
    const answer = await ask(scene);
    state.resolve(scene, answer.scene);
    const shown = await ask(view.restingScene());
    methodOptions?.explain(shown);
    limits.show(shown);
  } catch (error) {
    // A refused scene is told of by its frame, and an aborted question was about an old one.
    if (error.name !== 'AbortError' && error.pointer === undefined) say(inWords(error), 'refused');
  }
}

// ---- The scene changes ------------------------------------------------------------------------

let redraw;

function refreshControls() {
  redraw ??= requestAnimationFrame(() => {
    redraw = undefined;
    controls?.refresh();
    byId('undo').disabled = !state.canUndo();
    byId('redo').disabled = !state.canRedo();
  });
}

state.addEventListener('change', () => {
  view.change();
  refreshControls();
});
state.addEventListener('settle', () => {
  refreshControls();
  resolveScene();
});
bindAddress(state);

// ---- Keys -------------------------------------------------------------------------------------

byId('undo').addEventListener('click', () => state.undo());
byId('redo').addEventListener('click', () => state.redo());
byId('show-help').addEventListener('click', () => byId('help').showModal());

document.addEventListener('keydown', (event) => {
  if (byId('help').open || event.altKey) return;
  const typing = event.target.closest('input[type=text], input[type=number], textarea');
  if (event.ctrlKey || event.metaKey) {
    if (event.key.toLowerCase() !== 'z' || typing) return;
    event.preventDefault();
    if (event.shiftKey) state.redo();
    else state.undo();
    return;
  }
  if (typing) return;
  const onPicture = event.target === byId('picture') || event.target === document.body;
  if (event.key === '?') byId('help').showModal();
  else if (event.key.toLowerCase() === 'c' && !event.target.closest('select')) panel.toggle();
  else if (onPicture && event.key.toLowerCase() === 'p') probe.middle();
  else if (onPicture && camera.key(event)) event.preventDefault();
});

// ---- Starting ---------------------------------------------------------------------------------

const idle = () => new Promise((resolve) => {
  const look = () => (view.settled ? resolve() : setTimeout(look, 100));
  look();
});

async function start() {
  resolveScene();
  const ask = (what) => untilAnswered(() => list(what), (error) => say(inWords(error), 'waiting'));
  const [root, { presets }, known] =
    await Promise.all([ask('schema'), ask('presets'), ask('methods')]);
  methods = known.methods;
  const schema = new Schema(root, () => {
    const chosen = state.value('spectrum.wavelengths_nm');
    return Array.isArray(chosen) ? chosen.length : undefined;
  });
  state.rivals = (path) => schema.rivals(path);
  controls = new Controls(state, schema);
  const constituents = new Constituents(state, schema, controls);
  methodOptions = new MethodOptions(methods, state, controls, limits.element);
  const fold = () => byId('adjust').querySelector('[data-group=day]');
  const day = new Day({ state, view, idle, fold });
  byId('adjust').replaceChildren(...buildFolds(schema, controls, MethodOptions.paths(methods), {
    atmosphere: [constituents.element], method: [methodOptions.element], day: [day.element] }));
  fold().addEventListener('toggle', () => day.refresh());
  byId('skies').replaceChildren(presetGallery(presets, state, idle));
  byId('compare').replaceChildren(...comparePage());
  byId('save').replaceChildren(...savePage(state, view));
  for (const event of ['settle', 'resolve']) {
    state.addEventListener(event, () => {
      constituents.refresh();
      methodOptions.refresh();
      refreshControls();
    });
  }
  constituents.refresh();
  refreshControls();
}

function comparePage() {
  const overlay = new Overlay(byId('overlay'));
  const compare = new Compare({ state, view, overlay, methods, handle: byId('wipe'),
                                otherCanvas: byId('other') });
  const own = new OwnPicture({ state, panel, overlay, compare, curtain: byId('drop') });
  return [compare.element, new ChartBlock(state, methods).element, explainBlock(state, view), own.element];
}

start().catch((error) => say(inWords(error), 'refused'));
