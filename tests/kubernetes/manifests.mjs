// What kustomize makes of docker/k8s, and the program that it runs.

import { execFileSync, spawn } from 'node:child_process';
import path from 'node:path';
import { parseAllDocuments } from 'yaml';

export const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const root = path.join(here, '../..');
export const binary = path.resolve(root, process.env.CYANOMETER_BINARY ?? 'build/cyanometer');
export const docker = path.join(root, 'docker');

export const folders = ['base', 'keda', 'gpu', 'batch'];

export const documents = (folder) => parseAllDocuments(
  execFileSync('kubectl', ['kustomize', path.join(docker, 'k8s', folder)], { encoding: 'utf8' }),
).map((document) => document.toJS());

export const only = (list, kind) => {
  const found = list.filter((document) => document.kind === kind);
  if (found.length !== 1) throw new Error(`${found.length} of ${kind}`);
  return found[0];
};

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** A daemon with this environment on free ports, ready; `main` and `ops` are its addresses. */
export async function serve(env = {}) {
  const child = spawn(binary, ['serve', '--listen', '127.0.0.1:0', '--ops-listen', '127.0.0.1:0'],
    { env: { ...process.env, ...env }, stdio: ['ignore', 'ignore', 'pipe'] });
  let log = '';
  child.stderr.on('data', (data) => { log += data; });
  const ended = new Promise((resolve) => child.on('exit', resolve));
  const port = async (name) => {
    for (let i = 0; i < 1000; ++i) {
      const found = new RegExp(`"${name}":(\\d+)`).exec(log);
      if (found) return `http://127.0.0.1:${found[1]}`;
      if (child.exitCode !== null) break;
      await sleep(20);
    }
    throw new Error(log);
  };
  const daemon = {
    main: await port('port'),
    ops: await port('ops_port'),
    stop: () => { child.kill('SIGTERM'); return ended; },
  };
  while ((await fetch(`${daemon.ops}/readyz`)).status !== 200) await sleep(50);
  return daemon;
}
