// Speed against accuracy on the scene that is seen: every method over its settings, point by point
// as the daemon measures them. A click takes a point's method.

import { chart, inWords } from './api.js';
import { h, svg } from './dom.js';
import { words } from './editors.js';
import { percent } from './figures.js';
import { settingsInWords } from './methods.js';
import { format } from './numbers.js';
import { axes, extent } from './plot.js';
import { markStale } from './stale.js';
import { Task } from './task.js';

const HEIGHT = 250;
const SHAPES = {
  nishita: 'M-4-4H4V4H-4Z',
  raymarch: 'M0-5 5 4H-5Z',
  hillaire: 'M0 5 5-4H-5Z',
  bruneton: 'M0-5.5 5.5 0 0 5.5-5.5 0Z',
  moments: 'M-4.5 0A4.5 4.5 0 1 0 4.5 0 4.5 4.5 0 1 0-4.5 0Z',
  path: 'M-1.5-5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5Z',
};

/** The points that none beats in both, fastest first. */
export function paretoFront(points) {
  const front = [];
  for (const point of [...points].sort((a, b) => a.frame_ms - b.frame_ms)) {
    if (!front.length || point.error < front.at(-1).error) front.push(point);
  }
  return front;
}

export class ChartBlock {
  #task = new Task();
  #stopped = false;
  #head;
  #points = [];
  #redraw;

