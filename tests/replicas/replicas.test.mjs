// What the replicas behind nginx promise.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { ask, leaveUnread, Nginx, render, replicas, sleep, stranger } from './service.mjs';

const nginx = new Nginx();
const tiny = { image: { width: 64, height: 36 }, method: { name: 'raymarch' } };
const keyed = (key) => ask('/v1/limits', { from: stranger(), headers: { 'Cyanometer-Atmosphere': key } });
const keys = Array.from({ length: 60 }, (_, i) => `atmosphere${i}`);

async function homes() {
  const found = new Map();
  for (const key of keys) found.set(key, await nginx.replicaOf(await keyed(key)));
  return found;
}

before(async () => {
  for (const replica of replicas) replica.start();
  for (const replica of replicas) await replica.ready();
  await nginx.start();
});

after(async () => {
  await nginx.kill('SIGTERM');
  for (const replica of replicas) await replica.kill('SIGKILL');
});

test('a key has its replica, and each replica has keys', async () => {
  const first = await homes();
  assert.deepEqual(await homes(), first);
  for (const { address } of replicas) {
    const share = [...first.values()].filter((home) => home === `${address}:8080`).length;
    assert.ok(share >= 8, `${address} has ${share} of ${keys.length}`);
  }
});

test('the key that an answer gives leads back to one replica, whatever else changes', async () => {
  const first = await render(tiny);
  assert.equal(first.status, 200);
  const headers = { 'Cyanometer-Atmosphere': first.headers['cyanometer-atmosphere'] };
  const found = new Set();
  for (const elevation of [10, 20, 30, 40]) {
    const answer = await render({ ...tiny, sun: { elevation_deg: elevation } }, { headers });
    assert.equal(answer.headers['cyanometer-atmosphere'], headers['Cyanometer-Atmosphere']);
    found.add(await nginx.replicaOf(answer));
  }
  assert.equal(found.size, 1);
});

test('links of one preset share a replica; equal scenes do, and different ones are spread', async () => {
  const link = (rest) => ask(`/v1/render?preset=mars&image.width=64&image.height=36&method.name=raymarch${rest}`, { from: stranger() });
  const homesOf = async (answers) => new Set(await Promise.all(answers.map((answer) => nginx.replicaOf(answer))));
  const links = [];
  for (const elevation of [5, 6, 7, 8]) links.push(await link(`&sun.elevation_deg=${elevation}`));
  assert.equal((await homesOf(links)).size, 1);
  const equal = [];
  for (let i = 0; i < 4; ++i) equal.push(await render(tiny));
  assert.equal((await homesOf(equal)).size, 1);
  const different = [];
  for (let i = 0; i < 24; ++i) different.push(await render({ ...tiny, image: { ...tiny.image, exposure_ev: i } }));
  assert.equal((await homesOf(different)).size, replicas.length);
});

test('a stream that is not read is not rendered: nothing is buffered on the way', async () => {
  const rendered = async () => {
    let all = 0;
    for (const replica of replicas) all += await replica.metric('cyanometer_frames_rendered_total');
    return all;
  };
  const before = await rendered();
  // Of 3 MB each: a few fill the sockets between here and there.
  const leave = await leaveUnread('/v1/stream?frames=60&to.sun.elevation_deg=5&image.width=512&image.height=512'
    + '&image.format=npy&method.name=raymarch&method.view_nodes=1');
  let last = -1;
  for (let now = await rendered(); now !== last; now = await rendered()) {
    last = now;
    await sleep(3000);
  }
  leave();
  assert.ok(last - before >= 1 && last - before < 30, `${last - before} of 60 frames`);
});

test('the metrics are not for everyone', async () => {
  assert.equal((await ask('/metrics', { from: stranger() })).status, 404);
  assert.equal((await ask('/healthz', { from: stranger() })).status, 200);
});

