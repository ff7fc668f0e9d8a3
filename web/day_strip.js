// The strip of a day: slices of this view as the daemon streams them, the sun's height over them, and
// the moment as a slider.

import { inWords, stream } from './api.js';
import { h, svg } from './dom.js';
import { Task } from './task.js';

const SLICES = 18;
const SLICE_PX = { width: 32, height: 96 };
const WIDTH = 312;
const HEIGHT = 84;
const HEIGHTS_DEG = [-8, 92];
const POSITIONS = 1000;
const VIEW = { projection: 'perspective', fov_deg: 70 };
const METHOD = { max_error: 0.1, max_ms: 40 };

export class DayStrip {
  #task = new Task();

  constructor(onChoose, say) {
    this.say = say;
    this.canvas = h('canvas', { width: SLICES * SLICE_PX.width, height: SLICE_PX.height });
    this.drawing = svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: 'none',
                                'aria-hidden': 'true' });
    this.slider = h('input', { type: 'range', min: 0, max: POSITIONS, step: 1, className: 'moment',
                               'aria-label': 'Time of day',
                               oninput: () => onChoose(this.slider.valueAsNumber / POSITIONS) });
    this.marks = h('div', { className: 'strip-marks', 'aria-hidden': 'true' });
    this.element = h('div', {},
      h('div', { className: 'strip' }, this.canvas, this.drawing, this.slider), this.marks);
  }

  /** Fills it with slices of the scene, each with the patch of its moment; true where nothing stopped it. */
  fill(scene, patchAt) {
    const { channels, layers, ...look } = scene.image ?? {};
    const small = { ...scene, method: METHOD, camera: { ...scene.camera, ...VIEW },
                    image: { ...look, ...SLICE_PX, format: 'png' } };
    const frames = Array.from({ length: SLICES }, (_, i) => patchAt((i + 0.5) / SLICES));
    return this.#task.run((signal) => stream(small, frames, async (blob, facts, at) => {
      const bitmap = await createImageBitmap(blob);
      if (!at && !signal.aborted) this.say('');  // the daemon may have been busy
      if (!signal.aborted) this.#put(bitmap, at);
      this.canvas.dataset.slices = String(at + 1);
      bitmap.close();
    }, signal).then(() => true), (error) => this.say(inWords(error)));
  }
  // A slice stands at its moment and fades in from the one before.
  #put(bitmap, at) {
    const { width, height } = SLICE_PX;
    const context = this.canvas.getContext('2d');
    const middle = (at + 0.5) * width;
    context.drawImage(bitmap, middle, 0);
    context.drawImage(at ? faded(bitmap) : bitmap, middle - width, 0, width, height);
  }
  stop() {
    this.#task.stop();
  }

  /** The sun's height and the day's times. */
  draw(timeline) {
    const { moments, sunrise, sunset, highest } = timeline.day;
    const [low, high] = HEIGHTS_DEG;
    const y = (elevation) => HEIGHT * (1 - (elevation - low) / (high - low));
    const line = moments.map(({ time, elevation_deg: elevation }) =>
      [timeline.shareOf(time) * WIDTH, y(elevation)])
      .filter(([x]) => x >= -20 && x <= WIDTH + 20)
      .map(([x, up], i) => `${i ? 'L' : 'M'}${x.toFixed(1)} ${up.toFixed(1)}`).join('');
    this.drawing.replaceChildren(
      svg('line', { x1: 0, x2: WIDTH, y1: y(0), y2: y(0), class: 'horizon' }),
      svg('path', { d: line, class: 'height' }));
    const named = [[sunrise, 'sunrise'], [highest.time, 'highest'], [sunset, 'sunset']].filter(([time]) => time);
    this.marks.replaceChildren(...named.map(([time, name]) => {
      const mark = h('span', {}, `${name} ${time.slice(11, 16)}`);
      mark.style.setProperty('--at', String(timeline.shareOf(time)));
      return mark;
    }));
  }

  /** Moves the slider; `set` is whether the scene has this moment. */
  point(share, set, clock) {
    this.slider.value = Math.round(POSITIONS * share);
    this.slider.classList.toggle('unset', !set);
    this.slider.setAttribute('aria-valuetext', `${clock}${set ? '' : ', not chosen yet'}`);
  }
}

// The slice, clear at its left and opaque at its right.
function faded(bitmap) {
  const { width, height } = bitmap;
  const context = new OffscreenCanvas(width, height).getContext('2d');
  context.drawImage(bitmap, 0, 0);
  const ramp = context.createLinearGradient(0, 0, width, 0);
  ramp.addColorStop(0, 'transparent');
  ramp.addColorStop(1, 'black');
  context.globalCompositeOperation = 'destination-in';
  context.fillStyle = ramp;
  context.fillRect(0, 0, width, height);
  return context.canvas;
}
