// SPDX-License-Identifier: MIT
// Files that come again under a name that was there with other content: photograph, picture of a decal, scene; and two at
// once: node same_name_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch, openUrl } from '../page/browser.mjs';
import { allShown, dropFile } from './page.mjs';
import { ask, end, start } from './studio.mjs';

const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
const work = join(folder, 'work');
mkdirSync(work, { recursive: true });
const { encode } = await import(pathToFileURL(createRequire(new URL('../page/browser.mjs', import.meta.url)).resolve('fast-png')));

/** Blots of one colour. */
function blots(colour, side = 64) {
  const data = new Uint8Array(3 * side * side);
  for (let i = 0; i < side * side; ++i) {
    const x = i % side, y = Math.floor(i / side), share = 0.6 + 0.4 * Math.sin(x * x / 90 + y / 3) * Math.cos(y * y / 70 - x / 4);
    for (let k = 0; k < 3; ++k) data[3 * i + k] = Math.round(colour[k] * share);
  }
  return Buffer.from(encode({ width: side, height: side, data, channels: 3 }));
}
const RED = blots([255, 60, 20]), GREEN = blots([20, 255, 60]);
const plate = (width) => Buffer.from(`o plate\nv 0 0 0\nv ${width} 0 0\nv ${width} 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n`);
writeFileSync(join(work, 'plate.obj'), plate(40));
writeFileSync(join(work, 'logo.png'), RED);

