#!/usr/bin/env node
// How soon the page has a picture: see `--help`.

import { Daemon, openBrowser, SIZES } from './person.js';

const HELP = `usage: tests/web/first_frame.js [TIMES]

The time from the start of the navigation to the first picture on screen, over loopback, for a browser that
has never seen the page and a daemon that has rendered, each time another view of the first sky: the median of TIMES (10) at
each size, the fastest and the slowest; and where the time goes, in the median.

example: tests/web/first_frame.js 20
`;

// Notes when the first picture has been painted, and the milestones before it. Runs in the page.
function watch() {
  window.firstFrame = new Promise((resolve) => {
    const { prototype } = ImageBitmapRenderingContext;
    const asBefore = prototype.transferFromImageBitmap;
    prototype.transferFromImageBitmap = function (bitmap) {
      prototype.transferFromImageBitmap = asBefore;
      const pixels = bitmap.width * bitmap.height;
      const drawn = performance.now();
      asBefore.call(this, bitmap);
      requestAnimationFrame(() => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => {  // after that frame has been painted
          const shown = performance.now();
          const tell = () => {  // the browser notes requests at its leisure
            const [asked] = performance.getEntriesByType('resource').filter(({ name }) => name.endsWith('/v1/render'));
            if (!asked) return setTimeout(tell, 10);
            return resolve({ 'frame asked for': asked.startTime, 'frame there': asked.responseEnd, drawn,
                             'on screen': shown, pixels });
          };
          tell();
        };
        port2.postMessage(undefined);
      });
    };
  });
}

async function load({ browser, daemon }, size, headingDeg) {
  const context = await browser.newContext(SIZES[size]);
  try {
    const page = await context.newPage();
    await page.addInitScript(watch);
    await page.goto(`${daemon.address}#camera.heading_deg=${headingDeg}`, { waitUntil: 'commit' });
    return await page.evaluate(() => window.firstFrame);
  } finally {
    await context.close();
  }
}

const sorted = (values) => [...values].sort((a, b) => a - b);
const median = (values) => {
  const all = sorted(values);
  return (all[Math.floor((all.length - 1) / 2)] + all[Math.ceil((all.length - 1) / 2)]) / 2;
};
const ms = (value) => `${Math.round(value)} ms`;

async function measure(times) {
  const daemon = await Daemon.start();
  const browser = await openBrowser();
  try {
    await load({ browser, daemon }, 'desktop', 0);
    for (const size of Object.keys(SIZES)) {
      const all = [];
      for (let i = 0; i < times; ++i) all.push(await load({ browser, daemon }, size, (1 + i) / 8));
      const totals = sorted(all.map((one) => one['on screen']));
      const steps = Object.keys(all[0]).slice(0, -1).map((step) =>
        `${step} ${ms(median(all.map((one) => one[step])))}`);
      console.log(`${size}: ${ms(median(totals))} (${ms(totals[0])} to ${ms(totals.at(-1))}); ` +
        `${steps.join(', ')}; ${Math.round(median(all.map((one) => one.pixels)))} pixels`);
    }
  } finally {
    await browser.close();
    await daemon.stop();
  }
}

const [argument = '10'] = process.argv.slice(2);
if (argument === '--help' || argument === '-h') process.stdout.write(HELP);
else if (!(Number.isInteger(Number(argument)) && argument > 0)) {
  process.stderr.write(`first_frame.js: TIMES is a whole number above 0, not ${argument}\n`);
  process.exitCode = 2;
} else await measure(Number(argument));
