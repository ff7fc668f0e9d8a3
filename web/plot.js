// Plots: axes with ticks, titles and units, linear or logarithmic; lines and points; a cursor that
// reads values off, by pointer or arrow keys. All numbers come from the daemon.

import { svg } from './dom.js';
import { format } from './numbers.js';

const WIDTH = 312;
const MARGIN = { left: 42, right: 10, top: 20, bottom: 32 };
const FEWEST_DECADES = 0.02;
const HEADROOM = 0.06;  // above a linear line

const SUPERSCRIPTS = '⁰¹²³⁴⁵⁶⁷⁸⁹';
const raised = (exponent) => (exponent < 0 ? '⁻' : '') +
  [...String(Math.abs(exponent))].map((digit) => SUPERSCRIPTS[digit]).join('');

/** 10³ and the like. */
export const powerOfTen = (exponent) => (exponent === 0 ? '1' : exponent === 1 ? '10'
                                                                               : `10${raised(exponent)}`);

/** One axis: values against places between `from` and `to`. */
export class Axis {
  constructor({ low, high, scale = 'linear', title = '', unit = '' }, from, to) {
    this.logarithmic = scale === 'log';
    [this.low, this.high] = widened(low, high, this.logarithmic);
    this.title = title;
    this.unit = unit;
    this.from = from;
    this.to = to;
    // Small or large numbers are written without their common power of ten.
    const size = Math.max(Math.abs(this.low), Math.abs(this.high));
    const power = size > 0 ? Math.floor(Math.log10(size)) : 0;
    this.power = this.logarithmic || (power > -3 && power < 5) ? 0 : 3 * Math.floor(power / 3);
  }

  at(value) {
    const share = this.logarithmic ? Math.log(value / this.low) / Math.log(this.high / this.low)
                                   : (value - this.low) / (this.high - this.low);
    return this.from + share * (this.to - this.from);
  }
  has(value) {
    return Number.isFinite(value) && value >= this.low * (1 - 1e-9) - 1e-300 &&
      value <= this.high + 1e-9 * Math.abs(this.high);
  }

  ticks(most) {
    return this.logarithmic ? decades(this.low, this.high, most) : steps(this.low, this.high, most);
  }
  text(value) {
    if (!this.logarithmic) return format(Number((value / 10 ** this.power).toPrecision(6)));
    const exponent = Math.log10(value);
    const whole = Math.abs(exponent - Math.round(exponent)) < 1e-9;
    if (value >= 0.01 && value < 10000) return format(Number(value.toPrecision(6)));
    return whole ? powerOfTen(Math.round(exponent)) : '';
  }
  get caption() {
    const unit = [this.power ? powerOfTen(this.power) : '', this.unit].filter(Boolean).join(' ');
    return unit ? `${this.title}, ${unit}` : this.title;
  }
}

// An axis must have some length.
function widened(low, high, logarithmic) {
  if (logarithmic) {
    const middle = Math.sqrt(low * high);
    return Math.log10(high / low) > FEWEST_DECADES ? [low, high] : [middle / 3, middle * 3];
  }
  if (high > low) return [low, high];
  return low === 0 ? [0, 1] : [low - Math.abs(low) / 2, low + Math.abs(low) / 2];
}

function steps(low, high, most) {
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
}

function decades(low, high, most) {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const every = Math.max(1, Math.ceil((last - first + 1) / most));
  const factors = last - first < 2 ? [1, 2, 5] : [1];
  const all = [];
  for (let exponent = first - 1; exponent <= last; ++exponent) {
    if ((exponent - first) % every && exponent >= first) continue;
    all.push(...factors.map((factor) => factor * 10 ** exponent));
  }
  return all.filter((value) => value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9));
}

/** The lowest and highest of the series' values along a coordinate, positive ones for a log scale. */
export function extent(series, coordinate, scale) {
  const values = series.flatMap(({ points }) => points.map((point) => point[coordinate]))
    .filter((value) => Number.isFinite(value) && (scale !== 'log' || value > 0));
  if (!values.length) return scale === 'log' ? [0.1, 1] : [0, 1];
  return [Math.min(...values), Math.max(...values)];
}

/** An empty plot: { element, x, y, layer } with its axes drawn; `layer` is for what is plotted. */
export function axes({ label, x, y, height = 178 }) {
  const [right, bottom] = [WIDTH - MARGIN.right, height - MARGIN.bottom];
  const horizontal = new Axis(x, MARGIN.left, right);
  const vertical = new Axis(y, bottom, MARGIN.top);
  const line = (x1, y1, x2, y2, name) => svg('line', { x1, y1, x2, y2, class: name });
  const inner = horizontal.ticks(6).map((value) => {
    const place = horizontal.at(value);
    return svg('g', {}, line(place, MARGIN.top, place, bottom, 'grid'),
               svg('text', { x: place, y: bottom + 13, class: 'tick' }, horizontal.text(value)));
  }).concat(vertical.ticks(5).map((value) => {
    const place = vertical.at(value);
    return svg('g', {}, line(MARGIN.left, place, right, place, 'grid'),
               svg('text', { x: MARGIN.left - 5, y: place + 3.5, class: 'tick left' },
                   vertical.text(value)));
  }));
  const layer = svg('g', {});
  const element = svg('svg', { viewBox: `0 0 ${WIDTH} ${height}`, class: 'plot', role: 'img',
                               'aria-label': label, tabindex: 0 },
    ...inner, line(MARGIN.left, bottom, right, bottom, 'axis'),
    svg('text', { x: right, y: height - 4, class: 'caption end' }, horizontal.caption),
    svg('text', { x: 2, y: 11, class: 'caption' }, vertical.caption), layer);
  return { element, x: horizontal, y: vertical, layer };
}

