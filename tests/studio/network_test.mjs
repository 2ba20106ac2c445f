// SPDX-License-Identifier: MIT
// The studio by https, with a certificate of the test: node network_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { connect } from './socket.mjs';
import { ask, end, start } from './studio.mjs';

const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
if (spawnSync('openssl', ['version']).error) {
  console.log('openssl is missing');
  process.exit(77);
}
const make = (name, ...more) => execFileSync('openssl', ['req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-days', '2', '-subj', '/CN=studio', '-keyout', `${name}-key.pem`, '-out', `${name}.pem`, ...more], { cwd: folder, stdio: 'pipe' });
make('good', '-addext', 'subjectAltName=DNS:studio.test,DNS:*.pattern.test,IP:127.0.0.1,IP:fd00::7');
make('other', '-addext', 'subjectAltName=DNS:other.test');
make('nameless');
execFileSync('openssl', ['rsa', '-aes128', '-passout', 'pass:secret', '-in', 'good-key.pem', '-out', 'locked-key.pem'], { cwd: folder, stdio: 'pipe' });
writeFileSync(join(folder, 'text.pem'), 'no certificate');
writeFileSync(join(folder, 'plate.obj'), 'o plate\nv 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n');

const ca = readFileSync(join(folder, 'good.pem'));
const studio = await start(papilla, ['plate.obj', '--cache', 'none', '--tls', 'good.pem', 'good-key.pem'], { cwd: folder });
try {
  const { port, token } = studio, good = `?token=${token}`, tls = { ca, servername: 'studio.test' };
  assert.equal(studio.url, `https://studio.test:${port}/?token=${token}`, 'under the first name of the certificate');

  // Under each of its names, by https alone; else as without.
  for (const host of ['studio.test', '127.0.0.1', 'localhost', '[fd00::7]']) {
    const page = await ask(port, `/${good}`, { tls, headers: { host: `${host}:${port}`, origin: `https://${host}:${port}` } });
    assert.equal(page.status, 200, host);
    assert.match(page.headers['content-security-policy'], /connect-src 'self' wss:\/\/studio\.test:\d+ wss:\/\/127\.0\.0\.1:\d+/);
    assert.doesNotMatch(page.headers['content-security-policy'], / ws:/);
  }
  for (const [path, headers] of [
    ['/', {}], [`/?token=${'0'.repeat(32)}`, {}], [`/${good}`, { host: `evil.test:${port}` }], [`/${good}`, { host: `x.pattern.test:${port}` }],
    [`/${good}`, { origin: `http://127.0.0.1:${port}` }], [`/${good}`, { origin: 'https://evil.test' }], [`/${good}`, { origin: `https://studio.test:${port}` }],
  ]) {
    const answer = await ask(port, path, { tls, headers: { host: `127.0.0.1:${port}`, ...headers } });
    assert.equal(answer.status, 403, `${path} ${JSON.stringify(headers)}`);
    assert.equal(answer.body, '');
  }
  await assert.rejects(ask(port, `/${good}`, { tls: { servername: 'studio.test' } }), /self-signed|self signed/, 'nobody trusts it who does not know it');
  await assert.rejects(ask(port, `/${good}`), 'no http there');
  await assert.rejects(ask(port, `/${good}`, { tls: { ...tls, maxVersion: 'TLSv1.1' } }), 'no old protocol');

  // The WebSocket.
  const local = { ...studio, url: studio.url.replace('studio.test', '127.0.0.1') };
  const page = await connect(local, { tls, headers: { host: `127.0.0.1:${port}` }, socket: tls });
  await page.next(({ event }) => event === 'open');
  page.send({ feel: 'press', id: 'here', device: 'touch', point: [20, 15, 0] });
  assert.equal((await page.next((e) => e.id === 'here')).state, 'failed', 'it answers');
  page.close();
  await assert.rejects(connect(local, { tls, headers: { host: `127.0.0.1:${port}` }, socket: { ...tls, origin: 'https://evil.test' } }), /403/);
} finally {
  await end(studio.child, 'SIGKILL');
}

// Files of no use.
for (const [files, code, reason] of [
  [['gone.pem', 'good-key.pem'], 3, /gone\.pem/], [['good.pem', 'gone.pem'], 3, /gone\.pem/], [['text.pem', 'good-key.pem'], 3, /text\.pem: is no certificate in PEM/],
  [['good.pem', 'text.pem'], 3, /text\.pem: is no private key/], [['good.pem', 'locked-key.pem'], 3, /locked-key\.pem: is no private key in PEM without a password/],
  [['good.pem', 'other-key.pem'], 3, /other-key\.pem: is not the key of good\.pem/], [['nameless.pem', 'nameless-key.pem'], 3, /nameless\.pem: names no host/], [['good.pem'], 2, /--tls/],
]) {
  const { status, stderr } = spawnSync(papilla, ['studio', 'plate.obj', '--no-open', '--cache', 'none', '--time-limit', '20', '--tls', ...files], { cwd: folder, encoding: 'utf8' });
  assert.equal(status, code, `${files}: ${stderr}`);
  assert.match(stderr, reason);
  if (code === 3) assert.equal(stderr.trim().split('\n').length, 1, stderr);
}
