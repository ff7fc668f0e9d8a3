// An editor for each shape a schema node can have. An editor is `{ element, refresh() }`; it reads
// and writes through a binding `{ label, get(), set(value), complain(text) }`, where a slider may not reach
// its end also `most()`, and knows neither where its value lives nor what becomes of it.

import { h } from './dom.js';
import { format, parse, Scale, unitText, whyNoNumber } from './numbers.js';
import { spectrumCurve } from './spectrum.js';

const MOST_SLIDERS = 8;  // longer lists are edited as text

/** The editor for a node; `schema` follows its references. */
export function editor(schema, node, binding) {
  const forms = schema.forms(node);
  if (forms.length > 1 && forms.every((form) => form.enum || 'const' in form)) {
    return choice(forms.flatMap((form) => form.enum ?? [form.const]), [], binding);
  }
  if (forms.length > 1) return union(schema, forms, binding);
  const form = forms[0];
  if (form.enum) return choice(form.enum, form['x-titles'] ?? [], binding);
  if ('const' in form) return { element: h('span', { className: 'quiet' }), refresh() {} };
  if (form.type === 'boolean') return toggle(binding);
  if (form.type === 'number' || form.type === 'integer') return number(form, binding);
  if (form.type === 'array') return array(schema, form, binding);
  if (schema.isCurve(form)) return spectrumCurve(valueNode(form), binding);
  if (form.type === 'object') return members(schema, form, binding);
  return text(binding);
}

const valueNode = (form) => ({ 'x-slider': form['x-slider'], 'x-unit': form['x-unit'], minimum: form.minimum,
                               maximum: form.maximum, type: 'number' });

/** A slider with a number beside it. */
export function number(node, binding) {
  const scale = new Scale(node);
  const unit = unitText(node['x-unit']);
  const most = () => binding.most?.() ?? Infinity;
  const slider = h('input', {
    type: 'range', min: 0, max: scale.positions, step: scale.logarithmic ? 1 : 'any',
    'aria-label': binding.label,
    oninput: () => binding.set(Math.min(scale.toValue(Math.round(slider.valueAsNumber)), most())),
  });
  if (!scale.logarithmic) slider.step = 1;
  const typed = h('input', {
    type: 'text', inputMode: 'decimal', className: 'typed', autocomplete: 'off', spellcheck: false,
    'aria-label': unit ? `${binding.label}, ${node['x-unit']}` : binding.label,
    placeholder: node['x-default'] ? 'auto' : 'none',
    onchange: () => {
      typing.end();
      const value = parse(typed.value);
      if (value === undefined) binding.complain(whyNoNumber(typed.value));
      else binding.set(value);
    },
    onkeydown: (event) => {
      if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
      event.preventDefault();
      typing.end();
      const steps = (event.shiftKey ? 10 : 1) * (event.key === 'ArrowUp' ? 1 : -1);
      binding.set(Math.min(scale.stepped(binding.get(), steps), most()));
    },
    onfocus: () => typed.select(),
  });
  const typing = watchTyping(typed);
  return {
    element: h('div', { className: 'number' }, slider,
               h('span', { className: 'amount' }, typed, h('span', { className: 'unit' }, unit))),
    refresh() {
      const value = binding.get();
      const known = typeof value === 'number';
      slider.value = known ? scale.toPosition(value) : 0;
      slider.setAttribute('aria-valuetext', known ? `${format(value)} ${node['x-unit'] ?? ''}`
                                                  : 'automatic');
      slider.style.setProperty('--filled', `${(100 * slider.value) / scale.positions}%`);
      if (!typing.now) typed.value = known ? format(value) : '';
      slider.classList.toggle('unset', !known);
    },
  };
}

// What somebody is typing must not be overwritten by what the scene says meanwhile.
function watchTyping(field) {
  const typing = { now: false, end: () => { typing.now = false; } };
  field.addEventListener('input', () => { typing.now = true; });
  field.addEventListener('blur', typing.end);
  return typing;
}

function choice(values, titles, binding) {
  const select = h('select', {
    'aria-label': binding.label, onchange: () => binding.set(values[select.selectedIndex]),
  }, values.map((value, i) => h('option', {}, titles[i] ?? words(String(value)))));
  return {
    element: select,
    refresh() {
      select.selectedIndex = values.indexOf(binding.get());
    },
  };
}

function toggle(binding) {
  const box = switchBox(binding.label, (on) => binding.set(on));
  return { element: box, refresh: () => { box.checked = binding.get() === true; } };
}

/** A switch: a check box that looks like one. */
export function switchBox(label, onChange) {
  const box = h('input', {
    type: 'checkbox', role: 'switch', className: 'switch', 'aria-label': label,
    onchange: () => onChange(box.checked),
  });
  return box;
}

function array(schema, node, binding) {
  const items = schema.follow(node.items ?? {});
  if (items.enum) return checklist(items.enum, binding);
  if (node.prefixItems) return sliders(schema, node.prefixItems, binding);
  const length = binding.get()?.length ?? 0;
  if (!node['x-slider'] || length < 1 || length > MOST_SLIDERS) return text(binding);
  return sliders(schema, Array(length).fill({ 'x-slider': node['x-slider'], ...items }), binding);
}