const browser = await launch();
const studio = await start(papilla, ['plate.obj', '-m', 'm.json'], { cwd: work });
try {
  const { port, token } = studio, headers = { origin: `http://127.0.0.1:${port}` };
  const get = async (path, more = '') => { const answer = await ask(port, `${path}?token=${token}${more}`); assert.equal(answer.status, 200, answer.body); return answer; };
  const { page, complaints } = await openUrl(browser, studio.url);
  page.removeAllListeners('dialog').on('dialog', (dialog) => dialog.accept('40'));
  await allShown(page);
  const replaced = (name, bytes) => { rmSync(join(work, name)); return dropFile(page, name, 'image/png', bytes); };
  const selectAll = () => page.evaluate(() => { const { studio: s } = globalThis; s.select(s.state.surfaces.map((one) => s.keyOf(one)), false); });
  /** Means of red and green of what the plate shows. */
  const seen = async () => {
    await page.waitForFunction(() => [...globalThis.studio.view.surfaces.values()][0].material.map?.image, null, { timeout: 20000 });
    return page.evaluate(() => {
      const { map } = [...globalThis.studio.view.surfaces.values()][0].material, canvas = Object.assign(document.createElement('canvas'), { width: 32, height: 32 }), context = canvas.getContext('2d');
      context.drawImage(map.image, 0, 0, 32, 32);
      const { data } = context.getImageData(0, 0, 32, 32);
      return [0, 1].map((k) => data.reduce((sum, v, i) => i % 4 === k ? sum + v : sum, 0) / 1024);
    });
  };
  /** Until the plate has a material, which then shows its picture, also one of a single hue. */
  const hasMaterial = async (name) => {
    await page.waitForFunction((wanted) => globalThis.studio.state.surfaces.every((s) => s.material === wanted), name);
    await page.evaluate((material) => globalThis.studio.edit([{ kind: 'set', material, values: { '/show': 'picture' } }], material), name);
  };

  // ---- A photograph that was removed and comes again under its name.
  await selectAll();
  await dropFile(page, 'grain.png', 'image/png', RED);
  await hasMaterial('grain');
  await allShown(page);
  const [red, little] = await seen();
  assert.ok(red > 2 * little, `${red} ${little}`);
  await selectAll();
  await replaced('grain.png', GREEN);
  await hasMaterial('grain 2');
  await allShown(page);
  const state = JSON.parse((await get('/state')).body), { materials } = state.document;
  assert.deepEqual([materials.grain.texture, materials['grain 2'].texture], ['grain.png', 'grain.png']);
  const [less, green] = await seen();
  assert.ok(green > 2 * less, `${less} ${green}`);
  // The material of before has the file that is there now, too.
  await page.evaluate(() => globalThis.studio.apply({ material: 'grain' }, globalThis.studio.state.surfaces.map((s) => globalThis.studio.keyOf(s))));
  await hasMaterial('grain');
  await allShown(page);
  assert.ok((await seen())[1] > 2 * (await seen())[0]);
  // One of another kind with that stem is a material of its own.
  await selectAll();
  await dropFile(page, 'grain.jpg', 'image/jpeg', RED);
  await hasMaterial('grain 3');

  // ---- The picture of a decal likewise.
  const decal = { '/picture': '"logo.png"', '/at': '[20,15,0]', '/direction': '[0,0,-1]', '/up': '[0,1,0]', '/size_mm': '[10,10]', '/depth_mm': '10' };
  const edited = (edits) => ask(port, `/edit?token=${token}`, { method: 'POST', headers, body: JSON.stringify({ edits }) });
  const answer = await edited([{ kind: 'add-decal', values: Object.fromEntries(Object.entries(decal).map(([key, value]) => [key, JSON.parse(value)])) }]);
  assert.equal(answer.status, 200, answer.body);
  const pictureOf = async () => {
    await allShown(page);
    const { name } = JSON.parse((await get('/state')).body).decals[0];
    return { name, bytes: (await get('/decal-picture', `&id=${name}&image=0`)).bytes };
  };
  const before = await pictureOf();
  writeFileSync(join(work, 'logo.png'), GREEN);
  await edited([{ kind: 'add', material: 'other', values: { '/stiffness': 500 } }]);
  const after = await pictureOf();
  assert.ok(after.name !== before.name && !after.bytes.equals(before.bytes), 'the decal has the picture that is there now');

  // ---- The scene likewise.
  const width = () => page.evaluate(() => { const box = globalThis.studio.view.box(); return box.max.x - box.min.x; });
  assert.ok(Math.abs(await width() - 40) < 1e-3);
  const { scene_number: number } = JSON.parse((await get('/state')).body);
  rmSync(join(work, 'plate.obj'));
  await dropFile(page, 'plate.obj', '', plate(60));
  await page.waitForFunction((old) => globalThis.studio.state.scene_number > old && globalThis.studio.scene, number);
  await allShown(page);
  await page.waitForFunction(() => { const box = globalThis.studio.view.box(); return Math.abs(box.max.x - box.min.x - 60) < 1e-3; });
  assert.equal(await page.evaluate(() => globalThis.studio.state.scene_file), 'plate.obj');

  // ---- Two at once: the second one begins before the first has come.
  const slow = request({ host: '127.0.0.1', port, path: `/photograph?token=${token}&name=both.png`, method: 'POST', headers: { ...headers, 'content-type': 'application/octet-stream', 'content-length': RED.length } });
  const came = new Promise((done, failed) => slow.on('response', (response) => { let text = ''; response.on('data', (piece) => { text += piece; }); response.on('end', () => done(text)); }).on('error', failed));
  await new Promise((done) => slow.write(RED.subarray(0, 100), done));
  const { body } = await ask(port, `/photograph?token=${token}&name=both.png`, { method: 'POST', headers: { ...headers, 'content-type': 'application/octet-stream' }, body: GREEN });
  slow.end(RED.subarray(100));
  const [one, two] = [JSON.parse(await came).file, JSON.parse(body).file];
  assert.notEqual(one, two);
  assert.ok(readFileSync(join(work, one)).equals(RED) && readFileSync(join(work, two)).equals(GREEN), `${one} and ${two} are what came`);
  // Of a picture that was asked for while it was gone.
  assert.deepEqual(complaints.filter((c) => !c.includes('ws://127.0.0.1') && !c.includes('409')), []);
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
