// Every test of the page fails when its feature is taken out.

import assert from 'node:assert/strict';
import { readdir } from 'node:fs/promises';
import { test } from 'node:test';

import { Person, SIZES } from '../web/person.js';
import { collectVisits, company } from '../web/visits.js';
import { BREAKAGES } from './breakages.js';

// What waits in vain need not do so for long: what is there comes sooner, or is shown to.
const PATIENCE_MS = 12000;

const visits = collectVisits();
const tests = new URL('../web/', import.meta.url);
for (const file of await readdir(tests)) {
  if (file.endsWith('.test.js')) await import(new URL(file, tests));
}
const there = company();
const sizesOf = ({ size }) => (size ? [size] : Object.keys(SIZES));

/** What `sentence` complains of at a size, on a page that may be broken; undefined where it is content. */
async function complaint(sentence, size, breakage) {
  const { steps, arrival } = visits.get(sentence);
  const person = await Person.arrive(there, size, { ...arrival, breakage, patience: PATIENCE_MS });
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

const content = new Set();  // tests that were seen to pass with as little patience
for (const { sentence, without, ...breakage } of BREAKAGES) {
  for (const size of sizesOf(breakage)) {
    test(`${size}: ${sentence} - not without ${without}`, async (context) => {
      const error = await complaint(sentence, size, breakage);
      assert.ok(error, 'nothing was noticed');
      context.diagnostic(String(error.message).replace(/\s+/g, ' ').slice(0, 160));
      // Who waited in vain may only have waited too little.
      const name = `${size}: ${sentence}`;
      if (error.code === 'ERR_ASSERTION' || content.has(name)) return;
      assert.equal(await complaint(sentence, size), undefined, 'as it is it fails as well');
      content.add(name);
    });
  }
}
