// SPDX-License-Identifier: MIT
// Pages that follow a player: node live_test.mjs PAPILLA PLAYER FILE.glb PICTURE_FOLDER
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { folder, launch, openUrl, text } from './browser.mjs';

const [papilla, player, file, pictures] = process.argv.slice(2);
const place = mkdtempSync(join(tmpdir(), 'papilla-live-')), socket = join(place, 'player.sock');
folder(pictures);
const running = [];

function start(program, ...options) {
  const child = spawn(program, options, { stdio: ['ignore', 'pipe', 'inherit'] });
  running.push(child);
  return child;
}
const play = () => start(player, file, '--seconds', '300', '--live', socket, '--quiet');

async function finish(child, signal) {
  if (child.exitCode === null && child.signalCode === null) {
    child.kill(signal);
    await once(child, 'exit');
  }
  return child.exitCode;
}

function addressOf(viewer) {
  let said = '';
  return new Promise((resolve, reject) => {
    viewer.stdout.on('data', (chunk) => {
      said += chunk;
      const found = /http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]{32}/.exec(said);
      if (found) resolve(found[0]);
    });
    viewer.on('exit', () => reject(new Error(`papilla view ended: ${said}`)));
  });
}

/** Events of the stream, until `count` samples came. */
async function samples(url, count) {
  const end = new AbortController(), seen = [];
  const response = await fetch(url.replace('/?', '/live?'), { signal: end.signal });
  assert.equal(response.headers.get('content-type'), 'text/event-stream');
  let rest = '';
  for await (const chunk of response.body.pipeThrough(new TextDecoderStream())) {
    const blocks = (rest + chunk).split('\n\n');
    rest = blocks.pop();
    for (const block of blocks) {
      const [, name, data] = /^event: (\w+)\ndata: (.*)$/.exec(block) ?? [];
      if (name) seen.push({ name, data: JSON.parse(data) });
    }
    if (seen.filter((e) => e.name === 'sample').length >= count) break;
  }
  end.abort();
  return seen;
}

/** The status of a request with these headers. */
function status(url, headers = {}) {
  return new Promise((resolve, reject) => request(url, { headers }, (r) => { r.resume(); resolve(r.statusCode); }).on('error', reject).end());
}

/** A thousand connections that hold on: a third sends nothing, a third begins a request, a third follows and never reads. */
async function waitingClients(url) {
  const { port, host, pathname, search } = new URL(url);
  const begins = ['', `GET ${pathname}${search} HTTP/1.1\r\nHost: ${host}\r\nX: `, `GET /live${search} HTTP/1.1\r\nHost: ${host}\r\n\r\n`];
  const sockets = [];
  for (let i = 0; i < 1000; ++i) {
    const socket = connect({ port, host: '127.0.0.1' }).on('error', () => {});
    socket.pause();
    await once(socket, 'connect');
    socket.write(begins[i % 3]);
    sockets.push(socket);
  }
  return sockets;
}

async function follows(page) {
  await page.waitForFunction(() => Number(document.getElementById('live').dataset.count) > 20);
  assert.match(await text(page, '#live-state'), /^Playing on .+ at 1000 Hz\.$/);
  const places = new Set();
  for (let i = 0; i < 20; ++i) {
    places.add(await text(page, '#live-probe'));
    await sleep(50);
  }
  assert.ok(places.size > 5, `the probe moves: ${[...places]}`);
  await page.waitForFunction(() => parseFloat(document.getElementById('live-force').value) > 0);
  const frames = Number(await page.locator('#canvas3d').getAttribute('data-frames'));
  await page.waitForFunction((n) => Number(document.getElementById('canvas3d').dataset.frames) > n + 3, frames);
}

