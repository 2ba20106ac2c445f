// SPDX-License-Identifier: MIT
// The headset, emulated by iwer: node headset_test.mjs PAPILLA INDEX.html FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { encode } from 'fast-png';
import { folder, launch, open } from './browser.mjs';
import { DEVICE, costOf, enter } from './headset.mjs';
import { strengthOf, waves } from './waves.mjs';

const [papilla, file, place] = process.argv.slice(2);
folder(place);
async function entered(browser, html) {
  const opened = await open(browser, html, { viewport: { width: 480, height: 360 }, init: DEVICE });
  await opened.page.waitForSelector('#canvas3d[data-textures=loaded]');
  await enter(opened.page, 'globalThis.papilla.headset');
  return opened;
}

/** A plate of 300 x 300 mm, upright before the eye, with waves as height map. */
function plate(wanted) {
  const { relief, size } = waves(wanted), most = wanted.amplitude, data = Uint16Array.from(relief.mm, (h) => Math.round((h + most) / (2 * most) * 65535));
  const png = Buffer.from(encode({ width: relief.width, height: relief.height, data, depth: 16, channels: 1 }));
  const repeats = 300 / size[0];
  const floats = new Float32Array([-0.15, 0.85, 0, 0.15, 0.85, 0, 0.15, 1.15, 0, -0.15, 1.15, 0, 0, repeats, repeats, repeats, repeats, 0, 0, 0]), faces = new Uint16Array([0, 1, 2, 0, 2, 3]);
  const bytes = Buffer.concat([Buffer.from(floats.buffer), Buffer.from(faces.buffer)]), perUv = size[0] / 1000;
  const haptic = {
    version: 1, stiffness: wanted.stiffness, damping: 0, staticFriction: wanted.friction, dynamicFriction: wanted.friction, stribeckVelocity: 0.001,
    height: { sha256: createHash('sha256').update(png).digest('hex'), bits: 16, size: [relief.width, relief.height], channel: 'r', scale: 2 * most / 1000, offset: -most / 1000, outward: 'white', texCoord: 0,
      wrap: ['repeat', 'repeat'], metresPerUV: [perUv, perUv], rms: most / 1000 / Math.SQRT2, uri: `data:image/png;base64,${png.toString('base64')}` },
  };
  return {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name: 'plate' }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, indices: 2, material: 0 }] }], materials: [{ name: 'waves', extras: { haptic } }],
    buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 32 }, { buffer: 0, byteOffset: 80, byteLength: 12 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [-0.15, 0.85, 0], max: [0.15, 1.15, 0] }, { bufferView: 1, componentType: 5126, count: 4, type: 'VEC2' },
      { bufferView: 2, componentType: 5123, count: 6, type: 'SCALAR' }],
  };
}

/** Pulses of a stroke of known speed over a known relief. */
async function pulses(browser) {
  const wanted = { amplitude: 0.02, wave: 2, stiffness: 1000, friction: 0.3 }, speed = 100, gltf = join(place, 'plate.gltf'), html = join(place, 'plate.html');
  writeFileSync(gltf, JSON.stringify(plate(wanted)));
  execFileSync(papilla, ['view', gltf, '-o', html, '--no-open', '-q']);
  const { page, complaints } = await entered(browser, html);
  const found = await page.evaluate(async (v) => {
    const start = globalThis.clock ?? 1;
    await globalThis.frames(25, (time) => globalThis.tipTo(-60 + v * (time - start), 1000, -1, [0, 0, -1]));
    return { pulses: globalThis.pulses, contact: globalThis.contact() };
  }, speed);
  const closed = strengthOf({ ...wanted, speed }), last = found.pulses.slice(-5).map(({ value }) => value);
  console.log(`pulses ${last.map((v) => v.toFixed(4))} for ${closed.toFixed(4)}`);
  assert.ok(last.length === 5 && last.every((v) => Math.abs(v - closed) < 0.1 * closed), `${last} is not ${closed}`);
  assert.ok(found.pulses.every(({ hand, ms }) => hand === 'right' && ms > 1000 / 72));
  assert.equal(found.contact.part, 'plate');
  // 1 mm below the mean of the relief, which is there by -A to A.
  assert.ok(Math.abs(found.contact.normal - 1) < 0.025 && Math.abs(found.contact.friction - 0.3 * found.contact.normal) < 1e-3 && Math.abs(found.contact.speed - speed) < 2, JSON.stringify(found.contact));
  const lifted = await page.evaluate(async () => {
    globalThis.pulses.length = 0;
    await globalThis.frames(3, () => globalThis.tipTo(0, 1000, 40));
    return [globalThis.pulses.length, document.getElementById('canvas3d').dataset.xrContactright];
  });
  assert.deepEqual(lifted, [0, '']);
  assert.deepEqual(complaints, []);
  await page.close();
}

