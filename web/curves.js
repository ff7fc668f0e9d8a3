// A constituent as curves: density against altitude, phase around the particle, coefficients against
// wavelength. The daemon computes them; one look at a time is drawn in each card.

import { optics } from './api.js';
import { h } from './dom.js';
import { linePlot } from './plot.js';
import { polarPlot } from './polar.js';
import { segmented } from './segmented.js';
import { Task } from './task.js';

/** The curves of the scene on screen, asked for while somebody looks. Event: `curves`. */
export class Optics extends EventTarget {
  #task = new Task();
  #for = '';

  /** The daemon's answer, undefined before the first, and the whole scene that it is for. */
  answer;
  scene;

  constructor(state) {
    super();
    this.state = state;
  }

  async refresh() {
    const { preset, atmosphere, planet, spectrum } = this.state.document();
    const whole = this.state.scene();
    const scene = Object.fromEntries(Object.entries({ preset, atmosphere, planet, spectrum })
      .filter(([, member]) => member !== undefined));
    const key = JSON.stringify(scene);
    if (key === this.#for) return;
    this.#for = key;
    try {
      const answer = await this.#task.run((signal) => optics(scene, signal));
      if (!answer) return;
      this.answer = answer;
      this.scene = whole;
      this.dispatchEvent(new Event('curves'));
    } catch {
      this.#for = '';  // the frame is refused for the same reason, and says so
    }
  }
}

const LOOKS = [['profile', 'Profile'], ['phase', 'Phase'], ['coefficient', 'Spectrum']];

/** Draws the curves of the constituent `name`: { element, refresh() }. */
export function curvesOf(optics, name) {
  const place = h('div', { className: 'result' });
  const refresh = () => {
    const curves = optics.answer?.constituents[name];
    const drawn = curves && DRAW[looks.value](curves, optics.answer);
    place.replaceChildren(drawn ?? h('p', { className: 'help' }, curves ? 'It does not scatter.' : ''));
  };
  const looks = segmented('Curves', LOOKS, refresh);
  return { element: h('div', { className: 'curves' }, looks.element, place), refresh };
}

const DRAW = { profile: drawProfile, phase: drawPhase, coefficient: drawCoefficient };

function drawProfile({ density }, { altitude_km: altitudes }) {
  // To where nothing is left of it.
  const last = density.findLastIndex((value) => value > 1e-4);
  const end = Math.min(altitudes.length, Math.max(3, last + 2));
  return linePlot({
    label: 'Density against altitude', height: 190,
    x: { title: 'density, relative', low: 0, high: 1 },
    y: { title: 'altitude', unit: 'km', low: 0 },
    series: [{ name: 'Density', kind: 'main',
               points: density.slice(0, end).map((value, i) => [value, altitudes[i]]) }],
  });
}

const KINDS = ['short', 'middle', 'long'];

function drawPhase({ phase }, { angle_deg, phase_wavelengths_nm: wavelengths }) {
  if (!phase) return undefined;
  const order = wavelengths.map((_, i) => i).sort((a, b) => wavelengths[a] - wavelengths[b]);
  const kinds = order.length === 3 ? KINDS : KINDS.slice(1);
  const all = order
    .map((i, rank) => ({ name: `${Math.round(wavelengths[i])} nm`, values: phase[i], kind: kinds[rank] }))
    .filter(({ values }) => values.some((value) => value > 0));
  const same = all.every(({ values }) => values.every((value, i) => close(value, all[0].values[i])));
  const series = same ? [{ ...all[0], name: 'all wavelengths', kind: 'main' }] : all;
  return polarPlot({ label: 'Phase function against scattering angle', angle_deg, series });
}
const close = (a, b) => Math.abs(a - b) <= 1e-3 * Math.max(Math.abs(a), Math.abs(b));

function drawCoefficient(curves, { wavelengths_nm: wavelengths }) {
  const { scattering_per_km: scattering, absorption_per_km: absorption } = curves;
  const along = (values) => values.map((value, i) => [wavelengths[i], value]).sort(([a], [b]) => a - b);
  const series = [{ name: 'scattering', kind: 'main', points: along(scattering) },
                  { name: 'absorption', kind: 'second', points: along(absorption) }]
    .filter(({ points }) => points.some(([, value]) => value > 0));
  const title = series.length > 1 ? 'where it is densest' : series[0]?.name ?? '';
  return linePlot({ label: 'Coefficients against wavelength', height: 190, series,
                    x: { title: 'wavelength', unit: 'nm' }, y: { title, unit: 'km⁻¹', low: 0 } });
}
