// SPDX-License-Identifier: MIT
// Pages that follow weather --live: node looks_test.mjs PAPILLA FILE.glb PICTURE_FOLDER
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { folder, launch, openUrl, text } from './browser.mjs';

const [papilla, file, pictures] = process.argv.slice(2);
const place = mkdtempSync(join(tmpdir(), 'papilla-looks-')), config = join(place, 'config.json'), out = join(place, 'old.glb');
const EDIT_MS = 50, EDITS_S = 10;
folder(pictures);

const write = (layers) => writeFileSync(config, JSON.stringify({ size: 512, layers }));
const save = (...recipes) => write(recipes.map((recipe) => ({ recipe })));
const paint = (colour) => `rust_on|scale=.2|colorfunction=${colour}|alphafunction=1`;

function addressOf(child) {
  let said = '';
  return new Promise((resolve, reject) => {
    child.stdout.on('data', (chunk) => {
      said += chunk;
      const found = /http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]{32}/.exec(said);
      if (found) resolve(found[0]);
    });
    child.on('exit', () => reject(new Error(`papilla weather ended: ${said}`)));
  });
}

/** The mean colour of the scene as it is drawn. */
const meanColour = (page) => page.evaluate(async () => {
  const canvas = document.getElementById('canvas3d');
  const frame = Number(canvas.dataset.frames);
  canvas.dispatchEvent(new KeyboardEvent('keydown', { key: 'Home' }));
  const small = new OffscreenCanvas(64, 64), context = small.getContext('2d');
  await new Promise((resolve) => {
    const look = () => {
      if (Number(canvas.dataset.frames) <= frame) return requestAnimationFrame(look);
      const { width, height } = canvas;  // of this frame: smaller while the camera moves
      context.drawImage(canvas, width / 4, height / 4, width / 2, height / 2, 0, 0, 64, 64);  // in the frame that drew it
      return resolve();
    };
    look();
  });
  const { data } = context.getImageData(0, 0, 64, 64), sum = [0, 0, 0];
  for (let i = 0; i < data.length; ++i) if (i % 4 < 3) sum[i % 4] += data[i] / (64 * 64);
  return sum;
});
const version = (page) => page.locator('#looks').evaluate((node) => Number(node.dataset.version ?? 0));
const newer = (page, than) => page.waitForFunction((n) => Number(document.getElementById('looks').dataset.version ?? 0) > n, than);
const isRed = ([r, g]) => r > 1.3 * g, isGreen = ([r, g]) => g > 1.3 * r;

const browser = await launch();
save(paint('red'));
const child = spawn(papilla, ['weather', file, '-c', config, '-o', out, '--live', '--no-open'], { stdio: ['ignore', 'pipe', 'inherit'] });
try {
  const url = await addressOf(child);
  const { page, complaints } = await openUrl(browser, url);
  await page.setViewportSize({ width: 960, height: 640 });
  await page.waitForSelector('#canvas3d[data-textures=loaded]');
  const red = await meanColour(page);
  assert.ok(isRed(red), `red: ${red}`);
  const old = statSync(out).mtimeMs;

  // Another colour is drawn on the same page.
  await page.evaluate(() => { window.sameDocument = true; });
  save(paint('<0,.8,0>'));
  await newer(page, 0);
  const green = await meanColour(page);
  assert.ok(isGreen(green), `green: ${green}`);
  await page.screenshot({ path: join(pictures, 'looks.png') });

  // A mistake is told at its place, and goes away.
  save(paint('red').replace('scale', 'skale'));
  await page.waitForSelector('#looks-problem:not([hidden])');
  assert.match(await text(page, '#looks-problem'), /line 1, column \d+: unknown parameter 'skale'.*did you mean 'scale'/s);
  writeFileSync(config, '{"layers": [');
  await page.waitForFunction(() => /no valid JSON/.test(document.getElementById('looks-problem').textContent));
  await page.locator('#looks').scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(pictures, 'looks-problem.png') });
  let before = await version(page);
  save(paint('blue'));
  await newer(page, before);
  assert.ok(await page.locator('#looks-problem').isHidden());

  // Edits that come faster than pictures: the newest wins, and nothing queues.
  const counts = () => page.locator('#looks').evaluate((node) => Number(node.dataset.count));
  write([{ recipe: paint('blue') }, { recipe: paint('black'), materials: ['carpet*'] }]);  // one material changes from now on
  await sleep(1000);
  for (const window of [{ width: 960, height: 640 }, { width: 1400, height: 950 }]) {
    await page.setViewportSize(window);
    await sleep(2000);  // until a full frame was timed
    const [first, start] = [await counts(), performance.now()];
    let edits = 0;
    for (; performance.now() - start < 1000 * EDITS_S; ++edits) {
      write([{ recipe: paint('blue') }, { recipe: paint(`<${edits % 2},${(edits % 7) / 7},0>`), materials: ['carpet*'] }]);
      await sleep(EDIT_MS);
    }
    const shown = await counts() - first, seconds = (performance.now() - start) / 1000;
    console.log(`${window.width} x ${window.height}: ${edits} edits in ${seconds.toFixed(1)} s, ${shown} shown: ${(shown / seconds).toFixed(1)} a second`);
    assert.ok(shown > 0 && shown <= edits);
  }
  await page.setViewportSize({ width: 960, height: 640 });
  save(paint('red'));
  for (const end = performance.now() + 30000; !isRed(await meanColour(page));) assert.ok(performance.now() < end, 'the last edit is what is seen');
  assert.ok(await page.evaluate(() => window.sameDocument), 'the page was never loaded again');

  // The file follows when edits rest.
  while (statSync(out).mtimeMs === old) await sleep(100);
  // What needs other coordinates loads the page again.
  save(paint('<0,.8,0>'), 'base|colorfunction=currentcolor|alphafunction=clampunit(normaldot)');
  await page.waitForFunction(() => !window.sameDocument && document.body.dataset.ready === 'yes');
  await page.waitForSelector('#canvas3d[data-textures=loaded]');
  assert.ok(isGreen(await meanColour(page)));
  assert.deepEqual(complaints, []);

  child.kill('SIGINT');
  const [code] = await once(child, 'exit');
  assert.equal(code, 0);
  await page.waitForSelector('#looks[data-state=lost]');
  assert.ok(readFileSync(out).length > 1000);
} finally {
  await browser.close();
  if (child.exitCode === null && child.signalCode === null) child.kill('SIGKILL');
  rmSync(place, { recursive: true });
}
