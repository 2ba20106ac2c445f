// SPDX-License-Identifier: MIT
// The recipe editor in Chromium: a mistake at its place, completion, sliders and colours that are seen on the scene at once,
// layers, variations, age; kept, undone, saved and baked to the bytes of the command line: node recipe_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { folder as made, launch, openUrl, text } from '../page/browser.mjs';
import { allShown } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures'));
copyFileSync(join(data, 'cockpit.step'), join(work, 'cockpit.step'));
const DASH = 'dash_skin', WALL = 'wall', RECIPE = 'brick|scale=.5|switching=true|cols=grey,<.7,.2,.1>', MEASURED_MS = 3000;
writeFileSync(join(work, 'm.json'), JSON.stringify({ materials: { [WALL]: { texture: RECIPE, size_mm: [40, 40], show: 'picture' }, flat: { stiffness: 900 } }, assign: [{ part: DASH, material: WALL }] }));

const browser = await launch();
const studio = await start(papilla, ['cockpit.step', '-m', 'm.json'], { cwd: work });
try {
  const { page, complaints } = await openUrl(browser, studio.url, { viewport: { width: 1500, height: 950 } });
  const own = complaints.length;
  const all = () => allShown(page);
  const entry = () => page.evaluate((name) => globalThis.studio.state.document.materials[name], WALL);
  const written = () => page.inputValue('#recipe-text');
  const textIs = (wanted) => page.waitForFunction((t) => document.getElementById('recipe-text').value === t, wanted);
  /** What the dash shows: whether it is live, its scale in texels of one colour, and a colour of it. */
  const dash = () => page.evaluate((label) => {
    const { studio: s } = globalThis, surface = s.state.surfaces.find((x) => x.label === label), { material } = s.view.surfaces.get(s.keyOf(surface));
    const isLive = Boolean(material.map?.isDataTexture), pixels = isLive ? material.map.image.data : null;
    let sum = 0;
    for (let i = 0; pixels && i < pixels.length; i += 4) sum = (31 * sum + pixels[i] + 3 * pixels[i + 1] + 7 * pixels[i + 2]) % 1000003;
    const share = (is) => { let n = 0; for (let i = 0; pixels && i < pixels.length; i += 4) n += is(pixels[i], pixels[i + 1], pixels[i + 2]) ? 1 : 0; return n / (512 * 512); };
    return { isLive, sum, width: material.map?.image.width, red: share((r, g, b) => r > 100 && g < 30 && b < 30), green: share((r, g, b) => g > 100 && r < 30 && b < 30), normal: Boolean(material.normalMap?.isDataTexture) };
  }, DASH);
  /** Waits for the look of the text as it is. */
  const looked = () => page.waitForFunction(() => { const { asker } = globalThis.studio.recipe; return !asker.isRunning && asker.isFine && asker.wanted === asker.answered; });
  await all();

  // ---- Opened from a part's material.
  await page.fill('#find-part', DASH);
  await page.locator('#tree [role=treeitem]').first().click();
  await page.locator('#frame').click();
  await page.locator('#tab-part').click();
  await page.locator('#part-recipe').click();
  await page.waitForSelector('#recipe-tree [role=treeitem]');
  assert.equal(await written(), RECIPE);
  assert.equal(await text(page, '#recipe-title'), WALL);
  assert.equal(await text(page, '#recipe-state'), 'kept');
  assert.equal((await dash()).isLive, false, 'what is kept is shown as it is baked');

  // ---- A mistake is shown at its place while typing.
  await page.locator('#recipe-text').focus();
  await page.keyboard.press('Control+End');
  await page.keyboard.type('\n|octves=3');
  await page.waitForFunction(() => /^line 2, column 2: unknown parameter 'octves' of 'brick'/.test(document.getElementById('recipe-problem').textContent));
  assert.equal(await text(page, '.recipe-lines mark'), 'octves');
  assert.equal(await page.locator('.recipe-lines > div').count(), 2);
  await page.screenshot({ path: join(pictures, 'mistake.png') });
  await page.locator('#recipe-problem').click();
  assert.equal(await page.evaluate(() => document.getElementById('recipe-text').selectionStart), RECIPE.length + 2);
  await page.keyboard.press('Control+End');
  for (let i = 0; i < '\n|octves=3'.length; ++i) await page.keyboard.press('Backspace');
  await page.waitForFunction(() => document.getElementById('recipe-problem').hidden);

  // ---- Completion: Enter takes what fits the word as it is, though the list shown is of a shorter one.
  await page.keyboard.type('|mor');
  await page.waitForSelector('#recipe-completions [role=option][aria-selected=true]');
  let answer;
  const asked = new Promise((go) => { answer = go; });
  await page.route('**/recipe-completions?*', async (route) => { await asked; await route.continue(); });
  await page.keyboard.type('tarthickn');
  await page.keyboard.press('Enter');
  assert.equal(await written(), `${RECIPE}|mortarthickn`);
  answer();
  await textIs(`${RECIPE}|mortarthickness=`);
  await page.unroute('**/recipe-completions?*');
  for (let i = 0; i < '|mortarthickness='.length; ++i) await page.keyboard.press('Backspace');
  await page.keyboard.type('|mortarthickn');
  await page.waitForSelector('#recipe-completions [role=option][aria-selected=true]');
  assert.equal(await text(page, '#recipe-completions [aria-selected=true] b'), 'mortarthickness');
  assert.match(await text(page, '#recipe-completions [aria-selected=true]'), /width of the joint/);
  await page.keyboard.press('Enter');
  await textIs(`${RECIPE}|mortarthickness=`);
  await page.keyboard.type('.1');
  await textIs(`${RECIPE}|mortarthickness=.1`);
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.querySelector('[data-parameter=mortarthickness] input[type=range]') && document.getElementById('recipe-problem').hidden);
  await looked();
  const typed = await dash();
  assert.ok(typed.isLive && typed.normal && typed.width === 512, JSON.stringify(typed));
  assert.equal(await text(page, '#recipe-state'), 'not kept');
  assert.equal((await entry()).texture, RECIPE, 'the document is as it was');

  // ---- A slider and a colour rewrite their piece of the text; the scene follows.
  const slide = (name, value) => page.locator(`[data-parameter=${name}] input[type=range]`).evaluate((node, to) => { node.value = to; node.dispatchEvent(new Event('input', { bubbles: true })); }, value);
  await slide('scale', 1.25);
  await page.waitForFunction(() => document.getElementById('recipe-text').value.startsWith('brick|scale=1.25|switching=true|'));
  await looked();
  const slid = await dash();
  assert.notEqual(slid.sum, typed.sum);
  const colour = (n) => page.locator('#recipe-controls input[type=color]').nth(n);
  assert.equal(await colour(1).inputValue(), '#b3331a');
  await colour(1).fill('#ff0000');
  await page.waitForFunction(() => document.getElementById('recipe-text').value.includes('cols=grey,<1,0,0>|'));
  await looked();
  assert.ok((await dash()).red > 0.3 && slid.red === 0, JSON.stringify(await dash()));

  // ---- How many looks a second.
  const measured = await page.evaluate(async (ms) => {
    const slider = document.querySelector('[data-parameter=scale] input[type=range]'), panel = document.getElementById('panel-recipe'), { canvas } = globalThis.studio.view;
    const begin = performance.now(), looks = Number(panel.dataset.looks), frames = Number(canvas.dataset.frames);
    for (let i = 0; performance.now() - begin < ms; ++i) {
      slider.value = 0.4 + 0.3 * Math.sin(i / 7);
      slider.dispatchEvent(new Event('input', { bubbles: true }));
      await new Promise((next) => setTimeout(next, 16));
    }
    const seconds = (performance.now() - begin) / 1000;
    return { looks: (Number(panel.dataset.looks) - looks) / seconds, frames: (Number(canvas.dataset.frames) - frames) / seconds };
  }, MEASURED_MS);
  console.log(`${measured.looks.toFixed(1)} looks of 512 x 512 a second on the cockpit, ${measured.frames.toFixed(1)} pictures of the scene`);
  await slide('scale', 0.5);
  await looked();

  // ---- Kept; a colour that is picked while that is under way stays picked.
  let release;
  const held = new Promise((go) => { release = go; });
  await page.route('**/edit?*', async (route) => { await held; await route.continue(); });
  await page.locator('#recipe-keep').click();
  await colour(1).fill('#00ff00');
  release();
  await page.waitForFunction((name) => globalThis.studio.state.document.materials[name].texture.includes('<1,0,0>'), WALL);
  await page.waitForFunction(() => !globalThis.studio.recipe.isKeeping);
  await page.unroute('**/edit?*');
  await all();
  await looked();
  assert.match(await written(), /cols=grey,<0,1,0>/);
  assert.equal(await text(page, '#recipe-state'), 'not kept');
  const green = await dash();
  assert.ok(green.isLive && green.green > 0.3, JSON.stringify(green));
  await page.locator('#recipe-keep').click();
  await page.waitForFunction((name) => globalThis.studio.state.document.materials[name].texture.includes('<0,1,0>'), WALL);
  await all();
  await page.waitForFunction(() => globalThis.studio.recipe.live.looks.size === 0);
  assert.equal((await dash()).isLive, false);

  // ---- Undone and done again: the text follows.
  await page.locator('#undo').click();
  await page.waitForFunction(() => document.getElementById('recipe-text').value.includes('<1,0,0>'));
  assert.match(await page.locator('#undo').getAttribute('title'), /recipe of wall/);
  await page.locator('#redo').click();
  await page.waitForFunction(() => document.getElementById('recipe-text').value.includes('<0,1,0>'));
  await all();
  assert.equal(await text(page, '#recipe-state'), 'kept');

  // ---- Layers: added, dragged, aged.
  await page.locator('#recipe-layer').selectOption('scratches');
  await page.locator('#layer-add').click();
  await page.waitForFunction(() => /^multi\|textures=\[brick\|.*\],\[scratches\]$/.test(document.getElementById('recipe-text').value));
  await page.waitForFunction(() => document.querySelectorAll('#recipe-tree [role=treeitem]').length === 3);
  await looked();
  const rows = page.locator('#recipe-tree [role=treeitem]');
  assert.deepEqual(await rows.locator('span').allTextContents(), ['multi', 'brick', 'scratches']);
  const fresh = await dash();
  await page.locator('#recipe-time').evaluate((node) => { node.value = 0.9; node.dispatchEvent(new Event('input', { bubbles: true })); });
  await looked();
  assert.notEqual((await dash()).sum, fresh.sum, 'scratches lie on it at that age');
  await rows.nth(2).dragTo(rows.nth(1), { targetPosition: { x: 40, y: 3 } });
  await page.waitForFunction(() => /^multi\|textures=\[scratches\],\[brick\|.*\]$/.test(document.getElementById('recipe-text').value));
  await rows.nth(1).click();
  await page.keyboard.press('Alt+ArrowDown');
  await page.waitForFunction(() => /^multi\|textures=\[brick\|.*\],\[scratches\]$/.test(document.getElementById('recipe-text').value));
  // Every row has a picture of its own.
  await page.waitForFunction(() => {
    const sums = [...document.querySelectorAll('#recipe-tree canvas')].map((c) => c.getContext('2d').getImageData(0, 0, c.width, c.height).data.reduce((sum, v) => sum + v, 0));
    return new Set(sums).size === 3 && sums.every((sum) => sum > 0);
  });

  // ---- A variation is taken.
  await looked();
  const [before, seen] = [await written(), await dash()];
  await page.locator('#mutate').click();
  await page.waitForFunction(() => document.querySelectorAll('#mutations button').length === 9);
  await page.locator('#mutations button').nth(2).click();
  await page.waitForFunction((t) => document.getElementById('recipe-text').value !== t, before);
  await looked();
  assert.notEqual((await dash()).sum, seen.sum);
  assert.equal(await page.evaluate(() => document.getElementById('recipe-problem').hidden), true);
  await page.locator('#recipe-tree [role=treeitem]').nth(1).click();
  await page.waitForTimeout(400);
  await page.screenshot({ path: join(pictures, 'recipe.png') });

  // ---- Kept, saved, baked.
  const chosen = await written();
  await page.locator('#recipe-keep').click();
  await page.waitForFunction(([name, t]) => globalThis.studio.state.document.materials[name].texture === t && globalThis.studio.state.document.materials[name].time === 0.9, [WALL, chosen]);
  await all();
  await page.locator('#save').click();
  await page.waitForFunction(() => document.getElementById('saved').textContent === 'saved');
  assert.equal(JSON.parse(readFileSync(join(work, 'm.json'), 'utf8')).materials[WALL].texture, chosen);
  await page.locator('#tab-bake').click();
  await page.fill('#output', 'studio.glb');
  await page.locator('#bake').click();
  await page.waitForFunction(() => ['done', 'failed'].includes(document.body.dataset.bake));
  assert.equal(await page.evaluate(() => document.body.dataset.bake), 'done', await text(page, '#bake-state'));
  execFileSync(papilla, ['bake', 'cockpit.step', '-m', 'm.json', '-o', 'again.glb', '-q'], { cwd: work });
  assert.ok(readFileSync(join(work, 'studio.glb')).equals(readFileSync(join(work, 'again.glb'))), 'the command line gives other bytes');

  // ---- A recipe of the library as a new material.
  await page.locator('#tab-materials').click();
  await page.locator('#add-recipe').click();
  await page.locator('#recipe-from').selectOption('oak');
  await page.fill('#recipe-name', 'my oak');
  await page.locator('#recipe-new').click();
  await page.waitForFunction(() => document.getElementById('recipe-title').textContent === 'my oak');
  await page.waitForFunction((label) => globalThis.studio.state.surfaces.find((s) => s.label === label).material === 'my oak', DASH);
  assert.ok((await page.evaluate(() => globalThis.studio.state.document.materials['my oak'].texture)).includes('|'), 'its text, not its name');
  await all();

  // ---- One that reads the surface is seen on the scene, too, and as it is when it is kept.
  /** Colours of the dash where its triangles have their middles, in [0, 1]: of what is shown, by what it is shown with. */
  const coloursOfDash = () => page.evaluate((label) => {
    const { studio: s } = globalThis, shown = s.view.surfaces.get(s.keyOf(s.state.surfaces.find((x) => x.label === label))), { map } = shown.material;
    const { geometry } = shown.meshes[0], position = geometry.getAttribute('position'), uv = geometry.getAttribute('uv'), index = geometry.index.array, { width, height } = map.image;
    let { data } = map.image;
    if (!data) {
      const context = new OffscreenCanvas(width, height).getContext('2d');
      context.drawImage(map.image, 0, 0);
      ({ data } = context.getImageData(0, 0, width, height));
    }
    const texel = (x, y, k) => data[4 * ((y % height + height) % height * width + (x % width + width) % width) + k] / 255;
    const found = [], step = 3 * Math.max(1, Math.floor(index.length / 3 / 400));
    for (let t = 0; t < index.length; t += step) {
      const corners = [0, 1, 2].map((k) => index[t + k]), mean = (of) => corners.reduce((sum, i) => sum + of(i), 0) / 3;
      const x = mean((i) => uv.getX(i)) * width - 0.5, y = mean((i) => uv.getY(i)) * height - 0.5, [i, j] = [Math.floor(x), Math.floor(y)], [a, b] = [x - i, y - j];
      found.push({ place: ['getX', 'getY', 'getZ'].map((get) => mean((n) => position[get](n))), rgb: [0, 1, 2].map((k) => (1 - b) * ((1 - a) * texel(i, j, k) + a * texel(i + 1, j, k)) + b * ((1 - a) * texel(i, j + 1, k) + a * texel(i + 1, j + 1, k))) });
    }
    return { colours: found, laid: Boolean(shown.laid), width, height };
  }, DASH);
  const atlasLooked = () => page.waitForFunction(() => {
    const { recipe: { asker, looks } } = globalThis.studio, { dataset } = document.getElementById('panel-recipe');
    return !asker.isRunning && asker.isFine && asker.wanted === asker.answered && Number(dataset.looks) === looks && dataset.underWay === '0';
  });
  // Waves of 0.4 m: 0.4 · 2π/400 a mm at most.
  const SOLID = 'base|colorfunction=rgb(.5+.4*s(15.7*posx),.5+.4*s(15.7*posy),.5+.4*s(15.7*posz))';
  await page.fill('#recipe-text', SOLID);
  await page.waitForFunction(() => /^It reads the surface: .* being laid out/.test(document.getElementById('recipe-note').textContent) || document.getElementById('panel-recipe').dataset.underWay === '0');
  await atlasLooked();
  const asLive = await coloursOfDash();
  assert.ok(asLive.laid && (await dash()).isLive && new Set(asLive.colours.map(({ rgb }) => rgb[0].toFixed(1))).size > 2, JSON.stringify(asLive).slice(0, 400));
  await page.screenshot({ path: join(pictures, 'solid.png') });
  // Another one that looks at the same has its picture at once: the atlas is not made again.
  const mesh = () => page.evaluate(() => [...globalThis.studio.recipe.live.looks.values()].map(({ look }) => look.mesh).sort().join());
  const meshes = await mesh();
  await page.fill('#recipe-text', SOLID.replaceAll('15.7', '7'));
  await atlasLooked();
  assert.ok(meshes.length > 0);
  assert.equal(await mesh(), meshes);  // Of the fine looks: on a slow machine coarse ones have an atlas of their own.
  await page.fill('#recipe-text', SOLID);
  await atlasLooked();
  await page.locator('#recipe-keep').click();
  await page.waitForFunction((t) => globalThis.studio.state.document.materials['my oak'].texture === t, SOLID);
  await all();
  await page.waitForFunction(() => globalThis.studio.recipe.live.looks.size === 0);
  const asKept = await coloursOfDash();
  assert.ok(!asKept.laid && asKept.colours.length === asLive.colours.length);
  // Both are the recipe to a texel of theirs, those of the preview being at most this long.
  const farthest = Math.max(...asLive.colours.flatMap(({ rgb }, i) => rgb.map((v, k) => Math.abs(v - asKept.colours[i].rgb[k]))));
  console.log(`live and kept: atlases of ${asLive.width} x ${asLive.height} and ${asKept.width} x ${asKept.height}, colours at most ${farthest.toFixed(4)} apart`);
  assert.ok(asLive.colours.every(({ place }, i) => place.every((c, k) => Math.abs(c - asKept.colours[i].place[k]) < 1e-3)), 'the same places');
  assert.ok(farthest < 0.05, String(farthest));
  await page.locator('#undo').click();
  await page.waitForFunction(() => document.getElementById('recipe-state').textContent === 'kept' && !document.getElementById('recipe-text').value.startsWith('base'));
  await all();
  // A material without a recipe says so.
  await page.locator('#tab-materials').click();
  await page.locator('#own [data-material=flat]').click();
  await page.locator('#edit-recipe').click();
  await page.waitForFunction(() => document.getElementById('status').textContent === "material 'flat' has no recipe");

  // ---- Without violations, light and dark; nothing is cut.
  await page.locator('#tab-recipe').click();
  await page.fill('#recipe-text', 'fbm|octves=3');
  await page.waitForFunction(() => !document.getElementById('recipe-problem').hidden);
  await page.locator('#mutate').focus();
  await page.evaluate(readFileSync(createRequire(new URL('../page/package.json', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8'));
  for (const theme of ['light', 'dark']) {
    const { violations } = await page.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
    assert.deepEqual(violations.map(({ id, nodes }) => `${theme} ${id}: ${nodes.map(({ target, failureSummary }) => `${target} ${failureSummary}`).join('; ')}`), []);
    await page.locator('#theme').click();
  }
  await page.locator('#recipe-revert').click();
  for (const [width, height] of [[390, 844], [1280, 860], [3840, 2160]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(200);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `nothing is cut at ${width} px`);
    await page.screenshot({ path: join(pictures, `recipe-${width}.png`), fullPage: width === 390 });
  }
  assert.deepEqual(complaints.slice(own).filter((c) => !c.includes('ws://127.0.0.1') && !/status of 409/.test(c)), []);
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
