// What the air is made of as curves, what moves together, the sun of a place and a time.

import assert from 'node:assert/strict';

import { visits } from './visits.js';

const visit = visits();

async function open(page, name) {
  const card = page.locator(`.card[data-name=${name}]`);
  await card.locator('summary .name').click();
  await card.locator('.curves .plot').waitFor();
  return card;
}
const look = (card, name) => card.locator('.segmented').getByRole('button', { name }).click();
/** The numbers of a line's path. */
const line = async (card) => (await card.locator('.plot path.line').first().getAttribute('d'))
  .match(/-?[\d.]+/g).map(Number);

visit('a constituent is drawn against altitude, angle and wavelength', async (person, page) => {
  const air = await open(page, 'air');
  const profile = await line(air);
  assert.ok(profile.at(-1) < profile[1], 'altitude goes up');
  assert.ok(profile.at(-2) < profile[0], 'and density down');
  await look(air, 'Spectrum');
  const spectrum = await line(air);
  assert.ok(spectrum[1] < spectrum.at(-1), 'blue is scattered more');
  await look(air, 'Phase');
  assert.match(await air.locator('.plot').getAttribute('aria-label'), /Phase/);
  await air.locator('.curves').scrollIntoViewIfNeeded();
  await person.photograph('phase');
  const ozone = await open(page, 'ozone');
  await look(ozone, 'Phase');
  assert.match(await ozone.locator('.curves').innerText(), /does not scatter/);
});

visit('the curves follow the sliders', async (person, page) => {
  const air = await open(page, 'air');
  const before = await line(air);
  await person.find('atmosphere.constituents.air.profile');
  const typed = person.control('atmosphere.constituents.air.profile').locator('.typed').first();
  await typed.fill('4');
  await typed.press('Enter');
  await page.waitForFunction((old) =>
    document.querySelector('.card[data-name=air] .plot path.line').getAttribute('d').length !== old,
    (await air.locator('.plot path.line').first().getAttribute('d')).length);
  assert.notDeepEqual(await line(air), before);
});

visit('a card stays under the hand', async (person, page) => {
  const air = await open(page, 'air');
  await look(air, 'Phase');
  const profile = await person.find('atmosphere.constituents.air.profile');
  const { x, y, width, height } = await profile.locator('input[type=range]').boundingBox();
  const reached = async () => (await person.scene()).atmosphere.constituents.air.profile.scale_height_km;
  await person.press(x + 0.5 * width, y + height / 2);
  await person.move(x + 0.6 * width, y + height / 2, 5);
  const first = await reached();
  await person.move(x + 0.7 * width, y + height / 2, 5);
  assert.ok((await reached()) > first, 'the drag goes on after a pause');
  await person.lift();
  assert.equal(await air.locator('[data-value=phase]').getAttribute('aria-pressed'), 'true');
  const typed = profile.locator('.typed').first();
  await typed.fill('1e9');
  await typed.press('Enter');
  await profile.locator('.problem').waitFor();
  await person.settle();
  assert.ok(await profile.locator('.problem').isVisible(), 'why it is refused');
  await page.getByRole('switch', { name: 'Air on' }).focus();
  await page.keyboard.press('Space');
  await page.locator('.card.off[data-name=air]').waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.ariaLabel), 'Air on', 'the keys stay where they are');
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]', expected: /400/ });

visit('visibility and optical depth move together', async (person, page) => {
  const card = await open(page, 'aerosol');
  const visibility = card.locator('.linked .typed');
  const before = Number(await visibility.inputValue());
  assert.ok(before > 10 && before < 100, `${before} km`);
  await visibility.fill(String(before / 2));
  await visibility.press('Enter');
  const { optical_depth: depth } = (await person.scene()).atmosphere.constituents.aerosol;
  assert.ok(Math.abs(depth.power_law.value - 0.2) < 0.002, JSON.stringify(depth));
  const typed = (await person.find('atmosphere.constituents.aerosol.optical_depth')).locator('.typed').first();
  await typed.fill('0.4');
  await typed.press('Enter');
  await person.rest();
  assert.ok(Math.abs(Number(await visibility.inputValue()) - before / 4) < 0.02 * before);
});

visit('temperature and scale height move together when they are tied', async (person, page) => {
  const card = await open(page, 'air');
  await person.type('atmosphere.constituents.air.temperature_k', '250');
  assert.equal((await person.scene()).atmosphere.constituents.air.profile, undefined);
  await card.getByRole('switch', { name: /temperature and scale height together/i }).click();
  await person.type('atmosphere.constituents.air.temperature_k', '125');
  const { profile } = (await person.scene()).atmosphere.constituents.air;
  assert.deepEqual(profile, { type: 'exponential', scale_height_km: 4 });
});

visit('a spectrum is edited as red, green and blue', async (person, page) => {
  const albedo = await person.find('planet.ground_albedo');
  await albedo.locator('.form-choice').selectOption('Red, green, blue');
  await person.rest();
  const green = albedo.locator('.number.green .typed');
  await green.fill('0.6');
  await green.press('Enter');
  await person.rest();
  const scene = await person.scene();
  assert.deepEqual(scene.planet.ground_albedo, [0.1, 0.6, 0.1]);
  assert.equal(scene.spectrum.wavelengths_nm.length, 3);
  assert.equal(await page.locator('#status').textContent(), '');
});

