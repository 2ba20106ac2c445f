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

/** Of a request, or in the middle of its answer. */
export class ConnectionBroke extends Error {}

async function asked(place, init, take) {
  try {
    return await take(await checked(await fetch(place, init)));
  } catch (error) {
    throw error instanceof TypeError ? new ConnectionBroke(error.message) : error;  // As fetch() says it.
  }
}

export const get = (path, more) => asked(address(path, more), {}, (answer) => answer.json());
export const bytes = (path, more) => asked(address(path, more), {}, (answer) => answer.arrayBuffer());
export const blob = (path, more) => asked(address(path, more), {}, (answer) => answer.blob());

const posted = (path, body, more, take) => asked(address(path), { method: 'POST', body: JSON.stringify(body), ...more }, take);
export const post = (path, body = {}) => posted(path, body, {}, (answer) => answer.json());
/** The answer's bytes. @param more of fetch(), such as a signal */
export const postBytes = (path, body, more) => posted(path, body, more, (answer) => answer.arrayBuffer());

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

/** What belongs to a surface beside its arrays; one as it was read has no levels. @param place of the surface: {id}, or {part, slot} as it was read */
export const filesOf = (place) => ({
  picture: (image) => blob('picture', { ...place, image }), height: () => bytes('height', place),
  levels: async () => 'id' in place ? parseLevels(await bytes('levels', place)) : [],
});

/** Events of the server by name, "open" when it tells from now on, "lost" when it has ended, "bytes" for binary messages. */
export class Socket extends EventTarget {
  constructor(port) {
    super();
    this.socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.hostname}:${port}/?${query}`);
    this.socket.binaryType = 'arraybuffer';
    this.socket.addEventListener('message', ({ data }) => {
      if (typeof data !== 'string') return this.tell('bytes', data);
      const event = JSON.parse(data);
      return this.tell(event.event, event);
    });
    this.socket.addEventListener('close', () => this.tell('lost'));
  }

  tell(name, detail) { this.dispatchEvent(new CustomEvent(name, { detail })); }
  on(name, take) { this.addEventListener(name, (e) => take(e.detail)); }
  send(message) { if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message)); }
}

/** A JSON text and the bytes behind it (docs/studio.md): {json, buffer, at: where these begin}. */
export function parseFramed(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  return { json: JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length))), buffer, at: 4 + length };
}

/** Arrays of a surface. @param places {name: {at, count}} in a buffer's bytes that begin at `begin` */
export const arraysOf = (places, buffer, begin) => Object.fromEntries(Object.entries(places).map(([name, { at, count }]) => [name, new (name === 'indices' ? Uint32Array : Float32Array)(buffer, begin + at, count)]));

/** A surface of the server: its JSON with the arrays in it. */
export function parseSurface(bytesOfIt) {
  const { json, buffer, at } = parseFramed(bytesOfIt);
  return { ...json, arrays: arraysOf(json.arrays, buffer, at) };
}

/** Levels of detail of a surface, finest first: [{coverage, indices}]. */
function parseLevels(bytesOfThem) {
  const { json, buffer, at: begin } = parseFramed(bytesOfThem);
  return json.levels.map(({ coverage, at, count }) => ({ coverage, indices: new Uint32Array(buffer, begin + at, count) }));
}
