// The method's own options, and why it was chosen.

import { h } from './dom.js';
import { format } from './numbers.js';
import { equal } from './paths.js';

/** Schema nodes of a method's options, by path: they are listed by the daemon as data. */
export function optionNodes(method) {
  return Object.fromEntries((method.options ?? []).map((option) => [`method.${option.name}`, {
    type: option.integer ? 'integer' : 'number',
    title: option.title,
    description: option.description,
    minimum: option.minimum,
    maximum: option.maximum,
    default: option.default,
    'x-unit': option.unit,
    'x-slider': { minimum: option.minimum, maximum: option.maximum,
                  step: option.integer ? 1 : undefined,
                  scale: option.logarithmic && option.minimum > 0 ? 'log' : 'linear' },
  }]));
}

/** The settings among `options` that are not the method's defaults, in words. */
export function settingsInWords(methods, name, options) {
  const known = methods.find((one) => one.name === name)?.options ?? [];
  return known.map((option) => [option.name, options[option.name] ?? option.default, option.default])
    .filter(([, value, usual]) => value !== usual)
    .map(([option, value]) => `${option.replaceAll('_', ' ')} ${format(value)}`).join(', ');
}

export class MethodOptions {
  #drawn;

  /** `limits` is the element that says where the method falls short. */
  constructor(methods, state, controls, limits) {
    this.methods = methods;
    this.state = state;
    this.controls = controls;
    this.options = h('div', {});
    this.why = h('p', { className: 'help' });
    this.element = h('div', {}, this.options, this.why, limits);
    this.refresh();
  }

  /** Paths of all options of all methods. */
  static paths(methods) {
    return new Set(methods.flatMap((method) => Object.keys(optionNodes(method))));
  }

  refresh() {
    const name = this.state.value('method.name') ?? 'auto';
    if (equal(name, this.#drawn)) return;
    this.#drawn = name;
    const method = this.methods.find((one) => one.name === name);
    this.options.replaceChildren(...(method ? [
      h('p', { className: 'help' }, method.summary),
      ...Object.entries(optionNodes(method)).map(([path, node]) => this.controls.make(path, node)),
    ] : []));
  }

  /** Says what the plan says. */
  explain(plan) {
    const waves = plan.wavelengths_nm?.length;
    const options = settingsInWords(this.methods, plan.method, plan.options);
    const why = plan.why.replace(/ \([a-z_]+ [^)]*\)/, '');  // all of the method's options
    this.why.textContent = [why, options ? `Options: ${options}.` : '', waves ? `Wavelengths computed: ${waves}` +
      (waves <= 8 ? ` (${plan.wavelengths_nm.map(format).join(', ')} nm).` : '.') : '']
      .filter(Boolean).join(' ');
  }
}
