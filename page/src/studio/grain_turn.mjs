// SPDX-License-Identifier: MIT
// The direction of the grain of the selected surfaces: a number box and an arrow in the scene, which write the same.
import { element } from '../dom.mjs';
import { anchorOf, angleOf, axesAt, directionOf } from './direction.mjs';
import { DirectionArrow } from './direction_arrow.mjs';
import { T } from './texts.mjs';

export class GrainTurn {
  /** @param vary writes values of the selected surfaces' material */
  constructor(view, vary) {
    Object.assign(this, { view, vary, anchors: new WeakMap() });
    this.box = element('input', { type: 'number', id: 'turn', min: '0', max: '360', step: '5', 'aria-label': T.angle });
    // With the panel of the part, and gone with it.
    this.arrow = new DirectionArrow(view, (degrees, isDone) => this.turned(degrees, isDone), () => this.box.offsetParent !== null);
    new ResizeObserver(() => view.draw()).observe(this.box);
    this.box.addEventListener('change', () => {
      if (!Number.isFinite(this.box.valueAsNumber)) return;
      this.arrow.set((this.box.valueAsNumber % 360 + 360) % 360);
      this.write();
    });
  }

  /** The direction [x, y, z] in the part's coordinates that is shown. */
  get direction() { return directionOf(this.arrow.degrees, this.axes); }

  /** @param surface of the state, the first that is selected @param data of it, or nothing yet @param grain of its material */
  controls(surface, data, grain) {
    this.box.disabled = !data;
    if (data && !this.arrow.isHeld) this.place(surface, data, grain);
    return this.box;
  }

  place(surface, { arrays }, grain) {
    if (!this.anchors.has(arrays)) this.anchors.set(arrays, anchorOf(arrays));
    const anchor = this.anchors.get(arrays), use = surface.uses[0];
    this.box.disabled = !anchor;
    if (!anchor) return this.hide();
    this.axes = axesAt(anchor.normal, this.upOf(use));
    const degrees = Array.isArray(grain) ? angleOf(grain, this.axes) : 0;
    this.box.value = degrees;
    return this.arrow.show(anchor, this.axes, use, degrees);
  }

  /** What is up in the scene, in the part's coordinates: the world's row of it. */
  upOf(use) {
    const { world } = this.view.scene.uses[use], row = this.view.scene.z_up ? 2 : 1;
    return [world[4 * row], world[4 * row + 1], world[4 * row + 2]];
  }

  hide() { if (!this.arrow.isHeld) this.arrow.hide(); }

  turned(degrees, isDone) {
    this.box.value = degrees;
    if (isDone) this.write();
  }

  write() { this.vary({ '/unwrap/grain': this.direction }); }
}
