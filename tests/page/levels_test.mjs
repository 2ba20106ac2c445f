// SPDX-License-Identifier: MIT
// Levels of detail (MSFT_lod) on the page: the one whose share of the picture's height it is. node levels_test.mjs PAPILLA FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { folder, launch, open, text } from './browser.mjs';

const [papilla, place] = process.argv.slice(2);
const browser = await launch();
folder(place);
const at = (name) => join(place, name);
const run = (...words) => execFileSync(papilla, [...words, '--cache', 'none', '-q']);

/** A sphere of 100 mm. */
function sphere(rings, sectors) {
  const lines = [];
  for (let i = 0; i <= rings; ++i)
    for (let k = 0; k < sectors; ++k) {
      const a = Math.PI * i / rings, b = 2 * Math.PI * k / sectors;
      lines.push(`v ${50 * Math.sin(a) * Math.cos(b)} ${50 * Math.cos(a)} ${50 * Math.sin(a) * Math.sin(b)}`);
    }
  for (let i = 0; i < rings; ++i)
    for (let k = 0; k < sectors; ++k) {
      const [p, q] = [sectors * i + k + 1, sectors * i + (k + 1) % sectors + 1];
      if (i < rings - 1) lines.push(`f ${p} ${q + sectors} ${p + sectors}`);
      if (i > 0) lines.push(`f ${p} ${q} ${q + sectors}`);
    }
  return lines.join('\n') + '\n';
}
writeFileSync(at('sphere.obj'), sphere(48, 96));
// The box of the sphere has a diagonal of 173 mm: levels from 0.43 and 0.14 of the picture's height on.
run('simplify', at('sphere.obj'), '-o', at('levels.glb'), '--lod-tolerances', '0.2,0.6', '--json', at('levels.json'));
const { levels, triangles_after: finest } = JSON.parse(readFileSync(at('levels.json')));
assert.equal(levels.length, 2);
assert(finest > 2 * levels[0].triangles && levels[0].triangles > 2 * levels[1].triangles);

// The same levels as files: the triangles of each, below the same shares, and none of MSFT_lod.
run('simplify', at('sphere.obj'), '-o', at('files.glb'), '--lod-tolerances', '0.2,0.6', '--lod-files', '--json', at('files.json'));
const { lod_files: files } = JSON.parse(readFileSync(at('files.json')));
assert.deepEqual(files.map(({ file, triangles, tolerance_mm: mm }) => [file, triangles, mm]),
  [[at('files.lod1.glb'), levels[0].triangles, 0.2], [at('files.lod2.glb'), levels[1].triangles, 0.6]]);
for (const [i, { file, screen_coverage: share }] of files.entries()) {
  assert(Math.abs(share - Math.sqrt(3) * 100 / (2000 * [0.2, 0.6][i])) < 1e-6);
  run('inspect', file, '--json', at('inspected.json'));
  assert.equal(JSON.parse(readFileSync(at('inspected.json'))).totals.triangles, files[i].triangles);
}
assert(!readFileSync(at('files.glb')).includes('MSFT_lod') && readFileSync(at('levels.glb')).includes('MSFT_lod'));

run('view', at('levels.glb'), '-o', at('levels.html'), '--no-open');
const { page, complaints } = await open(browser, at('levels.html'));
const canvas = page.locator('#canvas3d');
const drawn = () => canvas.evaluate((node) => Number(node.dataset.triangles));
await canvas.focus();
const COUNTS = [finest, ...levels.map(({ triangles }) => triangles)];
/** Presses a key until so many triangles are drawn; at most so often. While the camera moves, slow machines draw fewer. */
async function until(key, wanted, most) {
  for (let i = 0; i < most && await drawn() !== wanted; ++i) {
    const frames = await canvas.evaluate((node) => Number(node.dataset.frames));
    await page.keyboard.press(key);
    await page.waitForFunction(([n, counts]) => {
      const { frames, triangles } = document.querySelector('#canvas3d').dataset;
      return Number(frames) > n && counts.includes(Number(triangles));
    }, [frames, COUNTS]);
  }
  assert.equal(await drawn(), wanted);
}
assert.equal(await drawn(), finest);
await until('-', levels[0].triangles, 12);
await until('-', levels[1].triangles, 12);
await page.screenshot({ path: at('far.png') });
await until('Home', finest, 2);
assert.match(await text(page, '#summary'), /in 1 part; coarser levels of detail at 1 place/);
assert.equal(await page.locator('#parts [role=option]').count(), 1);
assert.deepEqual(complaints, []);
await browser.close();
