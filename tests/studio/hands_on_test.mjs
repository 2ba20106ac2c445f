// SPDX-License-Identifier: MIT
// Hands on the studio in Chromium: press on the dash, turn the grain, move it, read a photograph's card, take notes, drop files;
// without violations of accessibility: node hands_on_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { folder as made, launch, openUrl, text } from '../page/browser.mjs';
import { allShown, dropFile, materialOf, placeOn, twoFrames } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
const browser = await launch(['--autoplay-policy=no-user-gesture-required']);
const { bumps } = await import('../page/bumps.mjs');
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures'));
copyFileSync(join(data, 'cockpit.step'), join(work, 'cockpit.step'));
const DASH = 'dash_skin', MATERIAL = 'skin';
writeFileSync(join(work, 'm.json'), JSON.stringify({ materials: { [MATERIAL]: { material: 'library:leather/nappa-fine' } }, assign: [{ part: DASH, material: MATERIAL }] }));
const photo = { size: [66, 42], pxPerMm: 10, periods: [6, 8.5], degrees: 17 }, { png, vectors } = bumps(photo);

const studio = await start(papilla, ['cockpit.step', '-m', 'm.json'], { cwd: work });
try {
  const { page, complaints } = await openUrl(browser, studio.url, { viewport: { width: 1280, height: 860 }, init: 'globalThis.prompt = () => "66";' });
  const own = complaints.length;
  const all = () => allShown(page), frames = () => twoFrames(page);
  await all();

  /** A place on the dash with the dash around it, seen from the driver's seat. */
  await page.locator('#camera').selectOption('seat');
  await page.locator('#camera').selectOption('orbit');
  const spot = await placeOn(page, DASH);
  assert.ok(spot, 'the dash is seen');

  // ---- Press on it.
  await page.locator('#tab-feel').click();
  const offered = await page.locator('#feel-device option').allTextContents(), models = await page.locator('#feel-model option').allTextContents();
  assert.ok(offered.length === 7 && models.length === 8 && models.some((m) => m.startsWith('graph-lateral')), `${offered} ${models}`);
  await page.locator('#feel-mode').click();
  await page.locator('#feel-listen').click();
  const camera = () => page.evaluate(() => globalThis.studio.view.camera.matrixWorld.toArray());
  const before = await camera();
  await page.mouse.move(spot.x, spot.y);
  await page.mouse.down();
  await page.waitForFunction(() => Number(document.getElementById('panel-feel').dataset.ticks) > 300);
  for (let i = 0; i < 20; ++i) {
    await page.mouse.move(spot.x + 1.2 * i, spot.y);
    await frames();
  }
  await page.waitForFunction(() => globalThis.studio.feel.samples[1].some((f) => f > 0.2));
  await page.screenshot({ path: join(pictures, 'feel.png') });
  const felt = await page.evaluate(() => {
    const { feel, view } = globalThis.studio;
    return { marks: feel.marks.group.visible, arrow: feel.marks.arrow.visible, samples: feel.samples.map((c) => c.length), total: document.getElementById('feel-total').value, press: document.getElementById('feel-press').textContent,
      depth: parseFloat(document.getElementById('feel-depth').textContent), contact: document.getElementById('feel-contact').textContent, sound: feel.sound.end, frames: view.canvas.dataset.frames, side: Math.max(...feel.samples[3]) };
  });
  assert.ok(felt.marks && felt.arrow && felt.contact === 'yes' && felt.depth > 0 && parseFloat(felt.total) > 0.2 && parseFloat(felt.press) > 0 && felt.side > 0 && felt.sound > 0, JSON.stringify(felt));
  assert.ok(new Set(felt.samples).size === 1 && felt.samples[0] > 300);
  await page.mouse.up();
  await page.waitForSelector('body[data-feel=idle]');
  assert.deepEqual(await camera(), before, 'a press does not turn the view');
  // Beside the scene one still turns it.
  await page.evaluate(() => globalThis.studio.view.frame());
  await frames();

  // By keyboard, with another device and model.
  await page.locator('#feel-device').selectOption('omega3');
  assert.match(await text(page, '#feel-limits'), /^Up to 12 N/);
  await page.locator('#feel-model').selectOption('textured-normal');
  await page.evaluate((label) => { const s = globalThis.studio.state.surfaces.find((x) => x.label === label); globalThis.studio.view.frame(new Set([globalThis.studio.keyOf(s)])); }, DASH);
  await page.locator('#canvas').focus();
  await page.keyboard.press(' ');
  await page.waitForFunction(() => ['feeling', 'idle'].includes(document.body.dataset.feel));
  const ticks = await page.evaluate(() => Number(document.getElementById('panel-feel').dataset.ticks));
  await page.waitForFunction((n) => Number(document.getElementById('panel-feel').dataset.ticks) > n + 100, ticks);
  for (let i = 0; i < 5; ++i) await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Escape');
  await page.waitForSelector('body[data-feel=idle]');
  await page.locator('#feel-mode').click();
  assert.equal(await page.evaluate(() => globalThis.studio.feel.marks.group.visible), false);

  // ---- The grain's direction and phase.
  await page.fill('#find-part', DASH);
  await page.locator('#tree [role=treeitem]').first().click();
  await page.locator('#tab-part').click();
  const uvOf = () => page.evaluate((label) => { const { studio: s } = globalThis, surface = s.state.surfaces.find((x) => x.label === label); return [...s.shown.get(s.keyOf(surface)).data.arrays.uv.slice(0, 4000)]; }, DASH);
  const straight = await uvOf();
  await page.fill('#phase-0', '3');
  await page.locator('#phase-0').blur();
  await page.waitForFunction((label) => { const { state } = globalThis.studio; return state.document.materials[state.surfaces.find((s) => s.label === label).material].phase_mm?.[0] === 3; }, DASH);
  await all();
  const moved = await uvOf(), size = await page.evaluate((label) => { const { studio: s } = globalThis, surface = s.state.surfaces.find((x) => x.label === label); return s.shown.get(s.keyOf(surface)).data.mm_per_uv; }, DASH);
  for (let i = 0; i < straight.length; i += 2) {
    const off = straight[i] - moved[i] - 3 / size[0];
    assert.ok(Math.abs(off - Math.round(off)) < 1e-4 && Math.abs((straight[i + 1] - moved[i + 1]) % 1) < 1e-4, `uv ${i / 2}: ${straight[i]} to ${moved[i]}`);
  }
  await page.fill('#turn', '35');
  await page.locator('#turn').blur();
  const grainOf = async () => (await materialOf(page, DASH)).unwrap?.grain;
  const turned = (old) => page.waitForFunction(([label, was]) => { const { state } = globalThis.studio, grain = state.document.materials[state.surfaces.find((s) => s.label === label).material].unwrap?.grain; return Array.isArray(grain) && JSON.stringify(grain) !== was; }, [DASH, JSON.stringify(old ?? null)]);
  await turned();
  const byBox = await grainOf();
  assert.ok(Math.abs(Math.hypot(...byBox) - 1) < 1e-5);
  assert.equal(await page.evaluate(() => globalThis.studio.panel.turn.arrow.degrees), 35);
  await page.locator('#canvas').focus();
  await page.keyboard.press('.');
  await turned(byBox);
  assert.equal(await page.inputValue('#turn'), '30', 'box and arrow say the same');
  const byKey = await grainOf();
  const tip = await page.evaluate(() => {
    const { arrow } = globalThis.studio.panel.turn, { left, top, width, height } = globalThis.studio.view.canvas.getBoundingClientRect();
    const place = (object) => { const p = object.getWorldPosition(object.position.clone()).project(globalThis.studio.view.camera); return [left + (p.x + 1) / 2 * width, top + (1 - p.y) / 2 * height]; };
    const head = arrow.head.localToWorld(arrow.head.position.clone().setY(0.16)).project(globalThis.studio.view.camera);
    return { at: place(arrow.group), head: [left + (head.x + 1) / 2 * width, top + (1 - head.y) / 2 * height] };
  });
  await page.screenshot({ path: join(pictures, 'arrow.png') });
  await page.mouse.move(...tip.head);
  await page.mouse.down();
  await page.mouse.move(2 * tip.at[0] - tip.head[0], 2 * tip.at[1] - tip.head[1], { steps: 4 });
  await page.mouse.up();
  await turned(byKey);
  const byPointer = await grainOf(), back = byPointer.reduce((sum, x, i) => sum + x * byKey[i], 0);
  assert.ok(back < -0.8, `turned about: ${byKey} to ${byPointer}`);
  await all();

  // ---- Files that are dropped on the scene: a photograph, which becomes a card.
  const drop = (...file) => dropFile(page, ...file);
  await drop('bumps.png', 'image/png', png);
  await page.waitForFunction(() => globalThis.studio.state.document.materials.bumps);
  assert.ok(readFileSync(join(work, 'bumps.png')).equals(png), 'the same bytes');
  assert.deepEqual((await page.evaluate(() => globalThis.studio.state.document.materials.bumps)).size_mm, photo.size);
  await page.locator('#tab-materials').click();
  await page.locator('#own [data-material=bumps]').click();
  await page.waitForSelector('#card[data-card=bumps]');
  assert.match(await text(page, '#card [data-row=class]'), /^strongly ordered/);
  assert.match(await text(page, '#card [data-row=lattice]'), / mm, .*° *; .* mm, /);
  assert.match(await text(page, '#card [data-row=relief]'), /mm deep, rms .* mm/);
  assert.match(await text(page, '#card [data-row=roughness]'), /^rms .* mm; /);
  assert.match(await text(page, '#card ul'), /depth: one photograph does not say it/);
  // The lattice that is drawn goes through the nodes of the one that the picture was made of.
  const nodes = await page.evaluate(([[a, b], sizes]) => {
    const canvas = document.querySelector('#card canvas[aria-label=lattice]'), context = canvas.getContext('2d'), scale = canvas.width / sizes[0], found = [];
    const isLine = (x, y) => {
      const { data: d, width } = context.getImageData(Math.round(x) - 3, Math.round(y) - 3, 7, 7);
      return Array.from({ length: width * width }, (_, i) => d[4 * i] > 200 && d[4 * i + 1] > 120 && d[4 * i + 2] < 120).some(Boolean);
    };
    for (let i = -2; i <= 4; ++i)
      for (let j = -2; j <= 4; ++j) {
        const at = [0, 1].map((k) => scale * (i * a[k] + j * b[k])), between = [0, 1].map((k) => at[k] + scale * (a[k] + b[k]) / 2);
        if (at.every((p, k) => p > 6 && p < [canvas.width, canvas.height][k] - 6)) found.push([isLine(...at), between.every((p, k) => p > 6 && p < [canvas.width, canvas.height][k] - 6) && isLine(...between)]);
      }
    return { found, ratio: canvas.width / canvas.height };
  }, [vectors, photo.size]);
  assert.ok(nodes.found.length > 8 && nodes.found.every(([isNode, isBetween]) => isNode && !isBetween), JSON.stringify(nodes.found));
  assert.ok(Math.abs(nodes.ratio - 66 / 42) < 0.02, 'the picture keeps its shape');
  await page.locator('#card').scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(pictures, 'card.png') });

  // By the button, onto what is selected; a file of another kind is refused with a reason.
  await page.setInputFiles('#photo-file', { name: 'again.png', mimeType: 'image/png', buffer: png });
  await page.waitForFunction((label) => globalThis.studio.state.surfaces.find((s) => s.label === label).material === 'again', DASH);
  await all();
  await drop('letter.txt', 'text/plain', Buffer.from('no scene'));
  await page.waitForFunction(() => /letter\.txt was not opened: .*must end in/.test(document.getElementById('status').textContent));

  // ---- Notes.
  await page.locator('#tab-notes').click();
  await page.locator('#note-add').click();
  await page.waitForFunction(() => document.getElementById('status').textContent.startsWith('Click on a place'));
  await page.locator('#camera').selectOption('seat');
  await page.locator('#camera').selectOption('orbit');
  await page.mouse.click(spot.x, spot.y);
  const looked = await camera();
  await page.locator('#note-add').click();
  await page.waitForSelector('#panel-notes[data-notes="1"] textarea');
  await page.fill('#notes textarea', 'Grain too large');
  await page.locator('#notes textarea').blur();
  await page.waitForFunction(() => globalThis.studio.review.notes[0].text === 'Grain too large');
  const [note] = JSON.parse(readFileSync(join(work, 'review.json'), 'utf8')).notes;
  assert.ok(note.part === DASH && note.text === 'Grain too large' && note.taken_in === 'studio' && note.picture.startsWith('data:image/jpeg') && note.place_m.every((m) => Math.abs(m) < 5), JSON.stringify({ ...note, picture: '' }));
  await page.evaluate(() => globalThis.studio.view.frame());
  await page.locator('#notes button').first().click();
  await frames();
  const seen = await camera();
  assert.ok(seen.every((x, i) => Math.abs(x - looked[i]) < (i >= 12 ? 0.5 : 1e-2)), 'Go there takes the view back');
  await page.screenshot({ path: join(pictures, 'notes.png') });

  // ---- Without violations, tab by tab, light and dark.
  await page.evaluate(readFileSync(createRequire(new URL('../page/package.json', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8'));
  for (const theme of ['light', 'dark']) {
    for (const tab of ['materials', 'part', 'feel', 'notes', 'bake']) {
      await page.locator(`#tab-${tab}`).click();
      const { violations } = await page.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
      assert.deepEqual(violations.map(({ id, nodes: where }) => `${theme} ${tab} ${id}: ${where.map(({ target, failureSummary }) => `${target} ${failureSummary}`).join('; ')}`), []);
    }
    await page.locator('#theme').click();
  }

  // ---- Three widths.
  await page.locator('#tab-feel').click();
  for (const [width, height] of [[390, 844], [1280, 860], [3840, 2160]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(200);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `nothing is cut at ${width} px`);
    await page.screenshot({ path: join(pictures, `feel-${width}.png`), fullPage: width === 390 });
  }

  // ---- Another scene, dropped.
  await drop('plate.obj', '', Buffer.from('o plate\nv 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n'));
  await page.waitForFunction(() => globalThis.studio.state.scene_file === 'plate.obj' && globalThis.studio.state.surfaces.length === 1);
  await all();
  assert.equal(await text(page, '#scene-file'), 'plate.obj');
  assert.deepEqual(complaints.slice(own).filter((c) => !c.includes('ws://127.0.0.1') && !/status of 409/.test(c)), []);
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
