// Elements in one call. Listeners are given as `onclick: f`, properties by their DOM names,
// everything with a dash as an attribute.

/** An element: `h('button', {type: 'button', onclick: f}, 'Go')`. */
export function h(tag, members = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(members)) {
    if (value === undefined || value === null) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name.includes('-') || name === 'for' || name === 'role') element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children.flat().filter((child) => child !== undefined && child !== null));
  return element;
}

/** An SVG element, its members all attributes: `svg('line', {x1: 0, class: 'grid'})`. */
export function svg(tag, attributes = {}, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** An icon of the page's own set, drawn as lines in a 24 x 24 box. */
export const icon = (name) =>
  svg('svg', { viewBox: '0 0 24 24', class: 'icon', 'aria-hidden': 'true' },
      svg('path', { d: ICONS[name] }));

const ICONS = {
  undo: 'M9 14 4 9l5-5M4 9h10.5a5.5 5.5 0 0 1 0 11H11',
  redo: 'm15 14 5-5-5-5M20 9H9.5a5.5 5.5 0 0 0 0 11H13',
  help: 'M9.1 9a3 3 0 1 1 4.4 2.7c-.9.5-1.5 1.200-1.5 2.300M12 17.5v.1M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18',
  close: 'M6 6l12 12M18 6 6 18',
  sliders: 'M4 7h9M19 7h1M4 17h1M11 17h9M16 4.5v5M8 14.5v5',
  reset: 'M4 4v6h6M4.6 10A8 8 0 1 1 4 14',
  info: 'M12 11v6M12 7.5v.1M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18',
  play: 'M8 5.5v13l10.500-6.500Z',
  stop: 'M7 7h10v10H7Z',
  pin: 'M9 4h6l-.8 6.500 3.300 3.500h-11l3.300-3.500ZM12 14v6',
  remove: 'M5 7h14M10 11v6M14 11v6M6.5 7l1 13h9l1-13M9 7V4h6v3',
};

/** Copies text to the clipboard; false where the browser does not allow it. */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

/** Hands a blob to the person as a file. */
export function saveFile(blob, name) {
  const address = URL.createObjectURL(blob);
  h('a', { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
}