/** Bare hands: the tip of the forefinger is the probe; there is sound and never a pulse, also where a hand brings a motor. */
async function hands(browser) {
  const wanted = { amplitude: 0.02, wave: 2, stiffness: 1000, friction: 0.3 }, speed = 100, gltf = join(place, 'hands.gltf'), html = join(place, 'hands.html');
  writeFileSync(gltf, JSON.stringify(plate(wanted)));
  execFileSync(papilla, ['view', gltf, '-o', html, '--no-open', '-q']);
  const { page, complaints } = await entered(browser, html);
  const found = await page.evaluate(async (v) => {
    const { headset } = globalThis.papilla, device = globalThis.device, out = { heights: [] };
    device.primaryInputMode = 'hand';
    await globalThis.frames(4);
    const hand = headset.hands.find(({ source }) => source?.handedness === 'right'), tip = () => hand.joints.joints['index-finger-tip'];
    out.isHand = Boolean(hand.source.hand) && headset.hands.every(({ source }) => source.hand);
    out.stick = hand.pointer.children.some((child) => child.isMesh && child.visible);
    hand.source = new Proxy(hand.source, { get: (source, key) => key === 'gamepad' ? { axes: [], hapticActuators: [{ pulse: (value) => { globalThis.pulses.push(value); } }] } : source[key] });
    globalThis.pulses.length = 0;
    let sounds = 0;
    const create = AudioContext.prototype.createBufferSource;
    AudioContext.prototype.createBufferSource = function () { ++sounds; return create.call(this); };
    // The emulator places the hand; the finger's tip follows from its pose.
    const V = headset.rig.position.constructor, input = device.hands.right;
    const tipTo = (x, y, z) => {
      const at = headset.rig.worldToLocal(new V(x, y, z).divideScalar(1000)), now = headset.rig.worldToLocal(tip().getWorldPosition(new V()));
      input.position.set(input.position.x + at.x - now.x, input.position.y + at.y - now.y, input.position.z + at.z - now.z);
    };
    tipTo(-60, 1000, 30);
    await globalThis.frames(3);
    const start = globalThis.clock;
    await globalThis.frames(25, (time) => tipTo(-60 + v * (time - start), 1000, -1));
    const data = document.getElementById('canvas3d').dataset;
    Object.assign(out, { contact: JSON.parse(data.xrContactright || 'null'), sounds, pulses: globalThis.pulses.length, left: data.xrContactleft });
    tipTo(0, 1000, 40);
    await globalThis.frames(3);
    out.lifted = data.xrContactright;
    device.primaryInputMode = 'controller';
    await globalThis.frames(4);
    out.isBack = headset.hands.every(({ source }) => source && !source.hand);
    return out;
  }, speed);
  console.log(`a forefinger: ${JSON.stringify(found.contact)}, ${found.sounds} sounds, ${found.pulses} pulses`);
  assert.ok(found.isHand && !found.stick, 'hands are hands, without the stick of a controller');
  assert.ok(found.contact?.part === 'plate' && Math.abs(found.contact.normal - 1) < 0.025 && Math.abs(found.contact.strength - strengthOf({ ...wanted, speed })) < 0.1 * strengthOf({ ...wanted, speed }), JSON.stringify(found));
  assert.ok(Math.abs(found.contact.friction - 0.3 * found.contact.normal) < 1e-3);
  assert.ok(found.sounds > 5, 'it sounds');
  assert.equal(found.pulses, 0, 'and does not shake');
  assert.equal(found.left, '', 'the other hand touches nothing');
  assert.equal(found.lifted, '');
  assert.ok(found.isBack, 'controllers again');
  assert.deepEqual(complaints, []);
  await page.close();
}

