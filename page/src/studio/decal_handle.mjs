// SPDX-License-Identifier: MIT
// The chosen decal in the scene: its frame, and what drags it over surfaces or turns it.
import * as THREE from 'three';
import { frameOf } from './decal_place.mjs';
import { listenFirst } from './first_listener.mjs';

const STEP = 5, FINE = 1;

export class DecalHandle {
  /** @param handlers isWanted(), numberAt(ray), choose(number), moved(hit, isDone), turnBy(degrees), dropped() when a drag was given up */
  constructor(view, handlers) {
    Object.assign(this, { view, handlers, decal: null });
    const material = new THREE.LineBasicMaterial({ color: 0xffb000, depthTest: false, transparent: true, toneMapped: false });
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), material);
    this.lines.renderOrder = 1e4;
    this.lines.frustumCulled = false;
    view.marks.push(this);
    listenFirst(view.canvas, this);
  }

  /** @param decal of the document, or null */
  show(decal) {
    if (!decal && !this.decal) return;
    this.decal = decal;
    if (decal) {
      const { corners, mark } = frameOf(decal), ends = corners.flatMap((corner, i) => [corner, corners[(i + 1) % 4]]);
      this.lines.geometry.dispose();
      this.lines.geometry = new THREE.BufferGeometry().setAttribute('position', new THREE.Float32BufferAttribute([...ends, ...mark].flat(), 3));
    }
    this.view.draw();
  }

  fit() {
    const { root } = this.view;
    if (this.lines.parent !== root) root.add(this.lines);  // A new scene empties the root.
    this.lines.visible = Boolean(this.decal) && this.handlers.isWanted() && !this.view.isWorn;
  }

  /** Where the decal's middle is on the screen. */
  middle() {
    const { left, top, width, height } = this.view.canvas.getBoundingClientRect(), p = this.view.root.localToWorld(new THREE.Vector3(...this.decal.at)).project(this.view.camera);
    return [left + (p.x + 1) / 2 * width, top + (1 - p.y) / 2 * height];
  }

  down(event) {
    if (event.button !== 0 || !this.handlers.isWanted()) return;
    const number = this.handlers.numberAt(this.view.rayAt(event));
    if (number === null) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.view.canvas.focus();
    this.handlers.choose(number);
    this.view.canvas.setPointerCapture(event.pointerId);
    const [x, y] = this.middle();
    this.held = { from: [event.clientX, event.clientY], off: [event.clientX - x, event.clientY - y], hit: null };
  }

  move(event) {
    if (!this.held) return;
    event.stopImmediatePropagation();
    const { from, off } = this.held;
    if (!this.held.hit && Math.hypot(event.clientX - from[0], event.clientY - from[1]) < 4) return;
    const hit = this.view.hitOf(this.view.rayAt({ clientX: event.clientX - off[0], clientY: event.clientY - off[1] }));
    if (!hit) return;
    this.held.hit = hit;
    this.handlers.moved(hit, false);
  }

  up(event) {
    const { held } = this;
    if (!held) return;
    event.stopImmediatePropagation();
    this.held = null;
    if (event.type === 'pointercancel') this.handlers.dropped();
    else if (held.hit) this.handlers.moved(held.hit, true);
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || !this.decal || !this.handlers.isWanted()) return;
    const way = { ',': 1, '.': -1, '<': 1, '>': -1 }[event.key], isGivenUp = event.key === 'Escape' && this.held;
    if (!way && !isGivenUp) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (way) return this.handlers.turnBy(way * (event.shiftKey ? FINE : STEP));
    this.held = null;
    return this.handlers.dropped();
  }
}
