// A daemon that is busy, away or of another opinion: clear words, the last picture, no reload.

import assert from 'node:assert/strict';

import { visits } from './visits.js';

const visit = visits();
const said = (page) => page.locator('#status').textContent();

visit('a busy daemon is asked again when it says', async (person, page) => {
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
  assert.equal(await said(page), '');
  assert.ok(asked[1] - asked[0] >= 1990, `${asked[1] - asked[0]} ms`);
}, { expected: /503/ });

visit('a daemon that went away comes back without a reload', async (person, page, daemon) => {
  const first = await person.look();
  await daemon.stop();
  await person.type('sun.elevation_deg', '8');
  await page.waitForFunction(() => /does not answer/.test(document.getElementById('status').textContent));
  assert.equal(await person.look(), first);
  await person.photograph('gone');
  await daemon.resume();
  await person.rest();
  assert.equal(await said(page), '');
  assert.notEqual(await person.look(), first);
}, { expected: /ERR_|Failed to fetch/ });

visit('a refusal is shown beside its control, under the last good picture', async (person, page) => {
  const first = await person.look();
  await person.type('sun.elevation_deg', '500');
  const problem = person.control('sun.elevation_deg').locator('.problem');
  await problem.waitFor();
  assert.match(await problem.innerText(), /90/);
  assert.match(await said(page), /last good picture/);
  assert.equal(await person.look(), first);
  await person.photograph('refused');
  await person.type('sun.elevation_deg', '9');
  await person.rest();
  assert.equal(await problem.isVisible(), false);
  assert.equal(await said(page), '');
}, { expected: /400/ });

visit('a refusal whose control is not seen is told over the picture', async (person, page) => {
  await page.locator('[data-group=sun] summary').click();
  await person.tab('Save');
  await page.evaluate(() => { location.hash = 'preset=earth&sun.elevation_deg=500'; });
  await page.waitForFunction(() => document.getElementById('status').dataset.kind === 'refused');
  assert.match(await said(page), /90, not 500/);
  await person.tab('Adjust');
  assert.ok(await person.control('sun.elevation_deg').locator('.problem').isVisible());
}, { expected: /400/ });
