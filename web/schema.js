// Reading the scene's JSON Schema: references, forms of a union, groups, first values.
//
// Beside the standard keywords it says `x-group`, `x-unit`, `x-slider` (a comfortable range), `x-titles`
// (of an enum) and `x-alternatives` (groups of members of which one may be given).

import { isObject } from './paths.js';

// JSON has no order of its own. Members that are not named here come in the middle.
const FIRST = ['elevation_deg', 'azimuth_deg', 'angular_diameter_deg', 'irradiance', 'solar_distance_au',
               'altitude_km', 'heading_deg', 'pitch_deg', 'fov_deg', 'exposure_ev', 'tone_map', 'name',
               'optical_depth', 'visibility_km', 'scattering_per_km', 'absorption_per_km',
               'refractive_index', 'pressure_pa', 'temperature_k', 'value', 'latitude_deg',
               'longitude_deg', 'sidereal_time_deg'];
const LAST = ['phase', 'profile', 'disc_samples', 'distance_km', 'place'];
const rank = (name) => (FIRST.includes(name) ? FIRST.indexOf(name) - FIRST.length
                                             : LAST.indexOf(name) + 1);

export const USUAL_PRIMARIES_NM = [680, 550, 440];

export class Schema {
  /** `count()` is how many values a list needs that has one for each wavelength. */
  constructor(root, count) {
    this.root = root;
    this.count = () => count() ?? USUAL_PRIMARIES_NM.length;
  }

  /** The node with its references followed; its own keywords win over those it refers to. */
  follow(node) {
    if (!node?.$ref) return node;
    const { $ref, ...own } = node;
    const target = $ref.split('/').slice(1).reduce((below, name) => below[name], this.root);
    return { ...this.follow(target), ...own };
  }

  /** The node of a dotted path through `properties`, undefined where there is none. */
  at(path) {
    return path.split('.').reduce((node, name) => {
      const below = this.follow(node);
      return below?.properties?.[name] ?? Object.values(below?.patternProperties ?? {})[0];
    }, this.root);
  }

  /** The alternative forms of a union, nested ones laid flat and `null` left out. */
  forms(node) {
    const followed = this.follow(node);
    const union = followed.oneOf ?? followed.anyOf;
    if (!union) return [followed];
    const shared = shareable(followed);
    return union.flatMap((form) => this.forms({ ...shared, ...this.follow(form) }))
      .flatMap((form) => form.enum?.map((value) => ({ const: value })) ?? [form])
      .filter((form) => form.type !== 'null' && form.const !== null);
  }

  /** The members of an object form, what people reach for first in front. */
  members(form) {
    return Object.entries(form.properties ?? {}).sort(([a], [b]) => rank(a) - rank(b))
      .map(([name, below]) => {
        const member = this.follow(below);
        // What a slider of the whole is about, its `value` is too.
        const inherits = form['x-slider'] && (name === 'value' || name === 'power_law');
        return [name, inherits ? { 'x-slider': form['x-slider'], ...member } : member];
      });
  }

  /** The groups of members of which an object form takes one at a time. */
  alternatives(form) {
    return form['x-alternatives'] ?? [];
  }

  /** True where the node leaves nothing to choose. */
  isFixed(node) {
    const forms = this.forms(node);
    return forms.length === 1 && ('const' in forms[0] || (forms[0].type === 'object' &&
      this.members(forms[0]).every(([, member]) => 'const' in member)));
  }

  /** True for the form of a spectrum that is a curve of nodes. */
  isCurve(form) {
    return Boolean(form.properties?.wavelengths_nm && form.properties.values);
  }
  isSpectrum(node) {
    return this.forms(node).some((form) => this.isCurve(form));
  }

  /** Number of the first form that `value` has; 0 where it has none. */
  formOf(forms, value) {
    return Math.max(0, forms.findIndex((form) => this.fits(form, value)));
  }

