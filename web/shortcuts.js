// Whether keys of a single character do something. Who speaks to a machine that types lets them rest.

const NAME = 'single-key-shortcuts';

// The browser may keep nothing for anybody: then the switch holds for as long as the page.
function kept() {
  try {
    return localStorage.getItem(NAME);
  } catch {
    return null;
  }
}
function keep(value) {
  try {
    localStorage.setItem(NAME, value);
  } catch {}
}

/** Makes `box` the switch: it says so, also at the next visit. */
export function bindShortcuts(box) {
  box.checked = kept() !== 'off';
  box.addEventListener('change', () => keep(box.checked ? 'on' : 'off'));
}
