// The tables of docker/README.md that say what frames cost: written, read and compared.

/** Of a cost, either way. */
export const tolerance = 0.15;

const thousands = (number) => Number(number.toPrecision(3)).toLocaleString('en-US');
const short = (number) => (number < 10 ? number.toPrecision(2) : thousands(Math.round(number)));
const duration = (s) => (s < 0.1 ? `${(1000 * s).toPrecision(3)} ms` : `${s.toPrecision(3)} s`);
const either = (texts) => [texts.slice(0, -1).join(', '), texts.at(-1)].join(' or ');
const row = (cells) => `| ${cells.join(' | ')} |`;
const table = (heads, rows) => [row(heads), `${'|---'.repeat(heads.length)}|`, ...rows.map(row)].join('\n');

/** What was measured; a cost is `{frame: '1280 x 720', cpu_s}`. */
export const costTable = (costs) => table(['frame', 'CPU of a frame', 'frames a second a core'],
  costs.map(({ frame, cpu_s: s }) => [frame, duration(s), short(1 / s)]));

const perReplica = 4 * 0.7;

/** What follows from it. */
export const replicasDo = (costs) => 'Replicas of four cores, kept to 70 %, hence do '
  + `${either(costs.map(({ cpu_s: s }) => short(perReplica / s)))} frames a second.`;

export const usersTable = (costs) => table(
  ['users', 'frames a second', ...costs.map(({ frame }, i) => `${i === 0 ? 'cores at' : 'at'} ${frame}`), 'replicas of 4 cores, at 70 %'],
  [1_000, 1_000_000].map((users) => {
    const perSecond = users / 100; // a tenth of them is there and asks every ten seconds
    const cores = costs.map(({ cpu_s: s }) => perSecond * s);
    return [thousands(users), thousands(perSecond), ...cores.map(short), either(cores.map((all) => thousands(Math.ceil(all / perReplica))))];
  }),
);

/** The costs that a guide states. */
export const statedCosts = (guide) => [...guide.matchAll(/^\| (\d+ x \d+) \| ([\d.]+) (ms|s) \|/gm)]
  .map(([, frame, number, unit]) => ({ frame, cpu_s: Number(number) / (unit === 'ms' ? 1000 : 1) }));

/** What a guide states wrongly, or not at all, or that nobody measured. */
export function differences(stated, measured) {
  const frames = new Set([...stated, ...measured].map(({ frame }) => frame));
  const of = (costs, frame) => costs.find((cost) => cost.frame === frame)?.cpu_s;
  return [...frames].flatMap((frame) => {
    const [said, found] = [of(stated, frame), of(measured, frame)];
    if (said === undefined) return [`${frame} is not in the guide`];
    if (found === undefined) return [`${frame} is in the guide and is not measured`];
    if (Math.abs(found / said - 1) <= tolerance) return [];
    return [`${frame}: the guide says ${duration(said)}, measured is ${duration(found)}`];
  });
}
