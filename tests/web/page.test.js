// The page as a person uses it, at a desk and on a phone.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { promisify } from 'node:util';

import { visits } from './visits.js';

const run = promisify(execFile);
const PNG = '89504e47';
const EXR = '762f3101';
const startOf = (bytes) => bytes.subarray(0, 4).toString('hex');

const FEW = '&spectrum.wavelengths_nm=[680,550,440]';  // which is quick
const visit = visits();

visit('the picture fills the window and the controls fold away', async (person, page) => {
  await person.photograph('adjust');
  await page.getByRole('button', { name: 'Fold the controls away' }).click();
  await person.rest();
  assert.equal(await page.locator('#panel').isVisible(), false);
  const { width, height } = page.viewportSize();
  assert.deepEqual(await page.locator('#picture').boundingBox(), { x: 0, y: 0, width, height });
  await person.photograph('folded');
  await page.getByRole('button', { name: 'Show the controls' }).click();
  assert.equal(await page.locator('#panel').isVisible(), true);
});

visit('every number of the schema has a slider, in a group', async (person, page) => {
  const schema = await (await fetch(`${new URL(page.url()).origin}/v1/schema`)).json();
  for (const [section, members] of Object.entries(schema.properties)) {
    for (const [name, member] of Object.entries(members.properties ?? {})) {
      if (!member['x-slider'] || /^(width|height|.*_samples|seed)$/.test(name)) continue;
      if (member['x-methods']) continue;  // drawn when one of these methods is chosen
      if (member.type !== 'number' && member.type !== 'integer') continue;
      const control = person.control(`${section}.${name}`);
      assert.equal(await control.locator('input[type=range]').count(), 1, `${section}.${name}`);
      assert.ok(await control.locator('xpath=ancestor::details[@data-group]').count(), name);
    }
  }
  assert.deepEqual(await page.locator('.fold h2').allInnerTexts(),
                   ['Sun', 'Time and place', 'Air, haze and ozone', 'Planet', 'Camera', 'Light', 'Picture',
                    'Method']);
  const unit = await person.control('sun.elevation_deg').locator('.unit').textContent();
  assert.equal(unit, '°');
});

visit('a number can be typed, and given back', async (person, page) => {
  const first = await person.look();
  await person.type('sun.elevation_deg', '4');
  await person.rest();
  assert.equal((await person.scene()).sun.elevation_deg, 4);
  assert.notEqual(await person.look(), first);
  const control = person.control('sun.elevation_deg');
  await control.getByRole('button', { name: /Reset/ }).click();
  await person.rest();
  assert.equal((await person.scene()).sun, undefined);
  assert.equal(await person.look(), first);
  assert.equal(await control.getByRole('button', { name: /Reset/ }).count(), 0);
});

visit('a logarithmic slider moves by factors', async (person, page) => {
  const slider = (await person.find('camera.altitude_km')).locator('input[type=range]');
  const altitudeAt = async (share) => {
    await slider.evaluate((element, at) => {
      element.value = at * element.max;
      element.dispatchEvent(new Event('input'));
    }, share);
    return (await person.scene()).camera.altitude_km;
  };
  const [low, middle, high] = [await altitudeAt(0.4), await altitudeAt(0.6), await altitudeAt(0.8)];
  assert.ok(Math.abs(Math.log(high / middle) / Math.log(middle / low) - 1) < 0.05);
});

visit('help says in words what a control is', async (person, page) => {
  const control = await person.find('sun.elevation_deg');
  await control.hover();
  const help = control.locator('.help');
  assert.equal(await help.isVisible(), false);
  await control.getByRole('button', { name: /What is/ }).click();
  assert.ok(await help.isVisible());
  assert.ok((await help.innerText()).length > 20);
});

