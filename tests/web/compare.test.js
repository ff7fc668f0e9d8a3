// Two skies against each other, what each part is worth, speed against accuracy, a picture of one's own.

import assert from 'node:assert/strict';

import { exrFile } from './exr_file.js';
import { visits } from './visits.js';

const visit = visits();
const FIXED = '#preset=earth&image.exposure_ev=0.5&spectrum.wavelengths_nm=[680,550,440]&method.name=hillaire';
const LEFT = { x: 0.3, y: 0.3 };
const RIGHT = { x: 0.62, y: 0.3 };

/** Waits until the figures beside the picture are there. */
async function figures(page) {
  await page.locator('#against-block [data-figure=error]').waitFor();
  return Number.parseFloat(await page.locator('#against-block [data-figure=error] dd').innerText());
}

/** Drops a file anywhere on the page. */
async function drop(page, name, bytes) {
  await page.evaluate(({ name: title, content }) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(atob(content), (c) => c.charCodeAt(0))], title));
    const event = (type) => new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true });
    document.body.dispatchEvent(event('dragover'));
    window.curtainSeen = !document.getElementById('drop').hidden;
    document.body.dispatchEvent(event('drop'));
  }, { name, content: bytes.toString('base64') });
  assert.equal(await page.evaluate(() => window.curtainSeen), true);
}

visit('a wipe shows the same sky by another method', async (person, page) => {
  await person.tab('Compare');
  const before = [await person.patch(LEFT), await person.patch(RIGHT)];
  await page.getByLabel('Against').selectOption('nishita');
  await figures(page);
  const [left, right] = [await person.patch(LEFT), await person.patch(RIGHT)];
  assert.equal(left, before[0]);
  assert.notEqual(right, before[1]);
  await person.photograph('wipe');
  const box = await page.locator('#wipe').boundingBox();
  const picture = await page.locator('#picture').boundingBox();
  const y = picture.y + picture.height * 0.6;
  await person.press(box.x + box.width / 2, y);
  await person.move(picture.x + picture.width * 0.8, y, 5);
  await person.lift();
  assert.equal(await page.locator('#wipe').getAttribute('aria-valuenow'), '80');
  assert.equal(await person.patch(RIGHT), before[1], 'the line has passed it');
  await page.locator('#wipe').focus();
  await page.keyboard.press('Home');
  assert.equal(await page.locator('#wipe').getAttribute('aria-valuenow'), '0');
  assert.notEqual(await person.patch(LEFT), before[0]);
}, { hash: FIXED });

visit('another method is compared in as many orders as the scene has', async (person, page) => {
  await person.tab('Compare');
  const [comparison] = await Promise.all([page.waitForRequest('**/v1/compare'),
                                          page.getByLabel('Against').selectOption('nishita')]);
  const { a, b } = comparison.postDataJSON();
  assert.deepEqual([b.method.name, b.method.scattering_orders], ['nishita', 1]);
  assert.equal(a.method.scattering_orders, 1);
}, { hash: `${FIXED}&method.scattering_orders=1` });

visit('a pinned sky is wiped against what was changed', async (person, page) => {
  await person.tab('Compare');
  const before = [await person.patch(LEFT), await person.patch(RIGHT)];
  await page.getByRole('button', { name: 'Pin this sky' }).click();
  await person.tab('Adjust');
  await person.type('sun.elevation_deg', '8');
  await person.rest();
  await person.tab('Compare');
  assert.ok((await figures(page)) > 1);
  assert.notEqual(await person.patch(LEFT), before[0]);
  assert.equal(await person.patch(RIGHT), before[1]);
  await page.getByLabel('Against').selectOption('');
  assert.notEqual(await person.patch(RIGHT), before[1]);
}, { hash: FIXED });

visit('the error picture shows where they differ, with a scale', async (person, page) => {
  await person.tab('Compare');
  await page.getByLabel('Against').selectOption('nishita');
  await page.locator('#against-block').getByRole('button', { name: 'Error picture' }).click();
  await page.locator('.error-scale').waitFor();
  assert.ok(await page.locator('#overlay').isVisible());
  const [r, , b] = await page.locator('#overlay').evaluate((canvas) =>
    [...canvas.getContext('2d').getImageData(canvas.width / 2, canvas.height / 3, 1, 1).data]);
  assert.ok(r > b, 'all orders are brighter than one: red');
  assert.ok((await figures(page)) > 5);
  await person.photograph('error');
  await person.drag({ x: 0.2, y: 0.7 }, { x: 0.4, y: 0.7 });
  assert.ok(!(await page.locator('#overlay').isVisible()), 'an old error is not shown over a new sky');
}, { hash: FIXED });

