// SPDX-License-Identifier: MIT
// What one sees first and does first: node first_view_test.mjs PAPILLA INDEX.html FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { curve, number } from '../../page/src/colour.mjs';
import { backgroundOf, folder, launch, middleOf, open, text } from './browser.mjs';

const [papilla, file, place] = process.argv.slice(2);
const browser = await launch();
folder(place);

const vectorOf = (text) => text.split(',').map(Number);
const drawn = (page) => page.locator('#canvas3d').evaluate(({ dataset }) => ({ ...dataset }));
const near = (a, b, within) => a.every((v, i) => Math.abs(v - b[i]) <= within);
/** Until the scene has been drawn at rest. */
const rest = (page) => page.evaluate(() => new Promise((resolve) => {
  const { three } = globalThis.papilla;
  const look = () => three.pace.isCoarse || three.pending ? requestAnimationFrame(look) : resolve();
  setTimeout(look, 400);
}));
async function ready(options) {
  const { page, complaints } = await open(browser, file, options);
  await page.waitForSelector('#canvas3d[data-textures=loaded]');
  await rest(page);
  return { page, complaints };
}

// Numbers for people.
assert.deepEqual([3.18e-12, -2e-9, 0, 0.000123, 1.23456, 4115, 12345678, 412345.678, NaN].map(number), ['~0', '~0', '0', '0.000123', '1.23', '4115', '12,345,678', '412,000', '–']);

// A client can tell curves apart by colour and by dash.
const curves = [0, 1, 2, 3, 4, 5].map(curve);
assert.equal(new Set(curves.map(({ stroke }) => stroke)).size, 6);
assert.equal(new Set(curves.map(({ dash }) => dash.join())).size, 6);

/** A square of 1 m that faces the first view of an object. */
function squareGltf(srgb) {
  const n = [0.7, 0.55, 0.9], long = Math.hypot(...n), [x, y, z] = n.map((c) => c / long);
  const right = [z / Math.hypot(x, z), 0, -x / Math.hypot(x, z)], up = [y * right[2] - z * right[1], z * right[0] - x * right[2], x * right[1] - y * right[0]];
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => right.map((r, i) => (a * r + b * up[i]) / 2));
  const points = new Float32Array(corners.flat()), faces = new Uint16Array([0, 1, 2, 0, 2, 3]), bytes = Buffer.concat([Buffer.from(points.buffer), Buffer.from(faces.buffer)]);
  const linear = (c) => c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4;
  return {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name: 'square' }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1, material: 0 }] }],
    materials: [{ name: 'paint', pbrMetallicRoughness: { baseColorFactor: [...srgb.map(linear), 1], metallicFactor: 0, roughnessFactor: 0.7 } }],
    buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 12 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 1, 2].map((k) => Math.min(...corners.map((c) => c[k]))), max: [0, 1, 2].map((k) => Math.max(...corners.map((c) => c[k]))) },
      { bufferView: 1, componentType: 5123, count: 6, type: 'SCALAR' }],
  };
}

// Under the page's light a surface that faces the camera has the colour of its material.
for (const [name, colour, within] of [['brown', [107, 74, 51], 8], ['black', [32, 32, 32], 8], ['tan', [200, 168, 120], 8], ['blue', [40, 80, 160], 8], ['grey', [128, 128, 128], 8], ['white', [255, 255, 255], 20]]) {
  writeFileSync(join(place, `${name}.gltf`), JSON.stringify(squareGltf(colour)));
  execFileSync(papilla, ['view', join(place, `${name}.gltf`), '-o', join(place, `${name}.html`), '--no-open', '-q']);
  const { page, complaints } = await open(browser, join(place, `${name}.html`), { viewport: { width: 800, height: 600 } });
  const found = await middleOf(page), background = await backgroundOf(page);
  console.log(`${name}: ${found} for ${colour} before ${background}`);
  assert.ok(near(found, colour, within), `${name}: ${found} is not ${colour}`);
  assert.ok(found.some((c, i) => Math.abs(c - background[i]) >= 30), `${name}: ${found} vanishes on ${background}`);
  assert.deepEqual(complaints, []);
  await page.close();
}

