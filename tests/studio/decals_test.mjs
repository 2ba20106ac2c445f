// SPDX-License-Identifier: MIT
// Decals in the studio, in Chromium: a picture onto the dash of the cockpit, moved, turned, undone, saved, baked and opened again:
// node decals_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { folder as made, launch, openUrl, text } from '../page/browser.mjs';
import { allShown, dropFile, placeOn, pictureDone } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
const browser = await launch();
const { halves, isRed } = await import('../page/halves.mjs');
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures'));
copyFileSync(join(data, 'cockpit.step'), join(work, 'cockpit.step'));
const DASH = 'dash_skin', near = (a, b, tolerance) => a.every((x, i) => Math.abs(x - b[i]) <= tolerance), dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
writeFileSync(join(work, 'm.json'), JSON.stringify({ materials: { skin: { material: 'library:leather/nappa-fine' } }, assign: [{ part: DASH, material: 'skin' }] }));

const run = () => start(papilla, ['cockpit.step', '-m', 'm.json'], { cwd: work });
let studio = await run();
try {
  const opened = async () => {
    const { page, complaints } = await openUrl(browser, studio.url, { viewport: { width: 1280, height: 860 } });
    await allShown(page);
    await page.locator('#camera').selectOption('seat');
    await page.locator('#camera').selectOption('orbit');
    await page.locator('#tab-decals').click();
    return { page, complaints, own: complaints.length };
  };
  const { page, complaints, own } = await opened(), asked = { surface: [], decal: [] };
  page.on('request', (request) => { const { pathname, searchParams } = new URL(request.url()); asked[pathname.slice(1)]?.push(searchParams.get('id')); });

  /** Until the scene shows as many decals as the document has, each as it is there. */
  const shown = (count) => page.waitForFunction((n) => {
    const { state, decals } = globalThis.studio;
    return state.decals.length === n && document.body.dataset.decals === String(n) && state.decals.every(({ number, name }) => decals.shown.data.get(number)?.name === name);
  }, count);
  const decal = (number = 0) => page.evaluate((n) => globalThis.studio.state.document.decals?.[n], number);
  const changed = async (before) => { await page.waitForFunction((was) => JSON.stringify(globalThis.studio.state.document.decals) !== was, before); return shown((await page.evaluate(() => globalThis.studio.state.document.decals.length))); };
  const all = () => page.evaluate(() => JSON.stringify(globalThis.studio.state.document.decals));
  /** Patches as the page draws them: places in the scene's frame with their uv, v down. */
  const patches = () => page.evaluate(() => globalThis.studio.decals.shown.meshesOf(0).map((mesh) => {
    const { array: p } = mesh.geometry.getAttribute('position'), { array: uv } = mesh.geometry.getAttribute('uv'), at = (i) => mesh.position.clone().fromArray(p, 3 * i).applyMatrix4(mesh.matrix).toArray();
    return Array.from({ length: p.length / 3 }, (_, i) => ({ at: at(i), uv: [uv[2 * i], uv[2 * i + 1]] }));
  }).flat());
  /** Every vertex is where the projection has its place of the picture. */
  const isProjected = async () => {
    const { at, direction: d, up: u, size_mm: size } = await decal(), right = [d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]], vertices = await patches();
    assert.ok(vertices.length > 3);
    for (const { at: p, uv } of vertices) {
      const off = p.map((x, i) => x - at[i]);
      assert.ok(near(uv, [0.5 + dot(off, right) / size[0], 0.5 - dot(off, u) / size[1]], 1e-4), `${p} shows ${uv}`);
    }
  };
  /** Where a place of the picture is on the screen: shares of half its width and height from its middle. */
  const onScreen = (x, y) => page.evaluate(([i, j]) => {
    const { view, decals } = globalThis.studio, { array } = decals.handle.lines.geometry.getAttribute('position'), [a, b, d] = [0, 1, 5].map((k) => [...array.slice(3 * k, 3 * k + 3)]), { left, top, width, height } = view.canvas.getBoundingClientRect();
    const p = view.root.localToWorld(view.camera.position.clone().fromArray(a.map((x, k) => x + (1 + i) / 2 * (b[k] - x) + (1 + j) / 2 * (d[k] - x)))).project(view.camera);
    return [left + (p.x + 1) / 2 * width, top + (1 - p.y) / 2 * height];
  }, [x, y]);
  const reds = async (name, places) => {
    await pictureDone(page);
    const png = await page.screenshot({ path: join(pictures, `${name}.png`) });
    return Promise.all(places.map(async ([x, y]) => isRed(png, ...await onScreen(x, y))));
  };

  // ---- A picture onto the dash.
  const png = halves(64, 32), spot = await placeOn(page, DASH);
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.locator('#decal-add').click()]);
  await chooser.setFiles({ name: 'logo.png', mimeType: 'image/png', buffer: png });
  await page.waitForFunction(() => document.getElementById('decal-status').textContent === 'Press on the scene where logo.png shall lie.');
  assert.ok(readFileSync(join(work, 'logo.png')).equals(png), 'the same bytes, in the folder');
  const hit = await page.evaluate(({ x, y }) => { const { view } = globalThis.studio, { point } = view.hitAt({ clientX: x, clientY: y }); return view.root.worldToLocal(point).toArray(); }, spot);
  await page.mouse.click(spot.x, spot.y);
  await shown(1);
  const first = await decal();
  assert.ok(near(first.at, hit, 1e-3), `${first.at} is not ${hit}`);
  assert.deepEqual([first.picture, first.part, first.size_mm, first.depth_mm], ['logo.png', DASH, [80, 40], 40]);
  assert.ok(Math.abs(dot(first.direction, first.up)) < 1e-5 && first.up[2] >= 0, 'upright, as far as the surface allows');
  assert.equal(await page.locator('#decals option').count(), 1);
  assert.match(await text(page, '#decal-note'), /^Covers 3\d(\.\d+)? cm² with \d+ triangles\.$/);
  await isProjected();
  const covered = await page.evaluate(() => { const { view: { levels, surfaces } } = globalThis.studio; return [...surfaces.values()].filter((s) => s.uses.some((use) => levels.isCovered(s, use))).map(({ data: { label } }) => label); });
  assert.deepEqual(covered, [DASH], 'what it lies on is drawn whole, and nothing else for its sake');
  await page.locator('#decal-go').click();
  assert.deepEqual(await reds('added', [[-0.5, 0.3], [-0.8, -0.5], [0.5, 0.3], [0.8, -0.5]]), [true, true, false, false]);

  // ---- Turned by a quarter: what was left is below.
  await page.fill('#decal-turn', '90');
  await changed(JSON.stringify([first]));
  const turned = await decal();
  assert.ok(Math.abs(dot(turned.up, first.up)) < 1e-5);
  await isProjected();
  assert.deepEqual(await reds('turned', [[-0.5, 0.3], [0.5, 0.3]]), [true, false]);
  const [below, middle] = [await onScreen(-0.5, 0), await onScreen(0, 0)];
  assert.ok(below[1] - middle[1] > 20, 'the red half is below');
  // By the keyboard, on the scene; the box says the same.
  await page.locator('#canvas').focus();
  let before = await all();
  await page.keyboard.press('.');
  await changed(before);
  assert.equal(await page.inputValue('#decal-turn'), '85');
  before = await all();
  await page.keyboard.press('Shift+Comma');
  await changed(before);
  assert.equal(await page.inputValue('#decal-turn'), '86');

  // ---- Its size, with its proportions; depth; a number that may not stand there changes nothing.
  before = await all();
  await page.fill('#decal-width', '60');
  await changed(before);
  assert.deepEqual((await decal()).size_mm, [60, 30]);
  before = await all();
  await page.locator('#decal-keeps').uncheck();
  await page.fill('#decal-height', '36');
  await changed(before);
  assert.deepEqual((await decal()).size_mm, [60, 36]);
  await page.fill('#decal-roughness', '7');
  await page.locator('#decal-roughness').blur();
  assert.equal((await decal()).roughness, undefined);
  before = await all();
  await page.fill('#decal-roughness', '0.2');
  await changed(before);
  assert.equal(await page.evaluate(() => globalThis.studio.decals.shown.meshesOf(0)[0].material.roughness), 0.2);
  before = await all();
  await page.fill('#decal-relief', '0.3');
  await changed(before);
  assert.ok(await page.evaluate(() => Boolean(globalThis.studio.decals.shown.meshesOf(0)[0].material.normalMap)), 'relief is seen');

  // ---- Moved: dragged over the dash, seen before it is let go; then by a step, along the surface.
  const dragged = await decal(), grip = await onScreen(0.2, 0.1);
  await page.mouse.move(...grip);
  await page.mouse.down();
  await page.mouse.move(grip[0] + 40, grip[1], { steps: 4 });
  await page.waitForFunction(() => { const { state, decals } = globalThis.studio, there = decals.shown.data.get(0); return there && there.name !== state.decals[0].name; });
  assert.deepEqual(await decal(), dragged, 'the document waits until it is let go');
  before = await all();
  await page.mouse.up();
  await changed(before);
  const moved = await decal(), way = Math.hypot(...moved.at.map((x, i) => x - dragged.at[i]));
  assert.ok(way > 5 && way < 200, `moved by ${way} mm`);
  assert.equal(moved.part, DASH);
  await isProjected();
  before = await all();
  await page.fill('#decal-step', '5');
  await page.locator('#decal-right').click();
  await changed(before);
  const stepped = await decal(), step = Math.hypot(...stepped.at.map((x, i) => x - moved.at[i]));
  assert.ok(step > 4.9 && step < 6, `a step of ${step} mm`);
  await page.screenshot({ path: join(pictures, 'moved.png') });

  // ---- Undone and done again; to the beginning, and back.
  await page.locator('#canvas').focus();
  await page.keyboard.press('Control+z');
  await page.waitForFunction((at) => JSON.stringify(globalThis.studio.state.document.decals[0].at) === at, JSON.stringify(moved.at));
  await shown(1);
  await page.keyboard.press('Control+Shift+z');
  await page.waitForFunction((at) => JSON.stringify(globalThis.studio.state.document.decals[0].at) === at, JSON.stringify(stepped.at));
  for (let i = 0; !(await page.locator('#undo').isDisabled()); ++i) {
    assert.ok(i < 30);
    const { version } = await page.evaluate(() => globalThis.studio.state);
    await page.keyboard.press('Control+z');
    await page.waitForFunction((v) => globalThis.studio.state.version > v, version);
  }
  await shown(0);
  assert.equal(await page.locator('#decals').isVisible(), false);
  while (!(await page.locator('#redo').isDisabled())) {
    const { version } = await page.evaluate(() => globalThis.studio.state);
    await page.keyboard.press('Control+Shift+z');
    await page.waitForFunction((v) => globalThis.studio.state.version > v, version);
  }
  await shown(1);
  assert.deepEqual(await decal(), stepped);

  // ---- For all surfaces in its box, and for the part alone again.
  before = await all();
  await page.locator('#decal-only').uncheck();
  await changed(before);
  assert.equal((await decal()).part, undefined);
  before = await all();
  await page.locator('#decal-only').check();
  await changed(before);
  assert.equal((await decal()).part, DASH);

  // ---- A second one, dropped and placed without a mouse; removed by the keyboard.
  await page.locator('#camera').selectOption('seat');
  await page.locator('#camera').selectOption('orbit');
  const drop = await placeOn(page, DASH);
  assert.ok(drop);
  await page.evaluate(([base64]) => {
    const transfer = new DataTransfer(), panel = document.getElementById('panel-decals');
    transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], 'logo.png', { type: 'image/png' }));
    for (const event of ['dragover', 'drop']) panel.dispatchEvent(new DragEvent(event, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, [png.toString('base64')]);
  await page.waitForFunction(() => document.getElementById('decal-status').textContent.includes('logo-2.png'));
  asked.decal.length = 0;
  await page.locator('#decal-middle').focus();
  await page.keyboard.press('Enter');
  await shown(2);
  assert.equal(await page.locator('#decals').inputValue(), '2. logo-2.png');
  assert.deepEqual(asked, { surface: [], decal: [await page.evaluate(() => globalThis.studio.state.decals[1].name)] }, 'what has not changed is not made anew');
  await dropFile(page, 'logo.png', 'image/png', png);
  await page.waitForFunction(() => globalThis.studio.state.document.decals.length === 3 || /middle of the view/.test(document.getElementById('status').textContent) || document.getElementById('decal-status').textContent.includes('logo-3.png'));
  await page.keyboard.press('Escape');
  for (let count = (await page.evaluate(() => globalThis.studio.state.document.decals.length)); count > 1; --count) {
    await page.locator('#decals').focus();
    await page.keyboard.press('Delete');
    await shown(count - 1);
  }
  assert.deepEqual(await decal(), stepped);

  // ---- Kept, saved, and baked: the same bytes by the command line, with the triangles that are shown.
  for (let i = 0; !existsSync(join(work, 'm.json.autosave')); ++i) { assert.ok(i < 600); await page.waitForTimeout(100); }
  await page.keyboard.press('Control+s');
  await page.waitForFunction(() => document.getElementById('saved').textContent === 'saved');
  assert.deepEqual(JSON.parse(readFileSync(join(work, 'm.json'), 'utf8')).decals, [stepped]);
  await page.locator('#tab-bake').click();
  await page.fill('#output', 'studio.glb');
  assert.equal(await text(page, '#command'), 'papilla bake cockpit.step -m m.json -o studio.glb');
  await page.locator('#bake').click();
  await page.waitForFunction(() => ['done', 'failed'].includes(document.body.dataset.bake));
  assert.equal(await page.evaluate(() => document.body.dataset.bake), 'done', await text(page, '#bake-state'));
  execFileSync(papilla, ['bake', 'cockpit.step', '-m', 'm.json', '-o', 'again.glb', '-q'], { cwd: work });
  const glb = readFileSync(join(work, 'studio.glb'));
  assert.ok(glb.equals(readFileSync(join(work, 'again.glb'))), 'the command line gives other bytes');
  const { meshes, accessors } = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
  const baked = meshes.filter(({ name }) => name === 'logo').flatMap(({ primitives }) => primitives.map(({ indices }) => accessors[indices].count / 3)).reduce((a, b) => a + b, 0);
  const { triangles } = await page.evaluate(() => globalThis.studio.decals.shown.data.get(0));
  assert.ok(triangles > 0 && baked === triangles, `${baked} triangles baked, ${triangles} shown`);

  // ---- Without violations, light and dark; on a phone nothing is cut.
  await page.locator('#tab-decals').click();
  await page.evaluate(readFileSync(createRequire(new URL('../page/package.json', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8'));
  for (const theme of ['light', 'dark']) {
    const { violations } = await page.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
    assert.deepEqual(violations.map(({ id, nodes: where }) => `${theme} ${id}: ${where.map(({ target, failureSummary }) => `${target} ${failureSummary}`).join('; ')}`), []);
    await page.locator('#theme').click();
  }
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(200);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is cut at 390 px');
  await page.screenshot({ path: join(pictures, 'small.png'), fullPage: true });
  assert.deepEqual(complaints.slice(own).filter((c) => !c.includes('ws://127.0.0.1')), []);
  assert.equal(await end(studio.child), 0);
  await page.close();

  // ---- Opened again.
  studio = await run();
  const again = await opened();
  await again.page.waitForFunction(() => document.body.dataset.decals === '1');
  assert.deepEqual(await again.page.evaluate(() => { const { decals, state } = globalThis.studio; return [state.document.decals, decals.shown.data.get(0).triangles]; }), [[stepped], triangles]);
  await again.page.screenshot({ path: join(pictures, 'again.png') });
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