  /** True where the shape (not the range) of `value` is the node's. */
  fits(node, value) {
    const form = this.follow(node);
    if (form.oneOf || form.anyOf) return this.forms(form).some((f) => this.fits(f, value));
    if ('const' in form) return form.const === value;
    if (form.enum) return form.enum.includes(value);
    if (form.type === 'number' || form.type === 'integer') return typeof value === 'number';
    if (form.type === 'array') return Array.isArray(value);
    if (form.type !== 'object') return typeof value === form.type;
    if (!isObject(value)) return false;
    return (form.required ?? []).every((name) => name in value) &&
      Object.entries(value).every(([name, member]) => {
        const below = form.properties?.[name];
        return below ? this.fits(below, member) : form.additionalProperties !== false;
      });
  }

  /** A value of the node's shape to start from, as near as can be to the value `like`. */
  initial(node, like) {
    const form = this.forms(node)[0];
    const size = magnitude(like);
    const usual = form.default ?? this.follow(node).default;
    if (size === undefined && usual !== undefined && this.fits(node, usual)) return usual;
    if ('const' in form) return form.const;
    if (form.enum) return form.enum[0];
    if (form.type === 'boolean') return false;
    if (form.type === 'number' || form.type === 'integer') return size ?? initialNumber(form);
    if (form.type === 'array') return this.#initialArray(form, size);
    if (form.type === 'string') return new Date().toISOString().replace(/\.\d+/, '');
    const members = this.members(form)
      .filter(([name]) => !form.required || form.required.includes(name));
    return Object.fromEntries(members.map(([name, member]) =>
      [name, INITIAL_OF[name] ?? this.initial(member, name in CARRIES ? size : undefined)]));
  }

  #initialArray(form, size) {
    if (form['x-order']) return USUAL_PRIMARIES_NM;
    const items = form.prefixItems ??
      Array(form.minItems === form.maxItems ? form.minItems : this.count()).fill(form.items);
    return items.map((item) => size ?? this.initial(item));
  }

  /** Paths of the members that may not be given beside `path`, the constituents' apart. */
  rivals(path) {
    const place = path.split('.').slice(0, -1).join('.');
    const name = path.slice(place.length + 1);
    const form = place ? this.follow(this.at(place)) : undefined;
    return this.alternatives(form ?? {}).filter((groups) => groups.flat().includes(name))
      .flatMap((groups) => groups.filter((group) => !group.includes(name)).flat())
      .map((rival) => `${place}.${rival}`);
  }

  /** [path, node] of every member of the document's sections, each of which says its `x-group`. */
  controllable() {
    return Object.entries(this.root.properties).flatMap(([section, node]) =>
      this.members(this.follow(node)).map(([name, member]) => [`${section}.${name}`, member]));
  }
}

// Where a spectrum's size goes when it takes another form, and what other parts, those of tables too, start from.
const CARRIES = { value: true, power_law: true };
const INITIAL_OF = { at_nm: 550, exponent: 0, wavelengths_nm: [400, 550, 700], values: [1, 1, 1],
                     angle_deg: [0, 90, 180], altitude_km: [0, 10, 100], density: [1, 0.3, 0] };

/** One number for how large a spectrum is, undefined where the value is something else. */
function magnitude(value) {
  if (typeof value === 'number') return value;
  if (Array.isArray(value)) return typeof value[0] === 'number' ? value[0] : undefined;
  return value?.power_law?.value;
}

// What a union says for all its forms.
function shareable({ 'x-unit': unit, 'x-slider': slider, minimum, maximum, default: value }) {
  return Object.fromEntries(Object.entries(
    { 'x-unit': unit, 'x-slider': slider, minimum, maximum, default: value })
    .filter(([, member]) => member !== undefined));
}

function initialNumber({ 'x-slider': slider, minimum = 0, maximum = 1 }) {
  const low = slider?.minimum ?? minimum;
  const high = slider?.maximum ?? maximum;
  if (slider?.scale === 'log' && low > 0) return Number(Math.sqrt(low * high).toPrecision(2));
  return Math.min(high, Math.max(low, 0));
}