visit('where the method falls short in this sky is told, and where the measurements are',
  async (person, page) => {
    await page.locator('#near').click();
    const limits = page.locator('.limits');
    assert.match(await limits.innerText(), /Moments falls short.*Late twilight is off by \d/s);
    const count = await limits.locator('li').count();
    assert.equal(await page.locator('#near').innerText(), `Near ${count} limits`);
    await person.photograph('limits');
    const [table] = await Promise.all([
      person.context.waitForEvent('page'), limits.getByRole('link').click()]);
    await table.waitForFunction(() => document.images[0]?.complete && document.images[0].naturalWidth);
    assert.match(await table.title(), /Where methods fail/);
    await table.close();
    await person.type('sun.elevation_deg', '40');
    await limits.waitFor({ state: 'hidden' });
    assert.equal(await page.locator('#near').isVisible(), false);
  }, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]&method.name=moments&sun.elevation_deg=-10' });

visit('what each part is worth is told in bars, and how far the work is', async (person, page) => {
  await person.tab('Compare');
  await page.locator('#explain-block').evaluate((block) => {
    window.shares = [];
    new MutationObserver((changes) => {
      for (const { target } of changes) if (target.matches('progress')) window.shares.push(target.position);
    }).observe(block, { subtree: true, attributes: true });
  });
  await page.getByRole('button', { name: 'Explain' }).click();
  const bars = page.locator('#explain-block .bars li');
  await bars.first().waitFor();
  const rows = await bars.evaluateAll((all) => all.map((row) => [
    row.querySelector('.bar-name').textContent, Number.parseFloat(row.querySelector('.bar-text').textContent)]));
  const names = rows.map(([name]) => name);
  for (const name of ['Air', 'Aerosol', 'Ozone', 'The ground’s light']) assert.ok(names.includes(name), name);
  assert.deepEqual(rows.map(([, error]) => error), rows.map(([, error]) => error).sort((a, b) => b - a));
  const shares = await page.evaluate(() => window.shares);
  assert.ok(shares.length && shares[0] > 0, 'the work tells how far it is');
  assert.deepEqual(shares, [...shares].sort((a, b) => a - b));
  await page.locator('#explain-block').scrollIntoViewIfNeeded();
  await person.photograph('explain');
}, { hash: FIXED });

visit('where the error of the chosen method comes from is told in bars', async (person, page) => {
  await person.tab('Compare');
  await page.getByRole('button', { name: 'Take apart' }).click();
  const block = page.locator('#attribute-block');
  await block.locator('.bars li').first().waitFor();
  assert.match(await block.locator('.total').textContent(), /view samples 8.*: error \d/);
  const rows = await block.locator('.bars li').evaluateAll((all) => all.map((row) => [
    row.querySelector('.bar-name').textContent, Number.parseFloat(row.querySelector('.bar-text').textContent)]));
  const errors = Object.fromEntries(rows);
  assert.ok(errors['Too few nodes and samples'] > 1);
  assert.ok(errors['Orders of scattering left out'] > 10);
  assert.deepEqual(rows.map(([, error]) => error), rows.map(([, error]) => error).sort((a, b) => b - a));
  await block.scrollIntoViewIfNeeded();
  await person.photograph('attribute');
}, { hash: '#preset=earth_low_sun&spectrum.wavelengths_nm=[680,550,440]&method.name=nishita&method.view_samples=8' });

visit('speed and accuracy are charted while they are measured; a point is taken',
  async (person, page) => {
    await person.tab('Compare');
    await page.locator('#chart-block').getByRole('button', { name: 'Measure' }).click();
    const points = page.locator('#chart-block .point[data-point]');
    await page.waitForFunction(() =>
      new Set([...document.querySelectorAll('.point[data-point]')].map((dot) => dot.dataset.method)).size >= 4);
    assert.match(await page.locator('#chart-block [role=status]').innerText(),
                 /of up to \d+ measured… Measured on small frames, \d+ × \d+/);
    assert.ok((await page.locator('#chart-block .front').getAttribute('d')).length > 4);
    const best = await page.locator('.point.best').evaluateAll((dots) =>
      dots.map((dot) => dot.getAttribute('aria-label')));
    assert.ok(best.length >= 1);
    await page.getByRole('button', { name: 'Stop' }).click();
    await page.locator('#chart-block').getByRole('button', { name: 'Measure' }).waitFor();
    assert.match(await page.locator('#chart-block [role=status]').innerText(), /^Stopped after \d+ settings of up to \d+/);
    const count = await points.count();
    await page.locator('.point[data-method=raymarch]').first().focus();
    await page.keyboard.press('Enter');
    assert.equal((await person.scene()).method.name, 'raymarch');
    const hillaire = page.locator('.point[data-method=hillaire]').first();
    if (person.size === 'phone') await hillaire.tap();
    else await hillaire.click();
    await person.rest();
    assert.equal((await person.scene()).method.name, 'hillaire');
    assert.match(await page.locator('[data-fact=Method]').innerText(), /Hillaire/);
    assert.equal(await page.locator('.point[aria-pressed=true]').getAttribute('data-method'), 'hillaire');
    assert.equal(await points.count(), count, 'nothing is measured after Stop');
    await page.locator('#chart-block').scrollIntoViewIfNeeded();
    await person.photograph('chart');
  }, { hash: '#preset=earth&method.scattering_orders=1' });

