// A person at the page: a daemon, a browser, hands, and eyes for what goes wrong.

import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { once } from 'node:events';
import { mkdir } from 'node:fs/promises';
import { createServer } from 'node:net';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

import { chromium } from 'playwright-core';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const binary = process.env.CYANOMETER_BINARY ?? path.join(root, 'build/cyanometer');
const screenshots = path.join(root, 'build/web-screenshots');

export const SIZES = {
  desktop: { viewport: { width: 1120, height: 700 } },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true,
           deviceScaleFactor: 2 },
};

async function freePort() {
  const server = createServer().listen(0, '127.0.0.1');
  await once(server, 'listening');
  const { port } = server.address();
  server.close();
  return port;
}

/** A daemon that can be stopped and started again on its port. */
export class Daemon {
  static async start() {
    const daemon = new Daemon();
    daemon.port = await freePort();
    await daemon.resume();
    return daemon;
  }
  get address() {
    return `http://127.0.0.1:${this.port}/`;
  }
  get #runs() {
    return this.process?.exitCode === null && this.process.signalCode === null;
  }
  async resume() {
    if (this.#runs) return;
    this.process = spawn(binary, ['serve', '--log-level', 'warning', '--listen', `127.0.0.1:${this.port}`],
                         { stdio: ['ignore', 'ignore', 'inherit'] });
    for (let attempt = 0; attempt < 1200; ++attempt) {
      const ready = await fetch(`${this.address}readyz`).catch(() => undefined);
      if (ready?.ok) return;
      if (!this.#runs) break;
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error(`${binary} serve did not become ready`);
  }
  async stop() {
    if (!this.#runs) return;
    const exit = once(this.process, 'exit');
    this.process.kill('SIGKILL');
    await exit;
  }
}

export const openBrowser = () => chromium.launch({
  executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--disable-dev-shm-usage'] });

// Counts the page's own requests for frames as they start and end.
function countFrames() {
  const counts = { flying: 0, most: 0, started: 0, failed: 0 };
  window.frameRequests = counts;
  const fetchAsBefore = window.fetch;
  window.fetch = (address, options = {}) => {
    if (address !== '/v1/render') return fetchAsBefore(address, options);
    counts.started++;
    counts.most = Math.max(counts.most, ++counts.flying);
    let ended = false;
    const end = () => {
      if (!ended) counts.flying--;
      ended = true;
    };
    options.signal?.addEventListener('abort', end);
    return fetchAsBefore(address, options).then(
      (answer) => {
        end();
        if (!answer.ok) counts.failed++;
        return answer;
      },
      (error) => {
        end();
        if (error.name !== 'AbortError') counts.failed++;
        throw error;
      });
  };
}

// Notes whether the scene has settled since it last changed, and whether the daemon has said what it is.
function watchScene() {
  window.sceneSettled = true;
  window.sceneKnown = false;
  const dispatchAsBefore = EventTarget.prototype.dispatchEvent;
  EventTarget.prototype.dispatchEvent = function (event) {
    const ofScene = !(this instanceof Node);
    if (ofScene && event.type === 'change') window.sceneSettled = false;
    const answer = dispatchAsBefore.call(this, event);
    if (ofScene && event.type === 'settle') window.sceneSettled = true;
    if (ofScene && event.type === 'resolve') window.sceneKnown = true;
    return answer;
  };
}

const PATIENCE_MS = 90000;  // laws, not speeds: machines may be slow

/** Somebody who looks at the page; what the console complains of is in `complaints`. */
export class Person {
  /**
   * Comes to the page at one of `SIZES` and waits until the sky is there. `hash` names the sky; `patience`
   * is what each wait may take from then on, in ms; `breakage` the `{ file, text, instead }` that is served otherwise (no
   * file where there is no text); what else there is goes to the browser.
   */
  static async arrive({ browser, daemon }, size, { hash = '#preset=earth', patience = PATIENCE_MS, breakage, ...options } = {}) {
    const person = new Person();
    Object.assign(person, { size, patience: PATIENCE_MS, whole: !breakage, complaints: [] });
    person.context = await browser.newContext({ ...SIZES[size], acceptDownloads: true, ...options });
    await person.context.grantPermissions(['clipboard-read', 'clipboard-write']);
    person.page = await person.context.newPage();
    person.page.setDefaultTimeout(PATIENCE_MS);
    person.page.on('console', (message) => {
      if (message.type() === 'error') person.complaints.push(message.text());
    });
    person.page.on('pageerror', (error) => person.complaints.push(String(error)));
    await person.page.addInitScript(countFrames);
    await person.page.addInitScript(watchScene);
    if (breakage) await person.#break(breakage);
    try {
      await person.page.goto(daemon.address + hash);
      await person.there();
    } catch (error) {
      await person.leave();
      throw error;
    }
    person.patience = patience;
    person.page.setDefaultTimeout(patience);
    return person;
  }

  async #break({ file, text, instead }) {
    const place = file === 'index.html' ? '/' : `/${file}`;
    await this.context.route(({ pathname }) => pathname === place, async (route) => {
      if (text === undefined) return route.fulfill({ status: 404 });
      const response = await route.fetch();
      return route.fulfill({ response, body: (await response.text()).replace(text, () => instead) });
    });
  }

  /** Waits until all of the page is there. */
  async there() {
    await this.page.locator('.fold').first().waitFor();
    await this.page.waitForFunction(() => window.sceneKnown);
    await this.rest();
  }
  /** Waits until the picture on screen is the final one. */
  async rest() {
    await this.settle();
    await this.page.waitForFunction(() => {
      const picture = document.getElementById('picture');
      const full = Math.round(picture.clientWidth * devicePixelRatio);
      return window.sceneSettled && window.frameRequests.flying === 0 && picture.dataset.state === 'sharp' &&
        Math.abs(picture.width - full) <= 2;
    }, undefined, { timeout: this.patience });
  }
  /** Waits until what was changed last is in the history, the address and the texts. */
  async settle() {
    await this.page.evaluate(() => new Promise((resolve) => {  // a new layout is noticed within a frame
      requestAnimationFrame(() => requestAnimationFrame(resolve));
    }));
    await this.page.waitForFunction(() => window.sceneSettled);
  }
  /** Looks until `look()` is true. @throws TimeoutError that says `words` */
  async until(look, words) {
    for (const ends = Date.now() + this.patience; !(await look());) {
      if (Date.now() > ends) throw Object.assign(new Error(words), { name: 'TimeoutError' });
    }
  }
  async leave() {
    await this.context.close();
  }

  control(path) {
    return this.page.locator(`.control[data-path="${path}"]`);
  }
  /** Opens what the control of `path` is folded away in, and returns the control. */
  async find(path) {
    const control = this.control(path);
    await control.evaluate((element) => {
      for (let fold = element.closest('details'); fold; fold = fold.parentElement.closest('details')) {
        fold.open = true;
      }
      element.scrollIntoView({ block: 'center' });
    });
    return control;
  }
  async type(path, text) {
    const typed = (await this.find(path)).locator('.typed').first();
    await typed.fill(text);
    await typed.press('Enter');
  }
  async tab(name) {
    await this.page.getByRole('tab', { name }).click();
  }

  /** The hand goes down at a point of the window, in CSS pixels: a mouse; on a phone a finger. */
  async press(x, y) {
    this.hand = { x, y };
    if (this.size === 'phone') return this.touch('touchStart', [this.hand]);
    await this.page.mouse.move(x, y);
    await this.page.mouse.down();
  }
  async move(x, y, steps = 1) {
    const from = this.hand;
    for (let i = 1; i <= steps; ++i) {
      this.hand = { x: from.x + (i / steps) * (x - from.x), y: from.y + (i / steps) * (y - from.y) };
      if (this.size === 'phone') await this.touch('touchMove', [this.hand]);
      else await this.page.mouse.move(this.hand.x, this.hand.y);
    }
  }
  async lift() {
    if (this.size === 'phone') await this.touch('touchEnd', []);
    else await this.page.mouse.up();
  }
  /** `fingers`: [{x, y}] of those that are down. */
  async touch(type, fingers) {
    this.client ??= await this.context.newCDPSession(this.page);
    await this.client.send('Input.dispatchTouchEvent',
                           { type, touchPoints: fingers.map((spot, id) => ({ ...spot, id })) });
  }

  /** Presses at `from`, moves through the points and lets go: {x, y} of the picture, 0 to 1. */
  async drag(from, ...points) {
    const box = await this.page.locator('#picture').boundingBox();
    const spot = ({ x, y }) => [box.x + x * box.width, box.y + y * box.height];
    await this.press(...spot(from));
    for (const point of points) await this.move(...spot(point), 8);
    await this.lift();
  }

  /** Holds what is asked of an address: `next()` is the route of the next question, `asked` are those to come. */
  async intercept(address) {
    const asked = [];
    await this.page.route(address, (route) => { asked.push(route); });
    const next = async () => {
      await this.until(() => this.page.waitForTimeout(20).then(() => asked.length), `nobody asks ${address}`);
      return asked.shift();
    };
    return { next, asked };
  }

  /** The scene that the address names, as the page's own JSON. */
  async scene() {
    await this.settle();
    return JSON.parse(await this.page.locator('pre[aria-label="The scene: JSON"]').textContent());
  }
  hash() {
    return decodeURIComponent(new URL(this.page.url()).hash);
  }
  requests() {
    return this.page.evaluate(() => window.frameRequests);
  }
  /** A fingerprint of the picture, to see whether it has changed. */
  async look() {
    const address = await this.page.locator('#picture').evaluate((canvas) => canvas.toDataURL());
    return createHash('sha256').update(address).digest('hex');
  }
  /** A fingerprint of what is on the window around a spot of the picture, {x, y} from 0 to 1. */
  async patch({ x, y }) {
    const box = await this.page.locator('#picture').boundingBox();
    const clip = { x: Math.round(box.x + x * box.width) - 4, y: Math.round(box.y + y * box.height) - 4,
                   width: 8, height: 8 };
    return createHash('sha256').update(await this.page.screenshot({ clip })).digest('hex');
  }
  async photograph(name) {
    if (!this.whole) return;
    await mkdir(screenshots, { recursive: true });
    await this.page.screenshot({ path: path.join(screenshots, `${this.size}-${name}.png`) });
  }
}
