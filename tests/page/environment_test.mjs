// SPDX-License-Identifier: MIT
// A chrome ball on the page is bright where its environment is: node environment_test.mjs PAPILLA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { folder, launch, open } from './browser.mjs';

const [papilla, place] = process.argv.slice(2);
const browser = await launch();
folder(place);

const length = (v) => Math.hypot(...v), unit = (v) => v.map((c) => c / length(v)), dot = (a, b) => a.reduce((sum, c, i) => sum + c * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** A ball of radius 0.5 m around the origin. */
function ballGltf() {
  const rings = 48, around = 96, points = [], indices = [];
  for (let i = 0; i <= rings; ++i)
    for (let j = 0; j < around; ++j) {
      const polar = Math.PI * i / rings, azimuth = 2 * Math.PI * j / around;
      points.push(Math.sin(polar) * Math.sin(azimuth), Math.cos(polar), Math.sin(polar) * Math.cos(azimuth));
    }
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < around; ++j) {
      const a = i * around + j, b = i * around + (j + 1) % around;
      if (i > 0) indices.push(a, b + around, b);
      if (i < rings - 1) indices.push(a, a + around, b + around);
    }
  const normals = new Float32Array(points), positions = normals.map((c) => c / 2), faces = new Uint16Array(indices);
  const bytes = Buffer.concat([positions, normals, faces].map((a) => Buffer.from(a.buffer)));
  return {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ name: 'ball', primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material: 0 }] }],
    materials: [{ name: 'chrome', pbrMetallicRoughness: { metallicFactor: 1, roughnessFactor: 0 } }],
    buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    bufferViews: [{ buffer: 0, byteLength: positions.byteLength }, { buffer: 0, byteOffset: positions.byteLength, byteLength: normals.byteLength },
      { buffer: 0, byteOffset: positions.byteLength + normals.byteLength, byteLength: faces.byteLength }],
    accessors: [{ bufferView: 0, componentType: 5126, count: points.length / 3, type: 'VEC3', min: [-0.5, -0.5, -0.5], max: [0.5, 0.5, 0.5] },
      { bufferView: 1, componentType: 5126, count: points.length / 3, type: 'VEC3' }, { bufferView: 2, componentType: 5123, count: indices.length, type: 'SCALAR' }],
  };
}

/** A Radiance picture, black but for green light around a direction; the middle of the picture is +X. */
function hdr(width, light) {
  const pixels = Buffer.alloc(2 * width * width), height = width / 2;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const longitude = 2 * Math.PI * ((x + 0.5) / width - 0.5), latitude = Math.PI * (0.5 - (y + 0.5) / height);
      const d = [Math.cos(latitude) * Math.cos(longitude), Math.sin(latitude), Math.cos(latitude) * Math.sin(longitude)];
      if (dot(d, light) > 0.97) pixels.set([0, 128, 0, 129], 4 * (width * y + x));  // 1
    }
  return Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`), pixels]);
}

/** Where the ball is green, from its middle in radii, up positive. */
async function brightest(page, picture) {
  await page.waitForSelector('#canvas3d[data-textures=loaded]');
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const shot = await page.locator('#canvas3d').screenshot({ path: picture });
  return page.evaluate(async (base64) => {
    const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], { type: 'image/png' }));
    const context = Object.assign(document.createElement('canvas'), { width: bitmap.width, height: bitmap.height }).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const { data, width, height } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    const isGreen = (i) => data[i + 1] > 120 && data[i] < 90 && data[i + 2] < 90;
    const isBall = (i) => isGreen(i) || Math.max(data[i], data[i + 1], data[i + 2]) < 12;
    const row = height >> 1;
    let left = width, right = 0, x = 0, y = 0, count = 0;
    for (let i = 0; i < width; ++i) if (isBall(4 * (width * row + i))) [left, right] = [Math.min(left, i), Math.max(right, i)];
    const radius = (right - left + 1) / 2;
    for (let j = 0; j < height; ++j)
      for (let i = 0; i < width; ++i)
        if (isGreen(4 * (width * j + i)) && Math.hypot(i - width / 2, j - height / 2) < 1.1 * radius) x += i + 0.5, y += j + 0.5, ++count;
    return { x: (x / count - width / 2) / radius, y: (height / 2 - y / count) / radius, count, radius };
  }, shot.toString('base64'));
}

const eye = unit([0.7, 0.55, 0.9]), right = unit(cross([0, 1, 0], eye)), up = cross(eye, right);  // Of the page's first view.
const ball = join(place, 'ball.gltf'), baked = join(place, 'chrome.glb'), rules = join(place, 'materials.json');
writeFileSync(ball, JSON.stringify(ballGltf()));
writeFileSync(join(place, 'dark.hdr'), hdr(64, [0, -1, 0]));
writeFileSync(rules, JSON.stringify({ materials: { chrome: { metallic: 1, roughness: 0, environment: 'own.hdr' } }, assign: [{ part: '*', material: 'chrome' }] }));

async function check(name, options, file, light) {
  const html = join(place, `${name}.html`);
  execFileSync(papilla, ['view', file, '-o', html, '--no-open', ...options]);
  const { page, complaints } = await open(browser, html);
  const found = await brightest(page, join(place, `${name}.png`)), half = unit(light.map((c, i) => c + eye[i]));
  assert.ok(found.count > 50, `${name}: ${JSON.stringify(found)}`);
  assert.ok(Math.abs(found.x - dot(half, right)) < 0.1, `${name}: x ${JSON.stringify(found)} for ${dot(half, right)}`);
  assert.ok(Math.abs(found.y - dot(half, up)) < 0.1, `${name}: y ${JSON.stringify(found)} for ${dot(half, up)}`);
  assert.deepEqual(complaints, []);
  await page.close();
  return html;
}

for (const [name, light] of Object.entries({ up: [0, 1, 0], left: unit([-0.5, 0.2, 1]) })) {
  writeFileSync(join(place, 'own.hdr'), hdr(1024, light));
  const plain = join(place, 'plain.html');
  execFileSync(papilla, ['view', ball, '-o', plain, '--no-open']);
  const html = await check(`scene-${name}`, ['--environment', join(place, 'own.hdr')], ball, light);
  assert.ok(statSync(html).size - statSync(plain).size < 1 << 20, 'an environment takes more than 1 MiB');
  execFileSync(papilla, ['bake', ball, '-m', rules, '-o', baked]);
  await check(`own-${name}`, ['--environment', join(place, 'dark.hdr')], baked, light);
}
await browser.close();
