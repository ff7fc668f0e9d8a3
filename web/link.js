// The scene in the address bar, and as text to take away.

import { equal, fromQuery, isObject, toQuery, unset } from './paths.js';

const FIRST_PRESET = 'earth_sunset';
// The window decides the picture's size, the download its format.
const NOT_IN_LINKS = ['image.width', 'image.height', 'image.format', 'image.channels', 'image.layers'];

/** The scene that an address's hash names. */
export function readLink(hash) {
  const { preset, ...patch } = fromQuery(hash.replace(/^#/, ''));
  return {
    preset: typeof preset === 'string' && preset ? preset : FIRST_PRESET,
    patch: NOT_IN_LINKS.reduce(unset, patch),
  };
}

const linkOf = ({ preset, patch }) => `#${toQuery({ preset, ...patch })}`;

/** Keeps address and scene the same: every settled edit is a step back in the browser's history. */
export function bindAddress(state) {
  state.addEventListener('settle', () => {
    if (equal(readLink(location.hash), state.snapshot())) return;
    history.pushState({}, '', linkOf(state.snapshot()));
  });
  window.addEventListener('popstate', () => {
    const linked = readLink(location.hash);
    if (!equal(linked, state.snapshot())) state.load(linked);
  });
}

/** The scene as text: an address, JSON, a command, a program. */
export const texts = {
  Link: (state) => location.href.split('#')[0] + linkOf(state.snapshot()),
  JSON: (state) => JSON.stringify(state.document(), null, 2),
  curl: (state) => `curl -d '${shellQuoted(JSON.stringify(state.document()))}' \\\n` +
    `  ${location.origin}/v1/render -o sky.png`,
  Python: (state) => `import json, urllib.request

scene = ${python(state.document())}
request = urllib.request.Request(
    "${location.origin}/v1/render", json.dumps(scene).encode())
with urllib.request.urlopen(request) as answer, open("sky.png", "wb") as file:
    file.write(answer.read())
`,
};

const shellQuoted = (text) => text.replaceAll("'", "'\\''");

function python(value, indent = '') {
  if (value === null) return 'None';
  if (typeof value === 'boolean') return value ? 'True' : 'False';
  if (Array.isArray(value)) return `[${value.map((item) => python(item)).join(', ')}]`;
  if (!isObject(value)) return JSON.stringify(value);
  const inner = `${indent}    `;
  const members = Object.entries(value)
    .map(([name, member]) => `${inner}${JSON.stringify(name)}: ${python(member, inner)},\n`);
  return members.length ? `{\n${members.join('')}${indent}}` : '{}';
}
