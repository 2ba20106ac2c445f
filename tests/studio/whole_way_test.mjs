// SPDX-License-Identifier: MIT
// The whole way in Chromium: drop a STEP file, pick materials, an own photograph, adjust, feel, the emulated headset, bake,
// save, open again; the same MATERIALS.json gives the same GLB on the command line: node whole_way_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { folder as made, launch, openUrl, text } from '../page/browser.mjs';
import { DEVICE, costOf, enter } from '../page/headset.mjs';
import { allShown, dropFile, materialOf, placeOn, twoFrames } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
const browser = await launch(['--autoplay-policy=no-user-gesture-required']);
const { bumps } = await import('../page/bumps.mjs');
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures'));
const DASH = 'dash_skin', TRIM = 'trim_strip', LEATHER = 'leather/nappa-fine', RULES = 'cockpit.materials.json';
const photo = { size: [66, 42], pxPerMm: 10, periods: [6, 8.5], degrees: 17 }, { png } = bumps(photo);

let studio = await start(papilla, [], { cwd: work });
try {
  const { page, complaints } = await openUrl(browser, studio.url, { viewport: { width: 1280, height: 860 }, init: `${DEVICE} globalThis.prompt = () => "${photo.size[0]}";` });
  const own = complaints.length, picture = (name) => page.screenshot({ path: join(pictures, `${name}.png`) });
  const select = async (part) => {
    await page.fill('#find-part', part);
    await page.locator('#tree [role=treeitem]').first().click();
    assert.match(await text(page, '#selected'), /^1 surface/);
  };
  const hasRelief = (label) => page.evaluate((wanted) => { const { studio: s } = globalThis; return Boolean(s.view.surfaces.get(s.keyOf(s.state.surfaces.find((x) => x.label === wanted))).material.normalMap); }, label);

  // ---- The scene, dropped.
  console.log('drop');
  await page.waitForSelector('#welcome:not([hidden])');
  await dropFile(page, 'cockpit.step', '', readFileSync(join(data, 'cockpit.step')));
  await page.waitForFunction(() => globalThis.studio.state?.scene_file === 'cockpit.step' && globalThis.studio.state.surfaces.length > 10);
  await allShown(page);
  await picture('dropped');

  // ---- Materials: one of the library onto the dash, a photograph onto the trim.
  console.log('materials');
  await select(DASH);
  await page.fill('#find-material', 'nappa');
  const leather = page.locator(`[data-material="library:${LEATHER}"]`);
  await leather.waitFor();
  await leather.dragTo(page.locator('#tree [role=treeitem]').first());
  await page.waitForFunction(([label, wanted]) => globalThis.studio.state.surfaces.find((s) => s.label === label).material === wanted, [DASH, LEATHER]);
  await select(TRIM);
  await page.setInputFiles('#photo-file', { name: 'bumps.png', mimeType: 'image/png', buffer: png });
  await page.waitForFunction((label) => globalThis.studio.state.surfaces.find((s) => s.label === label).material === 'bumps', TRIM);
  await allShown(page);
  assert.ok(await hasRelief(DASH) && await hasRelief(TRIM));
  assert.deepEqual((await materialOf(page, TRIM)).size_mm, photo.size);
  assert.ok(readFileSync(join(work, 'bumps.png')).equals(png));

  // ---- Adjusted: larger along u, moved, turned.
  console.log('adjust');
  await select(DASH);
  await page.locator('#tab-part').click();
  for (const [field, value] of [['size-0', '45'], ['size-1', '30'], ['phase-0', '3'], ['turn', '35']]) {
    const { version } = await page.evaluate(() => globalThis.studio.state);
    await page.fill(`#${field}`, value);
    await page.locator(`#${field}`).blur();
    await page.waitForFunction((old) => globalThis.studio.state.version > old, version);
  }
  await allShown(page);
  const adjusted = await materialOf(page, DASH);
  assert.deepEqual([adjusted.size_mm, adjusted.phase_mm[0]], [[45, 30], 3]);
  assert.ok(Math.abs(Math.hypot(...adjusted.unwrap.grain) - 1) < 1e-5);
  await picture('adjusted');

  // ---- Felt.
  console.log('feel');
  await page.locator('#camera').selectOption('seat');
  await page.locator('#camera').selectOption('orbit');
  const place = await placeOn(page, DASH);
  assert.ok(place, 'the dash is seen from the seat');
  await page.locator('#tab-feel').click();
  await page.locator('#feel-mode').click();
  await page.mouse.move(place.x, place.y);
  await page.mouse.down();
  await page.waitForFunction(() => Number(document.getElementById('panel-feel').dataset.ticks) > 200);
  for (let i = 0; i < 10; ++i) {
    await page.mouse.move(place.x + 1.2 * i, place.y);
    await twoFrames(page);
  }
  await page.waitForFunction(() => globalThis.studio.feel.samples[1].some((force) => force > 0.2));
  await picture('felt');
  await page.mouse.up();
  await page.waitForSelector('body[data-feel=idle]');
  await page.locator('#feel-mode').click();

  // ---- In the headset: a stroke over the dash.
  console.log('headset');
  await enter(page, 'globalThis.studio.headset');
  await page.waitForFunction(() => globalThis.worn.three.surface.places.every(({ object: { userData: { mesh } } }) => !globalThis.worn.page.scene.materials[mesh.material].haptic?.height || globalThis.worn.page.scene.materials[mesh.material].relief));
  const cost = await costOf(page);
  assert.ok(cost.isWithin && cost.textures > 0, JSON.stringify(cost));
  const touched = await page.evaluate(async (label) => {
    const { three, page: worn } = globalThis.worn, V = three.camera.position.constructor, { eye } = three.seat;
    const near = (x) => three.surface.meet(eye.clone(), new V(x, -0.2, -1).normalize());
    let x = -0.8;
    while (x < 1.6 && ![0, 0.04].every((step) => { const spot = near(x + step); return spot && worn.nameOf(spot.use) === label; })) x += 0.02;
    const spot = near(x), along = new V(1, 0, 0).projectOnPlane(spot.normal).normalize(), begin = globalThis.clock;
    await globalThis.frames(15, (time) => {
      const at = three.surface.nearest(spot.point.clone().addScaledVector(along, 100 * (time - begin)), 20);
      globalThis.tipTo(...at.point.clone().addScaledVector(at.normal, -0.5).toArray(), at.normal.clone().negate().toArray());
    });
    return { contact: globalThis.contact(), pulses: globalThis.pulses.length };
  }, DASH);
  assert.ok(touched.contact?.part === DASH && touched.contact.normal > 0 && touched.pulses > 0, JSON.stringify(touched));
  await page.evaluate(() => globalThis.worn.session.end());
  await page.waitForFunction(() => !globalThis.worn.session);

  // ---- Baked.
  console.log('bake');
  await page.locator('#tab-bake').click();
  assert.equal(await page.inputValue('#output'), 'cockpit.glb', 'what is offered is named after the scene');
  await page.fill('#output', 'studio.glb');
  const command = await text(page, '#command');
  assert.equal(command, `papilla bake cockpit.step -m ${RULES} -o studio.glb`);
  await page.locator('#bake').click();
  await page.waitForFunction(() => ['done', 'failed'].includes(document.body.dataset.bake));
  assert.equal(await page.evaluate(() => document.body.dataset.bake), 'done', await text(page, '#bake-state'));

  // ---- Saved; the studio ends; opened again, all is there.
  console.log('save and open again');
  await page.keyboard.press('Control+s');
  await page.waitForFunction(() => document.getElementById('saved').textContent === 'saved');
  const { document: saved } = await page.evaluate(() => globalThis.studio.state);
  assert.deepEqual(JSON.parse(readFileSync(join(work, RULES), 'utf8')), saved);
  assert.deepEqual(complaints.slice(own).filter((c) => !c.includes('ws://127.0.0.1')), []);
  assert.equal(await end(studio.child), 0);
  await page.close();
  studio = await start(papilla, ['cockpit.step', '-m', RULES], { cwd: work });
  const again = await openUrl(browser, studio.url, { viewport: { width: 1280, height: 860 } });
  await allShown(again.page);
  const { document: reopened } = await again.page.evaluate(() => globalThis.studio.state);
  assert.deepEqual(reopened, saved);
  assert.deepEqual([await materialOf(again.page, DASH), (await materialOf(again.page, TRIM)).size_mm], [adjusted, photo.size]);
  await again.page.screenshot({ path: join(pictures, 'again.png') });

  // ---- By the command line: the same bytes.
  console.log('command line');
  const [, ...args] = command.replace('studio.glb', 'line.glb').split(' ');
  execFileSync(papilla, [...args, '-q'], { cwd: work });
  assert.ok(readFileSync(join(work, 'studio.glb')).equals(readFileSync(join(work, 'line.glb'))), 'the command line gives other bytes');
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
