// SPDX-License-Identifier: MIT
// Runs the Khronos glTF validator on files and prints one JSON line for each.
// usage: node validate.mjs FILE...
// Exit code 0: neither error nor warning; 1: some; 2: usage; 77: the validator is not installed (npm ci).
import { readFile } from 'node:fs/promises';
import { dirname, resolve } from 'node:path';

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node validate.mjs FILE...');
  process.exit(2);
}

let validator;
try {
  validator = (await import('gltf-validator')).default;
} catch (error) {
  if (error.code !== 'ERR_MODULE_NOT_FOUND') throw error;
  console.error('gltf-validator is not installed: run npm ci in tests/gltf-validator');
  process.exit(77);
}

/** The validator's report on one file; files beside it are read when it names them. */
async function validate(file) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: file,
    externalResourceFunction: (uri) =>
      readFile(resolve(dirname(file), decodeURIComponent(uri))).then((bytes) => new Uint8Array(bytes)),
  });
  const { numErrors: errors, numWarnings: warnings, numInfos: infos, numHints: hints, messages } = report.issues;
  return { file, errors, warnings, infos, hints, messages };
}

let clean = true;
for (const file of files) {
  let result;
  try {
    result = await validate(file);
  } catch (error) {
    // A file that is missing or no glTF at all.
    result = { file, errors: 1, warnings: 0, infos: 0, hints: 0, messages: [{ code: 'UNREADABLE', message: String(error) }] };
  }
  console.log(JSON.stringify(result));
  clean &&= result.errors === 0 && result.warnings === 0;
}
process.exitCode = clean ? 0 : 1;
