// SPDX-License-Identifier: MIT
// Compressed files in three.js' GLTFLoader, beside the same scene without compression:
// node readers_test.mjs NODE_MODULES PLAIN.glb COMPRESSED.glb ...
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { basename, extname, join, normalize } from 'node:path';
import { launch, openUrl } from './browser.mjs';

const [modules, plain, ...compressed] = process.argv.slice(2);
const files = new Map([plain, ...compressed].map((file) => [`/files/${basename(file)}`, file]));
const TYPES = { '.js': 'text/javascript', '.wasm': 'application/wasm', '.glb': 'model/gltf-binary' };
const PAGE = `<!doctype html><meta charset="utf-8"><title>readers</title><link rel="icon" href="data:,">
<script type="importmap">{"imports": {"three": "/modules/three/build/three.module.js", "three/addons/": "/modules/three/examples/jsm/"}}</script>
<body>Files are read here.<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
const draco = new DRACOLoader().setDecoderPath('/modules/three/examples/jsm/libs/draco/gltf/');
const loader = new GLTFLoader().setDRACOLoader(draco).setMeshoptDecoder(MeshoptDecoder);
const values = (attribute, size) => attribute ? Array.from({ length: attribute.count * size }, (_, i) => attribute.getComponent(Math.floor(i / size), i % size)) : null;
window.read = async (file) => {
  const { scene } = await loader.loadAsync(file), meshes = [];
  scene.updateMatrixWorld(true);
  scene.traverse((object) => {
    if (!object.isMesh) return;
    const { geometry, material } = object, world = [], at = new THREE.Vector3();
    for (let i = 0; i < geometry.attributes.position.count; ++i) world.push(...at.fromBufferAttribute(geometry.attributes.position, i).applyMatrix4(object.matrixWorld).toArray());
    geometry.computeBoundingBox();
    const maps = [material.map, material.normalMap].filter(Boolean).map(({ channel, repeat, image }) => ({ channel, pixels: [repeat.x * image.width, repeat.y * image.height] }));
    meshes.push({ material: material.name, haptic: material.userData.haptic ?? null, triangles: geometry.index.count / 3, world, maps,
      side: Math.max(...geometry.boundingBox.getSize(new THREE.Vector3()).toArray()), uv: [values(geometry.attributes.uv, 2), values(geometry.attributes.uv1, 2)] });
  });
  return meshes;
};
document.body.dataset.ready = 'yes';
</script>`;

const server = createServer(({ url }, answer) => {
  const path = normalize(decodeURIComponent(url));
  if (path === '/') return answer.writeHead(200, { 'Content-Type': 'text/html' }).end(PAGE);
  const file = files.get(path) ?? (path.startsWith('/modules/') ? join(modules, path.slice(9)) : null);
  if (!file) return answer.writeHead(404).end();
  answer.writeHead(200, { 'Content-Type': TYPES[extname(file)] ?? 'application/octet-stream' }).end(readFileSync(file));
});
await new Promise((listening) => server.listen(0, '127.0.0.1', listening));

/** Farthest that rounding may move a vertex of a part, in metres: docs/files.md. */
const mostMoved = (side) => Math.max(Math.min(side / 16384, 2e-5), side / 32768);
const FLOAT = 2 ** -22;  // Of what matrices and floats of 32 bits leave of a metre.

/** Every vertex of one mesh has one of the other within both bounds; returns the largest distances, in metres and pixels. */
function compare(one, other, most, where) {
  const cells = new Map(), key = (x, y, z) => `${x},${y},${z}`, cell = (v) => Math.floor(v / most);
  for (let i = 0; i < other.world.length / 3; ++i) {
    const name = key(...[0, 1, 2].map((k) => cell(other.world[3 * i + k])));
    cells.set(name, [...(cells.get(name) ?? []), i]);
  }
  let moved = 0, pixels = 0;
  for (let i = 0; i < one.world.length / 3; ++i) {
    const at = one.world.slice(3 * i, 3 * i + 3);
    let best = null;
    for (let n = 0; n < 27; ++n)
      for (const j of cells.get(key(cell(at[0]) + n % 3 - 1, cell(at[1]) + Math.floor(n / 3) % 3 - 1, cell(at[2]) + Math.floor(n / 9) - 1)) ?? []) {
        const distance = Math.hypot(...at.map((v, k) => v - other.world[3 * j + k]));
        let drift = 0;
        for (const { channel, pixels: scale } of one.maps) drift = Math.max(drift, Math.hypot(...scale.map((s, k) => s * (one.uv[channel][2 * i + k] - other.uv[channel][2 * j + k]))));
        if (distance <= most && (!best || drift < best.drift)) best = { distance, drift };
      }
    assert(best, `${where}: no vertex within ${most} m of ${at}`);
    [moved, pixels] = [Math.max(moved, best.distance), Math.max(pixels, best.drift)];
  }
  return { moved, pixels };
}

/** The bytes of the height map that each tag names; those that share it name it by its sum. */
function heights(meshes) {
  const held = new Map();
  for (const { haptic } of meshes) if (haptic?.height?.uri) held.set(haptic.height.sha256, Buffer.from(haptic.height.uri.split(',')[1], 'base64'));
  for (const [sum, bytes] of held) assert.equal(createHash('sha256').update(bytes).digest('hex'), sum);
  return held;
}

const browser = await launch();
const { page, complaints } = await openUrl(browser, `http://127.0.0.1:${server.address().port}/`);
const read = (file) => page.evaluate((name) => window.read(name), `/files/${basename(file)}`);
const reference = await read(plain);
assert(reference.some(({ maps, haptic }) => maps.length && haptic?.height), `${plain}: no material with a grain that is seen and felt`);
for (const file of compressed) {
  const meshes = await read(file), least = [];
  assert.deepEqual(meshes.map(({ material }) => material), reference.map(({ material }) => material), file);
  for (const [i, mesh] of meshes.entries()) {
    const whole = reference[i], where = `${file}: ${mesh.material}`;
    assert.deepEqual(mesh.haptic, whole.haptic, `${where}: another tag`);
    assert.deepEqual(mesh.maps, whole.maps, `${where}: other pictures`);
    assert(mesh.triangles <= whole.triangles && mesh.triangles > 0.99 * whole.triangles, `${where}: ${mesh.triangles} of ${whole.triangles} triangles`);
    const most = mostMoved(whole.side) + FLOAT;
    for (const { moved, pixels } of [compare(mesh, whole, most, where), compare(whole, mesh, most, where)]) {
      assert(pixels <= 0.1 + 1e-3, `${where}: the grain moved by ${pixels} pixels`);
      least.push({ moved, pixels });
    }
  }
  assert(least.some(({ moved }) => moved > 0), `${file}: nothing is rounded`);
  const [before, after] = [heights(reference), heights(meshes)];
  assert(after.size > 0 && after.size === before.size);
  for (const [sum, bytes] of before) assert(bytes.equals(after.get(sum)), `${file}: another height map`);
  console.log(`${basename(file)}: ${meshes.length} meshes, moved by ${(1e3 * Math.max(...least.map(({ moved }) => moved))).toFixed(4)} mm and ${Math.max(...least.map(({ pixels }) => pixels)).toFixed(3)} px, ${after.size} height maps`);
}
assert.deepEqual(complaints, []);
await browser.close();
server.close();