visit('constituents have cards; they are switched off, added and removed',
  async (person, page) => {
    const card = page.locator('.card[data-name=air]');
    await card.locator('summary').scrollIntoViewIfNeeded();
    await card.locator('summary .name').click();
    assert.ok((await card.locator('input[type=range]').count()) >= 2);
    await person.photograph('card');
    const first = await person.look();
    await card.getByRole('switch', { name: 'Air on' }).click();
    assert.equal((await person.scene()).atmosphere.constituents.air, null);
    await person.rest();
    assert.notEqual(await person.look(), first);
    await page.locator('.card[data-name=air]').getByRole('switch', { name: 'Air on' }).click();
    await person.rest();
    assert.equal(await person.look(), first);
    await page.getByRole('button', { name: 'Dust', exact: true }).click();
    await page.locator('.card[data-name=dust]').waitFor();
    await person.rest();
    assert.equal((await person.scene()).atmosphere.constituents.dust.type, 'particles');
    assert.equal(await page.locator('#status').textContent(), '');
    await page.locator('.card[data-name=dust] summary .name').click();
    await page.getByRole('button', { name: 'Remove Dust' }).click();
    assert.equal((await person.scene()).atmosphere, undefined);
  }, { hash: `#preset=earth${FEW}` });

visit('a constituent that was changed comes back as it was', async (person, page) => {
  await person.type('atmosphere.constituents.air.temperature_k', '250');
  await person.rest();
  const [first, scene] = [await person.look(), await person.scene()];
  await page.getByRole('switch', { name: 'Air on' }).click();
  assert.equal((await person.scene()).atmosphere.constituents.air, null);
  await person.rest();
  await page.getByRole('switch', { name: 'Air on' }).click();
  assert.deepEqual(await person.scene(), scene);
  await person.rest();
  assert.equal(await person.look(), first);
  await page.locator('.card[data-name=air]:not(.off)').waitFor();
  assert.deepEqual(person.complaints, []);
}, { hash: `#preset=earth${FEW}` });

visit('where all of Show is taken away, nothing else is changed', async (person, page) => {
  const boxes = (await person.find('image.show')).locator('input');
  for (let i = 0; i < await boxes.count(); ++i) await boxes.nth(i).uncheck();
  assert.deepEqual(await person.scene(), { preset: 'earth', image: { show: [] } });
  await person.rest();
  assert.equal(await page.locator('#status').textContent(), '');
});

visit('no slider and no form leads to what is refused', async (person, page) => {
  const view = (await person.find('camera.fov_deg')).locator('input[type=range]');
  await view.focus();
  await page.keyboard.press('End');
  assert.equal((await person.scene()).camera.fov_deg, 179);
  await page.locator('.card[data-name=aerosol] summary .name').click();
  for (const member of ['profile', 'phase']) {
    const form = (await person.find(`atmosphere.constituents.aerosol.${member}`)).locator('.form-choice');
    await form.selectOption('Table');
    await person.rest();
    assert.equal(await page.locator('#status').textContent(), '', member);
  }
}, { hash: `#preset=earth${FEW}` });

visit('keys step a number from where it is, beyond its slider too', async (person, page) => {
  await person.type('sun.elevation_deg', '-50');
  await person.control('sun.elevation_deg').locator('.typed').press('ArrowUp');
  assert.equal((await person.scene()).sun.elevation_deg, -49.9);
  await person.type('sun.elevation_deg', '90');
  await person.control('sun.elevation_deg').locator('.typed').press('Shift+ArrowUp');
  assert.equal((await person.scene()).sun.elevation_deg, 90, 'but not beyond what is allowed');
});

visit('presets are thumbnails that the daemon has rendered', async (person, page) => {
  await person.tab('Skies');
  await page.waitForFunction(() => document.querySelectorAll('.preset img.there').length >= 3);
  await page.waitForTimeout(500);
  await person.photograph('skies');
  const image = page.locator('.preset img.there').first();
  assert.deepEqual(await image.evaluate((one) => [one.naturalWidth, one.naturalHeight]), [160, 90]);
  await page.locator('.preset[data-preset=mars]').click();
  await person.rest();
  assert.equal(person.hash(), '#preset=mars');
  assert.equal(await page.locator('.preset[aria-pressed=true]').getAttribute('data-preset'), 'mars');
  await person.photograph('mars');
});

