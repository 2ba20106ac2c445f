// SPDX-License-Identifier: MIT
// The studio's server: whom it serves, where it reads and writes, what it keeps: node server_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { ask, end, start } from './studio.mjs';

const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), options = { cwd: work };
writeFileSync(join(work, 'plate.obj'), 'o plate\nv 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n');
writeFileSync(join(folder, 'secret.png'), 'not for the studio');
writeFileSync(join(work, 'm.json'), '{"materials": {"hard": {"stiffness": 2000}}, "assign": []}');
symlinkSync(join(folder, 'secret.png'), join(work, 'link.png'));

/** A page that takes nothing of a long answer for longer than a request may take. @returns the bytes that came, and those that were announced */
async function readLate() {
  const side = 400, at = join(folder, 'large'), lines = [];
  mkdirSync(at);
  for (let i = 0; i < side; ++i) for (let k = 0; k < side; ++k) lines.push(`v ${i} ${k} ${(i * k) % 7}`);
  for (let i = 1; i < side; ++i) for (let k = 1; k < side; ++k) { const a = side * (i - 1) + k; lines.push(`f ${a} ${a + side} ${a + side + 1}`, `f ${a} ${a + side + 1} ${a + 1}`); }
  writeFileSync(join(at, 'large.obj'), lines.join('\n'));
  const large = await start(papilla, ['large.obj', '-m', 'm.json', '--cache', 'none'], { cwd: at }), { port: other, token: word } = large;
  while (!JSON.parse((await ask(other, `/state?token=${word}`)).body).surfaces.length) await sleep(100);
  const line = connect(other, '127.0.0.1', () => line.write(`GET /surface?token=${word}&part=0&slot=0 HTTP/1.1\r\nHost: 127.0.0.1:${other}\r\n\r\n`));
  await sleep(12000);
  const chunks = [];
  line.on('data', (chunk) => chunks.push(chunk));
  await new Promise((resolve) => { line.once('close', resolve); line.once('error', resolve); });
  await end(large.child);
  const all = Buffer.concat(chunks), head = all.indexOf('\r\n\r\n') + 4;
  return { came: all.length - head, announced: Number(/content-length: (\d+)/i.exec(all.subarray(0, head))[1]) };
}
const late = readLate();

let studio = await start(papilla, ['plate.obj', '-m', 'm.json', '--cache', 'none'], options);
const { port, token } = studio, host = `127.0.0.1:${port}`, good = `?token=${token}`;
assert.match(token, /^[0-9a-f]{32}$/);
const post = (path, body, more = {}) => ask(port, path + good, { method: 'POST', body: typeof body === 'string' ? body : JSON.stringify(body), headers: { origin: `http://${host}` }, ...more });
const state = async () => JSON.parse((await ask(port, `/state${good}`)).body);
const until = async (holds) => { for (let i = 0; i < 600; ++i) { const s = await state(); if (holds(s)) return s; await sleep(100); } throw new Error('it did not come'); };

// Whom it serves.
assert.equal((await ask(port, `/${good}`)).status, 200);
const page = await ask(port, `/${good}`);
assert.match(page.headers['content-security-policy'], /default-src 'none'.*frame-ancestors 'none'/);
assert.match(page.headers['content-security-policy'], /connect-src 'self' ws:\/\/127\.0\.0\.1:\d+/);
const socket = Number(/"socket":(\d+)/.exec(page.body)[1]);
for (const [path, headers] of [
  ['/', {}], ['/?token=', {}], [`/?token=${'0'.repeat(32)}`, {}], [`/?token=${token.slice(1)}`, {}], [`/?tokens=${token}`, {}],
  [`/${good}`, { host: 'evil.example' }], [`/${good}`, { host: `evil.example:${port}` }], [`/${good}`, { host: `127.0.0.1:${port + 1}` }],
  [`/${good}`, { origin: 'http://evil.example' }], [`/${good}`, { origin: 'null' }], [`/${good}`, { origin: `http://127.0.0.1:${port + 1}` }],
  [`/${good}`, { referer: 'http://evil.example/' }],
]) {
  const answer = await ask(port, path, { headers });
  assert.equal(answer.status, 403, `${path} ${JSON.stringify(headers)}`);
  assert.equal(answer.body, '');
}
assert.equal((await ask(port, '/edit?token=x', { method: 'POST', body: '{}' })).status, 403);
for (const method of ['PUT', 'DELETE', 'OPTIONS', 'PATCH']) assert.ok((await ask(port, `/state${good}`, { method })).status >= 400, method);
assert.equal((await ask(port, `/nowhere${good}`)).status, 404);
for (const path of ['/../m.json', '/%2e%2e/m.json', '/etc/passwd', '//m.json', '/m.json']) assert.notEqual((await ask(port, path + good)).status, 200, path);

