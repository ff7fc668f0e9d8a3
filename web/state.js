// The scene that is on screen: a preset and a merge patch over it, with undo and redo.
//
// Events: `change` after every edit; `settle` when the edits pause, which is when they enter the
// history and the address bar; `resolve` when the daemon has said what the whole scene is.

import { equal, get, isObject, merge, set, unset } from './paths.js';

const SETTLE_MS = 350;
const LONGEST_HISTORY = 200;

export class State extends EventTarget {
  #past = [];
  #future = [];
  #settled;
  #timer;
  #bases = new Map();  // the whole scene of each preset that has been seen

  constructor({ preset, patch }) {
    super();
    this.preset = preset;
    this.patch = patch;
    this.resolved = {};
    this.rivals = () => [];  // paths that a document may not hold beside a path
    this.#settled = this.snapshot();
  }

  snapshot() {
    return { preset: this.preset, patch: this.patch };
  }

  /** The scene as the daemon is asked for it. */
  document() {
    return { preset: this.preset, ...this.patch };
  }

  /** The whole scene, as far as it is known before the daemon has said. */
  scene() {
    return merge(this.resolved, this.patch);
  }
  value(path) {
    return get(this.scene(), path);
  }

  /** False while nothing is known but the patch: what is not in it may be anything. */
  isKnown() {
    return Object.keys(this.resolved).length > 0;
  }

  /** The whole scene of the preset alone. */
  base() {
    return this.#bases.get(this.preset) ?? {};
  }
  /** What that is; all that is known of the whole scene until the daemon says more, or where it refuses. */
  learnBase(preset, scene) {
    this.#bases.set(preset, scene);
    if (preset !== this.preset || this.isKnown()) return;
    this.resolved = scene;
    this.dispatchEvent(new Event('resolve'));
  }
  knowsBase() {
    return this.#bases.has(this.preset);
  }

  /** True where the person has changed something at or below `path`. */
  isChanged(path) {
    return get(this.patch, path) !== undefined;
  }

  /** Sets members by path; `undefined` gives one back to the preset. One edit, one `change`. */
  edit(members) {
    for (const [path, value] of Object.entries(members)) {
      if (value === undefined) this.#giveBack(path);
      else this.#assign(path, value);
    }
    this.#changed();
  }

  #assign(path, value) {
    for (const other of this.rivals(path)) this.patch = unset(this.patch, other);
    // A spectrum of another form, or an object of another type, must not merge with the old patch.
    this.patch = set(this.patch, path, value);
    if (isObject(value)) this.resolved = unset(this.resolved, path);
  }

  #giveBack(path) {
    this.patch = unset(this.patch, path);
    const inherited = get(this.base(), path);
    this.resolved = inherited === undefined ? unset(this.resolved, path)
                                            : set(this.resolved, path, inherited);
  }

  /** Shows another scene; undo comes back from it. */
  load({ preset, patch }) {
    this.preset = preset;
    this.patch = patch;
    this.resolved = this.base();
    this.#changed();
    this.settleNow();
  }

  #changed() {
    this.dispatchEvent(new Event('change'));
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.settleNow(), SETTLE_MS);
  }

  settleNow() {
    clearTimeout(this.#timer);
    if (!equal(this.#settled, this.snapshot())) {
      this.#past = [...this.#past, this.#settled].slice(-LONGEST_HISTORY);
      this.#future = [];
      this.#settled = this.snapshot();
    }
    this.dispatchEvent(new Event('settle'));
  }

  /** The daemon's whole scene for `document`; ignored where the scene has changed since. */
  resolve(document, scene) {
    if (!equal(document, this.document())) return;
    this.resolved = scene;
    if (!Object.keys(this.patch).length) this.learnBase(this.preset, scene);
    this.dispatchEvent(new Event('resolve'));
  }

  canUndo() {
    return this.#past.length > 0;
  }
  canRedo() {
    return this.#future.length > 0;
  }
  undo() {
    this.settleNow();
    if (!this.canUndo()) return;
    this.#future = [this.#settled, ...this.#future];
    this.#travel(this.#past.pop());
  }
  redo() {
    this.settleNow();
    if (!this.canRedo()) return;
    this.#past = [...this.#past, this.#settled];
    this.#travel(this.#future.shift());
  }
  #travel(snapshot) {
    this.#settled = snapshot;
    this.load(snapshot);
  }
}
