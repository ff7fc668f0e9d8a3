// A picture over the sky: an error by pixel, a picture of the person's own. One at a time.

import { h } from './dom.js';

const LEGEND_PX = 36;  // at most, of an error picture's bar below its pixels

export class Overlay {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }

  /** Shows a picture instead of the sky. */
  async show(blob, label) {
    const bitmap = await createImageBitmap(blob);
    this.#draw(bitmap, bitmap.width, bitmap.height, label);
  }

  /**
   * Shows the pixels of an error picture, `width` x `height` of it, and returns its scale as an
   * element.
   */
  async showErrors(blob, { width, height }, label) {
    const bitmap = await createImageBitmap(blob);
    const bar = h('canvas', { className: 'error-scale', width: bitmap.width,
                              height: Math.min(LEGEND_PX, bitmap.height - height), role: 'img',
                              'aria-label': 'Scale of the error picture: blue too dark, red too bright' });
    bar.getContext('2d').drawImage(bitmap, 0, -height);
    this.#draw(bitmap, width, height, label);
    return bar;
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