/**
 * Lines against a common axis. `series`: [{ name, points: [[x, y], ...], kind }], `kind` a class of
 * the style sheet. `x` and `y` say `title`, `unit`, `scale` and, where the data do not, `low`, `high`.
 */
export function linePlot({ label, x, y, series, height }) {
  const bound = (axis, coordinate) => {
    const [low, most] = extent(series, coordinate, axis.scale);
    const high = coordinate === 1 && axis.scale !== 'log' ? most + HEADROOM * (most - Math.min(0, low)) : most;
    return { ...axis, low: axis.low ?? low, high: axis.high ?? high };
  };
  const plot = axes({ label, height, x: bound(x, 0), y: bound(y, 1) });
  for (const one of series) {
    plot.layer.append(svg('path', { d: pathOf(one.points, plot), class: `line ${one.kind}` }));
  }
  if (series.length > 1) plot.layer.append(legend(series));
  bindCursor(plot, series);
  return plot.element;
}

// Moves where a value is off the axes, as the logarithm of 0 is.
function pathOf(points, { x, y }) {
  let down = false;
  return points.map(([a, b]) => {
    const inside = x.has(a) && y.has(b);
    const step = inside ? `${down ? 'L' : 'M'}${x.at(a).toFixed(1)} ${y.at(b).toFixed(1)}` : '';
    down = inside;
    return step;
  }).join('');
}

function legend(series) {
  const wide = series.map(({ name }) => 22 + 5.6 * name.length);
  let right = WIDTH - MARGIN.right;
  return svg('g', { class: 'legend' }, ...series.map((one, i) => {
    const left = right - wide.slice(i).reduce((sum, width) => sum + width, 0);
    return svg('g', {},
      svg('line', { x1: left + 6, y1: 8, x2: left + 17, y2: 8, class: `line ${one.kind}` }),
      svg('text', { x: left + 21, y: 11, class: 'caption' }, one.name));
  }));
}

// The nearest point of the first series, and what all series have there.
function bindCursor({ element, x, y, layer }, series) {
  const points = series[0]?.points ?? [];
  if (!points.length) return;
  const rule = svg('line', { y1: y.to, y2: y.from, class: 'cursor' });
  const dots = series.map(({ kind }) => svg('circle', { r: 3, class: `dot-of ${kind}` }));
  const words = svg('text', { y: 23, class: 'caption reading' });
  const cursor = svg('g', { visibility: 'hidden', 'aria-hidden': 'true' }, rule, ...dots, words);
  layer.append(cursor);
  let chosen = Math.floor(points.length / 2);
  const show = (index) => {
    chosen = Math.min(points.length - 1, Math.max(0, index));
    const place = x.at(points[chosen][0]);
    const values = series.map(({ points: those }) => those[chosen]?.[1]);
    rule.setAttribute('x1', place);
    rule.setAttribute('x2', place);
    dots.forEach((dot, i) => {
      dot.setAttribute('visibility', y.has(values[i]) ? 'inherit' : 'hidden');
      if (!y.has(values[i])) return;
      dot.setAttribute('cx', place);
      dot.setAttribute('cy', y.at(values[i]));
    });
    const text = `${format(Number(points[chosen][0].toPrecision(4)))} ${x.unit}: ` +
      values.filter((value) => value !== undefined)
        .map((value) => format(Number(value.toPrecision(3)))).join(', ');
    const late = place > (x.from + x.to) / 2;
    words.textContent = text;
    words.setAttribute('x', late ? place - 5 : place + 5);
    words.classList.toggle('end', late);
    cursor.setAttribute('visibility', 'visible');
  };
  const hide = () => cursor.setAttribute('visibility', 'hidden');
  element.addEventListener('pointermove', (event) => {
    const box = element.getBoundingClientRect();
    const wanted = ((event.clientX - box.left) / box.width) * WIDTH;
    const gaps = points.map(([value]) => Math.abs(x.at(value) - wanted));
    show(gaps.indexOf(Math.min(...gaps)));
  });
  element.addEventListener('pointerleave', hide);
  element.addEventListener('focus', () => { if (element.matches(':focus-visible')) show(chosen); });
  element.addEventListener('blur', hide);
  element.addEventListener('keydown', (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    show(chosen + step * (event.shiftKey ? 10 : 1));
    element.setAttribute('aria-description', words.textContent);
  });
}
