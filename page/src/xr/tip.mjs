// SPDX-License-Identifier: MIT
// The tip of a controller or of a forefinger as probe: contact with the surface by forceAt(), pulses, sound.
import * as THREE from 'three';
import { forceAt, surfaceOf } from '../force.mjs';
import { reliefSpot } from '../relief_spot.mjs';
import { Sound } from '../sound.mjs';
import { LEAST, Pulse } from './pulse.mjs';

/** How near the surface the tip is looked at, and how deep it counts (mm): hands in the air pass through walls. */
const REACH = 12, DEEPEST = 4;
/** A pulse lasts until the next frame has surely come (ms). */
const PULSE_MS = 30;
const JUMP = 3, JUMP_MM = 2;

export class Tip {
  /** @param compare says which material is at a spot */
  constructor(three, compare) {
    Object.assign(this, { three, compare, pulse: new Pulse(), sound: new Sound(), surfaces: new Map() });
    this.ball = new THREE.Mesh(new THREE.SphereGeometry(2.5, 16, 12), new THREE.MeshBasicMaterial({ color: 0xd55e00, toneMapped: false }));
    this.ball.visible = false;
    three.scene.add(this.ball);
  }

  surfaceOf(material) {
    if (!this.surfaces.has(material)) this.surfaces.set(material, surfaceOf(material));
    return this.surfaces.get(material);
  }

  /**
   * @param point of the tip (mm), @param time s, @param actuator may be missing: then there is sound only
   * @returns {spot, force, strength} of a contact, or null
   */
  touch(point, time, actuator) {
    const found = this.three.surface.nearest(point, REACH), { spot, material, ratio } = found ? this.compare.at(found) : {};
    if (!material?.relief || spot.depth > DEEPEST) return this.lift();
    const surface = this.surfaceOf(material), place = reliefSpot(material, surface, spot, ratio);
    if (!place) return this.lift();
    if (this.last && (this.last.material !== material || Math.hypot(...place.at.map((c, i) => c - this.last.at[i])) > JUMP * this.last.point.distanceTo(spot.point) + JUMP_MM)) this.lift();
    const seconds = this.last ? Math.max(time - this.last.time, 1e-3) : 0, v = this.last ? place.at.map((c, i) => (c - this.last.at[i]) / seconds) : [0, 0];
    const { normal, friction } = forceAt(surface, ...place.at, spot.depth, ...v);
    if (normal <= 0) return this.lift();
    this.last = { material, at: place.at, time, point: spot.point };
    this.ball.visible = true;
    this.ball.position.copy(spot.point);
    const strength = this.pulse.move(surface, place.at, time, spot.depth);
    this.sound.play(surface, place.at, time, spot.depth);
    if (actuator && strength >= LEAST) actuator.pulse(strength, PULSE_MS);
    return { spot, normal, friction, strength, speed: Math.hypot(...v) };
  }

  lift() {
    if (this.last) {
      this.pulse.lift();
      this.sound.lift();
    }
    this.last = null;
    this.ball.visible = false;
    return null;
  }

  end() {
    this.lift();
    this.sound.stop();
    this.three.scene.remove(this.ball);
  }
}
