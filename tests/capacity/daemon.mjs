// A daemon on free ports, what it says of itself, and load on it.

import { execFile, spawn } from 'node:child_process';
import { promisify } from 'node:util';

const binary = process.env.CYANOMETER_BINARY ?? 'build/cyanometer';
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export class Daemon {
  /** Ready; `startS` says after how long. */
  static async start(env) {
    const daemon = new Daemon(env);
    const begin = performance.now();
    while (!await daemon.isReady()) await sleep(20);
    daemon.startS = (performance.now() - begin) / 1000;
    return daemon;
  }

  constructor(env) {
    this.log = '';
    this.child = spawn(binary, ['serve', '--listen', '127.0.0.1:0', '--ops-listen', '127.0.0.1:0'],
      { env: { ...process.env, ...env }, stdio: ['ignore', 'ignore', 'pipe'] });
    this.child.stderr.on('data', (data) => { this.log += data; });
    this.ended = new Promise((resolve) => this.child.on('exit', resolve));
    process.once('exit', () => this.child.kill());
  }

  /** The address of a port, once the daemon has said it. */
  address(name) {
    const found = new RegExp(`"${name}":(\\d+)`).exec(this.log);
    return found && `http://127.0.0.1:${found[1]}`;
  }

  async isReady() {
    if (this.child.exitCode !== null) throw new Error(this.log);
    const ops = this.address('ops_port');
    return ops !== null && (await fetch(`${ops}/readyz`)).ok;
  }

  async metric(name) {
    const text = await (await fetch(`${this.address('ops_port')}/metrics`)).text();
    return Number(new RegExp(`^${name} (.*)$`, 'm').exec(text)[1]);
  }

  /** Frames of a scene, each another one, for so long. */
  async load(scene, seconds) {
    const run = promisify(execFile)(binary,
      ['load', this.address('port'), '--scene', '-', '--clients', '4', '--seconds', `${seconds}`, '--json']);
    run.child.stdin.end(JSON.stringify(scene));
    const report = JSON.parse((await run).stdout);
    if (Object.keys(report.statuses).join() !== '200') throw new Error(JSON.stringify(report.statuses));
    return report;
  }

  stop() {
    this.child.kill('SIGTERM');
    return this.ended;
  }
}
