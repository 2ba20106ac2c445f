// SPDX-License-Identifier: MIT
// What the studio says of a photograph of a known, oblong and turned lattice: node card_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { ask, end, start } from './studio.mjs';

const { bumps, spanTheSame } = await import('../page/bumps.mjs').catch(() => { console.log('fast-png is missing (npm ci in tests/page)'); process.exit(77); });
const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const made = { size: [66, 42], pxPerMm: 10, periods: [6, 8.5], degrees: 17 }, { png, vectors } = bumps(made);
writeFileSync(join(folder, 'plate.obj'), 'o plate\nv 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n');
writeFileSync(join(folder, 'm.json'), '{"materials": {"hard": {"stiffness": 300}}, "assign": []}');

const studio = await start(papilla, ['plate.obj', '-m', 'm.json', '--cache', 'none'], { cwd: folder });
try {
  const { port, token } = studio, good = `?token=${token}`, headers = { origin: `http://127.0.0.1:${port}` };
  const { file } = JSON.parse((await ask(port, `/photograph${good}&name=bumps.png`, { method: 'POST', body: png, headers })).body);
  assert.equal(file, 'bumps.png');
  const add = { kind: 'add', material: 'bumps', values: { '/texture': file, '/size_mm': made.size } };
  assert.equal((await ask(port, `/edit${good}`, { method: 'POST', body: JSON.stringify(add), headers })).status, 200);
  const answer = await ask(port, `/card${good}&material=bumps`);
  assert.equal(answer.status, 200, answer.body);
  const card = JSON.parse(answer.body);

  assert.match(card.class.name, /^strongly_ordered/);
  assert.deepEqual(card.picture.shows_mm, made.size);
  assert.ok(card.lattice);
  console.log(`lattice ${JSON.stringify(card.period_mm)} for ${JSON.stringify(vectors)}; relief of ${card.picture.size_mm.map((mm) => mm.toFixed(2))} mm`);
  assert.ok(spanTheSame(card.period_mm, vectors, 0.03), `${JSON.stringify(card.period_mm)} is not the lattice of ${JSON.stringify(vectors)}`);
  assert.ok(!spanTheSame(card.period_mm.map((v) => v.map((x) => 2 * x)), vectors, 0.03), 'and of no other');

  // The relief, one repeat of which may be a tile of the picture, has the size it says.
  const mm = new Float32Array(Uint8Array.from(Buffer.from(card.relief.mm, 'base64')).buffer), { width, height, size_mm: size } = card.relief;
  assert.equal(mm.length, width * height);
  assert.ok(size.every((length, k) => Math.abs(length - card.picture.size_mm[k]) < 0.02 * length), `${size} mm of ${card.picture.size_mm}`);
  const range = Math.max(...mm) - Math.min(...mm);
  assert.ok(range > 0.5 * card.height.depth_mm && range <= card.height.depth_mm * (1 + 1e-5), `${range} mm of ${card.height.depth_mm}`);
  assert.ok(card.roughness.rms_mm > 0 && card.roughness.rms_mm < card.height.depth_mm);
  assert.ok(card.doubts.some((text) => text.startsWith('depth: ')), card.doubts.join());
  assert.ok(Buffer.from(card.photo, 'base64').subarray(1, 4).equals(Buffer.from('PNG')));

  // With a depth that is said, that is no doubt any more.
  const set = { kind: 'set', material: 'bumps', values: { '/height/depth_mm': 0.2 } };
  await ask(port, `/edit${good}`, { method: 'POST', body: JSON.stringify(set), headers });
  assert.ok(!JSON.parse((await ask(port, `/card${good}&material=bumps`)).body).doubts.some((text) => text.startsWith('depth: ')));
  for (const material of ['hard', 'gone', '']) assert.equal((await ask(port, `/card${good}&material=${material}`)).status, 409, material);
} finally {
  await end(studio.child, 'SIGKILL');
}
