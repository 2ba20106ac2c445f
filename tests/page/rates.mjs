// SPDX-License-Identifier: MIT
// How fast a page moves: node rates.mjs PAGE.html OUT.json
import { writeFileSync } from 'node:fs';
import { launch, open } from './browser.mjs';

const TURNS = 20;
const [file, out] = process.argv.slice(2);
const browser = await launch();

/** Milliseconds from a key to the picture that it turned. */
const turn = (page) => page.evaluate(() => new Promise((resolve) => {
  const canvas = document.getElementById('canvas3d'), before = Number(canvas.dataset.frames), start = performance.now();
  canvas.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft' }));
  const look = () => Number(canvas.dataset.frames) > before ? resolve(performance.now() - start) : requestAnimationFrame(look);
  look();
}));
const triangles = (page) => page.locator('#canvas3d').getAttribute('data-triangles').then(Number);

try {
  const { page, complaints } = await open(browser, file);
  const turns = [];
  for (let i = 0; i < TURNS; ++i) turns.push(await turn(page));
  const moving = await triangles(page);
  await page.waitForTimeout(8000);
  writeFileSync(out, JSON.stringify({ turn_ms: turns.slice(TURNS / 2), triangles_moving: moving, triangles_at_rest: await triangles(page), complaints }));
} finally {
  await browser.close();
}