async function insideTheCar(page) {
  const { seat, seated, camera, look } = await drawn(page);
  assert.deepEqual([seat, seated], ['driver', 'true']);
  assert.ok(near(vectorOf(camera), [-370, 1000, 310], 120), `the eye is before the headrest: ${camera}`);
  assert.ok(vectorOf(look)[2] < -0.8, `the driver looks ahead: ${look}`);
  const canvas = await page.locator('#canvas3d').boundingBox(), { width, height } = page.viewportSize();
  assert.ok(canvas.width * canvas.height > 0.6 * width * height, 'the scene takes most of the window');
  const share = await page.evaluate(async () => {
    const { three } = globalThis.papilla, gl = three.renderer.getContext(), pixels = () => {
      three.draw();
      const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
      return bytes;
    };
    const scales = three.standard.map((m) => m.normalScale?.clone()), grained = pixels();
    three.standard.forEach((m) => m.normalScale?.setScalar(0));
    const plain = pixels();
    three.standard.forEach((m, i) => m.normalScale?.copy(scales[i]));
    let changed = 0;
    for (let i = 1; i < plain.length; i += 4) changed += Math.abs(grained[i] - plain[i]) >= 2;
    return changed / (plain.length / 4);
  });
  console.log(`grain changes ${(100 * share).toFixed(1)} % of the first view`);
  assert.ok(share > 0.08, `grain is seen: ${share}`);
}

async function homeComesBack(page) {
  const first = await drawn(page);
  await page.locator('#canvas3d').focus();
  for (const key of ['o', 'ArrowLeft', 'ArrowDown', '-', 'f', '+']) await page.keyboard.press(key);
  const box = await page.locator('#canvas3d').boundingBox();
  for (const button of ['left', 'right']) {
    await page.mouse.move(box.x + 500, box.y + 300);
    await page.mouse.down({ button });
    await page.mouse.move(box.x + 380, box.y + 420, { steps: 4 });
    await page.mouse.up({ button });
  }
  await rest(page);
  assert.ok(!near(vectorOf((await drawn(page)).camera), vectorOf(first.camera), 100), 'the camera went elsewhere');
  await page.keyboard.press('Home');
  await rest(page);
  const again = await drawn(page);
  assert.ok(near(vectorOf(again.camera), vectorOf(first.camera), 1) && near(vectorOf(again.look), vectorOf(first.look), 0.005), `${again.camera} ${again.look} is not ${first.camera} ${first.look}`);
}

async function legendsHaveNumbers(page) {
  for (const [view, unit] of [['stretch', ''], ['angle', '°'], ['density', 'texels/mm'], ['stiffness', 'N/m'], ['friction', ''], ['height', 'mm']]) {
    await page.locator(`#view-${view}`).check();
    const ticks = await page.locator('#legend-ticks li').allTextContents();
    const values = ticks.map((t) => t === '~0' ? 0 : Number(t.replaceAll(',', '')));
    assert.equal(values.length, 5);
    assert.ok(values.every((v, i) => Number.isFinite(v) && (i === 0 || v > values[i - 1])), `${view}: ${ticks}`);
    assert.ok((await text(page, '#legend-title')).includes(unit) && await page.locator('#legend-title').isVisible());
  }
  await page.locator('#view-textured').check();
}