// The WebSocket by the same rules.
function greet(headers, path = `/${good}`) {
  return new Promise((resolve, reject) => {
    const line = connect(socket, '127.0.0.1', () => line.write([`GET ${path} HTTP/1.1`, ...Object.entries({
      Host: `127.0.0.1:${socket}`, Origin: `http://${host}`, Upgrade: 'websocket', Connection: 'Upgrade', 'Sec-WebSocket-Version': 13, 'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ==', ...headers,
    }).filter(([, value]) => value !== null).map(([name, value]) => `${name}: ${value}`), '', ''].join('\r\n')));
    line.once('data', (data) => { resolve({ status: Number(data.toString().split(' ')[1]), line }); });
    line.once('error', reject);
  });
}
for (const [headers, path] of [
  [{ Origin: 'http://evil.example' }], [{ Origin: null }], [{ Host: 'evil.example' }], [{ Origin: `http://127.0.0.1:${socket}` }], [{}, '/?token=0'], [{}, '/'],
]) {
  const { status, line } = await greet(headers, path);
  assert.equal(status, 403, JSON.stringify([headers, path]));
  line.destroy();
}
const window1 = await greet({});  // The studio stays as long as this one is open.
const { status, line } = await greet({});
assert.equal(status, 101);
// A message that is too large ends its connection.
const frame = Buffer.alloc(14 + 70000);
frame.set([0x81, 0xff]);
frame.writeBigUInt64BE(70000n, 2);
const closed = new Promise((resolve) => line.once('close', resolve));
line.on('data', () => {});
line.on('error', () => {});
line.write(frame);
await closed;

// Bodies.
assert.equal((await post('/edit', '{')).status, 409);
assert.equal((await post('/edit', '[]')).status, 409);
assert.equal((await post('/edit', 'x'.repeat((1 << 20) + 1)).catch(() => ({ status: 413 }))).status, 413);

// Changes, back and forth.
await until((s) => s.surfaces.length === 1 && s.surfaces[0].ready);
const onto = (material) => ({ kind: 'assign', surfaces: [[0, 0]], material, title: `${material} onto plate` });
assert.equal(JSON.parse((await post('/edit', onto('hard'))).body).surfaces[0].material, 'hard');
assert.equal((await post('/edit', onto('gone'))).status, 409);
assert.equal((await post('/edit', { ...onto('hard'), surfaces: [[7, 0]] })).status, 409);
assert.equal((await post('/edit', { kind: 'set', material: 'hard', values: { '/stiffness': 'soft' } })).status, 409);
assert.equal((await state()).undo, 'hard onto plate');
assert.equal(JSON.parse((await post('/undo', {})).body).surfaces[0].material, null);
assert.equal(JSON.parse((await post('/redo', {})).body).surfaces[0].material, 'hard');

// What edits would make is made without them; with them it is there at once. A surface has the height map that its tag means.
assert.equal((await ask(port, `/height${good}&part=0&slot=0`)).status, 409);
const waves = { edits: [{ kind: 'add', material: 'waves', values: { '/texture': 'base|mainfunction=.5+.5*s(50.26548*x)', '/size_mm': [16, 12], '/height/depth_mm': 0.1 } }, onto('waves')], title: 'waves onto plate' };
const before = await until((s) => s.surfaces[0].ready), attempt = async () => JSON.parse((await post('/try', waves)).body).surfaces;
let [tried] = await attempt();
for (let i = 0; i < 600 && !tried.ready; ++i) { await sleep(100); [tried] = await attempt(); }
assert.deepEqual([tried.part, tried.slot, tried.material, tried.ready, tried.problem], [0, 0, 'waves', true, '']);
assert.deepEqual(await state(), before);
assert.equal((await post('/try', onto('gone'))).status, 409);
assert.equal((await post('/try', { edits: [] })).status, 409);
assert.deepEqual(JSON.parse((await post('/try', onto('hard'))).body).surfaces, []);
const height = await ask(port, `/height${good}&id=${tried.name}`), wavy = (await ask(port, `/surface${good}&id=${tried.name}`)).bytes;
const { haptic } = JSON.parse(wavy.subarray(4, 4 + wavy.readUInt32LE(0)).toString()).look;
assert.equal(height.headers['content-type'], 'image/png');
assert.equal(createHash('sha256').update(height.bytes).digest('hex'), haptic.height.sha256);
assert.deepEqual(haptic.height.metresPerUV.map((m) => Math.round(1e6 * m)), [16000, 12000]);
assert.ok(Math.abs(haptic.height.scale - 1e-4) < 1e-6 && !haptic.height.uri);
const [assigned] = JSON.parse((await post('/edit', waves)).body).surfaces;
assert.deepEqual([assigned.name, assigned.ready], [tried.name, true]);
await post('/undo', {});

