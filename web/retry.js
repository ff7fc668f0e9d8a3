// Waiting for a daemon that is busy or away.

import { Busy, Gone } from './api.js';

const LONGEST_WAIT_MS = 5000;

export const isPassing = (error) => error instanceof Busy || error instanceof Gone;

/** How long to wait before attempt number `attempt` (from 1) after `error`. */
export function waitMs(error, attempt) {
  if (error instanceof Busy) return 1000 * error.retryAfterSeconds;
  return Math.min(LONGEST_WAIT_MS, 250 * 2 ** attempt);
}

// Who gives up while waiting is not kept waiting.
const pause = (ms, signal) => new Promise((resolve) => {
  const timer = setTimeout(resolve, ms);
  signal?.addEventListener('abort', () => {
    clearTimeout(timer);
    resolve();
  }, { once: true });
});

/**
 * The result of `ask()`, asked until the daemon answers; `onWait(error)` before each wait.
 * @throws what the daemon refuses, and the reason of `signal` once that is aborted
 */
export async function untilAnswered(ask, onWait, signal) {
  for (let attempt = 1; ; ++attempt) {
    try {
      return await ask();
    } catch (error) {
      if (!isPassing(error)) throw error;
      signal?.throwIfAborted();
      onWait(error);
      await pause(waitMs(error, attempt), signal);
      signal?.throwIfAborted();
    }
  }
}
