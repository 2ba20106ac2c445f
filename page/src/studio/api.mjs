// SPDX-License-Identifier: MIT
// The studio's server: requests with the token of the page's address, and its WebSocket.
const query = new URLSearchParams(location.search);

/** The address of a path with the token and more of a query. */
export function address(path, more = {}) {
  const all = new URLSearchParams(query);
  for (const [name, value] of Object.entries(more)) all.set(name, value);
  return `${path}?${all}`;
}

async function checked(answer) {
  if (answer.ok) return answer;
  const said = await answer.json().catch(() => null);
  throw new Error(said?.error ?? `the server answered ${answer.status}`);
}

export const get = async (path, more) => (await checked(await fetch(address(path, more)))).json();
export const bytes = async (path, more) => (await checked(await fetch(address(path, more)))).arrayBuffer();
export const blob = async (path, more) => (await checked(await fetch(address(path, more)))).blob();
export const post = async (path, body = {}) => (await checked(await fetch(address(path), { method: 'POST', body: JSON.stringify(body) }))).json();

/** Sends a file. @param onProgress gets the share that was sent. @returns {promise, cancel} */
export function upload(path, file, onProgress) {
  const request = new XMLHttpRequest();
  const promise = new Promise((resolve, reject) => {
    request.open('POST', address(path, { name: file.name }));
    request.responseType = 'json';
    request.setRequestHeader('Content-Type', 'application/octet-stream');
    request.upload.addEventListener('progress', (e) => onProgress(e.total ? e.loaded / e.total : 0));
    request.addEventListener('load', () => request.status === 200 ? resolve(request.response) : reject(new Error(request.response?.error ?? `the server answered ${request.status}`)));
    request.addEventListener('error', () => reject(new Error('the server did not answer')));
    request.addEventListener('abort', () => reject(new Error('cancelled')));
    request.send(file);
  });
  return { promise, cancel: () => request.abort() };
}

/** Events of the server by name, "lost" when it has ended, "bytes" for binary messages. */
export class Socket extends EventTarget {
  constructor(port) {
    super();
    this.socket = new WebSocket(`ws://${location.hostname}:${port}/?${query}`);
    this.socket.binaryType = 'arraybuffer';
    this.socket.addEventListener('message', ({ data }) => {
      if (typeof data !== 'string') return this.tell('bytes', data);
      const event = JSON.parse(data);
      return this.tell(event.event, event);
    });
    this.socket.addEventListener('open', () => this.tell('open'));
    this.socket.addEventListener('close', () => this.tell('lost'));
  }

  tell(name, detail) { this.dispatchEvent(new CustomEvent(name, { detail })); }
  on(name, take) { this.addEventListener(name, (e) => take(e.detail)); }
  send(message) { if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message)); }
}

/** A surface of the server: its JSON with the arrays in it (docs/studio.md). */
export function parseSurface(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  for (const [name, { at, count }] of Object.entries(json.arrays)) json.arrays[name] = new (name === 'indices' ? Uint32Array : Float32Array)(buffer, 4 + length + at, count);
  return json;
}
