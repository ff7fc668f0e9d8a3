// The frame on screen: one request at a time, small while the scene moves, sharp when it rests.
//
// While the scene moves, frames are as large as can be had in TARGET_MS. When it has rested for
// REST_MS they grow in a few steps to the full size of the window. A frame that nobody needs any
// more is aborted, but a small one is let come home if it is nearly there: otherwise a hand that
// never stops would never see one.
//
// Events: `frame` (detail: facts), `refused` and `waiting` (detail: the error).

import { render } from './api.js';
import { isPassing, waitMs } from './retry.js';

const TARGET_MS = 40;
const PATIENCE_MS = 400;
const REST_MS = 160;
const FEWEST_PIXELS = 6000;
const MOST_PIXELS = 4.2e6;
const SHARPEN_STEP = 9;  // times as many pixels
const MOVING_BUDGET_MS = 60;    // of device time, where the method is the daemon's to choose
const RESTING_BUDGET_MS = 2000;
const FIXED_SHAPES = { equirectangular: 2, cubemap: 1 / 6 };

// A method for a frame that somebody waits for; what the scene itself says of time stands.
function withinTime(method = {}, moving) {
  return { max_error: 0.02, max_ms: moving ? MOVING_BUDGET_MS : RESTING_BUDGET_MS, ...method };
}

export class View extends EventTarget {
  #version = 0;        // of the scene that is wanted
  #shown = { version: -1, pixels: 0 };
  #flight;             // the request under way
  #timer;
  #retryAt = 0;
  #attempts = 0;
  #changedAt = -Infinity;
  #movingPixels = 40000;
  #frameTimes = [];
  #held = false;

  /** Facts of the frame on screen. */
  facts;

  /** `scene()` is the document that is wanted now. */
  constructor(canvas, scene) {
    super();
    this.canvas = canvas;
    this.scene = scene;
    this.context = canvas.getContext('bitmaprenderer');
    this.mostPixels = MOST_PIXELS;
    new ResizeObserver(() => this.change()).observe(canvas);
  }

