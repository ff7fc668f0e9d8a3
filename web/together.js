// What belongs together and is moved together: a gas's temperature with its scale height, a haze's
// visibility with its optical depth, a list of values with the wavelengths that they are for.

import { h } from './dom.js';
import { number, switchBox } from './editors.js';
import { get } from './paths.js';
import { USUAL_PRIMARIES_NM } from './schema.js';

/** A spectrum, in any form, times a factor. */
export function scaled(spectrum, factor) {
  if (typeof spectrum === 'number') return tidy(spectrum * factor);
  if (Array.isArray(spectrum)) return spectrum.map((value) => tidy(value * factor));
  if (spectrum.power_law) {
    return { power_law: { ...spectrum.power_law, value: tidy(spectrum.power_law.value * factor) } };
  }
  if (spectrum.values) return { ...spectrum, values: spectrum.values.map((value) => tidy(value * factor)) };
  return { ...spectrum, value: tidy(spectrum.value * factor) };
}
const tidy = (value) => Number(value.toPrecision(6));

/** One number of a spectrum, by which two of one form are compared. */
export const sizeOf = (spectrum) => (typeof spectrum === 'number' ? spectrum
  : Array.isArray(spectrum) ? spectrum[0]
  : spectrum?.power_law?.value ?? spectrum?.values?.[0] ?? spectrum?.value);

const VISIBILITY = { type: 'number', minimum: 0.01, maximum: 1000, 'x-unit': 'km',
                     'x-slider': { minimum: 0.5, maximum: 300, scale: 'log' } };

const VISIBILITY_HELP =
  'How far a black object is seen through the haze at the ground; moves with the optical depth';

/**
 * A slider of the visibility that an optical depth amounts to, and back: moving one moves the other.
 * The daemon says what visibility the haze had; that is inverse to its optical depth.
 */
export function linkedVisibility(path, state, optics, name) {
  const visibility = () => {
    const known = optics.answer?.constituents[name]?.visibility_km;
    const [then, now] = [optics.scene && get(optics.scene, path), state.value(path)].map(sizeOf);
    return known && then > 0 && now > 0 ? known * (then / now) : undefined;
  };
  const editor = number(VISIBILITY, {
    label: 'Visibility', get: visibility, complain: () => {},
    set: (value) => {
      const now = visibility();
      if (now > 0 && value > 0) state.edit({ [path]: scaled(state.value(path), now / value) });
    },
  });
  const element = h('div', { className: 'control linked' },
    h('div', { className: 'head' }, h('span', { className: 'title', title: VISIBILITY_HELP }, 'Visibility')),
    editor.element);
  return { element, refresh: () => editor.refresh() };
}

const TIE_HELP = 'Warm air reaches higher: the scale height is proportional to the temperature';

/**
 * What an edit brings along: `companions(path, value, node)`, `node` describing the member. A switch ties a
 * gas's scale height to its temperature: H = kT / (m g), so both go by the same factor.
 */
export class Ties {
  #tied = new Set();  // paths of constituents

  constructor(state, schema) {
    this.state = state;
    this.schema = schema;
  }

  companions(path, value, node) {
    if (this.#isListWithoutWavelengths(value, node)) {
      return { 'spectrum.wavelengths_nm': USUAL_PRIMARIES_NM };
    }
    const root = path.split('.').slice(0, -1).join('.');
    if (!this.#tied.has(root)) return {};
    const gas = this.state.value(root) ?? {};
    const height = gas.profile?.scale_height_km;
    if (path.endsWith('.temperature_k') && height > 0 && gas.temperature_k > 0 && value > 0) {
      const reached = tidy((height * value) / gas.temperature_k);
      return { [`${root}.profile`]: { ...gas.profile, scale_height_km: reached } };
    }
    if (path.endsWith('.profile') && height > 0 && value.scale_height_km > 0 && gas.temperature_k > 0) {
      return { [`${root}.temperature_k`]: tidy((gas.temperature_k * value.scale_height_km) / height) };
    }
    return {};
  }

  // Red, green and blue are values at three wavelengths: where the scene leaves them open, the usual.
  #isListWithoutWavelengths(value, node) {
    return Array.isArray(value) && this.schema.isSpectrum(node) &&
      !Array.isArray(this.state.value('spectrum.wavelengths_nm'));
  }

  /** The switch for the constituent at `root`. */
  row(root) {
    const box = switchBox('Move temperature and scale height together',
                          (on) => (on ? this.#tied.add(root) : this.#tied.delete(root)));
    box.checked = this.#tied.has(root);
    return h('div', { className: 'control row linked' },
      h('span', { className: 'title', title: TIE_HELP }, 'Temperature with scale height'), box);
  }
}