visit('frames follow the hand, small, and sharpen when it rests', async (person, page) => {
  const seconds = 5;
  const box = await page.locator('#picture').boundingBox();
  const before = (await person.requests()).started;
  const y = box.y + box.height * 0.7;
  await person.press(box.x + 60, y);
  const ends = Date.now() + 1000 * seconds;
  let small = Infinity;
  for (let i = 0; Date.now() < ends; ++i) {
    await person.move(box.x + 60 + 200 * Math.abs(Math.sin(i / 40)), y);
    await page.waitForTimeout(12);
    small = Math.min(small, await page.locator('#picture').evaluate((c) => c.width));
  }
  await person.lift();
  const { started, most, failed } = await person.requests();
  assert.equal(most, 1, 'at most one request is under way');
  assert.equal(failed, 0);
  // How many is the machine's affair: that the picture goes on while the hand does is the page's.
  assert.ok(started - before >= 3, `${started - before} frames in ${seconds} s`);
  assert.ok(small < box.width, 'frames are smaller while the hand moves');
  await person.rest();
  assert.equal((await person.requests()).flying, 0);
  const quiet = (await person.requests()).started;
  await page.waitForTimeout(500);
  assert.equal((await person.requests()).started, quiet, 'a resting page asks for nothing');
});

visit('the frame says its speed, method, options, error and exposure', async (person, page) => {
  const said = { Render: /^Render [\d.]+ ms$/, Method: /^Method Raymarch$/, Options: /^Options view nodes 7$/,
                 Error: /^Error ≤ [\d.]+ %/, Exposure: /^Exposure [+−][\d.]+ EV$/ };
  // A phone has room for all of it when the controls are folded.
  if (person.size === 'phone') await page.getByRole('button', { name: 'Fold the controls away' }).click();
  for (const [fact, text] of Object.entries(said)) {
    const place = page.locator(`[data-fact=${fact}]`);
    await place.waitFor();
    assert.match(await place.innerText(), text);
  }
  assert.match(await page.locator('[data-fact=Error]').getAttribute('title'), /meant to hold in 95 %/);
  assert.match(await page.locator('[data-fact=Exposure]').getAttribute('title'), /facing the sun outside the air/);
  await person.drag({ x: 0.2, y: 0.7 }, { x: 0.6, y: 0.7 }, { x: 0.2, y: 0.7 });
  await page.locator('[data-fact=Frames]').waitFor();
  assert.match(await page.locator('[data-fact=Frames]').innerText(), /\d+\/s/);
}, { hash: `#preset=earth${FEW}&method.name=raymarch&method.view_nodes=7` });

visit('dragging looks around', async (person, page) => {
  await person.drag({ x: 0.2, y: 0.7 }, { x: 0.5, y: 0.8 });
  const looked = (await person.scene()).camera;
  assert.ok(looked.heading_deg < -5, `heading ${looked.heading_deg}`);
  assert.ok(looked.pitch_deg > 11, `pitch ${looked.pitch_deg}`);
});

visit('one flies from the ground to space', async (person, page) => {
  const altitude = async () => (await person.scene()).camera.altitude_km;
  const ground = await person.look();
  if (person.size === 'phone') {
    const slider = (await person.find('camera.altitude_km')).locator('input[type=range]');
    const { x, y, width, height } = await slider.boundingBox();
    await person.press(x + 0.3 * width, y + height / 2);
    await person.move(x + 0.85 * width, y + height / 2, 20);
    await person.lift();
  } else {
    await page.locator('#picture').focus();
    for (let i = 0; i < 90; ++i) await page.keyboard.press('w');
  }
  assert.ok((await altitude()) > 400, `${await altitude()} km`);
  await person.rest();
  assert.notEqual(await person.look(), ground);
  const { pitch_deg: pitch } = (await person.scene()).camera;
  assert.ok(pitch < -5, `the horizon, which has sunk, is kept in sight: ${pitch}`);
  await person.photograph('space');
});

visit('the sun can be dragged', async (person, page) => {
  // Straight ahead at 10 degrees, where the camera looks: the middle of the picture.
  await person.drag({ x: 0.5, y: 0.5 }, { x: 0.6, y: 0.4 });
  const { sun, camera } = await person.scene();
  assert.equal(camera, undefined);
  assert.ok(sun.elevation_deg > 12 && sun.elevation_deg < 20, `elevation ${sun.elevation_deg}`);
  assert.ok(sun.azimuth_deg > 2, `azimuth ${sun.azimuth_deg}`);
}, { hash: '#preset=earth&sun.elevation_deg=10&sun.azimuth_deg=0' });

visit('a link is the scene, and back goes back', async (person, page) => {
  assert.equal((await person.scene()).sun.elevation_deg, 3);
  await person.type('sun.elevation_deg', '12');
  await person.rest();
  assert.equal(person.hash(), '#preset=mars&sun.elevation_deg=12');
  const later = await person.look();
  await page.goBack();
  await person.rest();
  assert.equal((await person.scene()).sun.elevation_deg, 3);
  await page.goForward();
  await person.rest();
  assert.equal((await person.scene()).sun.elevation_deg, 12);
  assert.equal(await person.look(), later);
}, { hash: '#preset=mars&sun.elevation_deg=3' });

