// SPDX-License-Identifier: MIT
// Shows that validate.mjs passes a clean file and fails one with an error, a warning, no glTF in it, or no file.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const folder = mkdtempSync(join(tmpdir(), 'papilla-validate-'));
const script = join(import.meta.dirname ?? new URL('.', import.meta.url).pathname, 'validate.mjs');

/** The exit code and the first line's report for a file of that content; without content the file is missing. */
function run(content) {
  const file = join(folder, 'test.gltf');
  rmSync(file, { force: true });
  if (content !== undefined) writeFileSync(file, content);
  const { status, stdout } = spawnSync(process.execPath, [script, file], { encoding: 'utf8' });
  if (status === 77) process.exit(77);
  return { status, ...JSON.parse(stdout.split('\n')[0]) };
}

try {
  const clean = run('{"asset": {"version": "2.0"}}');
  assert.deepEqual([clean.status, clean.errors, clean.warnings], [0, 0, 0]);
  const error = run('{"asset": {}}');
  assert.deepEqual([error.status, error.errors], [1, 1]);
  const warning = run('{"asset": {"version": "2.0"}, "unexpected": 1}');
  assert.deepEqual([warning.status, warning.errors, warning.warnings], [1, 0, 1]);
  assert.equal(run('no glTF').status, 1);
  assert.equal(run(undefined).status, 1);
} finally {
  rmSync(folder, { recursive: true });
}