async function probeIsOnTheSurface(page) {
  await page.locator('#tab-touch').click();
  const box = await page.locator('#canvas3d').boundingBox(), before = await drawn(page);
  await page.mouse.move(box.x + 0.62 * box.width, box.y + 0.4 * box.height);
  await page.mouse.down();
  for (let i = 0; i < 12; ++i) await page.mouse.move(box.x + 0.62 * box.width + 3 * i, box.y + 0.4 * box.height);
  await rest(page);
  const found = await page.evaluate(() => {
    const { touch, three, nameOf } = globalThis.papilla, { proxy } = touch.marks.now, spot = three.surface.nearest(proxy, 20);
    return { seen: touch.marks.group.visible, distance: spot?.distance, part: spot && nameOf.call(globalThis.papilla, spot.use), force: touch.marks.now.force.length() };
  });
  assert.ok(found.seen && found.distance < 0.5, `the probe is on the surface: ${JSON.stringify(found)}`);
  assert.ok(found.force > 0 && parseFloat(await text(page, '#force-total')) > 0);
  await page.screenshot({ path: join(place, 'touch.png') });
  await page.mouse.up();
  assert.deepEqual((await drawn(page)).camera, before.camera, 'the camera stays while one touches');
  assert.ok(await page.evaluate(() => !globalThis.papilla.touch.marks.group.visible), 'lifted, it is gone');
  const looks = await page.evaluate(() => { const { plot } = globalThis.papilla.touch; return plot.series.slice(1).filter((_, i) => i % 2 === 0).map((s) => `${s._stroke} ${s.dash} ${s.label}`); });
  assert.equal(new Set(looks).size, looks.length);
  await page.locator('#tab-parts').click();
}

async function partsShowTheirFronts(page) {
  for (const part of ['seat_cushion', 'seat_backrest', 'door_panel_right', 'glove_box_lid', 'headrest']) {
    await page.locator('#parts [role=option]').filter({ hasText: new RegExp(`^${part}$`) }).first().click();
    await rest(page);
    const seen = await page.evaluate(() => {
      const { three, selected } = globalThis.papilla;
      return { first: three.seen()[0] === selected, among: three.seen().includes(selected), below: three.camera.position.y < three.box.min.y };
    });
    assert.ok(seen.among && !seen.below, `${part} is seen: ${JSON.stringify(seen)}`);
    if (part.startsWith('seat')) assert.ok(seen.first, `${part} is what is seen most`);
    if (part === 'seat_cushion') await page.screenshot({ path: join(place, 'seat-cushion.png') });
  }
}

async function compareTwo(page) {
  await page.locator('#parts [role=option]').filter({ hasText: /^seat_cushion$/ }).first().click();
  await rest(page);
  const before = await page.locator('#canvas3d').screenshot();
  await page.locator('#compare').selectOption({ label: 'carpet #3C3C40' });
  await rest(page);
  assert.ok(!(await page.locator('#canvas3d').screenshot({ path: join(place, 'compare.png') })).equals(before));
  assert.match(await text(page, '#compare-text'), /^One half of seat_cushion is carpet/);
  const ratio = await page.evaluate(() => globalThis.papilla.compare.group.children[0].userData.ratio);
  assert.ok(near(ratio, [40 / 7.5, 40 / 7.5], 1e-6), `grain keeps its size: ${ratio}`);
  await page.locator('#compare').selectOption('');
}