// Decals: one that is tried is there to be seen; one whose picture can't be read says so; what is no decal is refused.
const square = { '/at': [20, 15, 0], '/direction': [0, 0, -1], '/up': [0, 1, 0], '/size_mm': [10, 10], '/depth_mm': 2, '/picture': 'gone.png' };
const { decals: [attempted] } = JSON.parse((await post('/try', { kind: 'add-decal', values: square, onto: 0 })).body);
assert.deepEqual([attempted.number, attempted.surfaces.length, attempted.problem], [0, 1, '']);
await until((s) => s.surfaces[0].ready);
const unread = await ask(port, `/decal${good}&id=${attempted.name}`);
assert.equal(unread.status, 409);
assert.match(unread.body, /gone\.png/);
assert.deepEqual((await state()).decals, []);
for (const [path, query] of [['decal', 'id=none'], ['decal', ''], ['decal-picture', `id=${attempted.name}&image=0`], ['decal-picture', 'id=none&image=0']]) assert.equal((await ask(port, `/${path}${good}&${query}`)).status, 409, path + query);
for (const edit of [{ kind: 'set-decal', decal: 0, values: {} }, { kind: 'remove-decal', decal: 0 }, { kind: 'add-decal', values: { '/picture': 'gone.png' } }, { kind: 'add-decal', values: square, onto: 7 }, { kind: 'add-decal', values: square, onto: 'plate' }])
  assert.equal((await post('/edit', edit)).status, 409, JSON.stringify(edit));

// Carriers: one whose picture can't be read says so; what is no carrier is refused.
assert.equal((await state()).carriers, null);
await post('/edit', { kind: 'add-carrier', values: { '/picture': 'gone.png' }, onto: 0 });
const { carriers: wanted } = await until((s) => s.surfaces[0].ready);
assert.deepEqual(wanted.problems, ['']);
const unseen = await ask(port, `/carriers${good}&id=${wanted.name}`);
assert.equal(unseen.status, 409);
assert.match(unseen.body, /gone\.png/);
for (const [path, query] of [['carriers', 'id=none'], ['carriers', ''], ['carrier-picture', `id=${wanted.name}&rectangle=0&image=0`], ['carrier-picture', 'id=none&rectangle=0&image=0']]) assert.equal((await ask(port, `/${path}${good}&${query}`)).status, 409, path + query);
for (const edit of [{ kind: 'set-carrier', carrier: 1, values: {} }, { kind: 'remove-carrier', carrier: 1 }, { kind: 'add-carrier', values: { '/picture': 'gone.png' } }, { kind: 'add-carrier', values: { '/picture': 'gone.png' }, onto: 7 }])
  assert.equal((await post('/edit', edit)).status, 409, JSON.stringify(edit));
await post('/undo', {});

// Paths.
for (const texture of ['../secret.png', 'link.png', join(folder, 'secret.png'), '/etc/passwd', 'x/../../secret.png']) {
  const answer = await post('/edit', { kind: 'add', material: 'p', values: { '/texture': texture, '/size_mm': [10, 10] } });
  assert.equal(answer.status, 409, texture);
  assert.match(answer.body, /leads out of the folders/);
}
for (const picture of ['../secret.png', 'link.png', '/etc/passwd']) {
  for (const edit of [{ kind: 'add-decal', values: { ...square, '/picture': picture } }, { kind: 'add-carrier', values: { '/picture': picture }, onto: 0 }]) {
    const answer = await post('/edit', edit);
    assert.equal(answer.status, 409, picture);
    assert.match(answer.body, /leads out of the folders/);
  }
}
for (const output of ['../out.glb', '/tmp/out.glb', 'link.png', 'm.json', 'out.txt', '']) assert.equal((await post('/bake', { output })).status, 409, output);
assert.equal((await post('/bake', { output: 'o.glb', report: '../report' })).status, 409);
for (const name of ['../x.obj', '/x.obj', '.x.obj', 'x.sh', '', 'a\\b.obj']) assert.equal((await ask(port, `/open${good}&name=${encodeURIComponent(name)}`, { method: 'POST', body: 'v 0 0 0' })).status, 409, name);
assert.equal(existsSync(join(folder, 'x.obj')), false);

