// SPDX-License-Identifier: MIT
// Carriers in the studio, in Chromium: a picture instead of the knobs of the cockpit, changed, undone, removed, and baked:
// node carriers_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { folder as made, launch, openUrl, text } from '../page/browser.mjs';
import { allShown, pictureDone } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
const browser = await launch();
const { halves, isRed } = await import('../page/halves.mjs');
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures')), KNOB = 'knob_grip';
copyFileSync(join(data, 'cockpit.step'), join(work, 'cockpit.step'));
writeFileSync(join(work, 'm.json'), JSON.stringify({ materials: {}, assign: [] }));

const studio = await start(papilla, ['cockpit.step', '-m', 'm.json'], { cwd: work });
try {
  const { page, complaints } = await openUrl(browser, studio.url, { viewport: { width: 1280, height: 860 } }), own = complaints.length;
  await allShown(page);
  await page.locator('#tab-decals').click();
  const entries = () => page.evaluate(() => globalThis.studio.state.document.replace ?? []);
  /** Until the scene shows as many rectangles, those of the newest document, and what they leave. */
  const shown = async (count) => {
    await page.waitForFunction((n) => {
      const { state, carriers } = globalThis.studio;
      return document.body.dataset.carriers === String(n) && (n === 0 || carriers.shown.told?.name === state.carriers?.name);
    }, count);
    await allShown(page);
  };
  /** Triangles of the knobs that the scene has left, with every instance. */
  const left = () => page.evaluate((label) => [...globalThis.studio.view.surfaces.values()].filter((s) => s.data.label === label).reduce((sum, { geometry, uses }) => sum + geometry.index.count / 3 * uses.length, 0), KNOB);
  const select = () => page.evaluate((label) => { const { studio: s } = globalThis; s.select(s.state.surfaces.filter((one) => one.label === label).map((one) => s.keyOf(one)), false); }, KNOB);

  // ---- Nothing is selected: nothing is done.
  await page.locator('#carrier-render').click();
  await page.waitForFunction(() => document.getElementById('status').textContent === 'Select a part first.');
  assert.deepEqual(await entries(), []);

  // ---- A picture instead of a part: its triangles go, and a rectangle stands for it wherever it is.
  const knobs = await page.evaluate((label) => globalThis.studio.state.surfaces.filter((s) => s.label === label).reduce((sum, { uses }) => sum + uses.length, 0), KNOB), whole = await left();
  assert.ok(knobs > 0 && whole > 2 * knobs);
  await select();
  const png = halves(64, 64), [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.locator('#carrier-add').click()]);
  await chooser.setFiles({ name: 'dial.png', mimeType: 'image/png', buffer: png });
  await shown(knobs);
  assert.ok(readFileSync(join(work, 'dial.png')).equals(png), 'the same bytes, in the folder');
  assert.deepEqual(await entries(), [{ part: KNOB, picture: 'dial.png' }]);
  assert.equal(await left(), 0);
  assert.match(await text(page, '#carrier-note'), /^(One rectangle stands|\d+ rectangles stand) for [\d ,.]+ triangles and saves? [\d ,.]+\.$/);
  /** Whether a place of a rectangle's picture is red: shares of half its width and height from its middle, seen from before it. */
  let corner = null;
  const reds = async (name, places) => {
    const points = await page.evaluate((wanted) => {
      const { view, carriers } = globalThis.studio, [mesh] = carriers.shown.group.children, p = mesh.geometry.getAttribute('position').array, uv = mesh.geometry.getAttribute('uv').array;
      const placeOf = (u, v) => { for (let i = 0; 2 * i < uv.length; ++i) if (uv[2 * i] === u && uv[2 * i + 1] === v) return mesh.localToWorld(view.camera.position.clone().fromArray(p, 3 * i)); return null; };
      const a = placeOf(0, 1), right = placeOf(1, 1).sub(a), up = placeOf(0, 0).sub(a), at = (x, y) => a.clone().addScaledVector(right, (1 + x) / 2).addScaledVector(up, (1 + y) / 2), out = right.clone().cross(up).normalize();
      view.setMode('orbit');
      view.controls.target.copy(at(0, 0));
      view.camera.position.copy(at(0, 0)).addScaledVector(out, 3 * right.length());
      view.controls.update();
      view.draw();
      view.camera.updateMatrixWorld(true);
      const { left: x0, top: y0, width, height } = view.canvas.getBoundingClientRect();
      return wanted.map(([x, y]) => { const q = at(x, y).project(view.camera); return [x0 + (q.x + 1) / 2 * width, y0 + (1 - q.y) / 2 * height]; });
    }, places);
    await pictureDone(page);
    const shot = await page.screenshot({ path: join(pictures, `${name}.png`) });
    [corner] = points;
    return points.map(([x, y]) => isRed(shot, x, y));
  };
  const CORNERS = [[-0.9, 0.9], [-0.9, -0.9], [0.9, 0.9], [0.9, -0.9]];  // The cap of the knob hides its middle.
  assert.deepEqual(await reds('instead', CORNERS), [true, true, false, false]);
  // A press on it picks the part.
  await page.evaluate(() => globalThis.studio.select([], false));
  await page.mouse.click(...corner);
  assert.deepEqual(await page.evaluate(() => { const { studio: s } = globalThis; return [...new Set(s.surfacesOf(s.selected).map(({ label }) => label))]; }), [KNOB]);

  // ---- Changed, undone and done again; what has not changed is not made anew.
  const asked = [];
  page.on('request', (request) => { const { pathname } = new URL(request.url()); if (['/surface', '/carriers'].includes(pathname)) asked.push(pathname); });
  const before = await page.evaluate(() => globalThis.studio.state.carriers.name);
  await page.fill('#carrier-contrast', '0');
  await page.waitForFunction((name) => globalThis.studio.state.carriers.name !== name, before);
  await shown(knobs);
  assert.deepEqual(asked, ['/carriers']);
  assert.deepEqual(await entries(), [{ part: KNOB, picture: 'dial.png', contrast: 0 }]);
  assert.deepEqual(await reds('grey', [[-0.9, 0.9]]), [false]);
  await page.locator('#undo').click();
  await page.waitForFunction((name) => globalThis.studio.state.carriers.name === name, before);
  await shown(knobs);
  await page.locator('#undo').click();
  await shown(0);
  assert.equal(await left(), whole);
  await page.screenshot({ path: join(pictures, 'undone.png') });
  await page.locator('#redo').click();
  await shown(knobs);
  assert.equal(await left(), 0);

  // ---- Its own picture, removed by the keyboard.
  await page.evaluate(() => { const { studio: s } = globalThis; s.select(s.state.surfaces.filter((one) => one.label === 'shifter_knob').map((one) => s.keyOf(one)).slice(0, 1), false); });
  await page.locator('#carrier-render').focus();
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => globalThis.studio.state.document.replace.length === 2);
  await page.waitForFunction((n) => Number(document.body.dataset.carriers) > n, knobs);
  assert.deepEqual((await entries())[1], { part: 'shifter_knob', picture: { render: true } });
  assert.equal(await page.locator('#carriers').inputValue(), '2. its own picture');
  await reds('both', [[0, 0]]);
  await page.locator('#carriers').focus();
  await page.keyboard.press('Delete');
  await shown(knobs);
  assert.equal((await entries()).length, 1);

  // ---- Saved and baked: the same bytes by the command line, with the rectangle.
  await page.keyboard.press('Control+s');
  await page.waitForFunction(() => document.getElementById('saved').textContent === 'saved');
  await page.locator('#tab-bake').click();
  await page.fill('#output', 'studio.glb');
  await page.locator('#bake').click();
  await page.waitForFunction(() => ['done', 'failed'].includes(document.body.dataset.bake));
  assert.equal(await page.evaluate(() => document.body.dataset.bake), 'done', await text(page, '#bake-state'));
  execFileSync(papilla, ['bake', 'cockpit.step', '-m', 'm.json', '-o', 'again.glb', '-q'], { cwd: work });
  const glb = readFileSync(join(work, 'studio.glb'));
  assert.ok(glb.equals(readFileSync(join(work, 'again.glb'))), 'the command line gives other bytes');
  const { meshes } = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
  assert.ok(meshes.some(({ name }) => name === 'dial') && !meshes.some(({ name }) => name === KNOB));

  // ---- Without violations.
  await page.locator('#tab-decals').click();
  await page.evaluate(readFileSync(createRequire(new URL('../page/package.json', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8'));
  const { violations } = await page.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
  assert.deepEqual(violations.map(({ id, nodes: where }) => `${id}: ${where.map(({ target, failureSummary }) => `${target} ${failureSummary}`).join('; ')}`), []);
  assert.deepEqual(complaints.slice(own).filter((c) => !c.includes('ws://127.0.0.1')), []);
  await page.screenshot({ path: join(pictures, 'panel.png'), fullPage: true });
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