test('one address that asks too often is told so, another is not', async () => {
  const greedy = await Promise.all(Array.from({ length: 150 }, () => ask('/v1/limits', { from: '127.9.9.9' })));
  const turnedAway = greedy.filter(({ status }) => status === 429);
  assert.ok(turnedAway.length >= 50, `${turnedAway.length} of 150`);
  assert.ok(greedy.some(({ status }) => status === 200));
  for (const answer of turnedAway) {
    assert.equal(answer.headers['content-type'], 'application/problem+json');
    assert.equal(answer.headers['retry-after'], '1');
    assert.equal(JSON.parse(answer.body).status, 429);
  }
  assert.equal((await ask('/v1/limits', { from: stranger() })).status, 200);
});

test('a scene that is too long is refused by the daemon, a body that is longer yet by nginx', async () => {
  const refusal = async (mib) => {
    const answer = await ask('/v1/render', { from: stranger(), method: 'POST', body: ' '.repeat(mib * 2 ** 20 + 1) });
    assert.equal(answer.status, 413, `${mib} MiB`);
    assert.equal(answer.headers['content-type'], 'application/problem+json');
    return JSON.parse(answer.body).detail;
  };
  assert.match(await refusal(8), /8388609 bytes/);
  assert.equal(await refusal(64), 'The body is longer than 64 MiB.');
});

test('what is too much for one replica is done by the others; what is too much for all is turned away with a time', async () => {
  const slow = { image: { width: 64, height: 36 }, method: { name: 'nishita', view_samples: 150, light_samples: 100 } };
  const headers = { 'Cyanometer-Atmosphere': 'one' };
  const answers = await Promise.all(Array.from({ length: 80 }, (_, i) =>
    render({ ...slow, image: { ...slow.image, exposure_ev: i / 100 } }, { headers })));
  const of = (status) => answers.filter((answer) => answer.status === status);
  assert.equal(of(200).length + of(429).length + of(503).length, answers.length);
  assert.ok(of(200).length > 20, `${of(200).length} answered`);
  for (const answer of [...of(429), ...of(503)]) assert.ok(Number(answer.headers['retry-after']) >= 1);
  const used = new Set(await Promise.all(of(200).map(async (answer) => (await nginx.replicaOf(answer)).split(', ').at(-1))));
  assert.equal(used.size, replicas.length);
});

test('a replica killed under load, twenty times: no client is without its answer unless it had begun', async () => {
  let going = true;
  const counts = { whole: 0, begun: 0 };
  const failures = [];
  const client = async (first) => {
    for (let i = first; going; ++i) {
      const answer = await render({ ...tiny, image: { ...tiny.image, exposure_ev: i * 1e-6 } });
      if (answer.status === 200 && answer.whole) counts.whole += 1;
      else if (answer.status === 200) counts.begun += 1;
      else failures.push(`${answer.status} ${answer.body}`);
    }
  };
  const load = Array.from({ length: 6 }, (_, i) => client(i * 100_000));
  for (let kill = 0; kill < 20; ++kill) {
    const replica = replicas[kill % replicas.length];
    await sleep(500);
    await replica.kill('SIGKILL');
    await sleep(500);
    replica.start();
    await replica.ready();
  }
  going = false;
  await Promise.all(load);
  console.log(`# ${counts.whole} answers whole, ${counts.begun} cut short`);
  assert.deepEqual(failures, []);
  assert.ok(counts.whole > 200, `${counts.whole} answers`);
});

test('without one replica the keys of the others stay where they were', async () => {
  const first = await homes();
  const [lost] = replicas;
  await lost.kill('SIGKILL');
  for (const key of keys) {
    const [tried, ...then] = (await nginx.replicaOf(await keyed(key))).split(', ');
    assert.equal(tried, first.get(key));
    assert.equal(then.length > 0, tried === `${lost.address}:8080`);
  }
  lost.start();
  await lost.ready();
});

test('with nobody left it says so, and when to come back', async () => {
  for (const replica of replicas) await replica.kill('SIGKILL');
  const answer = await render(tiny);
  assert.equal(answer.status, 503);
  assert.equal(answer.headers['content-type'], 'application/problem+json');
  assert.ok(Number(answer.headers['retry-after']) >= 1);
});