function checklist(values, binding) {
  const boxes = values.map((value) => h('input', {
    type: 'checkbox', onchange: () => binding.set(values.filter((_, i) => boxes[i].checked)),
  }));
  return {
    element: h('div', { className: 'checklist', role: 'group', 'aria-label': binding.label },
               boxes.map((box, i) => h('label', {}, box, words(String(values[i]))))),
    refresh() {
      const chosen = binding.get() ?? [];
      boxes.forEach((box, i) => { box.checked = chosen.includes(values[i]); });
    },
  };
}

const PRIMARIES = ['red', 'green', 'blue'];

function sliders(schema, items, binding) {
  const { length } = items;
  const all = items.map((item, i) => editor(schema, item, {
    label: `${binding.label} ${length === 3 ? PRIMARIES[i] : i + 1}`,
    complain: binding.complain,
    get: () => binding.get()?.[i],
    set: (value) => binding.set(binding.get().map((old, k) => (k === i ? value : old))),
  }));
  if (length === 3) all.forEach((one, i) => one.element.classList.add(PRIMARIES[i]));
  return {
    element: h('div', { className: 'stack' }, all.map((one) => one.element)),
    refresh: () => all.forEach((one) => one.refresh()),
  };
}

/** The members of an object, each with its own small title. */
function members(schema, node, binding) {
  const rows = schema.members(node)
    .filter(([, below]) => !('const' in below))
    .map(([name, below]) => {
      const label = below.title ?? words(name);
      const one = editor(schema, below, {
        label: `${binding.label}: ${label}`,
        complain: binding.complain,
        get: () => binding.get()?.[name] ?? below.default,
        set: (value) => binding.set({ ...binding.get(), [name]: value }),
      });
      const bare = below.type === 'object';
      return { ...one, node: below, row: h('div', { className: 'member', title: below.description ?? '' },
                              bare ? null : h('span', { className: 'quiet' }, label), one.element) };
    });
  const stack = h('div', { className: 'stack' }, rows.map(({ row }) => row));
  const begin = h('button', { type: 'button', className: 'chip', 'aria-label': `Set ${binding.label}`,
                              onclick: () => binding.set(schema.initial(node)) }, 'Set');
  const optional = rows.every(({ node: below }) => below.default === undefined);
  return {
    element: h('div', { className: 'members' }, begin, stack),
    refresh() {
      begin.hidden = !optional || binding.get() !== undefined;
      stack.hidden = !begin.hidden;
      rows.forEach((one) => one.refresh());
    },
  };
}

/** A choice of form, and the editor of the chosen one. */
function union(schema, forms, binding) {
  let shown = -1;
  let inner;
  const place = h('div', { className: 'form' });
  const select = h('select', {
    className: 'form-choice', 'aria-label': `${binding.label}: form`,
    onchange: () => binding.set(schema.initial(forms[select.selectedIndex], binding.get())),
  }, forms.map((form) => h('option', {}, formTitle(form, schema))));
  return {
    element: h('div', { className: 'union' }, select, place),
    refresh() {
      const value = binding.get();
      const current = value === undefined ? 0 : schema.formOf(forms, value);
      const key = `${current}:${Array.isArray(value) ? value.length : ''}`;
      if (shown !== key) {
        shown = key;
        select.selectedIndex = current;
        inner = editor(schema, forms[current], binding);
        place.replaceChildren(inner.element);
      }
      inner.refresh();
    },
  };
}

const FORM_TITLES = { number: 'Number', integer: 'Number', array: 'List', string: 'Name',
                      blackbody_k: 'Black body', wavelengths_nm: 'Curve' };

function formTitle(form, schema) {
  if (form.type === 'array' && !form['x-order'] && schema.count() === 3) return 'Red, green, blue';
  if ('const' in form) return words(String(form.const));
  const tag = form.properties?.type?.const;
  if (tag) return words(tag);
  const [first] = form.required ?? [];
  return FORM_TITLES[form.type] ?? FORM_TITLES[first] ?? form.title ?? words(first ?? 'other');
}

/** Anything else, as JSON; a date and time may stand without its quotes. */
function text(binding) {
  const area = h('textarea', {
    rows: 1, spellcheck: false, 'aria-label': binding.label, onchange: () => {
      typing.end();
      try {
        binding.set(/^[[{"\d-]/.test(area.value.trim()) ? JSON.parse(area.value) : area.value);
      } catch {
        if (/^\d{4}-/.test(area.value)) binding.set(area.value.trim());
        else binding.complain('This is not JSON.');
      }
    },
  });
  const typing = watchTyping(area);
  return {
    element: area,
    refresh() {
      if (typing.now) return;
      const value = binding.get();
      area.value = value === undefined ? '' : typeof value === 'string' ? value
                                                                        : JSON.stringify(value);
    },
  };
}

const SPELLED = { cie: 'CIE', d65: 'D65', aces: 'ACES', agx: 'AgX', co2: 'CO₂', n2: 'N₂', h2: 'H₂',
                  he: 'He', ch4: 'CH₄', mie: 'Mie',
                  cornette_shanks: 'Cornette–Shanks', henyey_greenstein: 'Henyey–Greenstein' };

/** A name of the document as a person would write it. */
export function words(name) {
  if (SPELLED[name]) return SPELLED[name];
  const spaced = name.replaceAll('_', ' ');
  return spaced.charAt(0).toUpperCase() + spaced.slice(1);
}