visit('undo and redo', async (person, page) => {
  await person.type('sun.elevation_deg', '12');
  await person.rest();
  await page.getByRole('button', { name: 'Undo' }).click();
  assert.equal((await person.scene()).sun, undefined);
  await page.getByRole('button', { name: 'Redo' }).click();
  assert.equal((await person.scene()).sun.elevation_deg, 12);
  await page.locator('#picture').focus();
  await page.keyboard.press('Control+z');
  assert.equal((await person.scene()).sun, undefined);
  await page.keyboard.press('Control+Shift+Z');
  assert.equal((await person.scene()).sun.elevation_deg, 12);
  await page.keyboard.press('Control+z');
  await person.settle();
  await page.locator('#picture').evaluate((picture) => {
    for (const key of [{ key: 'd' }, { key: 'Z', ctrlKey: true, shiftKey: true }]) {
      picture.dispatchEvent(new KeyboardEvent('keydown', { ...key, bubbles: true }));
    }
  });
  assert.equal((await person.scene()).sun.elevation_deg, 30.5, 'a hasty redo leaves the edit before it');
});

visit('JSON, link, curl and Python make the same frame', async (person, page) => {
  await person.tab('Save');
  await person.photograph('save');
  const copied = async (kind) => {
    await page.getByRole('button', { name: `Copy ${kind}` }).click();
    return page.evaluate(() => navigator.clipboard.readText());
  };
  const folder = await mkdtemp(path.join(os.tmpdir(), 'sky-'));
  try {
    assert.deepEqual(JSON.parse(await copied('JSON')),
                     { preset: 'earth', sun: { elevation_deg: 5 }, image: { tone_map: 'aces' } });
    assert.equal(await copied('Link'), page.url());
    await run('bash', ['-c', await copied('curl')], { cwd: folder });
    const byCurl = await readFile(path.join(folder, 'sky.png'));
    assert.equal(startOf(byCurl), PNG);
    await rm(path.join(folder, 'sky.png'));
    await run('python3', ['-c', await copied('Python')], { cwd: folder });
    assert.ok(byCurl.equals(await readFile(path.join(folder, 'sky.png'))));
  } finally {
    await rm(folder, { recursive: true });
  }
}, { hash: '#preset=earth&sun.elevation_deg=5&image.tone_map=aces' });

visit('PNG and EXR are downloaded at a chosen size', async (person, page) => {
  await person.tab('Save');
  await page.getByLabel('Width', { exact: true }).fill('320');
  await page.getByLabel('Height', { exact: true }).fill('100');
  for (const [format, start] of [['png', PNG], ['exr', EXR]]) {
    await page.getByLabel('As', { exact: true }).selectOption(format);
    const [download] = await Promise.all([
      page.waitForEvent('download'), page.getByRole('button', { name: 'Download' }).click()]);
    assert.equal(download.suggestedFilename(), `earth.${format}`);
    const bytes = await readFile(await download.path());
    assert.equal(startOf(bytes), start);
    if (format !== 'png') continue;
    assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [320, 100]);
  }
});