visit('a spectrum is edited as a curve of nodes', async (person, page) => {
  const albedo = await person.find('planet.ground_albedo');
  await albedo.locator('.form-choice').selectOption('Curve');
  const node = albedo.locator('.node').nth(1);
  await node.waitFor();
  await person.rest();
  await node.scrollIntoViewIfNeeded();
  const box = await node.boundingBox();
  const place = await albedo.locator('.spectrum').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await person.press(x, y);
  await person.move(x + 10, place.y + place.height * 0.5, 6);
  await person.lift();
  const { wavelengths_nm: wavelengths, values } = (await person.scene()).planet.ground_albedo;
  assert.ok(wavelengths[1] > 552 && wavelengths[1] < 600, String(wavelengths));
  assert.ok(values[1] > 0.3 && values[1] < 0.7, String(values));
  assert.deepEqual([values[0], values[2]], [1, 1]);
  const limits = await albedo.locator('.node').evaluateAll((nodes) => nodes.map((one) =>
    ['min', 'now', 'max'].map((name) => Number.parseFloat(one.getAttribute(`aria-value${name}`)))));
  for (const [low, now, high] of limits) assert.ok(low <= now && now <= high && low < high, String([low, now, high]));
  await albedo.locator('.node').nth(1).focus();
  await page.keyboard.press('ArrowDown');
  assert.ok((await person.scene()).planet.ground_albedo.values[1] < values[1]);
  await albedo.getByRole('button', { name: 'Add a node' }).click();
  assert.equal((await person.scene()).planet.ground_albedo.values.length, 4);
  await person.rest();
  assert.equal(await page.locator('#status').textContent(), '');
  await person.photograph('curve');
});

visit('a place and a time set the sun; the strip shows the day from dawn to dusk',
  async (person, page) => {
    await page.locator('[data-group=day] summary').click();
    await page.locator('.strip canvas[data-slices="18"]').waitFor();
    const colours = await page.locator('.strip canvas').evaluate((canvas) => [0.02, 0.5].map((share) =>
      [...canvas.getContext('2d').getImageData(share * canvas.width, 10, 1, 1).data].join()));
    assert.notEqual(colours[0], colours[1], 'dawn is not noon');
    assert.match(await page.locator('.strip-marks').innerText(), /sunrise \d\d:\d\d.*highest.*sunset/s);
    const first = await person.look();
    await page.getByLabel('Place').selectOption('Cape Town');
    const date = page.getByLabel('Date');
    await date.fill('2026-12-21');
    await date.dispatchEvent('change');
    await person.rest();
    const { sun } = await person.scene();
    assert.equal(sun.place.latitude_deg, -33.92);
    assert.match(sun.place.time, /^2026-12-21T12:00:00\+01:00$/);
    assert.notEqual(await person.look(), first);
    const slider = page.getByLabel('Time of day');
    await page.locator('.strip').scrollIntoViewIfNeeded();
    const strip = await slider.boundingBox();
    await person.press(strip.x + 0.5 * strip.width, strip.y + 40);
    await person.move(strip.x + 0.75 * strip.width, strip.y + 40, 5);
    await person.lift();
    assert.match((await person.scene()).sun.place.time, /^2026-12-21T1[5-7]:/);
    await slider.focus();
    await page.keyboard.press('Home');
    await person.rest();
    assert.match((await person.scene()).sun.place.time, /^2026-12-21T0[3-4]:/);
    await page.locator('.strip').scrollIntoViewIfNeeded();
    await person.photograph('day');
  });

visit('the strip is of the sky that is seen when it is looked at again', async (person, page) => {
  await page.locator('[data-group=day] summary').click();
  await page.locator('.strip canvas[data-slices="18"]').waitFor();
  await person.tab('Save');
  await page.locator('#picture').focus();
  await page.keyboard.press('w');
  await person.settle();
  const [{ camera }] = await Promise.all([
    page.waitForRequest('**/v1/stream').then((request) => request.postDataJSON().scene), person.tab('Adjust')]);
  assert.equal(camera.altitude_km, (await person.scene()).camera.altitude_km);
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]' });

visit('a time that is none breaks nothing', async (person, page) => {
  await page.evaluate(() => { location.hash = 'preset=earth&sun.place.time=soon&sun.place.longitude_deg=east'; });
  await page.waitForFunction(() => document.getElementById('status').dataset.kind === 'refused');
  await page.locator('[data-group=day] summary').click();
  await page.locator('.strip-marks span').first().waitFor();
}, { expected: /400/ });

visit('a longitude beyond 180 degrees has its day too', async (person, page) => {
  await page.locator('[data-group=day] summary').click();
  await page.locator('.strip-marks span').first().waitFor();
  assert.equal(await page.locator('.day .typed').nth(1).inputValue(), '-150');
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]&sun.place.latitude_deg=0&sun.place.longitude_deg=210' +
           '&sun.place.time=2026-03-20T12:00:00-10:00' });

