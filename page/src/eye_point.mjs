// SPDX-License-Identifier: MIT
// Where people sit in a scene: before the headrest nearest the steering wheel, else in the room of the scene, if it has one.
import * as THREE from 'three';

const HEADREST = /head[\s_-]?rest|kopfst(ü|ue)tze/i, POST = /post|stange/i;
const WHEEL = /steering[\s_-]?wheel|lenkrad|(^|[\s_-])rim([\s_-]|$)/i;
/** From the front of the headrest to the eye: a hand's breadth to the head and the head (mm). */
const HEAD_MM = 230;
/** Of a driver who looks at the middle of the dash: down, and of the way to the middle of the room. */
const DOWN = 0.24, ASIDE = 0.5;
/** Share of the directions in which a room has surface; before a wall it is half of them. */
const LEAST_ENCLOSURE = 0.6;
const NEAREST_MM = 300, FARTHEST_MM = 1500;
/** Nobody sits in what is smaller, as in a box for a display. */
const LEAST_ROOM_MM = 800;

function boxesOf(meshes, names, wanted, not = /$^/) {
  const boxes = new Map();
  for (const object of meshes) {
    const { use } = object.userData, name = names[use];
    if (!wanted.test(name) || not.test(name)) continue;
    if (!boxes.has(use)) boxes.set(use, new THREE.Box3());
    boxes.get(use).expandByObject(object);
  }
  return [...boxes.values()];
}

function driver(meshes, names, box) {
  const middle = box.getCenter(new THREE.Vector3());
  let best = null;
  for (const wheel of boxesOf(meshes, names, WHEEL))
    for (const rest of boxesOf(meshes, names, HEADREST, POST)) {
      const hub = wheel.getCenter(new THREE.Vector3()), head = rest.getCenter(new THREE.Vector3());
      const ahead = hub.clone().sub(head).setY(0), distance = ahead.length();
      if (distance < NEAREST_MM || distance > FARTHEST_MM || distance > (best?.distance ?? Infinity)) continue;
      ahead.divideScalar(distance);
      const half = rest.getSize(new THREE.Vector3()).multiplyScalar(0.5);
      const depth = Math.abs(ahead.x) * half.x + Math.abs(ahead.z) * half.z;
      const eye = head.clone().addScaledVector(ahead, depth + HEAD_MM);
      const aside = new THREE.Vector3(-ahead.z, 0, ahead.x);
      aside.multiplyScalar(Math.sign(middle.clone().sub(eye).dot(aside)) * Math.min(ASIDE, Math.abs(middle.clone().sub(eye).dot(aside)) / distance));
      best = { distance, eye, ahead: ahead.clone(), look: ahead.clone().add(aside).addScaledVector(new THREE.Vector3(0, -1, 0), DOWN).normalize(), kind: 'driver' };
    }
  return best;
}

/** Which cells of a grid over the box hold surface, and the way that it faces there. */
class Cells {
  constructor(meshes, box) {
    const size = box.getSize(new THREE.Vector3());
    this.low = box.min.clone();
    this.cell = Math.max(size.x, size.y, size.z) / 48;
    this.count = [size.x, size.y, size.z].map((s) => Math.ceil(s / this.cell) + 1);
    this.facing = new Float32Array(4 * this.count[0] * this.count[1] * this.count[2]);  // of each: normal and number
    for (const object of meshes) this.add(object);
  }

  add({ matrixWorld, geometry, userData: { mesh } }) {
    const { positions, indices, coarse } = mesh.data, list = coarse.length ? coarse : indices;
    const [a, b, c, n] = Array.from({ length: 4 }, () => new THREE.Vector3());
    const turn = matrixWorld.determinant() < 0 ? -1 : 1, at = new THREE.Vector3();
    if (!geometry) return;
    for (let t = 0; t < list.length; t += 3) {
      [a, b, c].forEach((v, k) => v.fromArray(positions, 3 * list[t + k]).applyMatrix4(matrixWorld));
      n.crossVectors(b.sub(a), c.sub(a));
      const area = n.length() / 2;
      if (area === 0) continue;
      n.multiplyScalar(turn / (2 * area));
      const steps = Math.min(Math.ceil(Math.max(b.length(), c.length()) / (0.7 * this.cell)), 64);
      for (let i = 0; i <= steps; ++i)
        for (let j = 0; j <= steps - i; ++j) {
          const cell = this.index(at.copy(a).addScaledVector(b, i / steps).addScaledVector(c, j / steps));
          if (cell >= 0) [n.x, n.y, n.z, 1].forEach((value, k) => { this.facing[4 * cell + k] += value; });
        }
    }
  }

