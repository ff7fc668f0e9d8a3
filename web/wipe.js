// Two skies on one window: left of a line the scene, right of it another. The line is dragged, or
// moved by arrow keys.

const STEP = { ArrowLeft: -0.02, ArrowRight: 0.02, ArrowDown: -0.02, ArrowUp: 0.02,
               Home: -1, End: 1, PageDown: -0.1, PageUp: 0.1 };

export class Wipe {
  #share = 0.5;

  /** @param other  the canvas that lies over the picture, right of the line */
  constructor(handle, other) {
    this.handle = handle;
    this.other = other;
    handle.addEventListener('pointerdown', (event) => {
      handle.setPointerCapture(event.pointerId);
      event.preventDefault();
      handle.focus({ preventScroll: true });
    });
    handle.addEventListener('pointermove', (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const box = other.getBoundingClientRect();
      this.#move((event.clientX - box.left) / box.width);
    });
    handle.addEventListener('keydown', (event) => {
      if (!(event.key in STEP)) return;
      event.preventDefault();
      event.stopPropagation();
      this.#move(this.#share + STEP[event.key]);
    });
  }

  /** Names what is left and right of the line. */
  show(left, right) {
    this.handle.dataset.left = left;
    this.handle.dataset.right = right;
    this.handle.hidden = this.other.hidden = false;
    this.#move(this.#share);
  }
  hide() {
    this.handle.hidden = this.other.hidden = true;
  }

  #move(share) {
    this.#share = Math.min(1, Math.max(0, share));
    const percent = `${(100 * this.#share).toFixed(2)}%`;
    this.other.style.clipPath = `inset(0 0 0 ${percent})`;
    this.handle.style.setProperty('--at', String(this.#share));
    this.handle.setAttribute('aria-valuenow', String(Math.round(100 * this.#share)));
    this.handle.setAttribute('aria-valuetext',
      `${Math.round(100 * this.#share)} % ${this.handle.dataset.left}`);
  }
}
