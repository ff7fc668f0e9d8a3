// A result stays to be read when the sky has changed: it says that it is of an earlier one.

import { h } from './dom.js';

/** Marks the result in `place` as of the sky before a change, or no longer. */
export function markStale(place, stale) {
  place.classList.toggle('stale', stale);
  const words = place.querySelector(':scope > .stale-words');
  if (!stale) words?.remove();
  else if (!words) place.prepend(h('p', { className: 'stale-words' }, 'Of the sky as it was before.'));
}
