// SPDX-License-Identifier: MIT
// The page of a baked cockpit: node report_test.mjs INDEX.html PICTURE_FOLDER
import assert from 'node:assert/strict';
import { readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { folder, launch, open, text } from './browser.mjs';

const [file, pictures] = process.argv.slice(2);
const browser = await launch();
folder(pictures);

async function views(page) {
  const seen = new Set();
  for (const view of ['checker', 'stretch', 'angle', 'density', 'stiffness', 'friction', 'height', 'textured']) {
    const frames = Number(await page.locator('#canvas3d').getAttribute('data-frames'));
    await page.locator(`#view-${view}`).check();
    await page.waitForFunction((n) => Number(document.getElementById('canvas3d').dataset.frames) > n, frames);
    assert.equal(await page.locator('#canvas3d').getAttribute('data-view'), view);
    const picture = await page.locator('#canvas3d').screenshot({ path: join(pictures, `view-${view}.png`) });
    seen.add(picture.toString('base64'));
  }
  assert.equal(seen.size, 8, 'every view is another picture');
}

async function pick(page) {
  await page.locator('#parts [role=option]').filter({ hasText: 'seat_cushion' }).first().click();
  assert.match(await text(page, '#picked'), /^seat_cushion: [\d,]+ triangles/);
  assert.equal(await page.locator('#canvasuv').getAttribute('data-part'), 'seat_cushion');
  const felt = await page.locator('#touch-material').evaluate((list) => list.selectedOptions[0].textContent);
  assert.match(felt, /leather/, 'the relief of what is picked lies under the probe');
  const box = await page.locator('#canvas3d').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => / uv /.test(document.getElementById('picked').textContent));
  const in3d = await text(page, '#picked');
  const part = in3d.split(':')[0];
  await page.locator('#tab-uv').click();
  await page.waitForFunction(() => {  // The layout is fitted once the browser has told its size, after a frame of the scene.
    const { width, height, clientWidth, clientHeight } = document.getElementById('canvasuv');
    return width === clientWidth && height === clientHeight;
  });
  const uv = await page.locator('#canvasuv').boundingBox();
  let linked = in3d;
  for (const [x, y] of [[0.5, 0.5], [0.4, 0.4], [0.6, 0.6], [0.3, 0.5], [0.5, 0.3]]) {
    await page.mouse.click(uv.x + x * uv.width, uv.y + y * uv.height);
    linked = await text(page, '#picked');
    if (linked !== in3d) break;
  }
  assert.notEqual(linked, in3d, 'a click into the layout picks another spot');
  assert.ok(linked.startsWith(`${part}:`));
}

async function touch(page) {
  await page.locator('#tab-touch').click();
  await page.locator('#relief').scrollIntoViewIfNeeded();
  const box = await page.locator('#relief').boundingBox(), forces = new Set();
  for (let i = 0; i <= 40; ++i) {
    await page.mouse.move(box.x + (0.2 + 0.015 * i) * box.width, box.y + 0.47 * box.height);
    forces.add(await text(page, '#force-total'));
  }
  assert.ok(forces.size > 10, `the force changes along the way: ${[...forces]}`);
  assert.ok([...forces].some((f) => parseFloat(f) > 0));
  assert.match(await text(page, '#touch-note'), /of 16 bits/);
  const leather = await page.locator('#touch-material option').filter({ hasText: 'leather' }).first().getAttribute('value');
  await page.locator('#touch-material').selectOption(leather);
  const levels = Number(/\((\d+) different/.exec(await text(page, '#touch-note'))[1]);
  assert.ok(levels > 256, `more than 8 bits of height survive: ${levels}`);
  await page.locator('#relief').focus();
  const before = await text(page, '#force-height');
  for (let i = 0; i < 5; ++i) await page.keyboard.press('ArrowRight');
  assert.notEqual(await text(page, '#force-height'), before, 'arrow keys slide the probe');
  await page.locator('#listen').click();
  assert.equal(await page.locator('#listen').getAttribute('aria-pressed'), 'true');
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height, { steps: 10 });
  await page.locator('#listen').click();
}

async function downloads(page) {
  await page.locator('#tab-files').click();
  for (const name of ['report.json', 'scene.json', 'distortion.csv', 'plan.csv', 'force.csv']) {
    const [got] = await Promise.all([page.waitForEvent('download'), page.locator(`[data-file="${name}"]`).click()]);
    const content = readFileSync(await got.path(), 'utf8');
    if (name.endsWith('.json')) assert.ok(Object.keys(JSON.parse(content)).length > 3);
    else assert.ok(content.split('\n').length > 5, name);
  }
}

try {
  assert.ok(statSync(file).size < 10e6, 'under 10 MB');
  const { page, complaints } = await open(browser, file);
  assert.equal(await page.locator('#problem').isVisible(), false);
  await page.waitForSelector('#canvas3d[data-textures=loaded]');
  await page.screenshot({ path: join(pictures, 'top.png') });
  await views(page);
  await pick(page);
  await touch(page);
  await downloads(page);
  assert.ok(await page.locator('#plan-table tbody tr').count() > 20);
  assert.match(await text(page, '#sides'), /looked at from the room .*; 1 changed\.door_panel_right: [\d,]+ triangles turned over \(seen\)/);
  assert.ok(await page.locator('#apart-table tbody tr').count() > 3, 'pairs of materials and reliefs');
  assert.match(await text(page, '#apart-table'), /RAII 70 to 1000 Hz .* Jones and Hunter/);
  assert.ok(await page.locator('#cards article').count() >= 4);
  const tones = await page.locator('#environment').evaluate((canvas) => new Set(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data).size);
  assert.ok(tones > 30, `the environment is a picture: ${tones} tones`);
  await page.locator('body').press('3');
  assert.equal(await page.locator('#canvas3d').getAttribute('data-view'), 'stretch');
  await page.screenshot({ path: join(pictures, 'light.png'), fullPage: true });
  await page.locator('#theme').click();
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(pictures, 'dark.png'), fullPage: true });
  assert.deepEqual(complaints, []);
} finally {
  await browser.close();
}
