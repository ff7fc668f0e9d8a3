// Controls: an editor with its title, help, reset and complaints, bound to a member of the scene.

import { h, icon } from './dom.js';
import { editor, words } from './editors.js';

let count = 0;

/** All controls on the page, found by path: whom a refusal is for. */
export class Controls {
  #all = new Set();

  constructor(state, schema) {
    this.state = state;
    this.schema = schema;
    this.companions = () => ({});  // edits that an edit of a path, whose node is given, brings along
    this.most = () => Infinity;  // the most that a slider of a path reaches in this scene
  }

  /** A control for the member at `path`, described by `node`. */
  make(path, node) {
    const set = (value) => this.state.edit({ [path]: value, ...this.companions(path, value, node) });
    const most = () => this.most(path);
    const control = new Control(this.state, this.schema, path, this.schema.follow(node), { set, most });
    this.#all.add(control);
    return control.element;
  }

  refresh() {
    for (const control of this.#all) {
      if (control.element.isConnected) control.refresh();
      else this.#all.delete(control);
    }
  }

  /** Shows a message beside the control of `path` or the nearest one around it; true where that is seen. */
  complain(path, message) {
    this.forgive();
    const nearest = [...this.#all]
      .filter((one) => one.element.isConnected && (path + '.').startsWith(one.path + '.'))
      .sort((a, b) => b.path.length - a.path.length)[0];
    nearest?.complain(message);
    return nearest?.element.checkVisibility() ?? false;
  }
  forgive() {
    for (const control of this.#all) control.complain('');
  }
}

class Control {
  constructor(state, schema, path, node, { set, most }) {
    this.state = state;
    this.path = path;
    const id = `control-${++count}`;
    const title = node.title ?? words(path.split('.').pop());
    this.help = h('p', { className: 'help', id: `${id}-help`, hidden: true }, node.description ?? '');
    this.problem = h('p', { className: 'problem', role: 'alert', hidden: true });
    this.reset = h('button', {
      type: 'button', className: 'small', title: `Reset ${title}`, 'aria-label': `Reset ${title}`,
      hidden: true, onclick: () => state.edit({ [path]: undefined }),
    }, icon('reset'));
    this.editor = editor(schema, node, {
      label: title,
      get: () => state.value(path) ?? node.default,
      set,
      most,
      complain: (message) => this.complain(message),
    });
    this.element = h('div', { className: 'control', 'data-path': path },
      h('div', { className: 'head' },
        h('span', { className: 'title', title: node.description ?? '' }, title),
        node.description ? this.#helpButton(title) : null, this.reset),
      this.editor.element, this.help, this.problem);
    this.refresh();
  }

  #helpButton(title) {
    const button = h('button', {
      type: 'button', className: 'small what', 'aria-label': `What is ${title}?`,
      'aria-expanded': 'false', 'aria-controls': this.help.id,
      onclick: () => {
        this.help.hidden = !this.help.hidden;
        button.setAttribute('aria-expanded', String(!this.help.hidden));
      },
    }, icon('info'));
    return button;
  }

  complain(message) {
    this.problem.textContent = message;
    this.problem.hidden = !message;
    this.element.classList.toggle('refused', Boolean(message));
    if (message) this.#unfold();
  }
  #unfold() {
    const folded = () => this.element.closest('details:not([open])');
    for (let fold = folded(); fold; fold = folded()) fold.open = true;
  }

  refresh() {
    this.editor.refresh();
    this.reset.hidden = !this.state.isChanged(this.path);
  }
}
