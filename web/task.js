// Work for the daemon of which only the last is wanted: starting again gives up what went before.

import { untilAnswered } from './retry.js';

export class Task {
  #controller;

  get running() {
    return this.#controller !== undefined;
  }

  /**
   * The result of `ask(signal)`, asked until the daemon answers; `onWait(error)` before each wait.
   * Undefined where it was given up; what the daemon refuses is thrown.
   */
  async run(ask, onWait = () => {}) {
    this.stop();
    const controller = new AbortController();
    const { signal } = controller;
    this.#controller = controller;
    try {
      const answer = await untilAnswered(() => ask(signal), onWait, signal);
      return signal.aborted ? undefined : answer;
    } catch (error) {
      if (signal.aborted) return undefined;
      throw error;
    } finally {
      if (this.#controller === controller) this.#controller = undefined;
    }
  }

  stop() {
    this.#controller?.abort();
    this.#controller = undefined;
  }
}
