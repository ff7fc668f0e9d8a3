// Scene documents as values: members by dotted path, merge patches, links. Nothing here changes its
// arguments.

export const isObject = (value) =>
  value !== null && typeof value === 'object' && !Array.isArray(value);

/** The member at a dotted path, undefined where there is none. */
export function get(document, path) {
  return path.split('.').reduce((value, name) => value?.[name], document);
}

/** The document with the member at `path` set. */
export function set(document, path, value) {
  const [name, ...rest] = path.split('.');
  const below = rest.length ? set(document?.[name], rest.join('.'), value) : value;
  return { ...(isObject(document) ? document : {}), [name]: below };
}

/** The document without the member at `path`, and without objects that this leaves empty. */
export function unset(document, path) {
  if (!isObject(document)) return document;
  const [name, ...rest] = path.split('.');
  if (!(name in document)) return document;
  const { [name]: value, ...others } = document;
  if (!rest.length) return others;
  const below = unset(value, rest.join('.'));
  return isObject(below) && !Object.keys(below).length ? others : { ...document, [name]: below };
}

const SPECTRUM_FORMS = ['power_law', 'blackbody_k', 'values'];
const isSpectrum = (value) => isObject(value) && SPECTRUM_FORMS.some((form) => form in value);
const replacesWhole = (old, patch) =>
  !isObject(old) || isSpectrum(old) || isSpectrum(patch) ||
  ('type' in patch && 'type' in old && patch.type !== old.type);

/** The contract's merge: RFC 7396, spectra and objects of another `type` replaced whole. */
export function merge(document, patch) {
  if (!isObject(patch)) return patch;
  const merged = replacesWhole(document, patch) ? {} : { ...document };
  for (const [name, value] of Object.entries(patch)) {
    if (value === null) delete merged[name];
    else merged[name] = merge(merged[name], value);
  }
  return merged;
}

/** [path, leaf] of every member that is not an object, in document order. */
export function flatten(document, prefix = '') {
  return Object.entries(document).flatMap(([name, value]) =>
    isObject(value) && Object.keys(value).length ? flatten(value, `${prefix}${name}.`)
                                                 : [[prefix + name, value]]);
}

/** A leaf as the text of a link: JSON, except that strings which do not parse stay as they are. */
export function linkText(value) {
  if (typeof value !== 'string') return JSON.stringify(value);
  try {
    JSON.parse(value);
    return JSON.stringify(value);
  } catch {
    return value;
  }
}

/** The inverse of `linkText`. */
export function linkValue(text) {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

/** A document as the query of a link: `preset=mars&sun.elevation_deg=4`. */
export function toQuery(document) {
  return flatten(document)
    .map(([path, value]) => `${path}=${escapeValue(linkText(value))}`)
    .join('&');
}

/** The inverse of `toQuery`. */
export function fromQuery(query) {
  let document = {};
  for (const [path, text] of new URLSearchParams(query)) document = set(document, path, linkValue(text));
  return document;
}

// Links are read by people: leave what a query may hold unescaped.
const escapeValue = (text) =>
  encodeURIComponent(text).replace(/%(2C|3A|2F|40|24)/g, (escape) => decodeURIComponent(escape));

/** The dotted path of a JSON pointer. */
export const fromPointer = (pointer) => pointer.split('/').slice(1)
  .map((name) => name.replaceAll('~1', '/').replaceAll('~0', '~')).join('.');

export const equal = (a, b) => JSON.stringify(a) === JSON.stringify(b);
