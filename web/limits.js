// Where the method of the frame on screen falls short in the scene that is seen: a word beside the
// frame's facts, and the limits themselves with the method's controls.

import { h } from './dom.js';
import { words } from './editors.js';

export class Limits {
  #plan = { limits: [] };

  /** `note` is the button beside the facts; `open()` brings what `element` is in into sight. */
  constructor({ view, note, open }) {
    Object.assign(this, { view, note });
    this.element = h('div', { className: 'limits', hidden: true });
    note.addEventListener('click', () => {
      open();
      this.element.scrollIntoView({ block: 'center' });
      this.element.querySelector('a').focus({ preventScroll: true });
    });
    view.addEventListener('frame', () => this.#label());
  }

  /** Says what the plan says. */
  show(plan) {
    this.#plan = plan;
    const { limits, method } = plan;
    this.element.hidden = !limits.length;
    this.element.replaceChildren(
      h('h3', {}, `Where ${words(method)} falls short in this sky`),
      h('ul', {}, limits.map((text) => h('li', {}, text))),
      h('a', { href: 'failures.html', target: '_blank', rel: 'noopener' }, 'Where all methods fail, measured'));
    this.#label();
  }

  // While the hand moves another method may be on screen, whose limits are others.
  #label() {
    const { limits, method } = this.#plan;
    this.note.hidden = !limits.length || this.view.facts?.method !== method;
    this.note.textContent = limits.length === 1 ? 'Near a limit' : `Near ${limits.length} limits`;
    this.note.title = limits.join('\n');
  }
}
