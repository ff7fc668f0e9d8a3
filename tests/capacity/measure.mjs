// What a start and frames cost on this machine, as the guide says it; with the guide it is compared unless
// it is only to be printed.

import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

import { Daemon } from './daemon.mjs';
import { costTable, differences, replicasDo, statedCosts, usersTable } from './guide.mjs';

const sizes = [[640, 360], [1280, 720], [1920, 1080]];
const warmS = 5;
const measuredS = 15;

/** The processor's time that the daemon spends on a frame, its tables and kernels there. */
async function costOf(daemon, [width, height]) {
  const scene = { image: { width, height } };
  await daemon.load(scene, warmS);
  const cpu = await daemon.metric('process_cpu_seconds_total');
  const rendered = await daemon.metric('cyanometer_frames_rendered_total');
  await daemon.load(scene, measuredS);
  const frames = await daemon.metric('cyanometer_frames_rendered_total') - rendered;
  return { frame: `${width} x ${height}`, cpu_s: (await daemon.metric('process_cpu_seconds_total') - cpu) / frames };
}

async function start(cache, what) {
  const daemon = await Daemon.start({ XDG_CACHE_HOME: cache });
  const cpu = await daemon.metric('process_cpu_seconds_total');
  console.log(`${what}: ready after ${daemon.startS.toFixed(1)} s, ${cpu.toFixed(1)} s of CPU`);
  return daemon;
}

async function measure() {
  const cache = fs.mkdtempSync(path.join(os.tmpdir(), 'cyanometer-capacity-'));
  try {
    await (await start(cache, 'the first start')).stop();
    const daemon = await start(cache, 'a start with its kernels in Mesa\'s cache');
    const costs = [];
    for (const size of sizes) costs.push(await costOf(daemon, size));
    await daemon.stop();
    return costs;
  } finally {
    fs.rmSync(cache, { recursive: true, force: true });
  }
}

const costs = await measure();
console.log(['', costTable(costs), replicasDo(costs), usersTable(costs)].join('\n\n'));
if (!process.argv.includes('--print')) {
  const guide = fs.readFileSync('docker/README.md', 'utf8');
  const wrong = differences(statedCosts(guide), costs);
  for (const line of wrong) console.log(line);
  process.exitCode = wrong.length ? 1 : 0;
}