const browser = await launch();
// A browser that keeps its command line, which every user of a machine may read, and the file that stands there.
process.env.XDG_RUNTIME_DIR = place;
process.env.PATH = `${place}:${process.env.PATH}`;
writeFileSync(join(place, 'xdg-open'), '#!/bin/sh\ncp "$1" "$XDG_RUNTIME_DIR/door.html"\necho "$@" > "$XDG_RUNTIME_DIR/command"\n', { mode: 0o755 });
try {
  const first = play();
  while (!existsSync(socket)) await sleep(100);  // it reads the file before it listens
  const viewer = start(papilla, 'view', '--follow', socket);
  const url = await addressOf(viewer);
  while (!existsSync(join(place, 'command'))) await sleep(100);
  const opened = readFileSync(join(place, 'command'), 'utf8').trim();
  assert.ok(opened.startsWith(join(place, 'papilla/')) && !opened.includes('token'), opened);
  assert.ok(readFileSync(join(place, 'door.html'), 'utf8').includes(url));

  // Two listeners beside the page, each with samples of its own.
  for (const seen of await Promise.all([samples(url, 30), samples(url, 30)])) {
    assert.equal(seen[0].name, 'state');
    assert.equal(seen[0].data.state, 'playing');
    assert.equal(seen[0].data.file, file);
    const ticks = seen.filter((e) => e.name === 'sample').map((e) => e.data);
    for (let i = 1; i < ticks.length; ++i) assert.ok(ticks[i].tick > ticks[i - 1].tick, 'ticks grow');
    for (const { probe, proxy, force, contact } of ticks) {
      for (const v of [probe, proxy, force]) assert.ok(v.length === 3 && v.every(Number.isFinite));
      assert.equal(typeof contact, 'boolean');
    }
  }
  assert.equal(await status(url), 200);
  assert.equal(await status(url, { Host: 'example.com' }), 403);
  assert.equal(await status(url, { Origin: 'http://example.com' }), 403);
  for (const path of ['/', '/live', '/none', '/?token=0', `/${new URL(url).search.slice(1)}`]) assert.equal(await status(new URL(path, url)), 403);

  const waiting = await waitingClients(url);
  const { page, complaints } = await openUrl(browser, url);
  await follows(page);
  const curve = await page.locator('#live-plot').boundingBox();
  assert.ok(curve.y > 0 && curve.y + curve.height < page.viewportSize().height && await page.evaluate(() => scrollY) === 0, 'the curve is above the fold');
  for (const seen of await Promise.all([samples(url, 30), samples(url, 30)])) assert.ok(seen.length > 30);
  for (const socket of waiting) socket.destroy();
  await page.screenshot({ path: join(pictures, 'live.png') });
  await page.locator('#live').scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(pictures, 'live-numbers.png') });
  const pageOf = readFileSync(new URL('../../page/src/index.html', import.meta.url), 'utf8');
  assert.match(pageOf, /default-src 'none'/);
  assert.match(await page.locator('meta[http-equiv=Content-Security-Policy]').getAttribute('content'), /; connect-src 'self'$/);
  const elsewhere = await page.evaluate(() => fetch('http://localhost:1/').then(() => 'sent', (e) => e.message));
  assert.match(elsewhere, /Failed to fetch/);
  assert.ok(complaints.splice(0).every((line) => /Content Security Policy|localhost:1/.test(line)));

  await finish(first, 'SIGKILL');  // It can't say that it ends.
  await page.waitForSelector('#live[data-state=ended]');
  assert.match(await text(page, '#live-state'), /^The player has ended/);
  const second = play();
  await page.waitForSelector('#live[data-state=playing]');
  await follows(page);
  assert.equal(await finish(second, 'SIGINT') !== null, true);
  await page.waitForSelector('#live[data-state=ended]');
  assert.deepEqual(complaints, []);

  assert.equal(await finish(viewer, 'SIGINT'), 0);  // With the page still open.
  assert.ok(!existsSync(opened));
  await page.waitForSelector('#live[data-state=lost]');
} finally {
  await browser.close();
  for (const child of running) await finish(child, 'SIGKILL');
  rmSync(place, { recursive: true });
}
