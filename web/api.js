// The daemon's HTTP interface: answers as values, failures as three kinds of error.

import { toQuery } from './paths.js';

/** The daemon read the request and refuses it (problem+json). */
export class Refused extends Error {
  constructor(problem, status) {
    super(problem.detail ?? problem.title ?? `The daemon answered ${status}.`);
    this.pointer = problem.pointer;
    this.status = status;
  }
}
/** The daemon has too much to do; it says after how many seconds to come back. */
export class Busy extends Error {
  constructor(retryAfterSeconds) {
    super('The daemon is busy.');
    this.retryAfterSeconds = retryAfterSeconds;
  }
}
/** Nobody answers. */
export class Gone extends Error {}

async function send(address, options = {}) {
  let answer;
  try {
    answer = await fetch(address, options);
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Gone('The daemon does not answer.');
  }
  if (answer.ok) return answer;
  if (answer.status === 429 || answer.status === 503) {
    throw new Busy(Number(answer.headers.get('Retry-After')) || 1);
  }
  if (answer.status >= 502 && answer.status !== 504) throw new Gone('The daemon does not answer.');
  throw new Refused(await answer.json().catch(() => ({})), answer.status);
}

async function readBody(read) {
  try {
    return await read();
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Gone('The daemon went away in the middle of an answer.');
  }
}

const post = (address, body, signal) => send(address, {
  method: 'POST', body: JSON.stringify(body), signal, headers: { 'Content-Type': 'application/json' },
});

/** What there is: `schema`, `presets`, `methods`, `limits`. */
export async function list(what) {
  const answer = await send(`/v1/${what}`);
  return readBody(() => answer.json());
}

/** The canonical scene and what would be done for it. */
export async function plan(scene, signal) {
  const answer = await post('/v1/plan', scene, signal);
  return readBody(() => answer.json());
}

/** The image of a scene, and what the daemon says of it. */
export async function render(scene, signal) {
  const answer = await post('/v1/render', scene, signal);
  const blob = await readBody(() => answer.blob());
  return { blob, facts: readFacts(answer.headers) };
}

/** The address of the same image, for links and thumbnails. */
export const renderAddress = (scene) => `/v1/render?${toQuery(scene)}`;

function readFacts(headers) {
  const timing = headers.get('Server-Timing') ?? '';
  const facts = {};
  for (const [, stage, milliseconds] of timing.matchAll(/(\w+)\s*;[^,]*?dur=([\d.eE+-]+)/g)) {
    facts[`${stage}Ms`] = Number(milliseconds);
  }
  return {
    ...facts,
    method: headers.get('Cyanometer-Method'),
    options: headers.get('Cyanometer-Options'),
    error: headers.get('Cyanometer-Error'),
    met: headers.get('Cyanometer-Met'),
    exposure: headers.get('Cyanometer-Exposure'),
  };
}

/** The words for a failure, for a person. */
export function inWords(error) {
  if (error instanceof Busy) {
    return `The daemon is busy; trying again in ${error.retryAfterSeconds} s.`;
  }
  if (error instanceof Gone) return 'The daemon does not answer; trying again.';
  return error.message;
}