/** What the cockpit costs a headset, where one is, and what one can do there. */
async function cockpit(browser) {
  const { page, complaints } = await entered(browser, file);
  const cost = await costOf(page);
  assert.ok(cost.isWithin && cost.textures > 0, JSON.stringify(cost));

  const eye = await page.evaluate(() => { const { three } = globalThis.papilla, head = three.camera.getWorldPosition(three.camera.position.clone()); return { head: head.toArray(), seat: three.seat.eye.toArray().map((c) => c / 1000), look: three.camera.getWorldDirection(head.clone()).toArray() }; });
  assert.ok(eye.head.every((c, i) => Math.abs(c - eye.seat[i]) < 0.005), `the head is at the driver's eye, in metres: ${JSON.stringify(eye)}`);
  assert.ok(eye.look[2] < -0.9);

  // Onto the dash, from the front, 0.3 mm below its surface, to the side.
  const touched = await page.evaluate(async () => {
    const { three, nameOf } = globalThis.papilla, V = three.seat.eye.constructor;
    const on = (x) => three.surface.meet(three.seat.eye.clone(), new V(x, -0.14, -1).normalize()), isDash = (spot) => spot && nameOf.call(globalThis.papilla, spot.use) === 'dash_skin';
    let x = 0.3;
    while (![0, 0.02, 0.04].every((step) => isDash(on(x + step)))) x += 0.01;  // plain for 40 mm
    const spot = on(x);
    const along = new V(1, 0, 0).projectOnPlane(spot.normal).normalize(), start = globalThis.clock;
    await globalThis.frames(12, (time) => {
      const near = three.surface.nearest(spot.point.clone().addScaledVector(along, 100 * (time - start)), 20);
      globalThis.tipTo(...near.point.clone().addScaledVector(near.normal, -0.3), near.normal.clone().negate().toArray());
    });
    return { part: nameOf.call(globalThis.papilla, spot.use), contact: globalThis.contact(), pulses: globalThis.pulses.length, ball: globalThis.papilla.headset.hands.some(({ tip }) => tip.ball.visible) };
  });
  assert.equal(touched.part, 'dash_skin');
  assert.ok(touched.contact?.part === 'dash_skin' && touched.contact.normal > 0 && touched.contact.strength > 0 && touched.ball && touched.pulses > 0, JSON.stringify(touched));

  // The names at the pointer, the letters' size, the views and B by the menu, note and picture.
  const done = await page.evaluate(async () => {
    const { headset, three } = globalThis.papilla, { press, rightHand } = globalThis;
    const V = three.seat.eye.constructor, out = { tag: null };
    await globalThis.frames(2, () => globalThis.tipTo(three.seat.eye.x + 150, three.seat.eye.y - 200, three.seat.eye.z - 250, [0.15, -0.1, -1]));
    out.tag = headset.tag.text;
    out.part = rightHand().spot?.use;
    headset.select(rightHand());
    out.picked = headset.spot?.use;
    const views = [];
    for (const view of ['checker', 'stretch', 'stiffness', 'textured']) {
      press(view);
      await globalThis.frames(1);
      views.push(document.getElementById('canvas3d').dataset.view);
    }
    out.views = views;
    press('B ▸');
    out.compared = globalThis.papilla.compare.group.children.length > 0;
    press('B off');
    press('Take note');
    await globalThis.frames(2);
    out.notes = globalThis.papilla.notes.list;
    headset.stand();
    await globalThis.frames(1);
    out.standing = headset.rig.position.y;
    const right = globalThis.device.controllers.right, left = globalThis.device.controllers.left, before = headset.rig.position.clone();
    left.updateAxes('thumbstick', 0, -1);
    await globalThis.frames(10);
    left.updateAxes('thumbstick', 0, 0);
    out.walked = headset.rig.position.distanceTo(before);
    const floor = headset.rig.position.clone();
    right.updateAxes('thumbstick', 0, -1);
    await globalThis.frames(2, () => globalThis.tipTo(three.seat.eye.x, three.seat.eye.y, three.seat.eye.z + 400, [0, -1, 0.5]));
    out.aimed = headset.moving.ring.visible;
    right.updateAxes('thumbstick', 0, 0);
    await globalThis.frames(2);
    out.stepped = headset.rig.position.distanceTo(floor);
    return out;
  });
  assert.ok(done.tag && done.picked !== undefined && done.picked === done.part, JSON.stringify(done.tag));
  assert.deepEqual(done.views, ['checker', 'stretch', 'stiffness', 'textured']);
  assert.ok(done.compared);
  const [note] = done.notes;
  assert.ok(note.taken_in === 'headset' && note.part && note.place_m.every(Number.isFinite) && note.text && note.view === 'textured' && note.picture.startsWith('data:image/jpeg'));
  writeFileSync(join(place, 'snapshot.jpg'), Buffer.from(note.picture.split(',')[1], 'base64'));
  assert.ok(Math.abs(done.standing - 0.052) < 0.001, `on the carpet, the lowest of the scene: ${done.standing}`);
  assert.ok(done.walked > 0.1 && done.walked < 0.25, `1.2 m/s for ten frames: ${done.walked}`);
  assert.ok(done.aimed && done.stepped > 0.1, `a step: ${done.stepped}`);

  await page.screenshot({ path: join(place, 'headset.png') });
  await page.evaluate(() => globalThis.papilla.headset.session.end());
  await page.waitForFunction(() => !globalThis.papilla.headset.session);
  await page.locator('#canvas3d').press('Home');
  await page.waitForFunction(() => document.getElementById('canvas3d').dataset.seated === 'true');
  const [got] = await Promise.all([page.waitForEvent('download'), page.evaluate(() => document.getElementById('notes-save').click())]);
  assert.equal(JSON.parse(readFileSync(await got.path(), 'utf8')).notes[0].taken_in, 'headset');
  assert.deepEqual(complaints, []);
}

const browser = await launch();
try {
  await pulses(browser);
  await hands(browser);
  await cockpit(browser);
} finally {
  await browser.close();
}