visit('an EXR has its layers apart, an environment map is a whole sphere', async (person, page) => {
  await person.tab('Save');
  const save = async () => {
    const [download] = await Promise.all([
      page.waitForEvent('download'), page.getByRole('button', { name: 'Download' }).click()]);
    return readFile(await download.path());
  };
  await page.getByLabel('Width', { exact: true }).fill('63');
  await page.getByLabel('As', { exact: true }).selectOption('exr');
  await page.getByLabel('Light of the air').check();
  await page.getByLabel('Transmittance').check();
  const channels = (await save()).subarray(0, 600).toString('latin1');
  for (const name of ['inscatter.R', 'transmittance.B']) assert.ok(channels.includes(name), name);
  assert.ok(!channels.includes('ground.R'));
  await page.getByLabel('As', { exact: true }).selectOption('sphere_hdr');
  assert.equal(await page.getByLabel('Height', { exact: true }).inputValue(), '32');
  const sphere = (await save()).toString('latin1');
  assert.match(sphere, /^#\?RADIANCE/);
  assert.match(sphere, /-Y 32 \+X 64/, 'twice as wide as high');
});

visit('looking around starts from where the camera is, in a refused scene too', async (person, page) => {
  const answer = await fetch(new URL('/v1/plan', page.url()), { method: 'POST', body: '{"preset":"mars"}' });
  const { camera } = (await answer.json()).scene;
  let release;
  const held = new Promise((resolve) => { release = resolve; });
  await page.route('**/v1/plan', (route) => held.then(() => route.continue()).catch(() => {}));
  const refused = { preset: 'mars', sun: { elevation_deg: 500 } };
  await page.evaluate(() => { location.hash = 'preset=mars&sun.elevation_deg=500'; });
  await page.waitForFunction(() => document.getElementById('status').dataset.kind === 'refused');
  await page.locator('#picture').focus();
  for (const key of ['ArrowUp', 'ArrowRight', 'w', 'd', '+']) await page.keyboard.press(key);
  assert.deepEqual(await person.scene(), refused, 'nothing is moved from where nobody knows');
  release();
  const pitch = person.control('camera.pitch_deg').locator('.typed');
  await person.until(async () => Number(await pitch.inputValue()) === camera.pitch_deg, 'the camera of the preset is known');
  await page.keyboard.press('ArrowUp');
  const moved = (await person.scene()).camera.pitch_deg - camera.pitch_deg;
  assert.ok(moved > 0 && moved < 5, `${moved} degrees`);
}, { expected: /400/ });

visit('a slider dragged for ten seconds leaves no request and no error behind', async (person, page) => {
  const open = new Set();
  page.on('request', (request) => open.add(request));
  for (const end of ['requestfinished', 'requestfailed']) page.on(end, (request) => open.delete(request));
  const slider = (await person.find('sun.elevation_deg')).locator('input[type=range]');
  const box = await slider.boundingBox();
  const y = box.y + box.height / 2;
  await person.press(box.x + box.width / 2, y);
  const ends = Date.now() + 10000;
  for (let i = 0; Date.now() < ends; ++i) {
    await person.move(box.x + box.width * (0.5 + 0.4 * Math.sin(i / 30)), y);
    await page.waitForTimeout(16);
  }
  await person.lift();
  await person.rest();
  const { started, flying, failed, most } = await person.requests();
  assert.ok(started > 5, `${started} frames`);
  assert.deepEqual({ flying, failed, most }, { flying: 0, failed: 0, most: 1 });
  await person.until(() => page.waitForTimeout(50).then(() => !open.size), 'what was asked when the hand rested ends too');
  const metrics = await (await fetch(new URL('/metrics', page.url()))).text();
  for (const idle of [/^cyanometer_queue_depth 0$/m, /^cyanometer_device_busy 0$/m]) assert.match(metrics, idle);
});

visit('what is not a number is refused where it was typed', async (person) => {
  const problem = person.control('sun.elevation_deg').locator('.problem');
  await person.type('sun.elevation_deg', 'high');
  assert.match(await problem.innerText(), /number/);
  await person.type('sun.elevation_deg', '6,360');
  assert.match(await problem.innerText(), /6360 or 6\.360/);
  assert.equal((await person.scene()).sun, undefined);
  await person.type('sun.elevation_deg', '6,36');
  assert.equal((await person.scene()).sun.elevation_deg, 6.36);
});

// One colour instead of the pictures; without one, the pictures again. Runs in the page.
function showInstead(colour = '') {
  for (const one of [document.documentElement, document.body]) one.style.background = colour;
  for (const canvas of document.querySelectorAll('main > canvas')) canvas.style.visibility = colour && 'hidden';
}

/** The strongest contrast of a part of the window with its own first pixel. */
async function contrast(page, clip) {
  const picture = (await page.screenshot({ clip })).toString('base64');
  return page.evaluate(async (content) => {
    const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(content), (c) => c.charCodeAt(0))]));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    const linear = (byte) => (byte <= 10 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
    const luminances = Array.from({ length: data.length / 4 }, (_, i) => 0.2126 * linear(data[4 * i]) +
      0.7152 * linear(data[4 * i + 1]) + 0.0722 * linear(data[4 * i + 2]));
    return Math.max(...luminances.map((one) =>
      (Math.max(one, luminances[0]) + 0.05) / (Math.min(one, luminances[0]) + 0.05)));
  }, picture);
}

