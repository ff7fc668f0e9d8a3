// The manifests are what the API takes, fit each other, and say what the program knows.

import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';

import { mostMemory, settingsOf } from '../daemon_settings.mjs';
import { binary, documents, folders, here, only, serve } from './manifests.mjs';

const made = new Map(folders.map((folder) => [folder, documents(folder)]));
const labels = { 'app.kubernetes.io/name': 'cyanometer' };

// ---- The API's types ----

const moduleOf = ({ apiVersion }) => (apiVersion.startsWith('keda.sh/')
  ? `@kubernetes-models/keda/${apiVersion}` : `kubernetes-models/${apiVersion}`);

/** Names of the files, of documents by name, in which the compiler finds something wrong. */
function refused(literals) {
  const folder = fs.mkdtempSync(path.join(here, 'node_modules/.literals-'));
  for (const [name, document] of literals) {
    fs.writeFileSync(path.join(folder, `${name}.ts`), `import type { I${document.kind} } from "${moduleOf(document)}";
export const document: I${document.kind} = ${JSON.stringify(document, null, 1)};\n`);
  }
  const { stdout } = spawnSync(path.join(here, 'node_modules/.bin/tsc'),
    ['--noEmit', '--strict', '--skipLibCheck', '--module', 'nodenext', ...[...literals.keys()].map((name) => path.join(folder, `${name}.ts`))],
    { cwd: here, encoding: 'utf8' });
  fs.rmSync(folder, { recursive: true });
  const lines = stdout.split('\n').filter((line) => line.includes('error TS'));
  return { names: new Set(lines.map((line) => path.basename(line.split('(')[0], '.ts'))), lines };
}

const literals = new Map();
for (const [folder, list] of made) {
  for (const document of list) literals.set(`${folder}_${document.kind}`, document);
}

test('every document is one of the API', () => {
  assert.ok(literals.size >= 18, `${literals.size} documents`);
  assert.deepEqual(refused(literals).lines, []);
});

test('a field that the API does not have is seen in each of them, and a value of another type', () => {
  const broken = new Map();
  for (const [name, document] of literals) {
    broken.set(`${name}_field`, { ...document, ...(document.spec ? { spec: { ...document.spec, replica: 1 } } : { dataa: {} }) });
    broken.set(`${name}_type`, { ...document, metadata: { ...document.metadata, name: 1 } });
    const pod = structuredClone(document);
    if (!pod.spec?.template) continue;
    pod.spec.template.spec.containers[0].securityContext.readOnlyRootFileSystem = true;
    broken.set(`${name}_pod`, pod);
  }
  const { names } = refused(broken);
  assert.deepEqual([...broken.keys()].filter((name) => !names.has(name)), []);
});

// ---- Each other ----

const podOf = (list) => (list.find(({ kind }) => kind === 'Deployment') ?? only(list, 'Job')).spec.template;

test('what selects pods selects these pods', () => {
  for (const folder of ['base', 'keda', 'gpu']) {
    const list = made.get(folder);
    const pod = podOf(list);
    assert.deepEqual(pod.metadata.labels, labels);
    assert.deepEqual(only(list, 'Service').spec.selector, labels);
    assert.deepEqual(only(list, 'Deployment').spec.selector.matchLabels, labels);
    assert.deepEqual(only(list, 'PodDisruptionBudget').spec.selector.matchLabels, labels);
    assert.deepEqual(only(list, 'NetworkPolicy').spec.podSelector.matchLabels, labels);
    assert.deepEqual(pod.spec.topologySpreadConstraints[0].labelSelector.matchLabels, labels);
    const scaler = list.find(({ kind }) => kind === 'HorizontalPodAutoscaler' || kind === 'ScaledObject');
    assert.equal(scaler.spec.scaleTargetRef.name, only(list, 'Deployment').metadata.name);
  }
});

test('there is one scaler, and nobody else says how many', () => {
  const scalers = (folder) => made.get(folder).map(({ kind }) => kind)
    .filter((kind) => kind === 'HorizontalPodAutoscaler' || kind === 'ScaledObject');
  assert.deepEqual(scalers('base'), ['HorizontalPodAutoscaler']);
  assert.deepEqual(scalers('keda'), ['ScaledObject']);
  assert.deepEqual(scalers('gpu'), ['ScaledObject']);
  for (const folder of ['base', 'keda', 'gpu']) {
    assert.equal(only(made.get(folder), 'Deployment').spec.replicas, undefined);
  }
});

test('pods are restricted, and lavapipe has as many threads as processors', () => {
  for (const [folder, list] of made) {
    const { spec } = podOf(list);
    assert.equal(spec.securityContext.runAsNonRoot, true, folder);
    assert.equal(spec.securityContext.seccompProfile.type, 'RuntimeDefault');
    assert.equal(spec.automountServiceAccountToken, false);
    const [container] = spec.containers;
    assert.deepEqual(container.securityContext, {
      allowPrivilegeEscalation: false, readOnlyRootFilesystem: true, capabilities: { drop: ['ALL'] },
    });
    assert.deepEqual(container.resources.requests, container.resources.limits);
    const threads = container.env.find(({ name }) => name === 'LP_NUM_THREADS');
    assert.deepEqual(threads.valueFrom, { resourceFieldRef: { resource: 'limits.cpu' } });
    assert.match(container.resources.limits.cpu, /^\d+$/);
  }
});