  index({ x, y, z }) {
    const i = Math.floor((x - this.low.x) / this.cell), j = Math.floor((y - this.low.y) / this.cell), k = Math.floor((z - this.low.z) / this.cell);
    const [nx, ny, nz] = this.count;
    return i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz ? -1 : (k * ny + j) * nx + i;
  }

  /** The distance to the surface that a ray meets and whether that shows its front; null when there is none. */
  meet(from, direction) {
    const at = from.clone();
    for (let way = 0; ; way += this.cell) {
      const cell = this.index(at);
      if (cell < 0) return null;
      if (this.facing[4 * cell + 3]) {
        const [x, y, z] = this.facing.subarray(4 * cell, 4 * cell + 3);
        return { way, front: x * direction.x + y * direction.y + z * direction.z <= 0 };
      }
      at.addScaledVector(direction, this.cell);
    }
  }
}

/** `count` directions spread over the sphere. */
function directions(count) {
  return Array.from({ length: count }, (_, i) => {
    const y = 1 - (2 * i + 1) / count, r = Math.sqrt(1 - y * y), turn = i * Math.PI * (3 - Math.sqrt(5));
    return new THREE.Vector3(r * Math.cos(turn), y, r * Math.sin(turn));
  });
}

/** The place of greatest (enclosure − 1/2) · clearance, most of what it sees showing its front, as the sides of sheets are looked at. */
function room(meshes, box) {
  const cells = new Cells(meshes, box), rays = directions(64), size = box.getSize(new THREE.Vector3());
  let best = { score: 0 };
  for (let i = 1; i < 8; ++i) for (let j = 1; j < 8; ++j) for (let k = 1; k < 8; ++k) {
    const eye = box.min.clone().add(new THREE.Vector3(i / 8, j / 8, k / 8).multiply(size));
    let hits = 0, fronts = 0, clearance = Infinity;
    for (const ray of rays) {
      const met = cells.meet(eye, ray);
      if (!met) continue;
      ++hits;
      fronts += met.front;
      clearance = Math.min(clearance, met.way);
    }
    const isRoom = 2 * fronts > hits && hits > LEAST_ENCLOSURE * rays.length && clearance > 2 * cells.cell;
    const score = isRoom ? (hits / rays.length - 0.5) * clearance : 0;
    if (score > best.score) best = { score, eye };
  }
  if (!best.eye) return null;
  const look = Array.from({ length: 16 }, (_, i) => new THREE.Vector3(Math.cos(i * Math.PI / 8), -0.2, Math.sin(i * Math.PI / 8)).normalize());
  const seen = (direction) => directions(256).reduce((sum, ray) => {
    const met = ray.dot(direction) > 0.8 ? cells.meet(best.eye, ray) : null;
    return sum + (met?.front ? Math.sqrt(met.way) : 0);
  }, 0);
  const ahead = look.reduce((most, direction) => seen(direction) > seen(most) ? direction : most, look[0]);
  return { eye: best.eye, look: ahead, ahead: ahead.clone().setY(0).normalize(), kind: 'room' };
}

/**
 * @param meshes objects of the scene with their places in the world (mm, y up), @param names of its uses
 * @returns {eye, look, ahead, kind}: a point, the way that it looks and that way along the floor; null for an object without a room
 */
export function eyePoint(meshes, names, box) {
  const { x, y, z } = box.getSize(new THREE.Vector3());
  return driver(meshes, names, box) ?? (Math.max(x, y, z) < LEAST_ROOM_MM ? null : room(meshes, box));
}
