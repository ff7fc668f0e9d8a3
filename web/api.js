// The daemon's HTTP interface: answers as values, failures as three kinds of error.

import { Broken, readLines, readParts } from './multipart.js';
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

// The key that the last answer gave. Replicas behind one address go by it to where the tables are, so it is
// sent back; every address here is the page's own.
let atmosphere;

async function send(address, options = {}) {
  let answer;
  try {
    answer = await fetch(address, options);
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Gone('The daemon does not answer.');
  }
  atmosphere = answer.headers.get('Cyanometer-Atmosphere') ?? atmosphere;
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
    throw goneMidway();
  }
}
const goneMidway = () => new Gone('The daemon went away in the middle of an answer.');

// The same for answers in pieces, where what takes the pieces may fail too.
async function readPieces(read) {
  try {
    await read();
  } catch (error) {
    throw error instanceof Broken ? goneMidway() : error;
  }
}

const postBytes = (address, body, signal, headers) => send(address, { method: 'POST', body, signal, headers: {
  ...headers, ...(atmosphere && { 'Cyanometer-Atmosphere': atmosphere }) } });
const post = (address, body, signal, headers = {}) => postBytes(
  address, JSON.stringify(body), signal, { 'Content-Type': 'application/json', ...headers });

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

const postJson = async (address, body, signal) => {
  const answer = await post(address, body, signal);
  return readBody(() => answer.json());
};
const postPicture = async (address, body, signal, type = 'application/json') => {
  const answer = await postBytes(address, body, signal, { 'Content-Type': type, Accept: 'image/png' });
  return readBody(() => answer.blob());
};

/** Spectra and colours along directions: [{elevation_deg, azimuth_deg}]. */
export const radiance = (scene, directions, signal) =>
  postJson('/v1/radiance', { scene, directions }, signal);
/** The constituents as curves. */
export const optics = (scene, signal) => postJson('/v1/optics', scene, signal);
/** The sun over a place through a day. */
export const day = (place, signal) => postJson('/v1/day', place, signal);
/** How much the frame of `a` differs from that of `b`, in figures or as a picture. */
export const compare = (a, b, signal) => postJson('/v1/compare', { a, b }, signal);
export const compareAsPicture = (a, b, signal) =>
  postPicture('/v1/compare', JSON.stringify({ a, b }), signal);

/** A picture of the person's own (EXR bytes) against the scene, in figures or as a picture. */
export async function judge(scene, exr, signal) {
  const answer = await postBytes(`/v1/compare?${toQuery(scene)}`, exr, signal, { 'Content-Type': 'image/x-exr' });
  return readBody(() => answer.json());
}
export const judgeAsPicture = (scene, exr, signal) =>
  postPicture(`/v1/compare?${toQuery(scene)}`, exr, signal, 'image/x-exr');
/** The scene's air over a picture with distances. */
export const composite = (scene, exr, signal) =>
  postPicture(`/v1/composite?${toQuery(scene)}`, exr, signal, 'image/x-exr');

const eachLine = (answer, onLine) => readPieces(() => readLines(answer.body, (text) => {
  const line = JSON.parse(text);
  if (line.status) throw new Refused(line, line.status);
  onLine(line);
}));

/** Speed against accuracy: `onLine` gets what was charted, then point after point. */
export async function chart(scene, onLine, signal) {
  await eachLine(await post('/v1/chart', scene, signal), onLine);
}

// What a route finds that tells how far it is: `onProgress(share)` while it works.
async function worked(route, member, scene, onProgress, signal) {
  let found;
  const answer = await post(route, scene, signal, { Accept: 'application/x-ndjson' });
  await eachLine(answer, ({ progress, [member]: document }) => {
    onProgress(progress);
    found = document;
  });
  if (!found) throw goneMidway();
  return found;
}

/** What each ingredient is worth. */
export const explain = (scene, onProgress, signal) =>
  worked('/v1/explain', 'ingredients', scene, onProgress, signal);
/** Where the error of the scene's method comes from. */
export const attribute = (scene, onProgress, signal) =>
  worked('/v1/attribute', 'attribution', scene, onProgress, signal);

/** Frames of the scene with each of the patches: `onFrame(blob, facts, place)` from 0 on. */
export async function stream(scene, frames, onFrame, signal) {
  const answer = await post('/v1/stream', { scene, frames }, signal);
  await readPieces(() => readParts(answer.body, async ({ headers, bytes }) => {
    if (!headers.get('Content-Type')?.startsWith('image/')) {
      throw new Refused(JSON.parse(new TextDecoder().decode(bytes)), 500);
    }
    const place = Number.parseInt(headers.get('Cyanometer-Frame'), 10) - 1;
    await onFrame(new Blob([bytes], { type: headers.get('Content-Type') }), readFacts(headers), place);
  }));
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
    options: readOptions(headers.get('Cyanometer-Options') ?? ''),
    error: headers.get('Cyanometer-Error'),
    met: headers.get('Cyanometer-Met'),
    exposure: headers.get('Cyanometer-Exposure'),
  };
}

const readOptions = (text) => Object.fromEntries(text.split(';').filter(Boolean)
  .map((option) => option.trim().split('=')).map(([name, value]) => [name, Number(value)]));

/** The words for a failure, for a person. */
export function inWords(error) {
  if (error instanceof Busy) {
    return `The daemon is busy; trying again in ${error.retryAfterSeconds} s.`;
  }
  if (error instanceof Gone) return 'The daemon does not answer; trying again.';
  return error.message;
}
