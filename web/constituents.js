// What the air is made of: a card for each constituent, with its sliders, its curves and a switch.

import { curvesOf, Optics } from './curves.js';
import { h, icon } from './dom.js';
import { switchBox, words } from './editors.js';
import { equal, flatten, get } from './paths.js';
import { linkedVisibility, Ties } from './together.js';

const ROOT = 'atmosphere.constituents';

// Members that may stay away from the way of saying how much there is that they belong to.
const OPTIONAL = new Set(['king_factor', 'single_scattering_albedo']);

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
  #live = [];  // curves and linked sliders of the cards

  constructor(state, schema, controls) {
    this.state = state;
    this.schema = schema;
    this.controls = controls;
    this.optics = new Optics(state);
    this.optics.addEventListener('curves', () => this.#live.forEach((one) => one.refresh()));
    this.ties = new Ties(state, schema);
    this.list = h('div', { className: 'cards' });
    this.element = h('div', {}, this.list, this.#addMenu());
    this.refresh();
  }

  /** Draws the cards again where what there is has changed, not only its numbers. */
  refresh() {
    this.#look();
    const cards = this.#cards();
    const shape = cards.map(([name, value, on]) => [name, on, ...shapeOf(value)]);
    if (equal(shape, this.#drawn)) return;
    this.#drawn = shape;
    const open = new Set([...this.list.querySelectorAll('details[open]')]
      .map((details) => details.parentElement.dataset.name));
    const focus = focusIn(this.list);
    this.#live = [];
    this.list.replaceChildren(...cards.map((card) => this.#card(...card, open)));
    focus();
    this.#live.forEach((one) => one.refresh());
  }

  // Curves are asked for while a card is open.
  #look() {
    if (this.list.querySelector('details[open]')) this.optics.refresh();
  }

  // [name, value, on]: those of the scene, and those that were switched off.
  #cards() {
    const present = this.state.value(ROOT) ?? {};
    const off = { ...get(this.state.base(), ROOT) };
    for (const [name, { value }] of this.#kept) off[name] = value;
    const absent = Object.keys(get(this.state.patch, ROOT) ?? {})
      .filter((name) => get(this.state.patch, `${ROOT}.${name}`) === null && off[name]);
    return [...Object.entries(present).filter(([, value]) => value)
              .map(([name, value]) => [name, value, true]),
            ...absent.map((name) => [name, off[name], false])]
      .sort(([a], [b]) => (a < b ? -1 : 1));
  }

  #card(name, value, on, open) {
    const path = `${ROOT}.${name}`;
    const type = this.#typeNode(value.type);
    const box = switchBox(`${words(name)} on`, (checked) => this.#switch(name, value, checked));
    box.checked = on;
    const added = !get(this.state.base(), path);
    const details = h('details', { open: on && open.has(name), ontoggle: () => this.#look() },
      h('summary', {}, h('span', { className: 'dot' }), h('span', { className: 'name' }, words(name)),
        h('span', { className: 'quiet', title: type?.title ?? '' }, words(value.type))),
      h('div', { className: 'body' }, on && type ? this.#fields(path, value, type) : null,
        added ? h('button', { type: 'button', className: 'plain', onclick: () => this.#remove(name) },
                  icon('remove'), `Remove ${words(name)}`) : null));
    return h('div', { className: `card ${value.type}${on ? '' : ' off'}`, 'data-name': name },
             details, box);
  }

  #fields(path, value, type) {
    const members = Object.fromEntries(this.schema.members(type));
    const ways = waysToDescribe(this.schema.alternatives(type), members);
    const current = ways.find(({ names }) => names.some((m) => !OPTIONAL.has(m) && m in value));
    const alternatives = new Set(ways.flatMap(({ names }) => names));
    const shown = Object.keys(members)
      .filter((name) => !('const' in members[name]))
      .filter((name) => !alternatives.has(name) ||
                        (current?.names.includes(name) && applies(name, value)));
    return [
      ways.length > 1 && current ? this.#wayChoice(path, ways, current, members) : null,
      ...shown.map((name) => this.controls.make(`${path}.${name}`, members[name])),
      ...this.#together(path, value),
      this.#keep(curvesOf(this.optics, path.slice(ROOT.length + 1))),
    ];
  }

  #together(path, value) {
    const name = path.slice(ROOT.length + 1);
    if ('optical_depth' in value) {
      return [this.#keep(linkedVisibility(`${path}.optical_depth`, this.state, this.optics, name))];
    }
    return hasTie(value) ? [this.ties.row(path)] : [];
  }
  #keep(live) {
    this.#live.push(live);
    return live.element;
  }

  // The document takes one of the ways at a time: choosing one lets go of the others.
  #wayChoice(path, ways, current, members) {
    const choose = ({ names }) => {
      const edits = {};
      for (const name of ways.flatMap((way) => way.names)) edits[`${path}.${name}`] = undefined;
      for (const name of names.filter((one) => !OPTIONAL.has(one))) {
        edits[`${path}.${name}`] = this.schema.initial(members[name]);
      }
      this.state.edit(edits);
    };
    const select = h('select', { 'aria-label': 'Given by',
                                 onchange: () => choose(ways[select.selectedIndex]) },
      ways.map((way) => h('option', { selected: way === current }, way.title)));
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
      // Back to what is inherited, and from there by the changes that there were.
      const changes = flatten(kept?.patch ?? {}, `${path}.`);
      this.state.edit({ [path]: undefined, ...Object.fromEntries(changes) });
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

// What a card's controls depend on. The order of members is of no account: an edited one goes to the end.
const shapeOf = (value) =>
  [value.type, Object.keys(value).sort(), hasTie(value), typeof value.optical_depth?.at_nm];

const hasTie = (value) => 'temperature_k' in value && value.profile?.type === 'exponential';

// Gives the focus, where it is in `list`, to what stands for the same in the same card then.
function focusIn(list) {
  const was = document.activeElement;
  const card = list.contains(was) && was.closest('.card').dataset.name;
  if (!card) return () => {};
  const same = (one) => ['tagName', 'type', 'ariaLabel', 'textContent'].every((name) => one[name] === was[name]);
  return () => [...list.querySelectorAll(`[data-name=${card}] :is(summary, input, select, button, textarea)`)]
    .find(same)?.focus({ preventScroll: true });
}

/** [{title, names}]: the groups of alternative members, named after what is chosen first. */
function waysToDescribe(alternatives, members) {
  const ways = alternatives.flat().map((names) => {
    const known = names.filter((name) => name in members);
    const leading = known.find((name) => !('const' in members[name])) ?? known[0];
    return { title: members[leading]?.title ?? words(leading), names: known };
  });
  return ways.filter((way, i) => ways.findIndex((other) => other.title === way.title) === i);
}

// With Mie spheres and an optical depth at one wavelength, the albedo follows from Mie theory.
function applies(member, value) {
  return member !== 'single_scattering_albedo' || member in value ||
    typeof value.optical_depth?.at_nm !== 'number';
}