// A surface is its arrays.
const [surface] = (await until((s) => s.surfaces[0].ready)).surfaces;
const { bytes } = await ask(port, `/surface${good}&id=${surface.name}`);
const length = bytes.readUInt32LE(0), told = JSON.parse(bytes.subarray(4, 4 + length).toString());
assert.equal(told.arrays.indices.count, 6);
assert.equal(told.arrays.positions.count, 12);
assert.equal(bytes.length, 4 + length + Math.max(...Object.values(told.arrays).map(({ at, count }) => at + 4 * count)));
assert.equal((await ask(port, `/surface${good}&id=none`)).status, 409);
// Two triangles have no levels of detail, nor has what is not there.
for (const id of [surface.name, 'none']) {
  const levels = (await ask(port, `/levels${good}&id=${id}`)).bytes;
  assert.deepEqual(JSON.parse(levels.subarray(4, 4 + levels.readUInt32LE(0)).toString()), { levels: [] });
}
assert.equal((await ask(port, `/levels${good}`)).status, 409);

// What is not saved is kept: also from a program that is killed.
await sleep(1000);
assert.ok(existsSync(join(work, 'm.json.autosave')));
await end(studio.child, 'SIGKILL');
window1.line.destroy();
assert.deepEqual(JSON.parse(readFileSync(join(work, 'm.json'), 'utf8')).assign, []);
studio = await start(papilla, ['plate.obj', '-m', 'm.json', '--port', String(port), '--token', 'a-token-of-my-own', '--json', 'out.json'], options);
assert.equal(studio.url, `http://127.0.0.1:${port}/?token=a-token-of-my-own`);
assert.deepEqual(JSON.parse(readFileSync(join(work, 'out.json'), 'utf8')), { url: studio.url, port });
const restored = JSON.parse((await ask(port, '/state?token=a-token-of-my-own')).body);
assert.equal(restored.restored, true);
assert.equal(restored.saved, false);
// SIGTERM saves, and leaves nothing beside.
assert.equal(await end(studio.child, 'SIGTERM'), 0);
assert.equal(JSON.parse(readFileSync(join(work, 'm.json'), 'utf8')).assign[0].material, 'hard');
assert.deepEqual(readdirSync(work).sort(), ['link.png', 'm.json', 'out.json', 'plate.obj']);
assert.equal(readFileSync(join(folder, 'secret.png'), 'utf8'), 'not for the studio');

// It ends when the last window is closed.
studio = await start(papilla, ['plate.obj', '-m', 'm.json'], options);
const page2 = await ask(studio.port, `/?token=${studio.token}`);
const window = await new Promise((resolve) => {
  const second = Number(/"socket":(\d+)/.exec(page2.body)[1]);
  const open = connect(second, '127.0.0.1', () => open.write(`GET /?token=${studio.token} HTTP/1.1\r\nHost: 127.0.0.1:${second}\r\nOrigin: http://127.0.0.1:${studio.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n`));
  open.once('data', () => resolve(open));
});
const ended = new Promise((resolve) => studio.child.on('exit', resolve));
window.destroy();
assert.equal(await ended, 0);

const { came, announced } = await late;
assert.ok(announced > 8e6);
assert.equal(came, announced, 'a long answer waits for who takes it late');

// Rubbish on the command line.
for (const [args, code] of [[['gone.step'], 3], [['plate.obj', '--token', 'short'], 2], [['plate.obj', '--port', '70000'], 2], [['plate.obj', '-m', 'plate.obj'], 3]]) {
  let got = 0;
  try { execFileSync(papilla, ['studio', ...args, '--no-open', '--cache', 'none', '--time-limit', '20'], { ...options, stdio: 'pipe' }); } catch (error) { got = error.status; }
  assert.equal(got, code, args.join(' '));
}
