// Replicas and nginx as processes, and clients with addresses of their own.

import { spawn } from 'node:child_process';
import { closeSync, openSync, readFileSync } from 'node:fs';
import http from 'node:http';

const binary = process.env.CYANOMETER_BINARY ?? 'build/cyanometer';
const services = JSON.parse(readFileSync(`${process.env.WORK}/services.json`, 'utf8'));

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const until = async (is, seconds, what) => {
  for (let i = 0; i < seconds * 20; ++i) {
    if (await is()) return;
    await sleep(50);
  }
  throw new Error(`waited ${seconds} s for ${what}`);
};

/** A request from an address; never rejects: `status` is 0 where no answer began. */
export function ask(path, { from = '127.1.0.1', host = '127.0.0.1', port = 8000, method = 'GET', body, headers = {} } = {}) {
  return new Promise((resolve) => {
    const answer = { status: 0, headers: {}, whole: false, body: Buffer.alloc(0) };
    const request = http.request(
      { host, port, path, method, headers, localAddress: from, agent: false, timeout: 300_000 },
      (response) => {
        answer.status = response.statusCode;
        answer.headers = response.headers;
        const chunks = [];
        response.on('data', (chunk) => chunks.push(chunk));
        response.on('close', () => {
          answer.whole = response.complete;
          answer.body = Buffer.concat(chunks);
          resolve(answer);
        });
        response.on('error', () => {});
      },
    );
    request.on('error', () => {
      if (answer.status === 0) resolve(answer);
    });
    request.on('timeout', () => request.destroy());
    if (body !== undefined) request.setHeader('Content-Length', Buffer.byteLength(body));
    request.end(body);
  });
}

/** Asks and reads nothing of the answer but its head; the result ends that. */
export const leaveUnread = (path) => new Promise((resolve, reject) => {
  const request = http.get({ host: '127.0.0.1', port: 8000, path, localAddress: stranger(), agent: false },
    (response) => {
      response.on('error', () => {});
      response.pause();
      resolve(() => request.destroy());
    });
  request.on('error', reject);
});

let clients = 0;
/** Another address each time, so that no limit by address is met. */
export const stranger = () => {
  clients += 1;
  return `127.${2 + Math.floor(clients / 62500)}.${Math.floor(clients / 250) % 250}.${1 + (clients % 250)}`;
};

export const render = (scene, options = {}) =>
  ask('/v1/render', { from: stranger(), method: 'POST', body: JSON.stringify(scene), ...options });

class Process {
  constructor(name) {
    this.name = name;
    this.log = `${process.env.WORK}/${name}.log`;
  }
  /** Into a file: what node calls a pipe is a socket, which cannot be opened as /dev/stdout. */
  launch(command, args, env = {}) {
    const log = openSync(this.log, 'a');
    this.child = spawn(command, args, { env: { ...process.env, ...env }, stdio: ['ignore', log, log] });
    closeSync(log);
    this.ended = new Promise((resolve) => this.child.on('exit', resolve));
  }
  get output() { return readFileSync(this.log, 'utf8'); }
  async kill(signal) {
    this.child.kill(signal);
    await this.ended;
  }
}

export class Replica extends Process {
  constructor(name, index) {
    super(name);
    this.address = `127.0.0.${index + 2}`;
  }
  start() {
    this.launch(binary, ['serve', '--listen', `${this.address}:8080`, '--ops-listen', `${this.address}:9090`],
      services[this.name].environment);
  }
  ready() {
    return until(async () => {
      const answer = await ask('/readyz', { host: this.address, port: 9090 });
      return answer.status === 200;
    }, 300, this.name);
  }
  async metric(name) {
    const { body } = await ask('/metrics', { host: this.address, port: 9090 });
    return Number(new RegExp(`^${name} (.*)$`, 'm').exec(body.toString())[1]);
  }
}

export class Nginx extends Process {
  constructor() { super('nginx'); }
  async start() {
    this.launch('nginx', ['-c', `${process.cwd()}/docker/nginx.conf`, '-g', 'daemon off;']);
    await until(async () => (await ask('/metrics')).status === 404, 10, `nginx: ${this.output}`);
  }
  /** What it logged of an answer, once it has. */
  async entry(answer) {
    const id = answer.headers['x-request-id'];
    const find = () => this.output.split('\n').find((line) => line.includes(`"id":"${id}"`));
    await until(find, 5, `a line of ${id}`);
    return JSON.parse(find());
  }
  async replicaOf(answer) {
    return (await this.entry(answer)).replica;
  }
}

export const replicas = Object.keys(services).filter((name) => name.startsWith('replica-')).sort()
  .map((name, index) => new Replica(name, index));