/** The contrast of a slider's thumb, its lower half and the track left out, and of a switch that is off. */
async function edges(person, page) {
  const slider = (await person.find('sun.elevation_deg')).locator('input[type=range]');
  const { x, y, width, height } = await slider.boundingBox();
  const share = await slider.evaluate(({ value, max }) => value / max);
  const size = person.size === 'phone' ? 22 : 16;
  const middle = x + size / 2 + share * (width - size);
  const thumb = await contrast(page, { x: middle - size / 2 - 3, y: y + height / 2 - size / 2 - 3,
                                       width: size + 6, height: size / 2 });
  const off = page.locator('.card.off .switch');
  await off.scrollIntoViewIfNeeded();
  const box = await off.boundingBox();
  return [thumb, await contrast(page, { x: box.x - 3, y: box.y - 3, width: box.width + 6, height: box.height + 6 })];
}

for (const colorScheme of ['light', 'dark']) {
  visit(`it is accessible in the ${colorScheme}`, async (person, page) => {
    const axe = await readFile(new URL('node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');
    await page.evaluate(axe);
    // With as much to see as there is.
    await page.locator('.card[data-name=air] summary .name').click();
    await page.getByRole('switch', { name: 'Ozone on' }).click();
    await page.locator('[data-group=day] summary').click();
    await page.locator('.strip-marks span').first().waitFor();
    await person.tab('Compare');
    await page.getByLabel('Against', { exact: true }).selectOption('nishita');
    await page.locator('.figures [data-figure=error]').waitFor();
    await page.locator('#picture').focus();
    await page.keyboard.press('p');
    await page.locator('#probe .plot').first().waitFor();
    const ask = async (what, options) => {
      const { violations } = await page.evaluate((rules) => window.axe.run(document, rules), options);
      assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes.map((n) => n.html)]), [], what);
    };
    for (const tab of ['Skies', 'Adjust', 'Compare', 'Probe', 'Save']) {
      await person.tab(tab);
      await ask(tab, {});
      await page.evaluate(() => {
        for (const result of document.querySelectorAll('.result')) result.classList.add('stale');
      });
      // Contrast over a picture cannot be told: it is over the brightest and the darkest there are.
      for (const sky of ['white', 'black']) {
        await page.evaluate(showInstead, sky);
        await ask(`${tab} over ${sky}`, { runOnly: ['color-contrast'] });
        if (tab !== 'Adjust') continue;
        for (const edge of await edges(person, page)) assert.ok(edge >= 3, `${edge} over ${sky}`);
      }
      await page.evaluate(showInstead);
    }
    const { 0: red } = (await page.locator('#panel')
      .evaluate((panel) => getComputedStyle(panel).color)).match(/\d+/);
    assert.equal(Number(red) > 128, colorScheme === 'dark');
    await person.tab('Adjust');
    await person.photograph(colorScheme);
  }, { colorScheme, hash: `#preset=earth${FEW}` });
}

visit('what is on is seen in forced colours', async (person, page) => {
  await page.getByRole('switch', { name: 'Ozone on' }).click();
  await person.rest();
  await page.locator('.card[data-name=air] summary .name').click();
  await page.locator('.card[data-name=air] .segmented').scrollIntoViewIfNeeded();
  const apart = async (buttons, first) => {  // two side by side, below their words
    const { x, y, width, height } = await buttons.nth(first).boundingBox();
    return contrast(page, { x: x + width / 2, y: y + height - 5, width, height: 2 });
  };
  assert.ok((await apart(page.getByRole('tab'), 1)) >= 3, 'the chosen tab');
  assert.ok((await apart(page.locator('.card[data-name=air] .segmented button'), 0)) >= 3, 'the chosen look');
  const edge = async (name) => {  // of the side where no thumb is while it is off
    const { x, y, width, height } = await page.getByRole('switch', { name }).boundingBox();
    return contrast(page, { x: x + 0.7 * width, y: y - 3, width: 0.3 * width + 3, height: height + 6 });
  };
  for (const name of ['Air on', 'Ozone on']) {
    await page.getByRole('switch', { name }).scrollIntoViewIfNeeded();
    assert.ok((await edge(name)) >= 3, name);
  }
  await person.photograph('forced');
}, { forcedColors: 'active', hash: `#preset=earth${FEW}` });

