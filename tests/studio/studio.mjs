// SPDX-License-Identifier: MIT
// Starts a studio, and asks its server.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { request } from 'node:http';
import { request as requestTls } from 'node:https';

/** @returns {child, url, port, token, said} */
export async function start(papilla, args, options = {}) {
  const child = spawn(papilla, ['studio', ...args, '--no-open'], { stdio: ['ignore', 'pipe', 'pipe'], ...options });
  let out = '', errors = '';
  child.stderr.on('data', (chunk) => { errors += chunk; });
  const url = await new Promise((resolve, reject) => {
    child.stdout.on('data', (chunk) => {
      out += chunk;
      const found = /studio: (https?:\/\/[\w.]+:\d+\/\?token=[\w-]+)/.exec(out);
      if (found) resolve(found[1]);
    });
    child.on('exit', (code) => reject(new Error(`papilla studio ended with ${code}: ${out} ${errors}`)));
  });
  const { port, searchParams } = new URL(url);
  return { child, url, port: Number(port), token: searchParams.get('token'), said: () => out + errors };
}

export async function end(child, signal = 'SIGTERM') {
  if (child.exitCode !== null || child.signalCode !== null) return child.exitCode;
  child.kill(signal);
  const [code] = await once(child, 'exit');
  return code;
}

/** A request with headers as they are given. @param tls {ca, servername} for https @returns {status, body, headers} */
export function ask(port, path, { method = 'GET', headers = {}, body, tls } = {}) {
  return new Promise((resolve, reject) => {
    const sent = (tls ? requestTls : request)({ host: '127.0.0.1', port, path, method, headers, ...tls }, (answer) => {
      const chunks = [];
      answer.on('data', (chunk) => chunks.push(chunk));
      answer.on('end', () => resolve({ status: answer.statusCode, headers: answer.headers, bytes: Buffer.concat(chunks), body: Buffer.concat(chunks).toString() }));
    });
    sent.on('error', reject);
    if (body !== undefined) sent.write(body);
    sent.end();
  });
}
