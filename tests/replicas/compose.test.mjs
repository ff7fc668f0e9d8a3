// docker/compose.yaml holds its containers in, and agrees with the image, nginx and the guide.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import { test } from 'node:test';

import { mostMemory, settingsOf } from '../daemon_settings.mjs';

const binary = process.env.CYANOMETER_BINARY ?? 'build/cyanometer';
const services = JSON.parse(fs.readFileSync(`${process.env.WORK}/services.json`, 'utf8'));
const { nginx, ...replicas } = services;
const image = fs.readFileSync('docker/Dockerfile', 'utf8');
const conf = fs.readFileSync('docker/nginx.conf', 'utf8');
const seconds = (text) => Number(/^(\d+)s$/.exec(text)[1]);

test('no container runs as root, writes to its root or can gain rights', () => {
  for (const [name, service] of Object.entries(services)) {
    const [, user] = service.build ? /^USER (\S+)$/m.exec(image) : [];
    assert.match(service.user ?? user, /^[1-9]\d*:[1-9]\d*$/, name);
    assert.equal(service.read_only, true, name);
    assert.deepEqual(service.cap_drop, ['ALL'], name);
    assert.deepEqual(service.security_opt, ['no-new-privileges:true'], name);
    assert.equal(service.privileged ?? service.cap_add, undefined, name);
  }
});

test('nginx knows each replica, and waits until it is healthy, which the image tells', () => {
  const names = Object.keys(replicas);
  assert.ok(names.length >= 2);
  assert.deepEqual([...conf.matchAll(/^ *server (.*):8080 /gm)].map(([, name]) => name), names);
  assert.match(image, /CYANOMETER_LISTEN=0\.0\.0\.0:8080 /);
  assert.deepEqual(nginx.depends_on, Object.fromEntries(names.map((name) => [name, { condition: 'service_healthy' }])));
  assert.match(image, /^HEALTHCHECK .*\\\n +CMD \[/m);
  for (const [name, { healthcheck }] of Object.entries(replicas)) assert.equal(healthcheck, undefined, name);
});

test('what a replica may take fits into its memory, and lavapipe has as many threads as processors', () => {
  for (const [name, { mem_limit: limit, cpus, environment }] of Object.entries(replicas)) {
    const most = mostMemory(settingsOf(binary, environment));
    assert.ok(Number(/^(\d+)g$/.exec(limit)[1]) * 1024 >= most, `${name}: ${most} MiB`);
    assert.equal(environment.LP_NUM_THREADS, `${cpus}`, name);
  }
});

test('what is in flight is finished before a replica is killed', () => {
  for (const [name, { stop_grace_period: grace, environment }] of Object.entries(replicas)) {
    const setting = settingsOf(binary, environment);
    assert.ok(seconds(grace) >= setting('CYANOMETER_DEADLINE_S') + setting('CYANOMETER_DRAIN_S'), name);
  }
});

test('nginx takes bodies as long as the daemon does, and writes where it may', () => {
  const [, mib] = /client_max_body_size (\d+)m;/.exec(conf);
  assert.equal(Number(mib), settingsOf(binary, {})('CYANOMETER_MAX_BODY_MB'));
  const written = [...conf.matchAll(/^ *(?:pid|\w+_temp_path) (.*);/gm)].map(([, path]) => path);
  assert.equal(written.length, 6);
  for (const path of written) assert.ok(nginx.tmpfs.some((folder) => path.startsWith(`${folder}/`)), path);
});