  constructor(state, methods) {
    this.state = state;
    this.methods = methods;
    this.titles = Object.fromEntries(methods.map(({ name, title }) => [name, title ?? words(name)]));
    this.place = h('div', { className: 'result' });
    this.words = h('p', { className: 'help', role: 'status' });
    this.button = h('button', { type: 'button', className: 'chip', onclick: () => this.#press() }, 'Measure');
    this.element = h('section', { className: 'block', id: 'chart-block' },
      h('div', { className: 'row' }, h('h2', {}, 'Speed and accuracy'), this.button),
      h('p', { className: 'help' }, 'Every method on this sky, with its settings. Choose a point to '
        + 'render by it.'), this.place, this.words);
    state.addEventListener('change', () => {
      this.#mark();
      this.#age();
    });
  }

  // All but the method, which is what the points differ in.
  #scene() {
    const { method, ...scene } = this.state.document();
    const orders = method?.scattering_orders;
    return orders === undefined ? scene : { ...scene, method: { scattering_orders: orders } };
  }
  #age() {
    markStale(this.place, this.#points.length > 0 && JSON.stringify(this.#scene()) !== this.measured);
  }

  async #press() {
    if (this.#task.running) return this.#stop();
    const scene = this.#scene();
    this.measured = JSON.stringify(scene);
    this.#points = [];
    this.#head = undefined;
    this.#stopped = false;
    this.place.replaceChildren();
    this.#age();
    this.button.textContent = 'Stop';
    this.words.textContent = 'Computing what the methods are measured against…';
    try {
      const done = await this.#task.run(
        (signal) => chart(scene, (line) => this.#take(line), signal).then(() => true),
        (error) => { this.words.textContent = inWords(error); });
      if (done) this.#end();  // else it was stopped, and the next may be under way
    } catch (error) {
      this.#end();
      this.words.textContent = inWords(error);
    }
  }

  #stop() {
    this.#stopped = true;
    this.#task.stop();
    this.#end();
  }
  #end() {
    this.button.textContent = 'Measure';
    this.#tell();
  }

  #take(line) {
    if (line.points !== undefined) [this.#head, this.#points] = [line, []];
    else if (line.method && !line.failure) {
      // Of what the reference's noise hides, the most that it may be.
      const error = line.error || line.error_95[1];
      if (error > 0) this.#points.push({ ...line, error });
    }
    this.#redraw ??= requestAnimationFrame(() => {
      this.#redraw = undefined;
      this.#draw();
      this.#tell();
    });
  }

  #tell() {
    if (!this.#head) {
      this.words.textContent = '';
      return;
    }
    const { width, height, points } = this.#head;
    const measured = `${this.#points.length} settings`;
    const small = `Measured on small frames, ${width} × ${height}.`;
    if (this.#task.running) {
      this.words.textContent = `${measured} of up to ${points} measured… ${small}`;
      return;
    }
    const done = this.#stopped ? `Stopped after ${measured} of up to ${points}` : measured;
    this.words.textContent = `${done}. ${small} The line joins what nothing else beats.`;
  }

  #draw() {
    if (!this.#points.length) return;
    const focused = document.activeElement?.dataset?.point;
    const series = [{ points: this.#points.map(({ frame_ms: ms, error }) => [ms, error]) }];
    const wide = ([low, high]) => [low / 1.6, high * 1.6];
    const [left, right] = wide(extent(series, 0, 'log'));
    const [low, high] = wide(extent(series, 1, 'log'));
    const plot = axes({ label: 'Error against time of a frame', height: HEIGHT,
      x: { title: `device time, ${this.#head.width} × ${this.#head.height}`, unit: 'ms', scale: 'log',
           low: left, high: right },
      y: { title: 'error', unit: '%', scale: 'log', low: 100 * low, high: 100 * high } });
    plot.element.removeAttribute('tabindex');  // the points are what is focused
    plot.element.setAttribute('role', 'group');
    const spot = ({ frame_ms: ms, error }) => [plot.x.at(ms), plot.y.at(100 * error)];
    const front = paretoFront(this.#points);
    plot.layer.append(svg('path', { class: 'front', d: front.map((point, i) =>
      `${i ? 'L' : 'M'}${spot(point).map((value) => value.toFixed(1)).join(' ')}`).join('') }));
    plot.layer.append(...this.#points.map((point) => this.#dot(point, spot(point), front.includes(point))));
    this.place.replaceChildren(plot.element, this.#legend());
    this.#mark();
    this.#age();
    if (focused) this.place.querySelector(`[data-point="${CSS.escape(focused)}"]`)?.focus();
  }

  #dot(point, [x, y], best) {
    const { method, error, frame_ms: ms } = point;
    const name = `${this.#inWords(point)}: ` +
      `error ${percent(error)}, ${format(Number(ms.toPrecision(2)))} ms`;
    const choose = () => this.#choose(point);
    const dot = svg('g', { class: `point of-${method}${best ? ' best' : ''}`, role: 'button', tabindex: 0,
                           transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`,
                           'aria-pressed': 'false', 'aria-label': name,
                           'data-point': keyOf(point), 'data-method': method },
      svg('title', {}, name), svg('circle', { r: 11, class: 'reach' }),
      svg('path', { d: SHAPES[method] ?? SHAPES.moments }));
    dot.addEventListener('click', choose);
    dot.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      choose();
    });
    return dot;
  }

  #legend() {
    const measured = new Set(this.#points.map(({ method }) => method));
    const present = Object.keys(this.titles).filter((name) => measured.has(name));
    return h('ul', { className: 'chart-legend' }, present.map((name) => h('li', {},
      svg('svg', { viewBox: '-6 -6 12 12', class: `point of-${name}`, 'aria-hidden': 'true' },
          svg('path', { d: SHAPES[name] ?? SHAPES.moments })), this.titles[name])));
  }

  #choose(point) {
    const orders = this.state.value('method.scattering_orders');
    const kept = typeof orders === 'number' ? { scattering_orders: orders } : {};
    this.state.edit({ method: { ...kept, name: point.method, ...point.options } });
    this.words.textContent = `Rendering by ${this.#inWords(point)}.`;
  }
  #inWords({ method, options }) {
    return [this.titles[method], settingsInWords(this.methods, method, options)].filter(Boolean).join(', ');
  }
  #mark() {
    const { name, ...options } = this.state.document().method ?? {};
    for (const dot of this.place.querySelectorAll('[data-point]')) {
      dot.setAttribute('aria-pressed', String(dot.dataset.point === keyOf({ method: name, options })));
    }
  }
}

const keyOf = ({ method, options }) => {
  const { scattering_orders, ...own } = options;
  return `${method} ${JSON.stringify(Object.entries(own).sort())}`;
};
