// Waiting for a daemon that is busy or away.

import { Busy, Gone } from './api.js';

const LONGEST_WAIT_MS = 5000;

export const isPassing = (error) => error instanceof Busy || error instanceof Gone;

/** How long to wait before attempt number `attempt` (from 1) after `error`. */
export function waitMs(error, attempt) {
  if (error instanceof Busy) return 1000 * error.retryAfterSeconds;
  return Math.min(LONGEST_WAIT_MS, 250 * 2 ** attempt);
}

/** The result of `ask()`, asked until the daemon answers; `onWait(error)` before each wait. */
export async function untilAnswered(ask, onWait) {
  for (let attempt = 1; ; ++attempt) {
    try {
      return await ask();
    } catch (error) {
      if (!isPassing(error)) throw error;
      onWait(error);
      await new Promise((resolve) => setTimeout(resolve, waitMs(error, attempt)));
    }
  }
}
