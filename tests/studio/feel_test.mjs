// SPDX-License-Identifier: MIT
// Feeling in the studio: a plate by closed forms, every device and force model, and the same forces as papilla-player on
// the baked file: node feel_test.mjs PAPILLA DATA FOLDER PLAYER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { ticksOf } from '../../page/src/studio/feel_batch.mjs';
import { connect } from './socket.mjs';
import { ask, end, start } from './studio.mjs';

const [papilla, , folder, player] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

// An oblong plate, turned about all axes and away from the origin.
const SIZE = [70, 45], AWAY = [310, -120, 80];
const turn = ([x, y, z]) => {
  const [a, b, c] = [0.7, 0.4, -0.5], [x1, y1, z1] = [x, y * Math.cos(c) - z * Math.sin(c), y * Math.sin(c) + z * Math.cos(c)];
  const [x2, y2, z2] = [x1 * Math.cos(b) + z1 * Math.sin(b), y1, -x1 * Math.sin(b) + z1 * Math.cos(b)];
  return [x2 * Math.cos(a) - y2 * Math.sin(a), x2 * Math.sin(a) + y2 * Math.cos(a), z2];
};
const at = (x, y, z) => turn([x, y, z]).map((v, i) => v + AWAY[i]);
const N = turn([0, 0, 1]);
const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0), minus = (a, b) => a.map((v, i) => v - b[i]), length = (a) => Math.hypot(...a);
const corners = [[0, 0], [SIZE[0], 0], SIZE, [0, SIZE[1]]].map(([x, y]) => at(x - SIZE[0] / 2, y - SIZE[1] / 2, 0));
writeFileSync(join(folder, 'plate.obj'), `o plate\n${corners.map((p) => `v ${p.join(' ')}`).join('\n')}\nf 1 2 3\nf 1 3 4\n`);
const K = 350, MU = [0.6, 0.4];
const hard = { stiffness: K, staticFriction: MU[0], dynamicFriction: MU[1] };
writeFileSync(join(folder, 'm.json'), JSON.stringify({ materials: { hard, grained: { ...hard, texture: 'grain:leather', size_mm: [21, 13], height: { depth_mm: 0.3 } } }, assign: [{ part: 'plate', material: 'hard' }] }));

const studio = await start(papilla, ['plate.obj', '-m', 'm.json', '--cache', 'none'], { cwd: folder });
const { port, token } = studio, good = `?token=${token}`;
const get = async (path) => JSON.parse((await ask(port, `/${path}${good}`)).body);
const ready = async (material) => { for (;;) { const s = await get('state'); if (s.surfaces.length === 1 && s.surfaces[0].ready && s.surfaces[0].material === material) return; await sleep(50); } };
await ready('hard');
const page = await connect(studio);
let count = 0;

/** A press along a path [[t, x, y, z], …] in mm. @returns {ready, ticks, state, problem, batches} */
async function press(path, { device = 'touch', model = '', point = AWAY } = {}) {
  const id = `press ${++count}`, after = page.events.length, of = (e) => e.id === id;
  page.send({ feel: 'press', id, device, model, point });
  const first = await page.next((e) => of(e) && e.event === 'feel', after);
  if (first.state !== 'ready') return first;
  for (let i = 0; i < path.length; i += 500) page.send({ feel: 'move', id, path: path.slice(i, i + 500) });
  page.send({ feel: 'move', id, lift: path.at(-1)[0] });
  const last = await page.next((e) => of(e) && e.event === 'feel' && e.state !== 'ready', after);
  const batches = page.events.slice(after).filter((e) => of(e) && e.event === 'felt');
  return { ready: first, ticks: batches.flatMap(ticksOf), state: last.state, problem: last.problem, batches };
}

/** A tap, after which forces have faded in; then onto `depth` below the surface, and along x with a speed in mm/s. */
const stroke = (depth, speed = 0, seconds = 0.5, from = 0) => {
  const path = [[0, 6], [0.05, 6], [0.1, -1], [0.15, 6], [0.3, 6], [0.45, -depth]].map(([t, z]) => [t, ...at(from, 0, z)]);
  if (!speed) return [...path, [0.45 + seconds, ...at(from, 0, -depth)]];
  for (let t = 0; t <= seconds; t += 0.004) path.push([0.55 + t, ...at(from + speed * t, 0, -depth)]);
  return path;
};
const height = (p) => dot(minus(p, AWAY), N);
const radiusOf = (choices, device) => choices.devices.find(({ name }) => name === device).probe_radius_mm;

