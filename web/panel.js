// The panel: tabs, folding, and one fold for each group of the schema.

import { h, icon } from './dom.js';

const byId = (id) => document.getElementById(id);

/**
 * Tabs and the fold. `select(id)` unfolds a tab and `showing(id)` says whether it is seen; elements
 * of tabs get `shown` and `hidden` events, by the fold too.
 */
export function bindPanel() {
  for (const [id, name] of [['undo', 'undo'], ['redo', 'redo'], ['show-help', 'help'],
                            ['close', 'close'], ['open', 'sliders']]) {
    byId(id).append(icon(name));
  }
  const tabs = [...document.querySelectorAll('[role=tab]')];
  let seen;
  const tell = () => {
    const page = byId('panel').hidden ? null : document.querySelector('[role=tabpanel]:not([hidden])');
    if (page === seen) return;
    seen?.dispatchEvent(new Event('hidden'));
    seen = page;
    seen?.dispatchEvent(new Event('shown'));
  };
  const select = (tab) => {
    for (const other of tabs) {
      const chosen = other === tab;
      other.setAttribute('aria-selected', String(chosen));
      other.tabIndex = chosen ? 0 : -1;
      byId(other.getAttribute('aria-controls')).hidden = !chosen;
    }
    tell();
  };
  tabs.forEach((tab, i) => {
    tab.addEventListener('click', () => select(tab));
    tab.addEventListener('keydown', (event) => {
      const next = { ArrowRight: tabs[(i + 1) % tabs.length], ArrowLeft: tabs.at(i - 1),
                     Home: tabs[0], End: tabs.at(-1) }[event.key];
      if (!next) return;
      event.preventDefault();
      select(next);
      next.focus();
    });
  });
  select(tabs.find((tab) => tab.getAttribute('aria-selected') === 'true'));

  const unfold = (open) => {
    byId('panel').hidden = !open;
    byId('open').hidden = open;
    byId('open').setAttribute('aria-expanded', String(open));
    document.body.classList.toggle('folded', !open);
    tell();
  };
  const show = (open) => {
    unfold(open);
    byId(open ? 'close' : 'open').focus({ preventScroll: true });
  };
  byId('close').addEventListener('click', () => show(false));
  byId('open').addEventListener('click', () => show(true));
  return {
    toggle: () => show(byId('panel').hidden),
    select: (id) => {
      select(byId(`tab-${id}`));
      unfold(true);
    },
    showing: (id) => !byId('panel').hidden && !byId(id).hidden,
  };
}

// The groups as people think; the constituents' own three share one fold with their cards.
const GROUPS = [
  ['sun', 'Sun'], ['day', 'Time and place'], ['atmosphere', 'Air, haze and ozone'], ['planet', 'Planet'], ['camera', 'Camera'],
  ['light', 'Light'], ['picture', 'Picture'], ['method', 'Method'],
];
const OPEN_AT_FIRST = new Set(['sun', 'atmosphere']);
const FOLD_OF_GROUP = { air: 'atmosphere', haze: 'atmosphere', ozone: 'atmosphere' };

// The picture's size and file belong to the download, the method's options to the method, and a
// place and a time to the strip of the day.
const ELSEWHERE =
  /^(image\.(width|height|format|channels|layers)|atmosphere\.constituents|sun\.place)$/;

/** Builds the folds. `extra` maps a fold's name to elements that follow its controls. */
export function buildFolds(schema, controls, methodOptions, extra) {
  const members = new Map(GROUPS.map(([name]) => [name, []]));
  for (const [path, node] of schema.controllable()) {
    if (ELSEWHERE.test(path) || methodOptions.has(path) || schema.isFixed(node)) continue;
    const group = FOLD_OF_GROUP[node['x-group']] ?? node['x-group'];
    members.get(members.has(group) ? group : 'picture').push(controls.make(path, node));
  }
  return GROUPS.map(([name, title]) =>
    h('details', { className: 'fold', open: OPEN_AT_FIRST.has(name), 'data-group': name },
      h('summary', {}, h('h2', {}, title)),
      h('div', { className: 'fold-body' }, members.get(name), extra[name] ?? [])));
}