test('the GPU overlay adds to the base and takes nothing away', () => {
  const container = (folder) => podOf(made.get(folder)).spec.containers[0];
  for (const { name } of container('base').env) {
    assert.ok(container('gpu').env.some((each) => each.name === name), name);
  }
  assert.equal(container('gpu').resources.limits['nvidia.com/gpu'], '1');
  assert.equal(container('gpu').env.find(({ name }) => name === 'CYANOMETER_DEVICE').value, 'NVIDIA');
});

// ---- The program ----

const environment = (container) => Object.fromEntries(
  container.env.filter(({ value }) => value !== undefined).map(({ name, value }) => [name, value]),
);

test('settings are those of the daemon, and it has what the probes ask', async () => {
  const known = execFileSync(binary, ['serve', '--help-markdown'], { encoding: 'utf8' });
  for (const folder of ['base', 'keda', 'gpu']) {
    for (const { name } of podOf(made.get(folder)).spec.containers[0].env) {
      if (name.startsWith('CYANOMETER_')) assert.ok(known.includes(`\`${name}\``), name);
    }
  }
  const [container] = podOf(made.get('base')).spec.containers;
  const daemon = await serve({ ...environment(container), CYANOMETER_DRAIN_S: '0' });
  const ports = { http: daemon.main, ops: daemon.ops };
  assert.deepEqual(container.ports.map(({ name }) => name), Object.keys(ports));
  for (const probe of ['startupProbe', 'readinessProbe', 'livenessProbe']) {
    const { path: asked, port } = container[probe].httpGet;
    assert.equal((await fetch(ports[port] + asked)).status, 200, probe);
  }
  assert.equal(await daemon.stop(), 0);
});

test('what the daemon may take fits into its pod', () => {
  const gibibytes = (amount) => Number(/^(\d+)Gi$/.exec(amount)[1]);
  for (const folder of ['base', 'keda', 'gpu']) {
    const [container] = podOf(made.get(folder)).spec.containers;
    const most = mostMemory(settingsOf(binary, environment(container)));
    const { requests, limits } = container.resources;
    assert.ok(gibibytes(limits.memory) * 1024 >= most, `${folder}: ${most} MiB`);
    assert.equal(requests.memory, limits.memory);
  }
});

test('what is in flight is finished before a pod is killed', () => {
  const { spec } = podOf(made.get('base'));
  const setting = settingsOf(binary, environment(spec.containers[0]));
  assert.ok(spec.terminationGracePeriodSeconds >= setting('CYANOMETER_DEADLINE_S') + setting('CYANOMETER_DRAIN_S'));
});

test('the pods of the Job render the sequence, each frame once', () => {
  const list = made.get('batch');
  const job = only(list, 'Job');
  const { data } = only(list, 'ConfigMap');
  const [container] = job.spec.template.spec.containers;
  const work = fs.mkdtempSync(path.join(os.tmpdir(), 'cyanometer-job-'));
  fs.mkdirSync(`${work}/frames`);
  fs.mkdirSync(`${work}/sequence`);
  // The frames are small ones, for time's sake.
  const scene = { ...JSON.parse(data['scene.json']), image: { width: 16 }, method: { name: 'raymarch' } };
  fs.writeFileSync(`${work}/sequence/scene.json`, JSON.stringify(scene));
  fs.writeFileSync(`${work}/sequence/sequence.json`, data['sequence.json']);
  const run = (index) => spawnSync(binary, container.args.map((argument) => argument.replace(/(^|=)\/(sequence|frames)\//, `$1${work}/$2/`)),
    { env: { ...process.env, JOB_COMPLETION_INDEX: `${index}` }, encoding: 'utf8' });
  for (let index = 0; index < job.spec.completions; ++index) {
    const { status, stderr } = run(index);
    assert.equal(status, 0, stderr);
  }
  const { frames } = JSON.parse(data['sequence.json']);
  const files = fs.readdirSync(`${work}/frames`);
  assert.equal(files.filter((file) => file.endsWith('.exr')).length, frames);
  const lines = files.filter((file) => file.endsWith('.jsonl'))
    .flatMap((file) => fs.readFileSync(`${work}/frames/${file}`, 'utf8').trim().split('\n'));
  assert.equal(new Set(lines.map((line) => JSON.parse(line).frame)).size, frames);
  assert.equal(lines.length, frames);
  assert.match(run(3).stderr, / 0 rendered/);
  // A scene that is refused ends the Job.
  fs.writeFileSync(`${work}/sequence/scene.json`, '{"sun": 1}');
  const [, rule] = job.spec.podFailurePolicy.rules;
  assert.equal(rule.action, 'FailJob');
  assert.deepEqual(rule.onExitCodes.values, [run(0).status]);
  fs.rmSync(work, { recursive: true });
});

test('the scenes of the Job are sound as they are', () => {
  const { data } = only(made.get('batch'), 'ConfigMap');
  const { status, stderr } = spawnSync(binary, ['plan', '-'], { input: data['scene.json'], encoding: 'utf8' });
  assert.equal(status, 0, stderr);
});
