// SPDX-License-Identifier: MIT
// The studio in the headset, emulated by iwer: names, views, touch, a second material, changes and notes:
// node headset_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { folder as made, launch, openUrl } from '../page/browser.mjs';
import { DEVICE, costOf, enter } from '../page/headset.mjs';
import { strengthOf } from '../page/waves.mjs';
import { allShown } from './page.mjs';
import { end, start } from './studio.mjs';

const [papilla, data, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work'), pictures = made(join(folder, 'pictures'));
copyFileSync(join(data, 'cockpit.step'), join(work, 'cockpit.step'));
const SPEED = 100, DEPTH = 1;

/** A·sin(2πx/λ): eight waves of 2 mm over 16 mm. */
const WAVES = { amplitude: 0.02, wave: 2, stiffness: 1000, friction: 0.3 };
const waves = ({ amplitude, stiffness, friction }) => ({
  texture: `base|mainfunction=.5+.5*s(${16 * Math.PI}*x)`, size_mm: [16, 16], height: { depth_mm: 2 * amplitude }, stiffness, staticFriction: friction, dynamicFriction: friction, stribeckVelocity: 0.001, fineRoughness: null,
});
/** Twice as high, and harder: of no surface at first. */
const STRONG = { ...WAVES, amplitude: 0.04, stiffness: 2000 };
const example = JSON.parse(readFileSync(join(data, '../examples/materials.json'), 'utf8'));
writeFileSync(join(work, 'materials.json'), JSON.stringify({
  materials: { waves: waves(WAVES), strong: waves(STRONG), ...example.materials }, assign: [{ part: 'dash_skin', material: 'waves' }, ...example.assign],
}));

/** Strokes along the relief's x, where the dash is plain for 40 mm. @param isThere of a spot, as text */
const strokeOn = (page, isThere) => page.evaluate(async ([text, speed, depth]) => {
  const { three, page: worn } = globalThis.worn, isThere = new Function('spot', 'worn', `return ${text}`), V = three.camera.position.constructor, eye = three.seat.eye;
  const on = (point) => three.surface.nearest(point, 20);
  const wayOf = (spot) => {
    const u = new V(1, 0, 0).projectOnPlane(spot.normal).normalize(), v = u.clone().cross(spot.normal), step = 0.5;
    const [a, b] = [u, v].map((way) => on(spot.point.clone().addScaledVector(way, step)).uv.sub(spot.uv).divideScalar(step)), area = a.x * b.y - a.y * b.x;
    return u.multiplyScalar(b.y / area).addScaledVector(v, -a.y / area).normalize();
  };
  const plain = (spot, way) => {
    const end = on(spot.point.clone().addScaledVector(way, 40));
    return end && end.use === spot.use && end.distance < 2 && isThere(end, worn) && Math.abs(Math.abs(end.uv.x - spot.uv.x) * 16 - 40) < 2 && Math.abs(end.uv.y - spot.uv.y) * 16 < 2;
  };
  for (let y = -0.1; y > -0.8; y -= 0.02)
    for (let x = -0.8; x < 1.6; x += 0.02) {
      const spot = three.surface.meet(eye.clone(), new V(x, y, -1).normalize());
      if (!spot || worn.nameOf(spot.use) !== 'dash_skin' || !isThere(spot, worn)) continue;
      const way = wayOf(spot);
      if (!plain(spot, way)) continue;
      globalThis.pulses.length = 0;
      const start = globalThis.clock;
      await globalThis.frames(25, (time) => {
        const near = on(spot.point.clone().addScaledVector(way, speed * (time - start)));
        globalThis.tipTo(...near.point.clone().addScaledVector(near.normal, -depth), near.normal.clone().negate().toArray());
      });
      const found = { pulses: globalThis.pulses.slice(-5).map(({ value }) => value), contact: globalThis.contact() };
      await globalThis.frames(2, () => globalThis.tipTo(eye.x, eye.y, eye.z));
      return found;
    }
  return null;
}, [isThere, SPEED, DEPTH]);

function checkStroke(found, wanted, what) {
  assert.ok(found, `${what}: there is a plain place`);
  const closed = strengthOf({ ...wanted, speed: SPEED });
  console.log(`${what}: pulses ${found.pulses.map((v) => v.toFixed(4))} for ${closed.toFixed(4)}`);
  assert.ok(found.pulses.length === 5 && found.pulses.every((v) => Math.abs(v - closed) < 0.12 * closed), `${what}: ${found.pulses} is not ${closed}`);
  assert.equal(found.contact.part, 'dash_skin');
  const { normal, friction } = found.contact, force = wanted.stiffness * DEPTH / 1000;
  assert.ok(Math.abs(normal - force) < 0.1 * force && Math.abs(friction - wanted.friction * normal) < 0.02 * normal, JSON.stringify(found.contact));
}

const browser = await launch();
const studio = await start(papilla, ['cockpit.step', '-m', 'materials.json'], { cwd: work });
try {
  const { page, complaints } = await openUrl(browser, studio.url, { init: DEVICE });
  const all = () => allShown(page);
  await all();
  const desk = await page.evaluate(() => globalThis.studio.view.camera.position.toArray());
  await enter(page, 'globalThis.studio.headset');
  await page.waitForFunction(() => globalThis.worn.three.surface.places.every(({ object: { userData: { mesh } } }) => !globalThis.worn.page.scene.materials[mesh.material].haptic?.height || globalThis.worn.page.scene.materials[mesh.material].relief));
  const cost = await costOf(page);
  assert.ok(cost.isWithin && cost.textures > 0, JSON.stringify(cost));

  // In true scale, at the driver's eye, looking ahead.
  const eye = await page.evaluate(() => {
    const { three } = globalThis.worn, head = three.camera.getWorldPosition(three.camera.position.clone());
    return { head: head.toArray(), seat: three.seat.eye.toArray().map((c) => c / 1000), look: three.camera.getWorldDirection(head.clone()).toArray(), scale: three.scene.scale.toArray() };
  });
  assert.ok(eye.head.every((c, i) => Math.abs(c - eye.seat[i]) < 0.005) && eye.look[2] < -0.9, JSON.stringify(eye));
  assert.deepEqual(eye.scale, [1e-3, 1e-3, 1e-3]);

  // The name at the pointer; the trigger picks; the views of the menu.
  const pointed = await page.evaluate(async () => {
    const { worn, rightHand, press } = globalThis, { three } = worn, V = three.camera.position.constructor, from = three.seat.eye.clone().add(new V(150, -150, -200));
    await globalThis.frames(2, () => globalThis.tipTo(...from.toArray(), [0.15, -0.2, -1]));
    const out = { tag: worn.tag.text, shown: worn.tag.mesh.visible, part: rightHand().spot?.use, views: [] };
    worn.select(rightHand());
    out.picked = worn.spot?.use;
    out.selected = [...globalThis.studio.selected].length;
    for (const view of ['checker', 'stretch', 'stiffness', 'textured']) {
      press(view);
      await globalThis.frames(1);
      out.views.push([three.canvas.dataset.view, worn.merged.group.children.every((piece) => (piece.material === piece.userData.standard) === (view === 'textured'))]);
    }
    return out;
  });
  assert.equal(pointed.tag, 'dash_skin');
  assert.ok(pointed.shown && pointed.part !== undefined && pointed.picked === pointed.part && pointed.selected === 1, JSON.stringify(pointed));
  assert.deepEqual(pointed.views, ['checker', 'stretch', 'stiffness', 'textured'].map((view) => [view, true]));

  // Touch, by the closed form.
  checkStroke(await strokeOn(page, 'true'), WAVES, 'the dash');

  // B, of no surface yet: the server makes it; the document stays as it was.
  const version = await page.evaluate(() => globalThis.studio.state.version);
  const second = await page.evaluate(async () => {
    const { page: own } = globalThis.worn;
    while (own.choices[own.b ?? -1]?.name !== 'strong') { globalThis.press('B ▸'); await globalThis.frames(1); }
    return globalThis.worn.menu.cells.map(({ text }) => text);
  });
  assert.ok(second.includes('B: strong'), second.join());
  await page.waitForFunction(() => globalThis.worn.page.compare.group.children.length > 0);
  checkStroke(await strokeOn(page, 'worn.compare.at(spot).material.name.startsWith("strong")'), STRONG, 'B');
  checkStroke(await strokeOn(page, 'worn.compare.at(spot).material.name.startsWith("waves")'), WAVES, 'A beside B');
  assert.equal(await page.evaluate(() => globalThis.studio.state.version), version);
  assert.equal(await page.evaluate(() => globalThis.studio.state.surfaces.find((s) => s.label === 'dash_skin').material), 'waves');
  const compared = await costOf(page);
  assert.ok(compared.isWithin, JSON.stringify(compared));

  // B follows its material; the last stroke is where the note will be.
  for (const [title, stiffness] of [['softer', 1500], ['as before', STRONG.stiffness]]) {
    await page.evaluate(([what, value]) => {
      globalThis.second = globalThis.worn.three.second;
      return globalThis.studio.edit([{ kind: 'set', material: 'strong', values: { '/stiffness': value } }], what);
    }, [title, stiffness]);
    await page.waitForFunction(() => { const { second } = globalThis.worn.three; return second && second !== globalThis.second; });
    checkStroke(await strokeOn(page, 'worn.compare.at(spot).material.name.startsWith("strong")'), { ...STRONG, stiffness }, `B, ${title}`);
  }

  // A note with what one sees.
  const note = await page.evaluate(async () => {
    const { three } = globalThis.worn;
    await globalThis.frames(1, () => globalThis.tipTo(...three.seat.eye.clone().setZ(three.seat.eye.z + 300).toArray(), [0, 0, 1]));
    globalThis.press('Take note');
    for (let i = 0; i < 100 && !globalThis.worn.page.notes.list.length; ++i) await globalThis.frames(2);
    return globalThis.worn.page.notes.list.at(-1);
  });
  assert.ok(note.taken_in === 'headset' && note.part === 'dash_skin' && note.material.startsWith('strong') && note.text && note.view === 'textured' && note.place_m.every((c) => Math.abs(c) < 5), JSON.stringify({ ...note, picture: null }));
  writeFileSync(join(pictures, 'both.jpg'), Buffer.from(note.picture.split(',')[1], 'base64'));

  // A library material as B, of a group further on; a part of no surface.
  await page.evaluate(async () => {
    globalThis.press('B off');
    globalThis.press('▸');
    await globalThis.frames(1);
  });
  await page.waitForFunction(() => globalThis.worn.page.compare.group.children.length > 0);
  assert.notEqual(await page.evaluate(() => globalThis.worn.page.choices[globalThis.worn.page.b].group), 'Of this scene');
  await page.evaluate(() => globalThis.press('B off'));

  // The dash gets another material while one looks: its piece is made anew, and only those that it was and comes to.
  const before = await page.evaluate(() => { globalThis.before = [...globalThis.worn.merged.pieces.values()]; return globalThis.before.length; });
  await page.evaluate(() => globalThis.studio.apply({ material: 'strong' }, [...globalThis.studio.selected]));
  await all();
  await page.waitForFunction(() => globalThis.worn.page.scene.materials[globalThis.worn.three.surface.places.find(({ object }) => globalThis.worn.page.nameOf(object.userData.use) === 'dash_skin').object.userData.mesh.material].relief);
  const kept = await page.evaluate(() => globalThis.before.filter((piece) => globalThis.worn.merged.group.children.includes(piece)).length);
  assert.equal(kept, before - 1, 'the other pieces stay');
  checkStroke(await strokeOn(page, 'true'), STRONG, 'the changed dash');

  // Standing, walking by the stick, a step to a pointed place.
  const moved = await page.evaluate(async () => {
    const { rig, three, moving } = globalThis.worn, { left, right } = globalThis.device.controllers, out = {};
    globalThis.press('Stand');
    await globalThis.frames(1);
    out.floor = rig.position.y - three.box.min.y / 1000;
    let before = rig.position.clone();
    left.updateAxes('thumbstick', 0, -1);
    await globalThis.frames(10);
    left.updateAxes('thumbstick', 0, 0);
    out.walked = rig.position.distanceTo(before);
    before = rig.position.clone();
    right.updateAxes('thumbstick', 0, -1);
    await globalThis.frames(2, () => globalThis.tipTo(three.seat.eye.x, three.seat.eye.y, three.seat.eye.z + 400, [0, -1, 0.5]));
    out.aimed = moving.ring.visible;
    right.updateAxes('thumbstick', 0, 0);
    await globalThis.frames(2);
    out.stepped = rig.position.distanceTo(before);
    return out;
  });
  assert.ok(Math.abs(moved.floor) < 1e-6 && moved.walked > 0.1 && moved.walked < 0.25 && moved.aimed && moved.stepped > 0.1, JSON.stringify(moved));
  await page.screenshot({ path: join(pictures, 'headset.png') });

  // Out again: the desk is as it was, with the note.
  await page.evaluate(() => globalThis.worn.session.end());
  await page.waitForFunction(() => !globalThis.worn.session);
  const after = await page.evaluate(() => ({ camera: globalThis.studio.view.camera.position.toArray(), scale: globalThis.studio.view.stage.scale.x, seen: [...globalThis.studio.view.surfaces.values()].every((s) => s.meshes.every((mesh) => mesh.visible)), children: globalThis.studio.view.stage.children.includes(globalThis.worn.merged.group) }));
  assert.ok(after.camera.every((c, i) => Math.abs(c - desk[i]) < 1e-6), JSON.stringify(after));
  assert.deepEqual([after.scale, after.seen, after.children], [1, true, false]);
  await page.locator('#tab-notes').click();
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(pictures, 'notes.png') });
  assert.equal(await page.locator('#notes li').count(), 1);
  const review = JSON.parse(readFileSync(join(work, 'review.json'), 'utf8'));
  assert.deepEqual([review.papilla_review, review.scene, review.notes[0].taken_in], [1, 'cockpit.step', 'headset']);
  assert.deepEqual(complaints.filter((c) => !c.includes('ws://127.0.0.1')), []);
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
}
