// SPDX-License-Identifier: MIT
// Files that Papilla did not make: node foreign_test.mjs PAPILLA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { folder, launch, open, text } from './browser.mjs';

const [papilla, place] = process.argv.slice(2);
const browser = await launch();
folder(place);
const EVIL = '</script><img src=x onerror="alert(1)"><script>alert(2)</script>&amp;';

/** A glTF of one square of 1 m, or of nothing. */
function gltf({ name = 'square', uv = false, empty = false }) {
  if (empty) return { asset: { version: '2.0' } };
  const floats = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 1, 1, 1, 0, 0, 0]), indices = new Uint16Array([0, 1, 2, 0, 2, 3]);
  const bytes = Buffer.concat([Buffer.from(floats.buffer), Buffer.from(indices.buffer)]);
  const attributes = uv ? { POSITION: 0, TEXCOORD_0: 1 } : { POSITION: 0 };
  return {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name }],
    meshes: [{ name, primitives: [{ attributes, indices: 2, material: 0 }] }], materials: [{ name: `material ${name}` }],
    buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 32 }, { buffer: 0, byteOffset: 80, byteLength: 12 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5126, count: 4, type: 'VEC2' }, { bufferView: 2, componentType: 5123, count: 6, type: 'SCALAR' }],
  };
}

async function view(name, model) {
  const input = join(place, `${name}.gltf`), output = join(place, `${name}.html`);
  writeFileSync(input, JSON.stringify(model));
  const report = JSON.parse(execFileSync(papilla, ['view', input, '-o', output, '--no-open', '--json', '-'], { encoding: 'utf8' }));
  assert.equal(report.page, output);
  const { page, complaints } = await open(browser, output);
  await page.screenshot({ path: join(place, `${name}.png`), fullPage: true });
  return { page, complaints, report };
}

const enabled = async (page, id) => !(await page.locator(`#view-${id}`).isDisabled());

try {
  { // uv, but nothing to feel
    const { page, complaints, report } = await view('with uv', gltf({ uv: true }));
    assert.equal(report.triangles_shown, 2);
    assert.match(await text(page, '#problem'), /views of touch are off: no material has a haptic tag/);
    assert.deepEqual(await Promise.all(['textured', 'checker', 'stretch', 'stiffness', 'friction', 'height'].map((id) => enabled(page, id))), [true, true, true, false, false, false]);
    assert.match(await text(page, '#touch-off'), /^Nothing to touch: no material has a haptic tag/);
    assert.deepEqual(complaints, []);
  }
  { // neither
    const { page, complaints } = await view('without-uv', gltf({}));
    assert.match(await text(page, '#problem'), /No part has texture coordinates/);
    assert.equal(await enabled(page, 'stretch'), false);
    assert.deepEqual(complaints, []);
  }
  { // nothing at all
    const { page, complaints } = await view('empty', gltf({ empty: true }));
    assert.match(await text(page, '#problem'), /has no triangles/);
    assert.deepEqual(complaints, []);
  }
  { // names that would like to be markup
    const { page, complaints } = await view("evil <b> & 'x'", gltf({ name: EVIL, uv: true }));
    assert.equal(await text(page, '#title'), "evil <b> & 'x'.gltf");
    assert.equal(await text(page, '#parts [role=option]'), EVIL);
    assert.ok((await text(page, '#cards')).includes(EVIL));
    assert.equal(await page.locator('img[src=x]').count(), 0);
    assert.deepEqual(complaints, []);
  }
} finally {
  await browser.close();
}