visit('what is measured is by the method of the frame on screen', async (person, page) => {
  let method;
  page.on('response', (response) => {
    const { 'cyanometer-method': name, 'cyanometer-options': options } = response.headers();
    if (name) method = { name, ...Object.fromEntries(options.split(';').filter(Boolean)
      .map((option) => option.split('=')).map(([key, value]) => [key, Number(value)])) };
  });
  await person.type('sun.elevation_deg', '20');
  await person.rest();
  await person.tab('Compare');
  const [attribution] = await Promise.all([page.waitForRequest('**/v1/attribute'),
                                           page.getByRole('button', { name: 'Take apart' }).click()]);
  assert.deepEqual(attribution.postDataJSON().method, method);
  await page.locator('#attribute-block').getByRole('button', { name: 'Stop' }).click();
  const [comparison] = await Promise.all([page.waitForRequest('**/v1/compare'),
                                          page.getByRole('button', { name: 'Pin this sky' }).click()]);
  const { a, b } = comparison.postDataJSON();
  assert.deepEqual([a.method, b.method], [method, method]);
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]' });

// What the daemon might answer, by address.
const ndjson = (...lines) => lines.map((line) => `${JSON.stringify(line)}\n`).join('');
const FOUND = {
  explain: ndjson({ progress: 0.5 }, { progress: 1, ingredients: { ozone: { error: 0.1, ciede2000: 2, ms_saved: 1 } } }),
  chart: ndjson({ width: 64, height: 36, points: 1 }, { method: 'hillaire', options: {}, frame_ms: 1, error: 0.1 }),
};

const busy = (route, seconds) => route.fulfill({ status: 503, headers: { 'Retry-After': String(seconds) },
  contentType: 'application/problem+json', body: '{"title":"Busy","status":503}' });

visit('a result of an earlier sky says so', async (person, page) => {
  await person.tab('Compare');
  for (const [name, action, part] of [['explain', 'Explain', '.bars'], ['chart', 'Measure', '.plot']]) {
    const { next } = await person.intercept(`**/v1/${name}`);
    const block = page.locator(`#${name}-block`);
    const words = block.locator('.stale-words');
    await block.getByRole('button', { name: action }).click();
    const route = await next();
    await page.locator('#picture').focus();
    await page.keyboard.press('d');
    await person.settle();
    await route.fulfill({ contentType: 'application/x-ndjson', body: FOUND[name] });
    await block.locator(part).waitFor();
    assert.equal(await words.innerText(), 'Of the sky as it was before.', name);
    await page.keyboard.press('Control+z');
    assert.equal(await words.count(), 0, `${name}: it is the sky again`);
    await page.keyboard.press('d');
    assert.equal(await words.count(), 1, name);
    await person.settle();
  }
  await page.locator('#explain-block').scrollIntoViewIfNeeded();
  await person.photograph('stale');
}, { hash: FIXED });

visit('who stopped waiting for a busy daemon and asks again sees the work of the second question', async (person, page) => {
  await person.tab('Compare');
  const { next } = await person.intercept('**/v1/explain');
  const block = page.locator('#explain-block');
  const button = block.getByRole('button');
  await block.evaluate((element) => {
    window.shares = [];
    new MutationObserver((changes) => {
      for (const { target } of changes) if (target.matches('progress')) window.shares.push(target.position);
    }).observe(element, { subtree: true, attributes: true });
  });
  await button.click();
  await busy(await next(), 1);
  await block.getByText(/busy/).waitFor();
  await button.click();
  await button.click();
  const second = await next();
  await page.waitForTimeout(1500);
  assert.equal(await button.innerText(), 'Stop', 'the first, which is over, says nothing of the second');
  await busy(second, 1);
  await block.getByText(/busy/).waitFor();
  await (await next()).fulfill({ contentType: 'application/x-ndjson', body: FOUND.explain });
  await block.locator('.bars').waitFor();
  assert.ok((await page.evaluate(() => window.shares)).length, 'how far it is is seen again');

  const charts = await person.intercept('**/v1/chart');
  const measure = page.locator('#chart-block').getByRole('button');
  await measure.click();
  await busy(await charts.next(), 60);
  await page.locator('#chart-block').getByText(/busy/).waitFor();
  await measure.click();
  assert.equal(await measure.innerText(), 'Measure');
}, { hash: FIXED, expected: /503/ });

visit('an EXR that is dropped is judged against the sky', async (person, page) => {
  const scene = { preset: 'earth', spectrum: { wavelengths_nm: [680, 550, 440] }, camera: { fov_deg: 40 } };
  const answer = await fetch(new URL('/v1/render', page.url()), { method: 'POST', body: JSON.stringify({
    ...scene, method: { name: 'nishita' }, image: { width: 20, height: 12, format: 'exr' } }) });
  await drop(page, 'mine.exr', Buffer.from(await answer.arrayBuffer()));
  const error = page.locator('#own-block [data-figure=error] dd');
  await error.waitFor();
  assert.ok(Number.parseFloat(await error.innerText()) > 5, 'one order is not all');
  await page.locator('#own-block').getByRole('button', { name: 'Error picture' }).click();
  await page.locator('#own-block .error-scale').waitFor();
  assert.ok(await page.locator('#overlay').isVisible());
  await person.photograph('judged');
  await page.getByRole('button', { name: 'Back to the sky' }).click();
  assert.ok(!(await page.locator('#overlay').isVisible()));
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]&camera.fov_deg=40' });

visit('a picture with distances gets the air of the sky', async (person, page) => {
  const land = exrFile(32, 20, { R: 0, G: 0, B: 0, Z: (column) => (column < 16 ? 0.1 : 60) });
  await drop(page, 'land.exr', land);
  await page.waitForFunction(() => !document.getElementById('overlay').hidden);
  const [left, right] = await page.locator('#overlay').evaluate((canvas) => [4, 28].map((x) =>
    [...canvas.getContext('2d').getImageData(x, 10, 1, 1).data].slice(0, 3)));
  assert.ok(right[2] > left[2] + 30, `air before what is dark and far: ${left} ${right}`);
  await person.photograph('composite');
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]&image.exposure_ev=1&sun.azimuth_deg=180' });

visit('an EXR is chosen where none can be dropped', async (person, page) => {
  await person.tab('Compare');
  await page.getByLabel('Choose an EXR').setInputFiles({
    name: 'grey.exr', mimeType: 'image/x-exr', buffer: exrFile(24, 16, { R: 0.1, G: 0.1, B: 0.1 }) });
  await page.locator('#own-block [data-figure=error]').waitFor();
  assert.match(await page.locator('#own-block').innerText(), /grey\.exr, 24 × 16/);
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]' });

visit('what is no EXR is said in words', async (person, page) => {
  await drop(page, 'cat.png', Buffer.from('no picture'));
  await page.waitForFunction(() => /not an EXR/.test(document.getElementById('own-block').textContent));
});

visit('a picture of one’s own is put away in any state, and gives way to the next', async (person, page) => {
  const grey = exrFile(24, 16, { R: 0.1, G: 0.1, B: 0.1 });
  const block = page.locator('#own-block');
  const back = block.getByRole('button', { name: 'Back to the sky' });
  await drop(page, 'grey.exr', grey);
  await block.locator('[data-figure=error]').waitFor();
  await back.click();
  assert.equal(await block.locator('.figures').count(), 0);
  assert.equal(await page.evaluate(() => document.activeElement.id), 'own-file');
  assert.equal(await back.isVisible(), false);
  const { next, asked } = await person.intercept(/\/v1\/compare/);
  await page.locator('#picture').focus();
  await page.keyboard.press('d');
  await person.rest();
  assert.equal(asked.length, 0, 'it is not judged any more');
  await drop(page, 'grey.exr', grey);
  const refused = await next();
  await refused.fulfill({ status: 400, contentType: 'application/problem+json', body: '{"detail":"Not this one."}' });
  await block.getByText('Not this one.').waitFor();
  assert.ok(await back.isVisible());
  await back.click();
  await drop(page, 'grey.exr', grey);
  const judged = await next();
  await drop(page, 'cat.png', Buffer.from('no picture'));
  await block.getByText(/not an EXR/).waitFor();
  await judged.fulfill({ json: { error: 0.1 } }).catch(() => {});  // nobody waits for it any more
  await page.waitForTimeout(500);
  assert.ok(await block.getByText(/not an EXR/).isVisible());
}, { hash: FIXED, expected: /400/ });

visit('a picture of one’s own gives way to a comparison', async (person, page) => {
  await drop(page, 'land.exr', exrFile(32, 20, { R: 0, G: 0, B: 0, Z: 10 }));
  await page.waitForFunction(() => !document.getElementById('overlay').hidden);
  await page.getByRole('button', { name: 'Pin this sky' }).click();
  await figures(page);
  assert.equal(await page.locator('#overlay').isVisible(), false);
  assert.equal(await page.getByRole('button', { name: 'Back to the sky' }).isVisible(), false);
}, { hash: FIXED });
