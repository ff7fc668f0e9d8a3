// The guide agrees with itself, and one that is wrong is told.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import { test } from 'node:test';

import { costTable, differences, replicasDo, statedCosts, usersTable } from './guide.mjs';

const guide = fs.readFileSync(new URL('../../docker/README.md', import.meta.url), 'utf8');
const costs = [{ frame: '64 x 36', cpu_s: 0.0123 }, { frame: '640 x 360', cpu_s: 0.456 }];

test('what follows from the costs in the guide is what it says', () => {
  const stated = statedCosts(guide);
  assert.ok(stated.length >= 2);
  assert.ok(guide.replaceAll(/\s+/g, ' ').includes(replicasDo(stated)), replicasDo(stated));
  assert.ok(guide.includes(usersTable(stated)), `\n${usersTable(stated)}`);
});

test('costs are read as they were written', () => {
  assert.deepEqual(statedCosts(costTable(costs)), costs);
});

test('a cost that is a seventh off is let pass, one that is a sixth off is told, and so is one that is missing', () => {
  const times = (factor) => costs.map(({ frame, cpu_s: s }) => ({ frame, cpu_s: factor * s }));
  assert.deepEqual(differences(costs, times(8 / 7)), []);
  assert.deepEqual(differences(costs, times(6 / 7)), []);
  assert.equal(differences(costs, times(7 / 6)).length, 2);
  assert.equal(differences(costs, times(5 / 6)).length, 2);
  assert.deepEqual(differences(costs, costs.slice(1)), ['64 x 36 is in the guide and is not measured']);
  assert.deepEqual(differences(costs.slice(1), costs), ['64 x 36 is not in the guide']);
});