async function notes(page) {
  await page.locator('#canvas3d').press('Home');
  await rest(page);
  const box = await page.locator('#canvas3d').boundingBox();
  await page.mouse.click(box.x + 0.62 * box.width, box.y + 0.4 * box.height);
  await page.locator('#tab-notes').click();
  await page.locator('#note-add').click();
  await page.keyboard.type('the grain runs off');
  await page.locator('#tab-notes').click();
  const [got] = await Promise.all([page.waitForEvent('download'), page.locator('#notes-save').click()]);
  const path = join(place, 'review.json');
  await got.saveAs(path);
  const review = JSON.parse(readFileSync(path, 'utf8'));
  assert.equal(review.papilla_review, 1);
  const [note] = review.notes;
  assert.deepEqual([note.text, note.part, note.view, note.taken_in], ['the grain runs off', 'dash_skin', 'textured', 'page']);
  assert.ok(near(note.camera.position_m, vectorOf((await drawn(page)).camera).map((c) => c / 1000), 0.01));
  assert.match(note.picture, /^data:image\/jpeg;base64,/);
  await page.locator('#notes-list button[aria-label^=Remove]').click();
  assert.equal(await page.locator('#notes-list li').count(), 0);
  await page.locator('#notes-open').setInputFiles(path);
  await page.waitForSelector('#notes-list li');
  assert.equal(await page.locator('#notes-list textarea').inputValue(), 'the grain runs off');
  await page.locator('#notes-open').setInputFiles(file);
  await page.waitForFunction(() => /^Can't be read/.test(document.getElementById('notes-state').textContent));
  await page.locator('#tab-parts').click();
}

async function nothingIsCut(page) {
  for (const tab of ['materials', 'apart', 'distortion', 'plan', 'timings', 'files']) {
    await page.locator(`#tab-${tab}`).click();
    const cut = await page.evaluate(() => [...document.querySelectorAll('.table')].filter((n) => n.clientWidth && n.scrollWidth > n.clientWidth).length + 1000 * (document.documentElement.scrollWidth > innerWidth));
    assert.ok(page.viewportSize().width < 900 ? cut < 1000 : cut === 0, `${tab} is cut at ${page.viewportSize().width}`);
    if (page.viewportSize().width === 1280) await page.locator(`#${tab}`).screenshot({ path: join(place, `${tab}.png`) });
    const powers = await page.locator(`#${tab}`).evaluate((node) => /\de-\d/.exec(node.innerText)?.[0]);
    assert.equal(powers, undefined, `${tab} has numbers for people`);
  }
}

async function accessible(page) {
  await page.evaluate(readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8'));
  for (const dark of [false, true]) {
    for (const tab of ['tab-materials', 'tab-apart', 'tab-distortion', 'tab-plan', 'tab-timings', 'tab-files', 'tab-parts', 'tab-uv', 'tab-touch', 'tab-notes']) {
      await page.locator(`#${tab}`).click();
      const found = await page.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
      const violations = found.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html, any }) => `${html.slice(0, 120)} ${any[0]?.message ?? ''}`).slice(0, 3).join(' | ')}`);
      assert.deepEqual(violations, [], `${tab}, ${dark ? 'dark' : 'light'}`);
    }
    await page.locator('#theme').click();
  }
}

async function phone() {
  const { page, complaints } = await ready({ viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true });
  assert.equal(await page.evaluate(() => scrollY), 0, 'opens at its top');
  const box = await page.locator('#canvas3d').boundingBox();
  await page.screenshot({ path: join(place, 'page-390.png') });
  assert.ok(box.y < 120 && box.width >= 380 && box.height > 400);
  await page.touchscreen.tap(box.x + 0.62 * box.width, box.y + 0.42 * box.height);
  await page.waitForFunction(() => / uv /.test(document.getElementById('picked').textContent));
  assert.equal(await page.evaluate(() => scrollY), 0, 'a tap picks and does not scroll');
  await nothingIsCut(page);
  assert.deepEqual(complaints, []);
  await page.close();
}

async function large() {
  const { page, complaints } = await ready({ viewport: { width: 2560, height: 1440 }, colorScheme: 'dark' });
  await page.screenshot({ path: join(place, 'page-2560.png') });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth > innerWidth), false);
  assert.deepEqual(complaints, []);
}

try {
  const { page, complaints } = await ready({ viewport: { width: 1280, height: 800 } });
  await page.screenshot({ path: join(place, 'page-1280.png') });
  await insideTheCar(page);
  await homeComesBack(page);
  await legendsHaveNumbers(page);
  await probeIsOnTheSurface(page);
  await partsShowTheirFronts(page);
  await compareTwo(page);
  await notes(page);
  await nothingIsCut(page);
  await accessible(page);
  assert.deepEqual(complaints, []);
  await page.close();
  await phone();
  await large();
} finally {
  await browser.close();
}
