// SPDX-License-Identifier: MIT
// The studio in Firefox: a plate is shown, gets grain, and is felt: node firefox_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { folder as made } from '../page/browser.mjs';
import { endFirefox, openFirefox } from '../page/firefox.mjs';
import { end, start } from './studio.mjs';

const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures'));
writeFileSync(join(work, 'plate.obj'), 'o plate\nv 0 0 0\nv 90 0 0\nv 90 0 -60\nv 0 0 -60\nf 1 2 3\nf 1 3 4\n');
writeFileSync(join(work, 'm.json'), '{"materials": {"grained": {"stiffness": 300, "texture": "grain:leather", "size_mm": [30, 20]}}, "assign": []}');
const studio = await start(papilla, ['plate.obj', '-m', 'm.json', '--cache', 'none'], { cwd: work });
try {
  const session = await openFirefox(studio.url);
  const shown = 'globalThis.studio?.state?.surfaces.length === 1 && globalThis.studio.shown.get(globalThis.studio.keyOf(globalThis.studio.state.surfaces[0]))?.name === globalThis.studio.state.surfaces[0].name';
  await session.until(`document.body.dataset.ready === 'yes' && ${shown}`);
  await session.value("document.querySelector('#tree [role=treeitem]').click()");
  await session.value("globalThis.studio.apply({ material: 'grained' }, [...globalThis.studio.selected]).then(() => true)");
  await session.until(`globalThis.studio.state.surfaces[0].material === 'grained' && globalThis.studio.state.surfaces[0].ready && ${shown}`);
  await session.value("document.getElementById('tab-feel').click()");
  await session.until("document.querySelectorAll('#feel-device option').length === 7");
  await session.value("document.getElementById('feel-mode').click()");
  await session.value("document.getElementById('canvas').focus(); document.getElementById('canvas').dispatchEvent(new KeyboardEvent('keydown', { key: ' ', bubbles: true, cancelable: true }))");
  await session.until("Number(document.getElementById('panel-feel').dataset.ticks) > 300 && parseFloat(document.getElementById('feel-total').value) > 0.05");
  await session.picture(join(pictures, 'firefox.png'));
  assert.equal(await session.value("globalThis.studio.feel.marks.group.visible"), true);
  await session.value("document.getElementById('canvas').dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape', bubbles: true, cancelable: true }))");
  await session.until("document.body.dataset.feel === 'idle'");
  assert.deepEqual(session.complaints, []);
  await session.close();
} finally {
  endFirefox();
  await end(studio.child, 'SIGKILL');
}
process.exit(0);
