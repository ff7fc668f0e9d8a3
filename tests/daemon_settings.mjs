// What a daemon with an environment does, and the memory that it may take for that.

import { execFileSync } from 'node:child_process';
import fs from 'node:fs';

const guide = fs.readFileSync(new URL('../docker/README.md', import.meta.url), 'utf8');

/** What the number NAME is for a daemon with this environment. */
export function settingsOf(binary, environment) {
  const usual = execFileSync(binary, ['serve', '--help-markdown'], { encoding: 'utf8' });
  return (name) => Number(environment[name] ?? new RegExp(`\`${name}\` \\| \`(\\d+)\``).exec(usual)[1]);
}

/** The sum of docker/README.md, "What to watch", MiB. */
export function mostMemory(setting) {
  const [, kernel, rest] = /twice the frames alive .*, (\d+) MiB a kernel and (\d+) MiB must fit/.exec(guide).map(Number);
  return setting('CYANOMETER_CACHE_MB') + 2 * setting('CYANOMETER_FRAME_MEMORY_MB')
    + kernel * setting('CYANOMETER_KERNELS') + rest;
}
