// SPDX-License-Identifier: MIT
// A haptic tag on the second texture coordinates is felt by those in the studio's headset: node second_uv_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { launch, openUrl } from '../page/browser.mjs';
import { DEVICE, enter } from '../page/headset.mjs';
import { strengthOf } from '../page/waves.mjs';
import { allShown } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

/** A·sin(2πx/λ): eight waves of 2 mm over 16 mm. */
const WAVES = { amplitude: 0.02, wave: 2, stiffness: 1000, friction: 0.3, speed: 100 }, SIZE = 16, DEPTH = 1, WIDE = 240, HIGH = 160;
writeFileSync(join(folder, 'plate.obj'), `o plate\nv 0 0 0\nv ${WIDE} 0 0\nv ${WIDE} ${HIGH} 0\nv 0 ${HIGH} 0\nf 1 2 3\nf 1 3 4\n`);
writeFileSync(join(folder, 'waves.json'), JSON.stringify({
  materials: { waves: { texture: `base|mainfunction=.5+.5*s(${16 * Math.PI}*x)`, size_mm: [SIZE, SIZE], height: { depth_mm: 2 * WAVES.amplitude }, stiffness: WAVES.stiffness, staticFriction: WAVES.friction, dynamicFriction: WAVES.friction, stribeckVelocity: 0.001, fineRoughness: null } },
  assign: [{ part: '*', material: 'waves' }],
}));
execFileSync(papilla, ['bake', 'plate.obj', '-m', 'waves.json', '-o', 'first.glb', '-q'], { cwd: folder });

/** The file with its coordinates as the second ones, and as the first ones some that are turned and three times as large. */
function onSecond(glb) {
  const length = glb.readUInt32LE(12), gltf = JSON.parse(glb.subarray(20, 20 + length).toString()), bin = glb.subarray(28 + length), added = [];
  let at = bin.length;
  for (const { primitives } of gltf.meshes)
    for (const { attributes } of primitives) {
      const accessor = gltf.accessors[attributes.TEXCOORD_0], view = gltf.bufferViews[accessor.bufferView], from = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0), stride = view.byteStride ?? 8;
      assert.equal(accessor.componentType, 5126);
      const bytes = Buffer.alloc(8 * accessor.count);
      for (let i = 0; i < accessor.count; ++i) {
        const [u, v] = [0, 4].map((k) => bin.readFloatLE(from + i * stride + k));
        bytes.writeFloatLE(3 * v, 8 * i);
        bytes.writeFloatLE(-3 * u, 8 * i + 4);
      }
      attributes.TEXCOORD_1 = attributes.TEXCOORD_0;
      attributes.TEXCOORD_0 = gltf.accessors.push({ bufferView: gltf.bufferViews.push({ buffer: 0, byteOffset: at, byteLength: bytes.length }) - 1, componentType: 5126, count: accessor.count, type: 'VEC2' }) - 1;
      added.push(bytes);
      at += bytes.length;
    }
  for (const material of gltf.materials) {
    if (material.normalTexture) material.normalTexture.texCoord = 1;
    material.extras.haptic.height.texCoord = 1;
  }
  gltf.buffers[0].byteLength = at;
  let text = JSON.stringify(gltf);
  text += ' '.repeat((4 - Buffer.byteLength(text) % 4) % 4);
  const json = Buffer.from(text), data = Buffer.concat([bin, ...added]), head = Buffer.alloc(20), between = Buffer.alloc(8);
  head.write('glTF');
  [2, 28 + json.length + data.length, json.length].forEach((n, i) => head.writeUInt32LE(n, 4 + 4 * i));
  head.write('JSON', 16);
  between.writeUInt32LE(data.length);
  between.write('BIN\0', 4);
  return Buffer.concat([head, json, between, data]);
}
const first = readFileSync(join(folder, 'first.glb'));
assert.ok(first.includes('"height"'), 'the tag has a relief');
writeFileSync(join(folder, 'second.glb'), onSecond(first));

const browser = await launch();
const studio = await start(papilla, ['second.glb'], { cwd: folder });
try {
  const { page, complaints } = await openUrl(browser, studio.url, { init: DEVICE });
  await allShown(page);
  await enter(page, 'globalThis.studio.headset');
  await page.waitForFunction(() => globalThis.worn.page.scene.materials.some((material) => material.relief));
  // Along the relief's x, by the second coordinates.
  const found = await page.evaluate(async ([speed, depth, wide, high]) => {
    const { three } = globalThis.worn, V = three.camera.position.constructor, middle = new V(wide / 2, high / 2, 0);
    const at = (point) => {
      const { mesh, face, bary } = three.surface.nearest(point, 20);
      return [0, 1].map((c) => bary.reduce((sum, w, k) => sum + w * mesh.data.uv1[2 * mesh.data.indices[3 * face + k] + c], 0));
    };
    const slope = (way) => { const a = at(middle), b = at(middle.clone().addScaledVector(way, 1)); return [b[0] - a[0], b[1] - a[1]]; };
    const a = slope(new V(1, 0, 0)), b = slope(new V(0, 1, 0)), area = a[0] * b[1] - a[1] * b[0];
    const way = new V(b[1] / area, -a[1] / area, 0).normalize(), begin = middle.clone().addScaledVector(way, -20);
    globalThis.pulses.length = 0;
    const start = globalThis.clock;
    await globalThis.frames(25, (time) => {
      const near = begin.clone().addScaledVector(way, speed * (time - start));
      globalThis.tipTo(near.x, near.y, -depth, [0, 0, -1]);
    });
    return { pulses: globalThis.pulses.slice(-5).map(({ value }) => value), contact: globalThis.contact(), mm: 1 / Math.hypot(...slope(way)) };
  }, [WAVES.speed, DEPTH, WIDE, HIGH]);
  const closed = strengthOf(WAVES);
  console.log(`pulses ${found.pulses.map((v) => v.toFixed(4))} for ${closed.toFixed(4)}`);
  assert.ok(Math.abs(found.mm - SIZE) < 0.01 * SIZE, `one repeat of the second coordinates is ${found.mm} mm`);
  assert.ok(found.pulses.length === 5 && found.pulses.every((v) => Math.abs(v - closed) < 0.12 * closed), `${found.pulses} is not ${closed}`);
  assert.ok(Math.abs(found.contact.normal - WAVES.stiffness * DEPTH / 1000) < 0.1, JSON.stringify(found.contact));
  assert.deepEqual(complaints.filter((c) => !c.includes('ws://127.0.0.1')), []);
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