visit('the wheel, or two fingers, zoom', async (person, page) => {
  if (person.size === 'phone') {
    const apart = (gap) => [{ x: 195 - gap, y: 260 }, { x: 195 + gap, y: 260 }];
    await person.touch('touchStart', apart(30));
    for (let gap = 35; gap <= 90; gap += 5) await person.touch('touchMove', apart(gap));
    await person.touch('touchEnd', []);
  } else {
    await page.mouse.move(400, 400);
    for (let i = 0; i < 4; ++i) await page.mouse.wheel(0, -150);
  }
  assert.ok((await person.scene()).camera.fov_deg < 40);
});

visit('keys look, climb, move the sun and show their own help', async (person, page) => {
  await page.getByRole('application', { name: /The sky/ }).focus();
  for (const key of ['ArrowRight', 'ArrowUp', 'w', 'd', '+']) await page.keyboard.press(key);
  const { camera, sun } = await person.scene();
  assert.ok(camera.heading_deg > 0 && camera.pitch_deg > 10 && camera.altitude_km > 0.002);
  assert.ok(camera.fov_deg < 60 && sun.elevation_deg > 30);
  await page.keyboard.press('0');
  assert.equal((await person.scene()).camera, undefined);
  await page.keyboard.press('?');
  assert.ok(await page.getByRole('dialog').isVisible());
  await page.waitForTimeout(200);
  await person.photograph('help');
  await page.keyboard.press('Escape');
  assert.ok(!(await page.getByRole('dialog').isVisible()));
  await page.keyboard.press('c');
  assert.equal(await page.locator('#panel').isVisible(), false);
});

visit('keys of a single character can be switched off, and stay off', async (person, page) => {
  await page.locator('#show-help').click();
  await page.getByRole('switch', { name: /single character/ }).click();
  await page.keyboard.press('Escape');
  const press = async () => {
    await page.locator('#picture').focus();
    for (const key of ['w', 'd', '+', 'p', 'c', '?']) await page.keyboard.press(key);
    assert.deepEqual(await person.scene(), { preset: 'earth' });
    assert.ok(await page.locator('#adjust').isVisible());
    assert.equal(await page.getByRole('dialog').isVisible(), false);
  };
  await press();
  await page.reload();
  await person.there();
  await press();
  await page.keyboard.press('ArrowRight');
  assert.ok((await person.scene()).camera.heading_deg > 0, 'arrows are for the picture alone');
});

visit('everything can be reached with the tabulator', async (person, page) => {
  await page.locator('#picture').focus();
  const reached = new Set();
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement.getAttribute('aria-label') ??
      document.activeElement.textContent.trim()));
  }
  for (const name of ['Help', 'Adjust', 'Elevation', 'Azimuth']) assert.ok(reached.has(name), name);
  await page.getByRole('tab', { name: 'Adjust' }).focus();
  for (const [key, name] of [['End', 'Save'], ['Home', 'Skies'], ['ArrowLeft', 'Save'], ['ArrowRight', 'Skies']]) {
    await page.keyboard.press(key);
    assert.equal(await page.locator('[role=tab][aria-selected=true]:focus').innerText(), name, key);
  }
});

visit('what is asked names the atmosphere that the last answer was for', async (person, page) => {
  const { headers } = await fetch(new URL('/v1/render', page.url()), { method: 'POST', body: JSON.stringify({
    preset: 'earth', image: { width: 16, height: 9 } }) });
  const asked = [];
  page.on('request', (request) => { if (request.method() === 'POST') asked.push(request); });
  await person.type('sun.elevation_deg', '12');
  await person.rest();
  const told = new Set(asked.map((request) => request.headers()['cyanometer-atmosphere']));
  assert.deepEqual([...told], [headers.get('Cyanometer-Atmosphere')]);
});

visit('all of the page comes from the daemon', async (person, page) => {
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  await page.reload();
  for (const tab of ['Skies', 'Adjust', 'Compare', 'Probe', 'Save']) await person.tab(tab);
  await person.rest();
  const { origin } = new URL(page.url());
  assert.ok(asked.length > 20, `${asked.length} requests`);
  assert.deepEqual(asked.filter((address) => !/^(blob|data):/.test(address) && new URL(address).origin !== origin), []);
  assert.deepEqual(person.complaints, []);
});
