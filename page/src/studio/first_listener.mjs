// SPDX-License-Identifier: MIT
// What lies on the scene gets the pointer and the keys before the camera does.

/** @param on with down(event), move(event), up(event) and key(event); what it takes it stops */
export function listenFirst(canvas, on) {
  const before = { capture: true };
  canvas.addEventListener('pointerdown', (e) => on.down(e), before);
  canvas.addEventListener('pointermove', (e) => on.move(e), before);
  for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, (e) => on.up(e), before);
  canvas.addEventListener('keydown', (e) => on.key(e), before);
}
