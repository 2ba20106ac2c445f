// SPDX-License-Identifier: MIT
// The studio in Chromium: open the cockpit, drop leather on the dash, see it, undo, redo, lay the grain, save, bake; the
// command line that is shown gives the same bytes: node workbench_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { folder as made, launch, openUrl, text } from '../page/browser.mjs';
import { allShown } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures'));
copyFileSync(join(data, 'cockpit.step'), join(work, 'cockpit.step'));
const DASH = 'dash_skin', LEATHER = 'leather/nappa-fine';

const browser = await launch();
const studio = await start(papilla, ['cockpit.step', '-m', 'cockpit.materials.json'], { cwd: work });
try {
  const { page, complaints } = await openUrl(browser, studio.url);
  const own = complaints.length;
  const all = () => allShown(page);
  await all();
  // News while surfaces are fetched: what an older state wanted does not take the place of what is made.
  const missed = await page.evaluate(async () => {
    const { studio } = globalThis, { state } = studio, news = (ready) => studio.take({ ...state, surfaces: state.surfaces.map((s) => ({ ...s, ready })) });
    studio.shown.clear();
    studio.made.clear();
    await Promise.all([news(false), news(true)]);
    return studio.state.surfaces.filter((s) => studio.shown.get(studio.keyOf(s))?.name !== s.name).map(({ label }) => label);
  });
  assert.deepEqual(missed, []);
  // Who has sat down while the scene came stays there; who has not moved is shown all of it.
  const modes = await page.evaluate(async () => {
    const { studio } = globalThis, all = studio.showSurfaces.bind(studio), found = [];
    for (const meanwhile of [() => studio.view.seat(), () => {}]) {
      studio.showSurfaces = async () => { await all(); meanwhile(); };
      await studio.takeScene();
      found.push(studio.view.mode);
    }
    delete studio.showSurfaces;
    return found;
  });
  assert.deepEqual(modes, ['walk', 'orbit']);
  await all();
  await page.waitForTimeout(500);
  await page.screenshot({ path: join(pictures, 'opened.png') });
  const tree = page.locator('#tree');
  assert.ok(await tree.locator('[role=treeitem]').count() > 0);

  // Find the dash, and drop leather on it.
  await page.fill('#find-part', DASH);
  const dash = tree.locator('[role=treeitem]').first();
  assert.equal(await dash.textContent(), DASH);
  await dash.click();
  assert.match(await text(page, '#selected'), /^1 surface/);
  await page.fill('#find-material', 'nappa');
  const leather = page.locator(`[data-material="library:${LEATHER}"]`);
  await leather.waitFor();
  const lookOf = () => page.evaluate((name) => {
    const { studio } = globalThis, surface = studio.state.surfaces.find((s) => s.label === name), shown = studio.view.surfaces.get(studio.keyOf(surface));
    return { material: surface.material, hasRelief: Boolean(shown.material.normalMap), name: studio.shown.get(studio.keyOf(surface)).name, uv: [...shown.geometry.getAttribute('uv').array.slice(0, 8)] };
  }, DASH);
  const before = await lookOf();
  assert.equal(before.hasRelief, false);
  await page.evaluate(() => document.addEventListener('drop', () => { globalThis.dropped = performance.now(); }, { capture: true, once: true }));
  await leather.dragTo(dash);
  const seen = await page.waitForFunction(([label, material]) => {
    const { studio } = globalThis, surface = studio.state.surfaces.find((s) => s.label === label), shown = studio.shown.get(studio.keyOf(surface));
    return surface.material === material && shown?.name === surface.name && { page: performance.now() - globalThis.dropped, server: 1000 * shown.data.seconds };
  }, [DASH, LEATHER]).then((found) => found.jsonValue());
  console.log(`grain on the dash ${Math.round(seen.page)} ms after the drop, of which ${Math.round(seen.server)} ms of the server`);
  await all();
  const after = await lookOf();
  assert.equal(after.material, LEATHER);
  assert.ok(after.hasRelief);
  assert.notDeepEqual(after.uv, before.uv);
  await page.locator('#frame').click();
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(pictures, 'dash.png') });

  // Undo and redo, by the keyboard.
  await page.locator('#canvas').focus();
  await page.keyboard.press('Control+z');
  await page.waitForFunction((name) => globalThis.studio.state.surfaces.find((s) => s.label === name).material === null, DASH);
  await all();
  assert.equal((await lookOf()).hasRelief, false);
  await page.keyboard.press('Control+Shift+z');
  await page.waitForFunction((name) => globalThis.studio.state.surfaces.find((s) => s.label === name).material !== null, DASH);
  await all();
  assert.equal((await lookOf()).name, after.name);

  // How the grain lies: of this part alone.
  await page.locator('#tab-part').click();
  await page.fill('#size-0', '20');
  await page.fill('#size-1', '20');
  // The material is of this part alone: it is changed, not copied.
  await page.waitForFunction((name) => globalThis.studio.state.document.materials[name].size_mm?.every((mm) => mm === 20), LEATHER);
  await page.locator('#grain').selectOption('longest');
  await page.waitForFunction(() => Object.values(globalThis.studio.state.document.materials).some((m) => m.unwrap?.grain === 'longest'));
  await all();
  assert.notDeepEqual((await lookOf()).uv, after.uv);

  // Overlays, sections, hiding, light and camera draw.
  for (const overlay of ['checker', 'stretch', 'angle', 'textured']) {
    await page.locator('#overlay').selectOption(overlay);
    if (overlay === 'stretch') {
      await page.locator('#seams').check();
      assert.match(await text(page, '#legend-text'), /stretch L2.*…/);
      await page.waitForTimeout(200);
      await page.screenshot({ path: join(pictures, 'stretch.png') });
      await page.locator('#seams').uncheck();
    }
  }
  await page.locator('#isolate').click();
  assert.ok(await page.evaluate(() => globalThis.studio.view.box().getSize(globalThis.studio.view.camera.position.clone()).length() > 0 && globalThis.studio.hidden.size > 0));
  await page.locator('#show-all').click();
  await page.locator('#section').selectOption('x');
  for (const light of ['sky', 'night', 'studio']) await page.locator('#light').selectOption(light);
  await page.locator('#section').selectOption('off');
  await page.locator('#camera').selectOption('seat');
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(pictures, 'seat.png') });

  // Saved, and baked: the same bytes as the command line.
  assert.equal(await text(page, '#saved'), 'not saved');
  await page.keyboard.press('Control+s');
  await page.waitForFunction(() => document.getElementById('saved').textContent === 'saved');
  assert.ok(JSON.parse(readFileSync(join(work, 'cockpit.materials.json'), 'utf8')).assign.length > 0);
  await page.locator('#tab-bake').click();
  await page.fill('#output', 'studio.glb');
  await page.fill('#report', 'report');
  const command = await text(page, '#command');
  assert.equal(command, 'papilla bake cockpit.step -m cockpit.materials.json -o studio.glb --report report');
  await page.locator('#bake').click();
  await page.waitForFunction(() => ['done', 'failed'].includes(document.body.dataset.bake));
  assert.equal(await page.evaluate(() => document.body.dataset.bake), 'done', await text(page, '#bake-state'));
  await page.screenshot({ path: join(pictures, 'baked.png') });
  assert.ok(existsSync(join(work, 'report/index.html')));
  execFileSync(papilla, ['bake', 'cockpit.step', '-m', 'cockpit.materials.json', '-o', 'again.glb', '-q'], { cwd: work });
  assert.ok(readFileSync(join(work, 'studio.glb')).equals(readFileSync(join(work, 'again.glb'))), 'the command line gives other bytes');

  // A small window, and dark.
  await page.setViewportSize({ width: 390, height: 844 });
  await page.locator('#theme').click();
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(pictures, 'small.png') });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is cut at 390 px');
  assert.deepEqual(complaints.slice(own).filter((c) => !c.includes(`ws://127.0.0.1`)), []);
  assert.equal(await end(studio.child), 0);
  await page.waitForSelector('body[data-state=lost]');
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
