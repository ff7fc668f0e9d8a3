// A daemon that is busy, away or of another opinion: clear words, the last picture, no reload.

import assert from 'node:assert/strict';

import { SIZES } from './person.js';
import { visits } from './visits.js';

const visit = visits();

/** Where the browser itself notes the answers that `expected` matches. */
function trouble(sentence, expected, steps) {
  for (const size of Object.keys(SIZES)) {
    visit(size, sentence,
          (person, page, daemon) => steps(person, page, page.locator('#status'), daemon), { expected });
  }
}

trouble('a busy daemon is asked again when it says', /503/, async (person, page, status) => {
  let refusals = 0;
  const asked = [];
  await page.route('**/v1/render', (route) => {
    asked.push(Date.now());
    if (refusals++) return route.continue();
    return route.fulfill({ status: 503, headers: { 'Retry-After': '2' },
                           contentType: 'application/problem+json',
                           body: '{"title":"Busy","status":503}' });
  });
  await person.type('sun.elevation_deg', '8');
  await page.waitForFunction(() => /busy/.test(document.getElementById('status').textContent));
  await person.photograph('busy');
  await person.rest();
  assert.equal(await status.textContent(), '');
  assert.ok(asked[1] - asked[0] >= 1990, `${asked[1] - asked[0]} ms`);
});

trouble('a daemon that went away comes back without a reload', /ERR_|Failed to fetch/,
  async (person, page, status, daemon) => {
    const first = await person.look();
    await daemon.stop();
    await person.type('sun.elevation_deg', '8');
    await page.waitForFunction(() => /does not answer/.test(document.getElementById('status').textContent));
    assert.equal(await person.look(), first);
    await person.photograph('gone');
    await daemon.resume();
    await person.rest();
    assert.equal(await status.textContent(), '');
    assert.notEqual(await person.look(), first);
  });

trouble('a refusal is shown beside its control, under the last good picture', /400/,
  async (person, page, status) => {
    const first = await person.look();
    await person.type('sun.elevation_deg', '500');
    const problem = person.control('sun.elevation_deg').locator('.problem');
    await problem.waitFor();
    assert.match(await problem.innerText(), /90/);
    assert.match(await status.innerText(), /last good picture/);
    assert.equal(await person.look(), first);
    await person.photograph('refused');
    await person.type('sun.elevation_deg', '9');
    await person.rest();
    assert.equal(await problem.isVisible(), false);
    assert.equal(await status.textContent(), '');
  });
