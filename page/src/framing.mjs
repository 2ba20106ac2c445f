// SPDX-License-Identifier: MIT
// From where a part is looked at: its front, past what stands before it, near the way that one looks already.
import * as THREE from 'three';

const SAMPLES = 40, AZIMUTHS = 12;
/** What turning away from the present view costs, as a share of the area that is seen. */
const TURN = 0.15;

function candidates(now) {
  const list = [now.clone()];
  for (const height of [0.1, 0.45, 0.8])
    for (let i = 0; i < AZIMUTHS; ++i) {
      const turn = 2 * Math.PI * i / AZIMUTHS, flat = Math.sqrt(1 - height * height);
      list.push(new THREE.Vector3(flat * Math.sin(turn), height, flat * Math.cos(turn)));
    }
  return list;
}

/**
 * The direction from the middle of a use to a camera that sees most of its front.
 * @param now that direction at present, @param distance of the camera from what it looks at (mm)
 */
export function frontOf(surface, use, now, distance) {
  const samples = surface.samples(use, SAMPLES);
  const area = samples.reduce((sum, { normal }) => sum + normal.length(), 0) || 1;
  let best = now, most = -Infinity;
  for (const direction of candidates(now)) {
    let seen = 0;
    for (const { point, normal } of samples) {
      const facing = normal.dot(direction);
      if (facing <= 0) continue;
      const before = surface.meet(point.clone().addScaledVector(normal, 1e-3).addScaledVector(direction, distance), direction.clone().negate(), distance);
      if (!before || before.use === use || before.distance > distance - 2) seen += facing;
    }
    const score = seen / area + TURN * direction.dot(now);
    if (score > most) [most, best] = [score, direction];
  }
  return best.clone().normalize();
}