visit('a time-lapse plays in any page, in an <img>', async (person, page) => {
  const link = 'preset=earth&image.width=64&image.height=36&image.exposure_ev=0';
  const address = (query) => String(new URL(`/v1/${query}`, page.url()));
  const elsewhere = await person.context.newPage();
  const show = (query) => elsewhere.setContent(`<img src="${address(query)}">`);
  const look = async () => (await elsewhere.screenshot()).toString('base64');
  await show(`render?${link}&sun.elevation_deg=-2`);
  const last = await look();
  await show(`stream?${link}&sun.elevation_deg=30&frames=60&to.sun.elevation_deg=-2`);
  const seen = new Set();
  await person.until(async () => seen.add(await look()).has(last), 'the last frame comes');
  assert.ok(seen.size > 5, `${seen.size} frames were seen`);
});

visit('the day plays as a time-lapse', async (person, page) => {
  await page.locator('[data-group=day] summary').click();
  await page.locator('.strip canvas[data-slices="18"]').waitFor();
  const moments = new Set();
  const skies = new Set();
  await page.getByRole('button', { name: 'Play the day' }).click();
  await page.getByRole('button', { name: 'Stop' }).waitFor();
  await person.until(async () => {
    moments.add(await page.locator('.strip-now').innerText());
    skies.add(await person.look());
    return moments.size >= 4 && skies.size >= 3;
  }, 'the day goes on');
  await page.getByRole('button', { name: 'Stop' }).click();
  await person.rest();
  assert.ok(Number(await page.getByLabel('Time of day').inputValue()) < 950, 'the day was not over');
  const { time } = (await person.scene()).sun.place;
  assert.ok((await page.locator('.strip-now').innerText()).startsWith(time.slice(11, 16)));
  assert.equal(await page.locator('#status').textContent(), '');
});

visit('what is chosen while the day plays stays chosen', async (person, page) => {
  await page.locator('[data-group=day] summary').click();
  await page.locator('.strip canvas[data-slices="18"]').waitFor();
  const first = await person.look();
  await page.getByRole('button', { name: 'Play the day' }).click();
  await person.until(async () => (await person.look()) !== first, 'the day plays');
  await person.type('sun.elevation_deg', '12');
  await page.getByRole('button', { name: 'Play the day' }).waitFor();
  await person.rest();
  assert.deepEqual((await person.scene()).sun, { elevation_deg: 12 });
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]' });

visit('a day that is pressed twice plays once', async (person, page) => {
  await page.locator('[data-group=day] summary').click();
  await page.locator('.strip canvas[data-slices="18"]').waitFor();
  const lapses = [];
  page.on('request', (request) => {
    if (request.url().endsWith('/v1/stream') && request.postDataJSON().frames.length > 100) lapses.push(request);
  });
  const { next } = await person.intercept('**/v1/day');
  await page.getByLabel('Date').evaluate((date) => {
    date.value = '2026-12-21';
    date.dispatchEvent(new Event('change'));
    const play = document.querySelector('.day .with-icon');
    play.click();
    play.click();
  });
  const day = await next();
  await person.settle();
  assert.equal(lapses.length, 0, 'not before its day is known');
  await day.continue();
  await page.getByRole('button', { name: 'Stop' }).click();
  await person.rest();
  assert.equal(lapses.length, 1);
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]' });

visit('Play waits for its day; the strip is finished afterwards', async (person, page) => {
  const { next } = await person.intercept('**/v1/day');
  await page.locator('[data-group=day] summary').click();
  const day = await next();
  await page.getByRole('button', { name: 'Play the day' }).click();
  await day.continue();
  await page.getByRole('button', { name: 'Stop' }).click();
  await page.locator('.strip canvas[data-slices="18"]').waitFor();
  await page.getByRole('button', { name: 'Play the day' }).waitFor();
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]' });

visit('a time-lapse that waits for a busy daemon is stopped at once', async (person, page) => {
  await page.locator('[data-group=day] summary').click();
  await page.locator('.strip canvas[data-slices="18"]').waitFor();
  const waits = [3600, 1];
  await page.route('**/v1/stream', (route) => (waits.length ? route.fulfill({
    status: 503, headers: { 'Retry-After': String(waits.shift()) }, contentType: 'application/problem+json',
    body: '{"title":"Busy","status":503}' }) : route.continue()));
  const play = page.getByRole('button', { name: 'Play the day' });
  const busy = page.locator('.day').getByText(/busy/);
  await play.click();
  await busy.waitFor();
  await page.getByRole('button', { name: 'Stop' }).click();
  await play.waitFor();
  assert.equal(await busy.count(), 0);
  await person.rest();
  const first = await person.look();
  await play.click();
  await busy.waitFor();
  await person.until(async () => (await person.look()) !== first, 'the day plays');
  assert.equal(await busy.count(), 0);
}, { hash: '#preset=earth&spectrum.wavelengths_nm=[680,550,440]', expected: /503/ });
