// Tests by somebody who has just arrived.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Daemon, openBrowser, Person } from './person.js';

/**
 * A daemon and a browser for the tests of a file. Returns `visit(size, sentence, steps, options)`: a
 * test in which `steps(person, page)` are taken; the console must stay silent.
 */
export function visits() {
  let daemon;
  let browser;
  before(async () => {
    daemon = await Daemon.start();
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
    await daemon?.stop();
  });
  return (size, sentence, steps, options) => test(`${size}: ${sentence}`, async () => {
    const person = await Person.arrive(browser, daemon, size, options);
    try {
      await steps(person, person.page);
      assert.deepEqual(person.complaints, []);
    } finally {
      await person.leave();
    }
  });
}
