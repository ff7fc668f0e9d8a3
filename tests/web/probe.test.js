// The probe: point at a pixel and read its light.

import assert from 'node:assert/strict';

import { visits } from './visits.js';

const visit = visits();

const value = (page, name) => page.locator(`#probe [data-figure="${name}"] dd`).innerText();
async function press(page, person, { x, y }) {
  const box = await page.locator('#picture').boundingBox();
  const spot = [box.x + x * box.width, box.y + y * box.height];
  if (person.size === 'phone') await page.touchscreen.tap(...spot);
  else await page.mouse.click(...spot);
}

visit('a pixel tells its spectrum, colour, luminance, transmittance and error', async (person, page) => {
  await person.tab('Probe');
  await press(page, person, { x: 0.5, y: 0.5 });
  await page.locator('#probe .plot').nth(1).waitFor();
  const pointed = await value(page, 'Direction');
  const [, elevation, azimuth] = pointed.match(/^([\d.]+)° up, ([\d.]+)° from north$/);
  assert.ok(Math.abs(elevation - 10) < 0.2, 'within a pixel of where the camera looks');
  assert.ok(Math.abs(((Number(azimuth) + 180) % 360) - 180) < 0.2, azimuth);
  assert.match(await value(page, 'Colour'), /#[0-9a-f]{6}/);
  assert.match(await value(page, 'Error'), /≤ [\d.]+ %/);
  const asked = { scene: { preset: 'earth' }, directions: [{ elevation_deg: 10, azimuth_deg: 0 }] };
  const answer = await (await fetch(new URL('/v1/radiance', page.url()),
                                    { method: 'POST', body: JSON.stringify(asked) })).json();
  const luminance = Number.parseFloat(await value(page, 'Luminance'));
  assert.ok(Math.abs(luminance / answer.luminance_cd_m2[0] - 1) < 0.02, `${luminance} cd/m²`);
  for (const [index, label] of [[0, /radiance/], [1, /Transmittance/]]) {
    const plot = page.locator('#probe .plot').nth(index);
    assert.match(await plot.getAttribute('aria-label'), label);
    const line = await plot.locator('path.line').getAttribute('d');
    assert.equal(line.match(/[ML]/g).length, answer.wavelengths_nm.length);
  }
  const picture = await page.locator('#picture').boundingBox();
  const ring = await page.locator('#mark').boundingBox();
  assert.ok(Math.abs(ring.x + ring.width / 2 - picture.width / 2) < 2);
  await person.photograph('probe');
  await person.drag({ x: 0.2, y: 0.7 }, { x: 0.3, y: 0.7 });
  await person.rest();
  const moved = await page.locator('#mark').boundingBox();
  assert.ok(moved.x > ring.x + 0.05 * picture.width, 'the ring stays in its direction');
  assert.equal(await value(page, 'Direction'), pointed);
});

visit('a plot reads its values off by keys', async (person, page) => {
  await page.locator('#picture').focus();
  await page.keyboard.press('p');
  const plot = page.locator('#probe .plot').first();
  await plot.waitFor();
  await plot.focus();
  const before = await plot.locator('.reading').textContent();
  await page.keyboard.press('ArrowRight');
  const after = await plot.locator('.reading').textContent();
  assert.notEqual(after, before);
  assert.match(after, /^\d+(\.\d+)? nm: [\d.]+/);
});

visit('a panorama is probed where it is pointed at', async (person, page) => {
  await person.tab('Probe');
  await press(page, person, { x: 0.25, y: 0.5 });
  await page.locator('#probe [data-figure=Direction]').waitFor();
  assert.match(await value(page, 'Direction'), /^−?0(\.\d+)?° up, (270|269\.\d|270\.\d)° from north$/);
}, { hash: '#preset=earth&camera.projection=equirectangular&camera.pitch_deg=0' });

visit('light of a sky that has changed behind the folded controls is asked for anew', async (person, page) => {
  await page.locator('#picture').focus();
  await page.keyboard.press('p');
  await page.locator('#probe .plot').first().waitFor();
  const before = await value(page, 'Linear R, G, B');
  await page.locator('#close').click();
  await page.locator('#picture').focus();
  for (let i = 0; i < 10; ++i) await page.keyboard.press('a');
  await person.settle();
  const { next } = await person.intercept('**/v1/radiance');
  await page.locator('#open').click();
  const route = await next();
  assert.equal(await page.locator('#probe .stale-words').count(), 1);
  await route.continue();
  await page.locator('#probe .stale-words').waitFor({ state: 'detached' });
  assert.notEqual(await value(page, 'Linear R, G, B'), before);
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]' });
