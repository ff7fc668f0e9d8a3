// What the air is made of: a card for each constituent, with its sliders and a switch.

import { h, icon } from './dom.js';
import { switchBox, words } from './editors.js';
import { equal, get } from './paths.js';

const ROOT = 'atmosphere.constituents';

// The ways to say how much of it there is; the document takes one of them at a time.
const DESCRIPTIONS = {
  molecules: {
    'The gas itself': ['refractive_index', 'pressure_pa', 'temperature_k', 'king_factor'],
    'Scattering coefficient': ['scattering_per_km'],
  },
  particles: {
    'Optical depth': ['optical_depth', 'single_scattering_albedo'],
    Visibility: ['visibility_km', 'single_scattering_albedo'],
    Coefficients: ['scattering_per_km', 'absorption_per_km'],
  },
  absorber: {
    'Ozone column': ['gas', 'dobson_units'],
    'Absorption coefficient': ['absorption_per_km'],
  },
};
const OPTIONAL = new Set(['king_factor', 'single_scattering_albedo']);
const FIXED = new Set(['type', 'gas']);

const TEMPLATES = {
  gas: {
    type: 'molecules', refractive_index: 'co2', pressure_pa: 20000, temperature_k: 288.15,
    profile: { type: 'exponential', scale_height_km: 8 },
  },
  haze: {
    type: 'particles', optical_depth: { power_law: { value: 0.2, at_nm: 550, exponent: -1.3 } },
    single_scattering_albedo: 0.95, phase: { type: 'cornette_shanks', g: 0.76 },
    profile: { type: 'exponential', scale_height_km: 1.2 },
  },
  dust: {
    type: 'particles', optical_depth: { value: 0.3, at_nm: 550 },
    phase: { type: 'mie', radius_um: 0.5, geometric_sigma: 1.8, refractive_index: [1.53, 0.003] },
    profile: { type: 'exponential', scale_height_km: 2.5 },
  },
  absorber: {
    type: 'absorber',
    absorption_per_km: { wavelengths_nm: [480, 600, 720], values: [0, 0.01, 0] },
    profile: { type: 'tent', centre_km: 25, half_width_km: 15 },
  },
};

export class Constituents {
  #kept = new Map();  // what was switched off: its card and the patch it had
  #drawn;

  constructor(state, schema, controls) {
    this.state = state;
    this.schema = schema;
    this.controls = controls;
    this.list = h('div', { className: 'cards' });
    this.element = h('div', {}, this.list, this.#addMenu());
    this.refresh();
  }

  /** Draws the cards again where what there is has changed, not only its numbers. */
  refresh() {
    const cards = this.#cards();
    const shape = cards.map(([name, value, on]) => [name, on, value.type, Object.keys(value)]);
    if (equal(shape, this.#drawn)) return;
    this.#drawn = shape;
    const open = new Set([...this.list.querySelectorAll('details[open]')].map((d) => d.dataset.name));
    this.list.replaceChildren(...cards.map((card) => this.#card(...card, open)));
  }

  // [name, value, on]: those of the scene, and those that were switched off.
  #cards() {
    const present = this.state.value(ROOT) ?? {};
    const off = { ...(get(this.state.base(), ROOT) ?? {}) };
    for (const [name, { value }] of this.#kept) off[name] = value;
    const absent = Object.keys(get(this.state.patch, ROOT) ?? {})
      .filter((name) => get(this.state.patch, `${ROOT}.${name}`) === null && off[name]);
    return [...Object.entries(present).map(([name, value]) => [name, value, true]),
            ...absent.map((name) => [name, off[name], false])]
      .sort(([a], [b]) => (a < b ? -1 : 1));
  }

  #card(name, value, on, open) {
    const path = `${ROOT}.${name}`;
    const type = this.#typeNode(value.type);
    const box = switchBox(`${words(name)} on`, (checked) => this.#switch(name, value, checked));
    box.checked = on;
    box.addEventListener('click', (event) => event.stopPropagation());
    const added = get(this.state.base(), path) === undefined;
    const card = h('details', { className: `card ${value.type}${on ? '' : ' off'}`, 'data-name': name,
                                open: on && open.has(name) },
      h('summary', {}, h('span', { className: 'dot' }), h('span', { className: 'name' }, words(name)),
        h('span', { className: 'quiet' }, type?.title ?? words(value.type)), box),
      h('div', { className: 'body' }, on && type ? this.#fields(path, value, type) : null,
        added ? h('button', { type: 'button', className: 'plain', onclick: () => this.#remove(name) },
                  icon('remove'), `Remove ${words(name)}`) : null));
    return card;
  }

  #fields(path, value, type) {
    const ways = DESCRIPTIONS[value.type] ?? {};
    const current = Object.entries(ways)
      .find(([, members]) => members.some((m) => !OPTIONAL.has(m) && m in value));
    const alternatives = new Set(Object.values(ways).flat());
    const shown = Object.keys(type.properties)
      .filter((member) => !FIXED.has(member))
      .filter((member) => (alternatives.has(member) ? current?.[1].includes(member) && applies(member, value)
                                                    : true));
    return [
      current ? this.#wayChoice(path, Object.keys(ways), current[0], ways, type) : null,
      ...shown.map((member) => this.controls.make(`${path}.${member}`, type.properties[member])),
    ];
  }

  #wayChoice(path, names, current, ways, type) {
    const select = h('select', { 'aria-label': 'Given by', onchange: () => {
      const chosen = ways[names[select.selectedIndex]];
      const edits = Object.fromEntries(Object.values(ways).flat().map((m) => [`${path}.${m}`, undefined]));
      for (const member of chosen.filter((m) => !OPTIONAL.has(m))) {
        edits[`${path}.${member}`] = this.schema.initial(type.properties[member]);
      }
      this.state.edit(edits);
    } }, names.map((name) => h('option', { selected: name === current }, name)));
    return h('div', { className: 'control row' }, h('span', { className: 'title' }, 'Given by'), select);
  }

  #typeNode(type) {
    const forms = this.schema.forms(this.schema.at(`${ROOT}.any`));
    return forms.find((form) => form.properties?.type?.const === type);
  }

  #switch(name, value, on) {
    const path = `${ROOT}.${name}`;
    if (!on) {
      this.#kept.set(name, { value, patch: get(this.state.patch, path) });
      this.state.edit({ [path]: null });
    } else {
      const kept = this.#kept.get(name);
      this.#kept.delete(name);
      this.state.edit({ [path]: kept?.patch ?? undefined });
    }
  }

  #remove(name) {
    this.#kept.delete(name);
    this.state.edit({ [`${ROOT}.${name}`]: undefined });
  }

  #addMenu() {
    const add = (template) => {
      const taken = this.state.value(ROOT) ?? {};
      const free = [template, ...Array.from({ length: 32 }, (_, i) => `${template}_${i + 2}`)]
        .find((name) => !(name in taken));
      this.state.edit({ [`${ROOT}.${free}`]: TEMPLATES[template] });
    };
    return h('div', { className: 'adders', role: 'group', 'aria-label': 'Add a constituent' },
      h('span', { className: 'quiet' }, 'Add'),
      Object.keys(TEMPLATES).map((template) => h('button', {
        type: 'button', className: 'chip', onclick: () => add(template) }, words(template))));
  }
}

// With Mie spheres and an optical depth at one wavelength, the albedo follows from Mie theory.
function applies(member, value) {
  return member !== 'single_scattering_albedo' || member in value ||
    typeof value.optical_depth?.at_nm !== 'number';
}
