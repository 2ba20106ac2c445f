// SPDX-License-Identifier: MIT
// The studio's server: whom it serves, where it reads and writes, what it keeps: node server_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
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

// Paths.
for (const texture of ['../secret.png', 'link.png', join(folder, 'secret.png'), '/etc/passwd', 'x/../../secret.png']) {
  const answer = await post('/edit', { kind: 'add', material: 'p', values: { '/texture': texture, '/size_mm': [10, 10] } });
  assert.equal(answer.status, 409, texture);
  assert.match(answer.body, /leads out of the folders/);
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
assert.equal(bytes.length, 4 + length + told.arrays.indices.at + 4 * 6);
assert.equal((await ask(port, `/surface${good}&id=none`)).status, 409);

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

// Rubbish on the command line.
for (const [args, code] of [[['gone.step'], 3], [['plate.obj', '--token', 'short'], 2], [['plate.obj', '--port', '70000'], 2], [['plate.obj', '-m', 'plate.obj'], 3]]) {
  let got = 0;
  try { execFileSync(papilla, ['studio', ...args, '--no-open', '--cache', 'none', '--time-limit', '20'], { ...options, stdio: 'pipe' }); } catch (error) { got = error.status; }
  assert.equal(got, code, args.join(' '));
}