  /** The scene or the window has changed. */
  change() {
    if (this.#held) return;
    this.#version++;
    this.#changedAt = performance.now();
    this.canvas.dataset.state = 'rough';
    this.#pump();
  }

  /** True when the frame of the wanted scene is on screen at full size. */
  get settled() {
    return this.#shown.version === this.#version && this.#shown.pixels >= this.#fullPixels() &&
      !this.#flight;
  }
  get framesPerSecond() {
    const now = performance.now();
    this.#frameTimes = this.#frameTimes.filter((time) => now - time < 1000);
    return this.#frameTimes.length;
  }

  #projection() {
    return this.scene().camera?.projection;
  }
  /** True for panoramas, which are refused in any shape but their own. */
  hasOwnShape() {
    return this.#projection() in FIXED_SHAPES;
  }
  shape() {
    return FIXED_SHAPES[this.#projection()] ?? this.canvas.clientWidth / this.canvas.clientHeight;
  }

  /** Where the picture is on its canvas, in CSS pixels: panoramas have margins. */
  pictureBox() {
    const { clientWidth, clientHeight } = this.canvas;
    const shape = this.shape();
    const width = Math.min(clientWidth, clientHeight * shape);
    const height = width / shape;
    return { left: (clientWidth - width) / 2, top: (clientHeight - height) / 2, width, height };
  }

  /** The scene as it is asked for while it moves, at the size that keeps up. */
  movingScene() {
    return this.#request({ ...this.#sizeUpTo(this.#movingPixels), moving: true });
  }

  /** The scene as it is asked for when it rests. */
  restingScene() {
    return this.#request({ ...this.fullSize(), moving: false });
  }

  /**
   * `scene` by the method and options of the frame on screen, where that shows the wanted scene and not only
   * while it moves: asked anew, the daemon may choose others.
   */
  asShown(scene) {
    if (this.#held || this.#shown.version !== this.#version || !this.facts) return scene;
    if (this.facts.moving && !this.settled) return scene;
    const { method: name, options } = this.facts;
    return { ...scene, method: { ...scene.method, name, ...options } };
  }

  /** Asks for nothing until `release()`: frames come from elsewhere, by `present`. */
  hold() {
    this.#held = true;
    this.canvas.dataset.state = 'rough';
    this.#flight?.controller.abort();
    this.#flight = undefined;
    clearTimeout(this.#timer);
  }
  release() {
    this.#held = false;
    this.change();
  }
  present(bitmap, facts) {
    this.#draw(bitmap);
    this.#tell({ ...facts, width: bitmap.width, height: bitmap.height, moving: true });
  }

  #fullPixels() {
    const { width, height } = this.fullSize();
    return width * height;
  }
  /** The size that fills the window, device pixels counted, within what is sensible. */
  fullSize() {
    const shape = this.shape();
    const ratio = window.devicePixelRatio || 1;
    const boxWidth = this.canvas.clientWidth * ratio;
    const boxHeight = this.canvas.clientHeight * ratio;
    return this.#sizeFor(Math.min(boxWidth * Math.min(boxHeight, boxWidth / shape),
                                  boxHeight * shape * boxHeight, this.mostPixels));
  }
  #sizeFor(pixels) {
    const shape = this.shape();
    if (this.#projection() === 'cubemap') {
      const width = Math.max(8, Math.floor(Math.sqrt(pixels * shape)));
      return { width, height: width * 6 };
    }
    const height = Math.max(8, Math.floor(Math.sqrt(pixels / shape)));
    const width = shape === 2 ? height * 2 : Math.max(8, Math.round(height * shape));
    return { width, height };
  }

  // Looks at what is wanted, shown and under way, and does the next thing.
  #pump() {
    clearTimeout(this.#timer);
    const now = performance.now();
    if (this.#held || !this.canvas.clientWidth || !this.canvas.clientHeight) return;
    if (now < this.#retryAt) return this.#pumpIn(this.#retryAt - now);
    if (this.#flight && !this.#mayAbandon(now)) return;
    const size = this.#nextSize(now);
    if (!size) return;
    this.#abandon(now);
    this.#fly(size);
  }
  #pumpIn(ms) {
    this.#timer = setTimeout(() => this.#pump(), Math.max(1, ms));
  }

  #mayAbandon(now) {
    if (this.#flight.version === this.#version) return false;
    const left = this.#flight.moving ? this.#flight.startedAt + PATIENCE_MS - now : 0;
    if (left <= 0) return !this.#flight.moving || this.#movingPixels > FEWEST_PIXELS;
    this.#pumpIn(left);
    return false;
  }

  // The size to ask for now; undefined where there is nothing to ask for yet.
  #nextSize(now) {
    const full = this.#fullPixels();
    const fresh = this.#shown.version === this.#version;
    const restsIn = this.#changedAt + REST_MS - now;
    if (restsIn > 0 && fresh) {
      this.#pumpIn(restsIn);
      return undefined;
    }
    if (restsIn > 0 || !fresh) {
      return { ...this.#sizeUpTo(this.#movingPixels), moving: true };
    }
    if (this.#shown.pixels >= full) return undefined;
    return { ...this.#sizeUpTo(this.#shown.pixels * SHARPEN_STEP), moving: false };
  }
  #sizeUpTo(pixels) {
    return pixels >= this.#fullPixels() ? this.fullSize() : this.#sizeFor(pixels);
  }

  #abandon(now) {
    if (!this.#flight) return;
    if (this.#flight.moving) this.#learn(now - this.#flight.startedAt);
    this.#flight.controller.abort();
    this.#flight = undefined;
  }

  // Steers the size of moving frames towards TARGET_MS, in steps that the eye does not follow.
  #learn(ms) {
    const ratio = TARGET_MS / ms;
    if (ratio > 0.8 && ratio < 1.6) return;
    const factor = Math.min(2, Math.max(0.4, ratio));
    this.#movingPixels = Math.min(this.#fullPixels(),
                                  Math.max(FEWEST_PIXELS, this.#movingPixels * factor));
  }

  // Rounding of a small frame's size must not show as bars: only panoramas keep their own shape.
  #fit() {
    this.canvas.classList.toggle('filling', !this.hasOwnShape());
  }

  #request({ width, height, moving }) {
    const scene = this.scene();
    const { channels, layers, ...image } = scene.image ?? {};
    return { ...scene, method: withinTime(scene.method, moving),
             image: { ...image, width, height, format: 'png' } };
  }

  async #fly(size) {
    const { width, height, moving } = size;
    const flight = { version: this.#version, moving, startedAt: performance.now(),
                     controller: new AbortController() };
    this.#flight = flight;
    try {
      const { blob, facts } = await render(this.#request(size), flight.controller.signal);
      const bitmap = await createImageBitmap(blob);
      if (this.#flight !== flight) return bitmap.close();
      this.#show(flight, bitmap, { ...facts, width, height });
    } catch (error) {
      if (this.#flight !== flight) return;
      this.#flight = undefined;
      this.#fail(flight, error);
    }
    this.#pump();
  }

  #show(flight, bitmap, facts) {
    const now = performance.now();
    this.#flight = undefined;
    this.#attempts = 0;
    this.#shown = { version: flight.version, pixels: facts.width * facts.height };
    if (flight.moving) this.#learn(now - flight.startedAt);
    this.#draw(bitmap);
    if (this.settled) this.canvas.dataset.state = 'sharp';
    this.#tell({ ...facts, totalMs: now - flight.startedAt, moving: flight.moving });
  }
  #draw(bitmap) {
    this.#frameTimes.push(performance.now());
    this.#fit();
    this.canvas.width = bitmap.width;
    this.canvas.height = bitmap.height;
    this.context.transferFromImageBitmap(bitmap);
  }
  #tell(facts) {
    this.facts = facts;
    this.dispatchEvent(new CustomEvent('frame', { detail: facts }));
  }

  #fail(flight, error) {
    if (isPassing(error)) {
      this.#retryAt = performance.now() + waitMs(error, ++this.#attempts);
      this.dispatchEvent(new CustomEvent('waiting', { detail: error }));
    } else {
      this.#shown = { version: flight.version, pixels: Infinity };  // keep the last good picture
      this.dispatchEvent(new CustomEvent('refused', { detail: error }));
    }
  }
}
