// SPDX-License-Identifier: MIT
// The page of a baked cockpit in Firefox, with 3D: node firefox_test.mjs INDEX.html PICTURE_FOLDER
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { folder } from './browser.mjs';
import { endFirefox, openFirefox } from './firefox.mjs';

const [file, pictures] = process.argv.slice(2);
folder(pictures);

try {
  const session = await openFirefox(pathToFileURL(file).href);
  await session.until("document.body.dataset.ready === 'yes' && document.getElementById('canvas3d').dataset.textures === 'loaded'");
  assert.equal(await session.value("document.getElementById('problem').hidden"), true);
  for (const view of ['stretch', 'height', 'textured']) {
    const frames = await session.value("Number(document.getElementById('canvas3d').dataset.frames)");
    await session.value(`document.getElementById('view-${view}').click()`);
    await session.until(`Number(document.getElementById('canvas3d').dataset.frames) > ${frames}`);
    assert.equal(await session.value("document.getElementById('canvas3d').dataset.view"), view);
  }
  await session.value("document.getElementById('tab-touch').click()");
  await session.value("for (const x of [100, 140, 180]) document.getElementById('relief').dispatchEvent(new PointerEvent('pointermove', { clientX: x + document.getElementById('relief').getBoundingClientRect().x, clientY: 150 + document.getElementById('relief').getBoundingClientRect().y }))");
  assert.ok(parseFloat(await session.value("document.getElementById('force-total').value")) >= 0);
  assert.notEqual(await session.value("document.getElementById('force-height').textContent"), '–');
  await session.picture(join(pictures, 'firefox.png'));
  assert.deepEqual(session.complaints, []);
  await session.close();
} finally {
  endFirefox();
}
process.exit(0);
