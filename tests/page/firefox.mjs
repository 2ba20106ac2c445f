// SPDX-License-Identifier: MIT
// Firefox with one page, with 3D: it draws so on a display only, here that of Xvfb, and is driven over WebDriver BiDi.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

const firefox = ['/usr/bin/firefox-esr', '/usr/bin/firefox'].find((place) => existsSync(place));
const { WebSocket } = await import('ws').catch(() => ({}));
if (!firefox || !WebSocket || !existsSync('/usr/bin/Xvfb')) {
  console.log('firefox, Xvfb or the module ws is missing');
  process.exit(77);
}
const place = mkdtempSync(join(tmpdir(), 'papilla-firefox-')), running = [];

function start(program, options, env = {}) {
  const child = spawn(program, options, { stdio: ['ignore', 'ignore', 'pipe', 'pipe'], env: { ...process.env, HOME: place, ...env } });
  running.push(child);
  return child;
}

/** What the stream says first that the expression finds. */
async function said(stream, expression) {
  let text = '';
  for await (const chunk of stream.iterator({ destroyOnReturn: false })) {
    text += chunk;
    const found = expression.exec(text);
    if (found) return found[1];
  }
  throw new Error(`ended with: ${text}`);
}

/** A connection that asks and hears complaints. */
class Session {
  constructor(socket) {
    this.asked = new Map();
    this.complaints = [];
    this.socket = socket;
    socket.on('message', (message) => {
      const data = JSON.parse(message);
      if (data.id) this.asked.get(data.id)(data);
      else if (data.method === 'log.entryAdded' && data.params.level === 'error') this.complaints.push(data.params.text);
    });
  }

  async ask(method, params = {}) {
    const id = this.asked.size + 1;
    const answer = await new Promise((resolve) => {
      this.asked.set(id, resolve);
      this.socket.send(JSON.stringify({ id, method, params }));
    });
    assert.equal(answer.type, 'success', JSON.stringify(answer));
    return answer.result;
  }

  async value(expression) {
    const { result } = await this.ask('script.evaluate', { expression, target: { context: this.context }, awaitPromise: true });
    return result.value;
  }

  async until(expression) {
    while (!(await this.value(expression))) await sleep(200);
  }
}

async function connect(address) {
  const socket = new WebSocket(`${address}/session`);
  await once(socket, 'open');
  const session = new Session(socket);
  await session.ask('session.new', { capabilities: {} });
  await session.ask('session.subscribe', { events: ['log.entryAdded'] });
  const { contexts } = await session.ask('browsingContext.getTree');
  session.context = contexts[0].context;
  await session.ask('browsingContext.setViewport', { context: session.context, viewport: { width: 1400, height: 950 } });
  return session;
}

/** @returns a Session whose page is there; picture(file) keeps what it shows, close() ends the browser */
export async function openFirefox(url) {
  const display = await said(start('/usr/bin/Xvfb', ['-displayfd', '3', '-screen', '0', '1500x1200x24']).stdio[3], /(\d+)\n/);
  writeFileSync(join(place, 'user.js'), 'user_pref("webgl.force-enabled", true);\n');
  const browser = start(firefox, ['--profile', place, '--remote-debugging-port', '0', '--no-remote', 'about:blank'], { DISPLAY: `:${display}`, LIBGL_ALWAYS_SOFTWARE: '1' });
  const session = await connect(await said(browser.stderr, /WebDriver BiDi listening on (ws:\S+)/));
  await session.ask('browsingContext.navigate', { context: session.context, url, wait: 'complete' });
  session.picture = async (file) => {
    const { data } = await session.ask('browsingContext.captureScreenshot', { context: session.context });
    writeFileSync(file, Buffer.from(data, 'base64'));
  };
  session.close = async () => {
    await session.ask('browser.close');
    await once(browser, 'exit');
  };
  return session;
}

/** Whatever happened. */
export function endFirefox() {
  for (const child of running) child.kill('SIGKILL');
  rmSync(place, { recursive: true, force: true, maxRetries: 5 });
}