const choices = await get('feel');
try {
  // At rest: k·δ of the probe's ball; the hand's own spring of 1000 N/m and that of the wall in a row, but for the friction of the handle.
  const radius = radiusOf(choices, 'touch'), rest = await press(stroke(3));
  assert.equal(rest.state, 'lifted');
  assert.equal(rest.ticks.length, 951, 'a tick a millisecond, both ends counted');
  assert.ok(rest.batches.every(({ rows, columns }) => rows.length <= 16 * columns.length));
  const { press: normal, side, probe, hand, contact } = rest.ticks.at(-1), depth = (radius - height(probe)) / 1000;
  assert.ok(contact);
  assert.ok(Math.abs(normal - K * depth) < 1e-3, `${normal} N is not ${K * depth} N`);
  const serial = (radius - height(hand)) / 1000 * K * 1000 / (K + 1000);
  assert.ok(Math.abs(normal - serial) < 0.26, `${normal} N is not ${serial} N by the handle's friction of 0.26 N`);
  assert.ok(side <= MU[0] * normal + 1e-3);
  console.log(`at rest ${normal.toFixed(4)} N, k·d ${(K * depth).toFixed(4)} N`);

  // Sliding: μd·N against the way.
  const slid = (await press(stroke(3, 60, 0.4, -15))).ticks.slice(-100), along = turn([1, 0, 0]);
  const ratios = slid.map(({ press: n, side: f }) => f / n).sort((a, b) => a - b);
  assert.ok(Math.abs(ratios[50] - MU[1]) < 0.01 * MU[1], `μ ${ratios[50]} is not ${MU[1]}`);
  assert.ok(slid.every(({ force }) => dot(force, along) < 0), 'against the way');
  console.log(`sliding ${ratios[50].toFixed(4)} for ${MU[1]}`);

  // Free: nothing.
  const free = await press([[0, ...at(0, 0, 6)], [0.2, ...at(10, 0, 6)]]);
  assert.ok(free.ticks.every(({ total, contact: touches }) => total === 0 && !touches));

  // The device's limit; every device and force model that is offered.
  for (const { name, max_force_n: most } of choices.devices) {
    const deep = await press(stroke(60, 0, 0.5), { device: name });
    assert.ok(deep.ticks.every(({ total }) => total <= most * (1 + 1e-9)), name);
    assert.ok(Math.abs(deep.ticks.at(-1).total - most) < 1e-6 * most, `${name}: ${deep.ticks.at(-1).total} N is not the limit ${most} N`);
  }
  for (const { name } of choices.models) {
    const felt = await press(stroke(2, 50, 0.1, -5), { model: name });
    assert.equal(felt.state, 'lifted', `${name}: ${felt.problem}`);
    assert.ok(felt.ticks.at(-1).total > 0.1, name);
  }
  assert.equal(choices.models.length, 7);

  // A stiffer material than the device holds is told.
  const stiff = { kind: 'set', material: 'hard', values: { '/stiffness': 5000 } };
  await ask(port, `/edit${good}`, { method: 'POST', body: JSON.stringify(stiff), headers: { origin: `http://127.0.0.1:${port}` } });
  for (;;) { const s = await get('state'); if (s.surfaces[0].ready) break; await sleep(50); }
  const softened = await press(stroke(2));
  assert.deepEqual(softened.ready.limits.map(({ material, stiffness_wanted: wanted }) => [material, wanted]), [['hard', 5000]]);
  assert.ok(softened.ready.limits[0].stiffness < 500);
  await ask(port, `/undo${good}`, { method: 'POST', body: '{}', headers: { origin: `http://127.0.0.1:${port}` } });
  await ready('hard');

  // A decal whose opaque half is raised by half a millimetre, with the plate's stiffness.
  const RAISED = 0.5, { halves } = await import('../page/halves.mjs');
  writeFileSync(join(folder, 'logo.png'), halves(64, 32));
  const decal = { '/picture': 'logo.png', '/at': AWAY, '/direction': N.map((v) => -v), '/up': turn([0, 1, 0]), '/size_mm': [40, 20], '/depth_mm': 4, '/height': { depth_mm: RAISED, from: 'alpha' } };
  const post = (path, body = {}) => ask(port, `/${path}${good}`, { method: 'POST', body: JSON.stringify(body), headers: { origin: `http://127.0.0.1:${port}` } });
  assert.equal((await post('edit', { kind: 'add-decal', values: decal })).status, 200);
  assert.equal((await ask(port, `/decal${good}&id=${(await get('state')).decals[0].name}`)).status, 200);
  for (const [from, raised] of [[-10, RAISED], [10, 0]]) {
    const { press: n, probe: p } = (await press(stroke(2, 0, 0.5, from))).ticks.at(-1), wanted = K * (radius + raised - height(p)) / 1000;
    assert.ok(Math.abs(n - wanted) < 0.01, `${n} N at ${from} mm is not ${wanted} N`);
  }
  await post('undo');

  // What can't be felt, and rubbish.
  assert.match((await press(stroke(1), { point: [5000, 0, 0] })).problem, /nothing here has a haptic material/);
  assert.match((await press(stroke(1), { device: 'none' })).problem, /there is no such preset/);
  assert.match((await press(stroke(1), { model: 'none' })).problem, /there is no force model 'none'/);
  for (const text of ['', '[]', '{"feel": "press"}', '{"feel": 1, "id": {}}', '{"feel": "move", "id": "x", "path": 1}', '{"feel": "press", "id": "x", "device": "touch", "point": [null, 0, 0]}', '{"feel": "press", "id": "x", "device": "touch", "point": [1e300, 0, 0]}']) page.send(text === '' ? '' : JSON.parse(text));
  const busy = page.events.length;
  page.send({ feel: 'press', id: 'one', device: 'touch', point: AWAY });
  page.send({ feel: 'press', id: 'two', device: 'touch', point: AWAY });
  assert.match((await page.next((e) => e.id === 'two', busy)).problem, /another press/);
  page.send({ feel: 'move', id: 'one', path: [[0, ...at(0, 0, 6)]] });
  assert.equal((await page.next((e) => e.id === 'one' && e.state && e.state !== 'ready', busy)).state, 'silent', 'a page that says nothing more');

  // The same as papilla-player on the baked file, along the same path.
  await ask(port, `/edit${good}`, { method: 'POST', body: JSON.stringify({ kind: 'assign', surfaces: [[0, 0]], material: 'grained' }), headers: { origin: `http://127.0.0.1:${port}` } });
  await ready('grained');
  const felt = await press(stroke(1.5, 70, 0.6, -20)), { z_up: isZUp } = await get('scene');
  assert.equal(felt.state, 'lifted');
  await ask(port, `/save${good}`, { method: 'POST', body: '{}', headers: { origin: `http://127.0.0.1:${port}` } });
  execFileSync(papilla, ['bake', 'plate.obj', '-m', 'm.json', '-o', 'plate.glb', '-q', '--cache', 'none'], { cwd: folder });
  const inFile = ([x, y, z]) => isZUp ? [x, z, -y] : [x, y, z];
  writeFileSync(join(folder, 'path.csv'), felt.ticks.map(({ t, hand: h }) => [t, ...inFile(h).map((mm) => mm / 1000)].join(',')).join('\n') + '\n');
  // A machine that is busy elsewhere is no pause of the hand.
  execFileSync(player, ['plate.glb', '--device', 'sim:touch', '--trajectory', 'path.csv', '--record', 'record.csv', '--watchdog', '1000', '-q'], { cwd: folder });
  const rows = readFileSync(join(folder, 'record.csv'), 'utf8').trim().split('\n').slice(1).map((line) => line.split(',').map(Number));
  assert.equal(rows.length, felt.ticks.length);
  let worst = 0, most = 0;
  rows.forEach((row, i) => {
    worst = Math.max(worst, length(minus(row.slice(10, 13), inFile(felt.ticks[i].force))));
    most = Math.max(most, felt.ticks[i].total);
  });
  const touching = felt.ticks.filter(({ contact: touches }) => touches), spread = Math.max(...touching.slice(-300).map(({ press: n }) => n)) - Math.min(...touching.slice(-300).map(({ press: n }) => n));
  console.log(`player and studio differ by ${worst.toExponential(2)} N of ${most.toFixed(2)} N; the grain moves the force by ${spread.toFixed(3)} N`);
  assert.ok(most > 0.3 && spread > 0.02, 'the grain is felt');
  assert.ok(worst < 1e-3 * most, `${worst} N`);
} finally {
  page.close();
  await end(studio.child, 'SIGKILL');
}
