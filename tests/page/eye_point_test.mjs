// SPDX-License-Identifier: MIT
// Where people sit in a scene, without a page: in a room, at a steering wheel, and nowhere in what is small:
// node eye_point_test.mjs NODE_MODULES
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const modules = resolve(process.argv[2]), { build } = createRequire(join(modules, 'x'))('esbuild');
const contents = "export { eyePoint } from './eye_point.mjs'; export * as THREE from 'three';";
const bundled = await build({ stdin: { contents, resolveDir: fileURLToPath(new URL('../../page/src', import.meta.url)) }, bundle: true, write: false, nodePaths: [modules], format: 'cjs', platform: 'node', logLevel: 'error' });
const module = { exports: {} };
new Function('module', 'exports', bundled.outputFiles[0].text)(module, module.exports);
const { eyePoint, THREE } = module.exports;

/** A box with its front inside (a room) or outside (a thing). */
function box(use, size, middle, inside) {
  const geometry = new THREE.BoxGeometry(...size), indices = Uint32Array.from(geometry.index.array);
  if (inside) for (let i = 0; i < indices.length; i += 3) [indices[i], indices[i + 1]] = [indices[i + 1], indices[i]];
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  const object = new THREE.Mesh(geometry);
  object.userData = { use, mesh: { data: { positions: geometry.getAttribute('position').array, indices, coarse: new Uint32Array() } } };
  object.position.set(...middle);
  object.updateMatrixWorld(true);
  return object;
}

const seen = (objects, names = objects.map(() => 'wall')) => eyePoint(objects, names, objects.reduce((all, object) => all.expandByObject(object), new THREE.Box3()));
const room = (...size) => seen([box(0, size, [500, 200, -300], true)]);

// In the middle of a room, wherever it stands.
const large = room(2000, 2000, 2000);
assert.equal(large.kind, 'room');
assert.ok(large.eye.distanceTo(new THREE.Vector3(500, 200, -300)) < 300, JSON.stringify(large.eye));
assert.ok(Math.abs(large.look.length() - 1) < 1e-9 && large.ahead.y === 0);

// What is smaller than 0.8 m in all directions is looked at from outside, whatever it is; its longest edge decides.
assert.equal(room(801, 801, 801)?.kind, 'room');
assert.equal(room(799, 799, 799), null);
assert.equal(room(801, 700, 600)?.kind, 'room');
assert.equal(room(400, 300, 200), null);

// Nobody sits in a thing, which shows its back inside, or before a plate.
assert.equal(seen([box(0, [2000, 2000, 2000], [0, 0, 0], false)]), null);
assert.equal(seen([box(0, [2000, 2000, 1], [0, 0, 0], false)]), null);

// Who has a steering wheel and a headrest sits before that, small or not.
for (const inside of [[], [box(2, [2000, 1500, 3000], [0, 0, 0], true)]]) {
  const driver = seen([box(0, [200, 200, 20], [0, 0, -350], false), box(1, [200, 150, 60], [0, 200, 350], false), ...inside], ['steering_wheel', 'head_rest', 'wall']);
  assert.equal(driver.kind, 'driver');
  assert.ok(driver.eye.distanceTo(new THREE.Vector3(0, 200, 350 - 30 - 230)) < 1e-6 && driver.ahead.z === -1, JSON.stringify(driver));
}
