// A spectrum as a curve whose nodes are dragged: wavelengths and values, linear between.

import { h, svg } from './dom.js';
import { format, parse, Scale, unitText } from './numbers.js';
import { axes } from './plot.js';

const SHORTEST = 380;
const LONGEST = 730;
const HEIGHT = 150;
const VIEW_WIDTH = 312;
const GRIP = 24;        // of the drawing's own pixels
const APART_NM = 1;     // at least, between two nodes

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const tidy = (value) => Number(value.toPrecision(3));

/** The editor of `{ wavelengths_nm, values }`; `node` describes a value. */
export function spectrumCurve(node, binding) {
  const range = new Scale(node);
  let chosen = 0;
  let plot;
  const place = h('div', { className: 'spectrum', role: 'group',
    'aria-label': `${binding.label}: nodes, moved by dragging or arrow keys` });
  const typed = h('input', { type: 'text', inputMode: 'decimal', className: 'typed', 'aria-label':
    `${binding.label}: value of the chosen node`, onchange: () => {
      const value = parse(typed.value);
      if (value === undefined) binding.complain('This needs a number.');
      else move(chosen, at(chosen)[0], value);
    } });
  const where = h('span', { className: 'quiet' });
  const button = (title, act) => h('button', { type: 'button', className: 'chip', onclick: act }, title);
  const add = button('Add a node', () => insert());
  const remove = button('Remove it', () => drop());

  const nodes = () => {
    const { wavelengths_nm: wavelengths = [], values = [] } = binding.get() ?? {};
    return wavelengths.map((wavelength, i) => [wavelength, values[i]]);
  };
  const at = (index) => nodes()[index] ?? [550, 0];
  const put = (list) => binding.set({ wavelengths_nm: list.map(([wavelength]) => wavelength),
                                      values: list.map(([, value]) => value) });
  // A node stays between its neighbours.
  const move = (index, wavelength, value) => {
    const list = nodes();
    const low = index ? list[index - 1][0] + APART_NM : 10;
    const high = index + 1 < list.length ? list[index + 1][0] - APART_NM : 5000;
    list[index] = [clamp(Math.round(wavelength), low, high), value];
    put(list);
  };
  const insert = () => {
    const list = nodes();
    const after = chosen + 1 < list.length ? chosen : chosen - 1;
    const [left, right] = [list[after] ?? list[0], list[after + 1] ?? list[0]];
    if (right[0] - left[0] < 2 * APART_NM) return;
    chosen = after + 1;
    put([...list.slice(0, chosen), [Math.round((left[0] + right[0]) / 2), tidy((left[1] + right[1]) / 2)],
         ...list.slice(chosen)]);
  };
  const drop = () => {
    const list = nodes();
    if (list.length < 3) return;
    list.splice(chosen, 1);
    chosen = Math.max(0, chosen - 1);
    put(list);
  };

  const draw = () => {
    const list = nodes();
    const focused = place.contains(document.activeElement);
    const wavelengths = list.map(([wavelength]) => wavelength);
    const least = range.logarithmic ? range.low : Math.min(range.low, ...list.map(([, value]) => value));
    plot = axes({ label: `${binding.label} against wavelength`, height: HEIGHT,
      x: { title: 'wavelength', unit: 'nm', low: Math.min(SHORTEST, ...wavelengths),
           high: Math.max(LONGEST, ...wavelengths) },
      y: { title: '', unit: unitText(node['x-unit']), scale: range.logarithmic ? 'log' : 'linear', low: least,
           high: Math.max(range.high, ...list.map(([, value]) => value)) } });
    plot.element.removeAttribute('tabindex');
    plot.element.setAttribute('role', 'presentation');
    const spots = list.map(([wavelength, value]) =>
      [plot.x.at(wavelength), plot.y.at(range.logarithmic ? Math.max(value, range.low) : value)]);
    if (!spots.length) return;
    const ends = [[plot.x.from, spots[0][1]], ...spots, [plot.x.to, spots.at(-1)[1]]];
    plot.layer.append(svg('path', { class: 'line main', d: ends.map(([x, y], i) =>
      `${i ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`).join('') }), ...spots.map(([x, y], i) => nodeAt(x, y, i, list[i])));
    place.replaceChildren(plot.element);
    if (focused) place.querySelector(`[data-node="${chosen}"]`)?.focus({ preventScroll: true });
  };
  const nodeAt = (x, y, index, [wavelength, value]) => {
    const words = `${format(wavelength)} nm: ${format(value)}`;
    return svg('circle', { cx: x, cy: y, r: 6, class: `node${index === chosen ? ' chosen' : ''}`, tabindex: 0,
      role: 'slider', 'aria-label': `${binding.label}, node ${index + 1}`, 'aria-valuenow': value,
      'aria-valuetext': words, 'data-node': index }, svg('title', {}, words));
  };

  // Pointers are held by the place, since every move draws the plot anew.
  const spotOf = (event) => {
    const box = place.getBoundingClientRect();
    const factor = VIEW_WIDTH / box.width;
    return [(event.clientX - box.left) * factor, (event.clientY - box.top) * factor];
  };
  place.addEventListener('pointerdown', (event) => {
    const [x, y] = spotOf(event);
    const gaps = nodes().map(([wavelength, value]) => Math.hypot(plot.x.at(wavelength) - x,
      plot.y.at(range.logarithmic ? Math.max(value, range.low) : value) - y));
    const nearest = gaps.indexOf(Math.min(...gaps));
    if (!(gaps[nearest] < GRIP)) return;
    chosen = nearest;
    place.setPointerCapture(event.pointerId);
    event.preventDefault();
    refresh();
    place.querySelector(`[data-node="${chosen}"]`)?.focus({ preventScroll: true });
  });
  place.addEventListener('pointermove', (event) => {
    if (!place.hasPointerCapture(event.pointerId)) return;
    const [x, y] = spotOf(event);
    const { x: across, y: up } = plot;
    const wavelength = across.low + ((x - across.from) / (across.to - across.from)) * (across.high - across.low);
    const share = clamp((y - up.from) / (up.to - up.from), 0, 1);
    move(chosen, wavelength, tidy(range.toValue(share * range.positions)));
  });
  place.addEventListener('focusin', (event) => {
    if (event.target.dataset.node === undefined || Number(event.target.dataset.node) === chosen) return;
    chosen = Number(event.target.dataset.node);
    refresh();
  });
  place.addEventListener('keydown', (event) => {
    const [wavelength, value] = at(chosen);
    const step = range.positions / (event.shiftKey ? 10 : 100);
    const to = (by) => tidy(range.toValue(clamp(range.toPosition(value) + by, 0, range.positions)));
    const moves = { ArrowUp: [0, step], ArrowDown: [0, -step], ArrowLeft: [-5, 0], ArrowRight: [5, 0] };
    if (event.key in moves) {
      const [across, up] = moves[event.key];
      move(chosen, wavelength + across, up ? to(up) : value);
    } else if (event.key === 'Delete') {
      drop();
    } else {
      return;
    }
    event.preventDefault();
  });

  const refresh = () => {
    chosen = clamp(chosen, 0, Math.max(0, nodes().length - 1));
    draw();
    const [wavelength, value] = at(chosen);
    where.textContent = `${format(wavelength)} nm`;
    if (document.activeElement !== typed) typed.value = format(value);
    remove.disabled = nodes().length < 3;
  };
  return {
    element: h('div', { className: 'stack' }, place,
               h('div', { className: 'row' }, where, typed, add, remove)),
    refresh,
  };
}
