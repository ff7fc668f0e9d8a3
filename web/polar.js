// A phase function around the scattering particle: light comes from the left, distance from the
// centre is the logarithm of what goes that way.

import { svg } from './dom.js';
import { powerOfTen } from './plot.js';

const WIDTH = 312;
const HEIGHT = 218;
const RADIUS = 92;
const MOST_DECADES = 5;

/** `series`: [{ name, kind, values }] by `angle_deg`, 1/sr. */
export function polarPlot({ label, angle_deg: angles, series }) {
  const positive = series.flatMap(({ values }) => values).filter((value) => value > 0);
  const high = Math.ceil(Math.log10(Math.max(...positive)));
  const low = Math.max(high - MOST_DECADES, Math.floor(Math.log10(Math.min(...positive))) - 1);
  const centre = { x: WIDTH / 2, y: HEIGHT / 2 + 4 };
  const radius = (value) => RADIUS *
    Math.max(0, (Math.log10(Math.max(value, 1e-300)) - low) / (high - low));
  const spot = (degrees, r) => {
    const angle = (degrees * Math.PI) / 180;
    return [centre.x + r * Math.cos(angle), centre.y - r * Math.sin(angle)];
  };
  const rings = Array.from({ length: high - low }, (_, i) => low + 1 + i).map((exponent) =>
    svg('g', {}, svg('circle', { cx: centre.x, cy: centre.y, r: radius(10 ** exponent), class: 'grid ring' }),
        svg('text', { x: centre.x + 3, y: centre.y - radius(10 ** exponent) - 2, class: 'tick left-of' },
            powerOfTen(exponent))));
  const spokes = [0, 30, 60, 90, 120, 150].map((degrees) => {
    const [[x1, y1], [x2, y2]] = [spot(degrees, RADIUS), spot(degrees + 180, RADIUS)];
    return svg('line', { x1, y1, x2, y2, class: 'grid' });
  });
  const around = [[0, 'forward', 'start'], [180, 'back', 'end']].map(([degrees, words, side]) => {
    const [x, y] = spot(degrees, RADIUS + 6);
    return svg('text', { x, y: y + 4, class: `caption ${side}` }, words);
  });
  const lines = series.map(({ kind, values }) => {
    const half = angles.map((angle, i) => [angle, radius(values[i])]);
    const whole = [...half, ...half.slice(1, -1).reverse().map(([angle, r]) => [-angle, r])];
    const d = whole.map(([angle, r], i) =>
      `${i ? 'L' : 'M'}${spot(angle, r).map((value) => value.toFixed(1)).join(' ')}`).join('');
    return svg('path', { d: `${d}Z`, class: `line ${kind}` });
  });
  const names = series.map(({ name, kind }, i) => svg('g', {},
    svg('line', { x1: 2, y1: 12 + 15 * i, x2: 13, y2: 12 + 15 * i, class: `line ${kind}` }),
    svg('text', { x: 17, y: 15.5 + 15 * i, class: 'caption' }, name)));
  return svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: 'plot', role: 'img', 'aria-label': label },
    ...spokes, ...rings, ...around, ...lines, ...names,
    svg('text', { x: WIDTH - 2, y: 12, class: 'caption end' }, '1/sr, logarithmic'));
}
