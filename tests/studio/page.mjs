// SPDX-License-Identifier: MIT
// What tests ask of the studio's page in a browser.

/** Until every surface is shown as the document says. */
export const allShown = (page) => page.waitForFunction(() => {
  const { studio } = globalThis;
  return studio.state?.surfaces.length > 0 && studio.state.surfaces.every((s) => studio.shown.get(studio.keyOf(s))?.name === s.name);
});

/** The material of a surface in the document; nothing for a surface without. @param label the surface's */
export const materialOf = (page, label) => page.evaluate((wanted) => {
  const { state } = globalThis.studio;
  return state.document.materials[state.surfaces.find((s) => s.label === wanted).material];
}, label);

/** A place in the window where a surface is seen, and around it too, from where the camera is. @returns {x, y} or null */
export const placeOn = (page, label) => page.evaluate((wanted) => {
  const { view, state, keyOf } = globalThis.studio, { left, top, width, height } = view.canvas.getBoundingClientRect();
  const is = (x, y) => { const hit = view.hitAt({ clientX: x, clientY: y }); return hit && state.surfaces.find((s) => keyOf(s) === hit.key)?.label === wanted; };
  for (let y = top + 40; y < top + height - 40; y += 12)
    for (let x = left + 60; x < left + width - 60; x += 12)
      if ([[0, 0], [-24, 0], [24, 0], [0, 16], [0, -16]].every(([i, j]) => is(x + i, y + j))) return { x, y };
  return null;
}, label);

export const twoFrames = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** Until the window shows the scene as it is, in its full resolution: however slow the processor is that draws it. */
export async function pictureDone(page) {
  await page.waitForFunction(() => !globalThis.studio.view.pace.isCoarse);
  await twoFrames(page);
  await page.evaluate(() => globalThis.studio.view.renderer.getContext().finish());
  await twoFrames(page);
}

/** Drops a file on the scene. */
export const dropFile = (page, name, type, bytes) => page.evaluate(([file, mime, base64]) => {
  const transfer = new DataTransfer(), canvas = document.getElementById('canvas');
  transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], file, { type: mime }));
  for (const event of ['dragover', 'drop']) canvas.dispatchEvent(new DragEvent(event, { dataTransfer: transfer, bubbles: true, cancelable: true }));
}, [name, type, bytes.toString('base64')]);
