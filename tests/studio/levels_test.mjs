// SPDX-License-Identifier: MIT
// Levels of detail of the studio in Chromium: fewer triangles from far away, all of them from near, no holes, and the page
// comes to rest: node levels_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { folder as made, launch, openUrl } from '../page/browser.mjs';
import { allShown } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
const browser = await launch();
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures')), DASH = 'dash_skin';
copyFileSync(join(data, 'cockpit.step'), join(work, 'cockpit.step'));

const studio = await start(papilla, ['cockpit.step', '-m', 'm.json'], { cwd: work });
try {
  const { page, complaints } = await openUrl(browser, studio.url, { viewport: { width: 1280, height: 860 } });
  const own = complaints.length;
  await allShown(page);
  /** When nothing is drawn any more, the picture is a full one and no level is to come: what was drawn. */
  const drawn = async () => {
    await page.waitForFunction(() => { const { view } = globalThis.studio; return !view.waiting && !view.pace.isCoarse && view.levels.missing === 0 && view.canvas.dataset.missingLevels === '0'; });
    return page.evaluate(() => Number(globalThis.studio.view.canvas.dataset.triangles));
  };
  const go = async (factor) => { await page.evaluate((by) => globalThis.studio.view.orbitBy(0, 0, by), factor); return drawn(); };
  const look = async (work_, argument) => { await page.evaluate(work_, argument); return drawn(); };

  // ---- The whole cockpit.
  const whole = await page.evaluate(() => [...globalThis.studio.view.surfaces.values()].reduce((sum, { geometry, meshes }) => sum + meshes.length * geometry.index.count / 3, 0));
  const framed = await look(() => globalThis.studio.view.frame()), far = await go(6);
  console.log(`the cockpit has ${whole} triangles: ${framed} are drawn where it fills the picture, ${far} from six times as far away`);
  assert.ok(framed < 0.8 * whole && far < framed / 2);
  assert.equal(await go(1 / 6), framed, 'they come back');

  // It rests.
  const frames = () => page.evaluate(() => globalThis.studio.view.canvas.dataset.frames), before = await frames();
  await page.waitForTimeout(1000);
  assert.equal(await frames(), before, 'nothing is drawn without a change');

  /** Beside the same picture of whole surfaces: pixels of these, those where one now sees through, and those that are unlike. */
  const compared = async (name) => {
    await page.screenshot({ path: join(pictures, `${name}.png`) });
    const counts = await page.evaluate(() => {
      const { view } = globalThis.studio, gl = view.renderer.getContext(), { drawingBufferWidth: w, drawingBufferHeight: h } = gl;
      const read = () => { const rgba = new Uint8Array(4 * w * h); gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, rgba); return rgba; };
      view.paint();
      const coarse = read();
      view.renderer.render(view.world, view.camera);
      const all = read(), back = [0, 1, 2].map((k) => all[4 * (w * h - 1) + k]), counts = { pixels: 0, holes: 0, unlike: 0 };
      const isBack = (rgba, i) => back.every((value, k) => rgba[4 * i + k] === value), around = [-w - 1, -w, -w + 1, -1, 0, 1, w - 1, w, w + 1];
      for (let y = 1; y < h - 1; ++y)
        for (let x = 1; x < w - 1; ++x) {
          const i = w * y + x;
          if (isBack(all, i)) continue;
          ++counts.pixels;
          if (isBack(coarse, i) && around.every((step) => !isBack(all, i + step))) ++counts.holes;
          if ([0, 1, 2].some((k) => Math.abs(all[4 * i + k] - coarse[4 * i + k]) > 32)) ++counts.unlike;
        }
      return counts;
    });
    console.log(`${name}: of ${counts.pixels} pixels ${counts.holes} are seen through, ${counts.unlike} differ by more than 32`);
    return counts;
  };
  // Between parts that lie side by side, which are simplified one by one, a pixel may be seen through.
  for (const [name, factor] of [['framed', 1], ['far', 3]]) {
    await go(factor);
    const { pixels, holes, unlike } = await compared(name);
    assert.ok(pixels > 5000 && holes < 5e-4 * pixels && unlike < 0.02 * pixels);
  }

  // ---- One surface: from near it is whole, and so it is for distortion, seams and rays from wherever.
  const triangles = await page.evaluate((label) => {
    const { studio: s } = globalThis, surface = s.state.surfaces.find((x) => x.label === label), key = s.keyOf(surface);
    s.setHidden(new Set(s.state.surfaces.map((x) => s.keyOf(x)).filter((other) => other !== key)));
    s.view.frame(new Set([key]));
    return s.view.surfaces.get(key).geometry.index.count / 3;
  }, DASH);
  assert.equal(await drawn(), triangles);
  const fewer = await go(2.5), { holes, pixels } = await compared('dash');
  assert.ok(fewer < triangles && holes === 0 && pixels > 5000, `a surface has no holes: ${fewer} triangles, ${holes} of ${pixels} pixels`);
  assert.equal(await go(0.2), triangles);
  const away = await go(16);
  assert.ok(away > 0 && away < triangles / 2, `${away} of ${triangles}`);
  const off = await page.evaluate(() => {
    const { view, worn } = globalThis.studio, { left, top, width, height } = view.canvas.getBoundingClientRect();
    worn.three.take();
    let most = 0, hits = 0;
    for (let x = 0.3; x < 0.7; x += 0.01)
      for (let y = 0.3; y < 0.7; y += 0.01) {
        const hit = view.hitAt({ clientX: left + x * width, clientY: top + y * height });
        if (!hit) continue;
        const met = worn.three.surface.meet(view.camera.position, hit.point.clone().sub(view.camera.position).normalize());
        ++hits;
        most = Math.max(most, met ? met.point.distanceTo(hit.point) : Infinity);
      }
    return hits > 10 ? most : Infinity;
  });
  assert.ok(off < 0.05, `rays meet the whole surface, ${off} mm off`);
  assert.equal(await look(() => globalThis.studio.view.setOverlay('stretch')), triangles);
  assert.equal(await look(() => globalThis.studio.view.setOverlay('textured')), away);
  assert.equal(await look(() => globalThis.studio.view.setSeams(true)), triangles);
  assert.equal(await look(() => globalThis.studio.view.setSeams(false)), away);

  // A new surface gets levels of its own.
  await page.evaluate((label) => { const { studio: s } = globalThis; return s.apply({ library: 'leather/nappa-fine' }, [s.keyOf(s.state.surfaces.find((x) => x.label === label))]); }, DASH);
  await allShown(page);
  const grained = await drawn();
  console.log(`the dash has ${triangles} triangles, ${away} from far away, ${grained} of them in leather`);
  assert.ok(grained > 0 && grained < triangles / 2);
  assert.deepEqual(complaints.slice(own), []);
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
