// A picture over the sky: an error by pixel, a picture of the person's own. One at a time.

import { h } from './dom.js';

// An error picture has its scale below its pixels: a row of that bar, and what lies beside it.
const BAR = { row: 12, side: 20 };
const LABELS = ['−100 %', '−1 %', '0.01 %', '+1 %', '+100 %'];

export class Overlay {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }

  /** Shows a picture instead of the sky. */
  show(bitmap, label) {
    this.#draw(bitmap, bitmap.width, bitmap.height, label);
  }

  /**
   * Shows the pixels of an error picture, `width` x `height` of it, and returns its scale as an
   * element.
   */
  showErrors(bitmap, { width, height }, label) {
    const bar = h('canvas', { width: bitmap.width - 2 * BAR.side, height: 1 });
    bar.getContext('2d').drawImage(bitmap, -BAR.side, -(height + BAR.row));
    this.#draw(bitmap, width, height, label);
    return h('div', { className: 'error-scale', role: 'img',
                      'aria-label': 'Scale of the error picture: blue too dark, red too bright' },
             bar, h('div', {}, LABELS.map((text) => h('span', {}, text))), 'Grey was not measured.');
  }

  #draw(bitmap, width, height, label) {
    this.canvas.width = width;
    this.canvas.height = height;
    this.context.drawImage(bitmap, -(bitmap.width - width) / 2, 0);
    bitmap.close();
    this.canvas.setAttribute('aria-label', label);
    this.canvas.hidden = false;
    // Rounding of the size must not show as bars.
    const shape = (width / height) * (this.canvas.clientHeight / this.canvas.clientWidth);
    this.canvas.classList.toggle('filling', Math.abs(shape - 1) < 0.02);
  }

  hide() {
    this.canvas.hidden = true;
  }
}
