// What somebody does who has just arrived: a test at each size, or material for who collects them.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Daemon, openBrowser, Person, SIZES } from './person.js';

let collected;

/** From here on visits become no tests: they are kept in the map that is returned, by sentence. */
export function collectVisits() {
  collected = new Map();
  return collected;
}

/** A daemon and a browser for the tests of a file, as `{ daemon, browser }` once they run. */
export function company() {
  const there = {};
  before(async () => {
    there.daemon = await Daemon.start();
    there.browser = await openBrowser();
  });
  after(async () => {
    await there.browser?.close();
    await there.daemon?.stop();
  });
  return there;
}

/**
 * Returns `visit(sentence, steps, options)`: a test at each size in which `steps(person, page, daemon)`
 * are taken; the console must stay silent, but for what `options.expected` matches. The other options
 * are those of an arrival.
 */
export function visits() {
  const there = collected ? undefined : company();
  return (sentence, steps, { expected, ...arrival } = {}) => {
    if (collected) {
      assert.ok(!collected.has(sentence), `twice: ${sentence}`);
      collected.set(sentence, { steps, arrival });
      return;
    }
    for (const size of Object.keys(SIZES)) {
      test(`${size}: ${sentence}`, async () => {
        const person = await Person.arrive(there, size, arrival);
        try {
          await steps(person, person.page, there.daemon);
          assert.deepEqual(person.complaints.filter((text) => !expected?.test(text)), []);
        } finally {
          await person.leave();
        }
      });
    }
  };
}
