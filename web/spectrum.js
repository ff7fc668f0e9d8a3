// A spectrum as a curve whose nodes are dragged: wavelengths and values, linear between.

import { h, svg } from './dom.js';
import { format, parse, Scale, unitText, whyNoNumber } from './numbers.js';
import { axes } from './plot.js';

const SHORTEST_NM = 380;
const LONGEST_NM = 730;
const ALLOWED_NM = [10, 5000];
const APART_NM = 1;  // at least, between two nodes
const STEP_NM = 5;
const HEIGHT = 150;
const VIEW_WIDTH = 312;
const GRIP = 24;  // in the drawing's own unit

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const tidy = (value) => Number(value.toPrecision(3));

/** The editor of `{ wavelengths_nm, values }`; `node` describes a value. */
export const spectrumCurve = (node, binding) => new SpectrumCurve(node, binding);

class SpectrumCurve {
  #chosen = 0;
  #plot;

  constructor(node, binding) {
    this.unit = unitText(node['x-unit']);
    this.range = new Scale(node);
    this.binding = binding;
    const { label } = binding;
    this.place = h('div', { className: 'spectrum', role: 'group',
                            'aria-label': `${label}: nodes, moved by dragging or arrow keys` });
    this.typed = h('input', { type: 'text', inputMode: 'decimal', className: 'typed',
                              'aria-label': `${label}: value of the chosen node`, onchange: () => this.#type() });
    this.where = h('span', { className: 'quiet' });
    const button = (title, what, act) => h('button', {
      type: 'button', className: 'chip', 'aria-label': what, title: what, onclick: act }, title);
    this.remove = button('Remove', 'Remove the chosen node', () => this.#drop());
    this.element = h('div', { className: 'stack' }, this.place, h('div', { className: 'row' },
      this.where, this.typed, button('Add', 'Add a node', () => this.#insert()), this.remove));
    this.#bindPointer();
    this.place.addEventListener('keydown', (event) => this.#key(event));
    this.place.addEventListener('focusin', ({ target }) => {
      const { node: index } = target.dataset;
      if (index === undefined || Number(index) === this.#chosen) return;
      this.#chosen = Number(index);
      this.refresh();
    });
  }

  refresh() {
    const list = this.#nodes();
    this.#chosen = clamp(this.#chosen, 0, Math.max(0, list.length - 1));
    if (!list.length) return;
    this.#draw(list);
    const [wavelength, value] = list[this.#chosen];
    this.where.textContent = `${format(wavelength)} nm`;
    if (document.activeElement !== this.typed) this.typed.value = format(value);
    this.remove.disabled = list.length < 3;
  }

  // ---- The nodes: [wavelength, value] ---------------------------------------------------------

  #nodes() {
    const { wavelengths_nm: wavelengths = [], values = [] } = this.binding.get() ?? {};
    return wavelengths.map((wavelength, i) => [wavelength, values[i]]);
  }
  #put(list) {
    this.binding.set({ wavelengths_nm: list.map(([wavelength]) => wavelength),
                       values: list.map(([, value]) => value) });
  }
  // The chosen one stays between its neighbours.
  #move(wavelength, value) {
    const list = this.#nodes();
    const low = list[this.#chosen - 1]?.[0] + APART_NM || ALLOWED_NM[0];
    const high = list[this.#chosen + 1]?.[0] - APART_NM || ALLOWED_NM[1];
    list[this.#chosen] = [clamp(Math.round(wavelength), low, high), value];
    this.#put(list);
  }
  #type() {
    const value = parse(this.typed.value);
    if (value === undefined) this.binding.complain(whyNoNumber(this.typed.value));
    else this.#move(this.#nodes()[this.#chosen][0], value);
  }
  // Between the chosen one and the next; the last has its place before it.
  #insert() {
    const list = this.#nodes();
    const after = Math.min(this.#chosen, list.length - 2);
    const [[left, a], [right, b]] = [list[after], list[after + 1] ?? list[after]];
    if (!(right - left >= 2 * APART_NM)) return;
    this.#chosen = after + 1;
    list.splice(this.#chosen, 0, [Math.round((left + right) / 2), tidy((a + b) / 2)]);
    this.#put(list);
  }
  #drop() {
    const list = this.#nodes();
    if (list.length < 3) return;
    list.splice(this.#chosen, 1);
    this.#put(list);
  }

  // ---- The drawing ----------------------------------------------------------------------------

  #draw(list) {
    const focused = this.place.contains(document.activeElement);
    const wavelengths = list.map(([wavelength]) => wavelength);
    const values = list.map(([, value]) => value);
    const { low, high, logarithmic } = this.range;
    this.#plot = axes({ label: '', height: HEIGHT,
      x: { title: 'wavelength', unit: 'nm', low: Math.min(SHORTEST_NM, ...wavelengths),
           high: Math.max(LONGEST_NM, ...wavelengths) },
      y: { title: this.unit ? 'value' : '', unit: this.unit, scale: logarithmic ? 'log' : 'linear',
           low: logarithmic ? low : Math.min(low, ...values), high: Math.max(high, ...values) } });
    const { element, layer, x } = this.#plot;
    for (const name of ['tabindex', 'aria-label']) element.removeAttribute(name);
    element.setAttribute('role', 'presentation');
    const spots = list.map((node) => this.#spotOf(node));
    const line = [[x.from, spots[0][1]], ...spots, [x.to, spots.at(-1)[1]]];
    layer.append(svg('path', { class: 'line main', d: line.map(([across, up], i) =>
      `${i ? 'L' : 'M'}${across.toFixed(1)} ${up.toFixed(1)}`).join('') }),
      ...list.map((node, i) => this.#dot(node, spots[i], i)));
    this.place.replaceChildren(element);
    if (focused) this.#focus();
  }
  #dot([wavelength, value], [cx, cy], index) {
    const words = `${format(wavelength)} nm: ${format(value)}`;
    return svg('circle', { cx, cy, r: 6, class: `node${index === this.#chosen ? ' chosen' : ''}`, tabindex: 0,
      role: 'slider', 'aria-label': `${this.binding.label}, node ${index + 1}`, 'aria-valuenow': value,
      'aria-valuemin': Math.min(this.range.low, value), 'aria-valuemax': Math.max(this.range.high, value),
      'aria-valuetext': words, 'data-node': index }, svg('title', {}, words));
  }
  #spotOf([wavelength, value]) {
    const { x, y } = this.#plot;
    return [x.at(wavelength), y.at(this.range.logarithmic ? Math.max(value, this.range.low) : value)];
  }
  #focus() {
    this.place.querySelector(`[data-node="${this.#chosen}"]`)?.focus({ preventScroll: true });
  }

  // ---- Hands ----------------------------------------------------------------------------------

  // The place holds the pointer, since every move draws the plot anew.
  #bindPointer() {
    const { place } = this;
    const spot = (event) => {
      const box = place.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top].map((length) => (length * VIEW_WIDTH) / box.width);
    };
    place.addEventListener('pointerdown', (event) => {
      const [x, y] = spot(event);
      const gaps = this.#nodes().map((node) => this.#spotOf(node))
        .map(([across, up]) => Math.hypot(across - x, up - y));
      const nearest = gaps.indexOf(Math.min(...gaps));
      if (!(gaps[nearest] < GRIP)) return;
      event.preventDefault();
      place.setPointerCapture(event.pointerId);
      this.#chosen = nearest;
      this.refresh();
      this.#focus();
    });
    place.addEventListener('pointermove', (event) => {
      if (place.hasPointerCapture(event.pointerId)) this.#dragTo(spot(event));
    });
  }
  #dragTo([x, y]) {
    const { x: across, y: up } = this.#plot;
    const along = (axis, at) => clamp((at - axis.from) / (axis.to - axis.from), 0, 1);
    const value = this.range.toValue(along(up, y) * this.range.positions);
    this.#move(across.low + along(across, x) * (across.high - across.low), tidy(value));
  }

  #key(event) {
    const [wavelength, value] = this.#nodes()[this.#chosen];
    const { range } = this;
    const step = range.positions / (event.shiftKey ? 10 : 100);
    const raise = (by) => {
      const position = clamp(range.toPosition(value) + by, 0, range.positions);
      this.#move(wavelength, tidy(range.toValue(position)));
    };
    const act = {
      ArrowUp: () => raise(step), ArrowDown: () => raise(-step), Delete: () => this.#drop(),
      ArrowLeft: () => this.#move(wavelength - STEP_NM, value),
      ArrowRight: () => this.#move(wavelength + STEP_NM, value),
    }[event.key];
    if (!act || event.target === this.typed) return;
    event.preventDefault();
    act();
  }
}
