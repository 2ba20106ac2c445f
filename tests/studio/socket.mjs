// SPDX-License-Identifier: MIT
// The studio's WebSocket from Node.js, by the module ws of tests/page.
import { once } from 'node:events';
import { createRequire } from 'node:module';
import { ask } from './studio.mjs';

const require = createRequire(new URL('../page/package.json', import.meta.url));

/** Ends the test as skipped where the module is missing. */
export function webSocket() {
  try {
    return require('ws').WebSocket;
  } catch {
    console.log('the module ws is missing (npm ci in tests/page)');
    return process.exit(77);
  }
}

/** Connects as a page of the studio does. @returns {send, next(holds), events, close} */
export async function connect(studio, more = {}) {
  const { port, token, url } = studio, page = await ask(port, `/?token=${token}`, more);
  const second = Number(/"socket":(\d+)/.exec(page.body)[1]), { protocol, host, hostname } = new URL(url);
  const socket = new (webSocket())(`${protocol === 'https:' ? 'wss' : 'ws'}://${hostname}:${second}/?token=${token}`, { origin: `${protocol}//${host}`, ...more.socket });
  const events = [], waiting = new Set();
  socket.on('message', (data) => {
    events.push(JSON.parse(data));
    for (const look of waiting) look();
  });
  await once(socket, 'open');
  return {
    events, send: (message) => socket.send(JSON.stringify(message)),
    /** The first event from `after` on that holds. */
    next: (holds, after = 0) => new Promise((resolve) => {
      const look = () => {
        const found = events.slice(after).find(holds);
        if (!found) return;
        waiting.delete(look);
        resolve(found);
      };
      waiting.add(look);
      look();
    }),
    close: () => { socket.terminate(); },
  };
}
