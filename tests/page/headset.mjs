// SPDX-License-Identifier: MIT
// A page in the headset that iwer emulates, with frames of a clock of the test's own.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const iwer = readFileSync(createRequire(import.meta.url).resolve('iwer').replace(/lib.index\.js$/, 'build/iwer.min.js'), 'utf8');

/** To be run before all scripts of the page. */
export const DEVICE = `${iwer}
globalThis.device = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: true });
globalThis.device.installRuntime({ forceInstall: true });
globalThis.device.position.set(0, 1.2, 0);
globalThis.pulses = [];`;

/** @param headset the page's, as an expression. frames() runs frames, 72 a second, steer(time) before each. */
const stepsOf = (headset) => `globalThis.worn = ${headset};
globalThis.frames = async (count, steer = () => {}) => {
  const { worn } = globalThis;
  globalThis.clock ??= 1;
  if (!worn.real) {
    worn.real = worn.frame;
    worn.frame = () => {};
  }
  for (let i = 0; i < count; ++i) {
    globalThis.clock += 1 / 72;
    steer(globalThis.clock);
    await new Promise((done) => { worn.frame = () => { worn.frame = () => { worn.real.call(worn, globalThis.clock); worn.frame = () => {}; done(); }; }; });
  }
};
/** Puts the right tip to a point of the scene (mm), pointing against the normal. */
globalThis.tipTo = (x, y, z, ahead) => {
  const { rig } = globalThis.worn, V = rig.position.constructor, right = globalThis.device.controllers.right;
  const at = rig.worldToLocal(new V(x, y, z).divideScalar(1000)), way = ahead ? new V(...ahead).transformDirection(rig.matrixWorld.clone().invert()) : null;
  right.position.set(at.x, at.y, at.z);
  if (way) { const q = rig.quaternion.clone().setFromUnitVectors(new V(0, 0, -1), way); right.quaternion.set(q.x, q.y, q.z, q.w); }
};
/** Presses the cell of the menu that begins so. */
globalThis.press = (text) => {
  const { menu } = globalThis.worn;
  menu.draw();
  menu.under = menu.cells.findIndex((cell) => cell.text.startsWith(text));
  menu.press();
  menu.under = -1;
};
globalThis.rightHand = () => globalThis.worn.hands.find(({ source }) => source.handedness === 'right');
globalThis.contact = () => JSON.parse(globalThis.worn.three.canvas.dataset.xrContactright || 'null');`;

/** Enters; the pulses that controllers get are collected in globalThis.pulses. @param headset as an expression */
export async function enter(page, headset) {
  await page.waitForSelector('#enter-vr:not([hidden])');
  await page.evaluate(stepsOf(headset));
  await page.locator('#enter-vr').click();
  await page.waitForFunction(() => Number(globalThis.worn.three.canvas.dataset.xrFrames) > 1 && globalThis.worn.hands.every((hand) => hand.source));
  await page.evaluate(() => {
    for (const { source } of globalThis.worn.hands) source.gamepad.hapticActuators[0].pulse = (value, ms) => { globalThis.pulses.push({ value, ms, hand: source.handedness }); return Promise.resolve(true); };
    return globalThis.frames(3);
  });
}

/** What a frame of both eyes costs, within the budget. */
export async function costOf(page) {
  const cost = await page.evaluate(() => {
    const { xrCalls, xrTriangles, xrTextureBytes } = globalThis.worn.three.canvas.dataset;
    return { calls: Number(xrCalls), triangles: Number(xrTriangles), textures: Number(xrTextureBytes) };
  });
  console.log(`a frame of both eyes: ${cost.calls} draw calls, ${cost.triangles} triangles, ${(cost.textures / 2 ** 20).toFixed(1)} MiB of textures`);
  return { ...cost, isWithin: cost.calls > 0 && cost.calls <= 300 && cost.triangles > 1000 && cost.triangles <= 500000 && cost.textures <= 256 * 2 ** 20 };
}
