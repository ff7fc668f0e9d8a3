// Every test of the page fails when its feature is taken out.

import assert from 'node:assert/strict';
import { readdir } from 'node:fs/promises';
import { test } from 'node:test';

import { Person, SIZES } from '../web/person.js';
import { collectVisits, company } from '../web/visits.js';
import { BREAKAGES } from './breakages.js';

// What waits in vain need not do so for long, where the whole page needs less; on a slow machine it may not.
const PATIENCES_MS = [12000, 40000, 90000];

const visits = collectVisits();
const tests = new URL('../web/', import.meta.url);
for (const file of await readdir(tests)) {
  if (file.endsWith('.test.js')) await import(new URL(file, tests));
}
const there = company();
const sizesOf = ({ size }) => (size ? [size] : Object.keys(SIZES));

/** What `sentence` complains of at a size, on a page that may be broken; undefined where it is content. */
async function complaint(sentence, size, patience, breakage) {
  const { steps, arrival } = visits.get(sentence);
  const person = await Person.arrive(there, size, { ...arrival, breakage, patience });
  try {
    await steps(person, person.page, there.daemon);
    return undefined;
  } catch (error) {
    return error;
  } finally {
    await person.leave();
    await there.daemon.resume();
  }
}

test('every test of the page has a breakage at each size, every breakage a test', () => {
  const broken = new Set(BREAKAGES.flatMap((one) => sizesOf(one).map((size) => `${size}: ${one.sentence}`)));
  const all = [...visits.keys()].flatMap((sentence) => Object.keys(SIZES).map((size) => `${size}: ${sentence}`));
  assert.deepEqual(all.filter((name) => !broken.has(name)), []);
  assert.deepEqual([...broken].filter((name) => !all.includes(name)), []);
});

test('every breakage finds its text in the page once', async () => {
  for (const { file, text } of BREAKAGES) {
    const answer = await fetch(new URL(file === 'index.html' ? '' : file, there.daemon.address));
    const times = text === undefined ? 1 : (await answer.text()).split(text).length - 1;
    assert.equal(times, 1, `${file}: ${text}`);
  }
});

const enough = {};  // the patience with which a test was seen to pass on the whole page, and is tried first

/** What is noticed of a breakage. Who waited in vain may only have waited too little: the whole page decides. */
async function noticed(sentence, size, breakage) {
  const name = `${size}: ${sentence}`;
  for (const patience of enough[name] ? [enough[name]] : PATIENCES_MS) {
    const error = await complaint(sentence, size, patience, breakage);
    if (error?.name !== 'TimeoutError' || enough[name]) return error;
    const whole = await complaint(sentence, size, patience);
    if (!whole) {
      enough[name] = patience;
      return error;
    }
    assert.equal(whole.name, 'TimeoutError', `on the whole page: ${whole.stack}`);
  }
  throw new Error('the test does not pass on the whole page');
}

for (const { sentence, without, ...breakage } of BREAKAGES) {
  for (const size of sizesOf(breakage)) {
    test(`${size}: ${sentence} - not without ${without}`, async (context) => {
      const error = await noticed(sentence, size, breakage);
      assert.ok(error, 'nothing was noticed');
      context.diagnostic(String(error.message).replace(/\s+/g, ' ').slice(0, 160));
    });
  }
}
