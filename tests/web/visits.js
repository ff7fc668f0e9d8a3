// Tests by somebody who has just arrived.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Daemon, openBrowser, Person } from './person.js';

/**
 * A daemon and a browser for the tests of a file. Returns `visit(size, sentence, steps, options)`: a
 * test in which `steps(person, page, daemon)` are taken; the console must stay silent, but for what
 * `options.expected` matches.
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
  return (size, sentence, steps, { expected, ...options } = {}) => test(`${size}: ${sentence}`, async () => {
    const person = await Person.arrive(browser, daemon, size, options);
    try {
      await steps(person, person.page, daemon);
      const unexpected = person.complaints.filter((text) => !expected?.test(text));
      assert.deepEqual(unexpected, []);
    } finally {
      await person.leave();
    }
  });
}
