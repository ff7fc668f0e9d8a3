// What the dashboard and the scaler ask Prometheus is there: a real one scrapes a real daemon.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';

import { docker, documents, only, serve } from './manifests.mjs';

const dashboard = JSON.parse(fs.readFileSync(path.join(docker, 'grafana.json'), 'utf8'));
const address = `127.0.0.1:${19000 + Math.floor(Math.random() * 1000)}`;
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'cyanometer-prometheus-'));
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
let daemon;
let prometheus;

async function query(expression) {
  const text = expression.replaceAll('$__rate_interval', '10s');
  const answer = await fetch(`http://${address}/api/v1/query?query=${encodeURIComponent(text)}`);
  const { status, data, error } = await answer.json();
  assert.equal(status, 'success', `${expression}: ${error}`);
  return data.result;
}

/** Two that are rendered, and one that has been kept. */
const renders = (i) => [i, i + 0.5, i].map((exposure) => JSON.stringify({
  image: { width: 16, height: 8, exposure_ev: exposure }, method: { name: 'raymarch' },
}));

before(async () => {
  daemon = await serve();
  fs.writeFileSync(`${work}/prometheus.yml`, JSON.stringify({
    global: { scrape_interval: '1s' },
    scrape_configs: [{ job_name: 'cyanometer', static_configs: [{ targets: [new URL(daemon.ops).host] }] }],
  }));
  prometheus = spawn('prometheus', [`--config.file=${work}/prometheus.yml`, `--storage.tsdb.path=${work}/data`,
    `--web.listen-address=${address}`], { stdio: 'ignore' });
  for (let i = 0; i < 12; ++i) {
    for (const body of renders(i)) await fetch(`${daemon.main}/v1/render`, { method: 'POST', body });
    await sleep(1000);
  }
});

after(async () => {
  prometheus.kill();
  await daemon.stop();
  fs.rmSync(work, { recursive: true, force: true });
});

const targets = dashboard.panels.flatMap((panel) => panel.targets.map((target) => [panel.title, target]));

test('every query of the dashboard has an answer, with the labels of its legend', async () => {
  assert.ok(targets.length > 20);
  for (const [title, { expr, legendFormat }] of targets) {
    const result = await query(expr);
    assert.ok(result.length > 0, `${title}: ${expr}`);
    for (const series of result) assert.ok(Number.isFinite(Number(series.value[1])), `${title}: ${expr} is ${series.value[1]}`);
    for (const [, label] of legendFormat.matchAll(/{{(\w+)}}/g)) {
      assert.ok(result.every((series) => label in series.metric), `${title}: ${label} of ${expr}`);
    }
  }
});

test('every metric of the daemon but histograms\' parts is on the dashboard', async () => {
  const text = await (await fetch(`${daemon.ops}/metrics`)).text();
  const names = [...text.matchAll(/^# TYPE (\w+)/gm)].map(([, name]) => name);
  assert.ok(names.length > 15);
  const shown = targets.map(([, { expr }]) => expr).join('\n');
  assert.deepEqual(names.filter((name) => !shown.includes(name)), []);
});

test('what KEDA asks is one number', async () => {
  const [{ metadata }] = only(documents('keda'), 'ScaledObject').spec.triggers;
  const result = await query(metadata.query);
  assert.equal(result.length, 1);
  assert.equal(result[0].value[1], '0');
});

test('panels have places of their own', () => {
  const places = dashboard.panels.map(({ gridPos }) => `${gridPos.x},${gridPos.y}`);
  assert.equal(new Set(places).size, places.length);
  assert.equal(new Set(dashboard.panels.map(({ id }) => id)).size, places.length);
});
