// SPDX-License-Identifier: MIT
// Files that Papilla did not make: node foreign_test.mjs PAPILLA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { deflateSync } from 'node:zlib';
import { backgroundOf, folder, launch, middleOf, open, text } from './browser.mjs';

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

/** A PNG of one row of 8-bit RGB pixels. */
function rowPng(pixels) {
  const crc = (bytes) => {
    let value = ~0;
    for (const byte of bytes) for (let k = 0, low = byte; k < 8; ++k, low >>>= 1) value = (value ^ low) & 1 ? 0xedb88320 ^ value >>> 1 : value >>> 1;
    return ~value >>> 0;
  };
  const word = (value) => { const bytes = Buffer.alloc(4); bytes.writeUInt32BE(value); return bytes; };
  const chunk = (type, data) => Buffer.concat([word(data.length), Buffer.from(type), data, word(crc(Buffer.concat([Buffer.from(type), data])))]);
  const header = Buffer.concat([word(pixels.length), word(1), Buffer.from([8, 2, 0, 0, 0])]);
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', header), chunk('IDAT', deflateSync(Buffer.from([0, ...pixels.flat()]))), chunk('IEND', Buffer.alloc(0))]);
}

const RED_BLUE = `data:image/png;base64,${rowPng([[255, 0, 0], [0, 0, 255]]).toString('base64')}`;
const WEBP = 'data:image/webp;base64,UklGRiIAAABXRUJQVlA4IBYAAAAwAQCdASoBAAEADsD+JaQAA3AAAAAA';
const KTX2 = `data:image/ktx2;base64,${Buffer.from('\xabKTX 20\xbb\r\n\x1a\n and no more', 'latin1').toString('base64')}`;

/** The square without light, its picture on channel 1, which is at the picture's right end; channel 0 is at the left. */
function unlit({ uri = RED_BLUE, extension = null, color = [1, 1, 1, 1] }) {
  const model = gltf({ name: 'unlit', uv: true });
  const floats = new Float32Array([0.25, 0.5, 0.25, 0.5, 0.25, 0.5, 0.25, 0.5, 0.75, 0.5, 0.75, 0.5, 0.75, 0.5, 0.75, 0.5]);
  const bytes = Buffer.from(floats.buffer);
  model.buffers.push({ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` });
  model.bufferViews.push({ buffer: 1, byteLength: 32 }, { buffer: 1, byteOffset: 32, byteLength: 32 });
  for (const view of [3, 4]) model.accessors.push({ bufferView: view, componentType: 5126, count: 4, type: 'VEC2' });
  Object.assign(model.meshes[0].primitives[0].attributes, { TEXCOORD_0: 3, TEXCOORD_1: 4 });
  model.extensionsUsed = ['KHR_materials_unlit'];
  model.materials = [{ name: 'unlit', pbrMetallicRoughness: { baseColorFactor: color }, extensions: { KHR_materials_unlit: {} } }];
  if (!uri) return model;
  model.materials[0].pbrMetallicRoughness.baseColorTexture = { index: 0, texCoord: 1 };
  model.images = [{ uri }];
  model.textures = [extension ? { extensions: { [extension]: { source: 0 } } } : { source: 0 }];
  if (extension) model.extensionsRequired = [extension], model.extensionsUsed.push(extension);
  return model;
}

/** The square with one normal everywhere: of its vertices, or of a picture, X along u, Y against v. */
function tilted(normal, byPicture) {
  const model = gltf({ name: byPicture ? 'pictured' : 'tilted', uv: true });
  model.materials = [{ name: 'grey', pbrMetallicRoughness: { baseColorFactor: [0.4, 0.4, 0.4, 1], metallicFactor: 0, roughnessFactor: 0.6 } }];
  const bytes = Buffer.from(new Float32Array(Array(4).fill(byPicture ? [0, 0, 1] : normal).flat()).buffer);
  model.buffers.push({ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` });
  model.bufferViews.push({ buffer: 1, byteLength: bytes.length });
  model.accessors.push({ bufferView: 3, componentType: 5126, count: 4, type: 'VEC3' });
  model.meshes[0].primitives[0].attributes.NORMAL = 3;
  if (!byPicture) return model;
  const pixel = normal.map((c) => Math.round(255 * (c + 1) / 2));
  model.images = [{ uri: `data:image/png;base64,${rowPng([pixel, pixel]).toString('base64')}` }];
  model.textures = [{ source: 0 }];
  model.materials[0].normalTexture = { index: 0 };
  return model;
}

function assertColour(found, wanted) {
  assert.ok(found.every((value, i) => Math.abs(value - wanted[i]) <= 3), `${found} instead of ${wanted}`);
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
  { // without light a colour is what the file says
    const { page, complaints } = await view('unlit', unlit({ uri: null, color: [0.2159, 0.0, 0.8, 1] }));
    assertColour(await middleOf(page), [128, 0, 231]);
    assert.deepEqual(complaints, []);
  }
  { // a normal of a picture is lit as one of the vertices
    const seen = [];
    for (const [name, normal] of [['right', [0.6, 0, 0.8]], ['up', [0, 0.6, 0.8]], ['down', [0, -0.6, 0.8]]]) {
      const [vertices, picture] = [await view(`${name} by vertices`, tilted(normal, false)), await view(`${name} by a picture`, tilted(normal, true))];
      seen.push(await middleOf(vertices.page));
      assertColour(await middleOf(picture.page), seen.at(-1));
      assert.deepEqual([...vertices.complaints, ...picture.complaints], []);
    }
    assert.ok(Math.abs(seen[1][0] - seen[2][0]) > 20, `up and down look alike: ${seen}`);
  }
  { // back sides are drawn where the material says so, as clients do; a mirrored node shows its front
    const turned = (doubleSided, scale) => {
      const model = unlit({ uri: null, color: [0.2159, 0.0, 0.8, 1] });
      model.materials[0].doubleSided = doubleSided;
      model.nodes[0].scale = scale;
      model.nodes[0].rotation = [0, 1, 0, 0];  // half a turn
      return model;
    };
    for (const [name, model, drawn] of [['culled', turned(false, [1, 1, 1]), false], ['double-sided', turned(true, [1, 1, 1]), true], ['mirrored', turned(false, [1, 1, -1]), true]]) {
      const { page, complaints } = await view(name, model);
      for (const kind of ['textured', 'checker']) {
        await page.locator(`#view-${kind}`).check();
        const background = await backgroundOf(page);
        const found = await middleOf(page), isBackground = found.every((value, i) => Math.abs(value - background[i]) <= 3);
        assert.equal(isBackground, !drawn, `${name}, ${kind}: ${found} on ${background}`);
      }
      assert.deepEqual(complaints, []);
    }
  }
  { // a picture on channel 1
    const { page, complaints } = await view('channel-1', unlit({}));
    assertColour(await middleOf(page), [0, 0, 255]);
    assert.deepEqual(complaints, []);
  }
  for (const [name, uri, extension] of [['webp', WEBP, 'EXT_texture_webp'], ['ktx2', KTX2, 'KHR_texture_basisu']]) { // pictures of other formats
    const { page, complaints } = await view(name, unlit({ uri, extension, color: [0, 1, 0, 1] }));
    const [red, , blue] = await middleOf(page);
    assert.ok(red <= 3 && blue <= 3);
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
