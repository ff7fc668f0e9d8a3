// Reading the scene's JSON Schema: references, forms of a union, groups, first values.

import { isObject } from './paths.js';

export class Schema {
  constructor(root) {
    this.root = root;
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
      return below?.properties?.[name] ??
        (isObject(below?.additionalProperties) ? below.additionalProperties : undefined);
    }, this.root);
  }

  /** The alternative forms of a union, nested ones laid flat and `null` left out. */
  forms(node) {
    const followed = this.follow(node);
    const union = followed.oneOf ?? followed.anyOf;
    if (!union) return [followed];
    const shared = shareable(followed);
    return union.flatMap((form) => this.forms({ ...shared, ...this.follow(form) }))
      .filter((form) => form.type !== 'null' && form.const !== null);
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

  /** A value of the node's shape to start from. */
  initial(node) {
    const form = this.forms(node)[0];
    if (form.default !== undefined && this.fits(form, form.default)) return form.default;
    if ('const' in form) return form.const;
    if (form.enum) return form.enum[0];
    if (form.type === 'boolean') return false;
    if (form.type === 'number' || form.type === 'integer') return initialNumber(form);
    if (form.type === 'array') return this.#initialArray(form);
    if (form.format === 'date-time') return new Date().toISOString().replace(/\.\d+/, '');
    if (form.type === 'string') return '';
    const names = form.required ?? Object.keys(form.properties ?? {});
    return Object.fromEntries(names.map((name) => [name, this.initial(form.properties[name])]));
  }

  #initialArray(form) {
    const items = form.items ?? { type: 'number' };
    return Array.from({ length: Math.max(1, form.minItems ?? 1) }, () => this.initial(items));
  }

  /** [path, node] of every member that stands in a group (`x-group`), outermost first. */
  grouped(node = this.root, prefix = '') {
    return Object.entries(this.follow(node).properties ?? {}).flatMap(([name, below]) => {
      const followed = this.follow(below);
      const path = prefix + name;
      if (followed['x-group']) return [[path, followed]];
      return this.grouped(followed, `${path}.`);
    });
  }
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
