// SPDX-License-Identifier: MIT
// A second material on one half of a part, each grain in its own size: A and B side by side on the same surface.
import * as THREE from 'three';
import { mmPerUv } from './data.mjs';
import { applyView, shadingOf } from './shading.mjs';
import { Surface } from './surface.mjs';

const MAPS = ['map', 'normalMap', 'roughnessMap', 'metalnessMap'];

/** By what the part's coordinates must grow so that the grain of B keeps its millimetres. */
function ratioOf(a, b) {
  const from = mmPerUv(a), to = mmPerUv(b);
  return from && to ? from.map((mm, i) => mm / to[i]) : [1, 1];
}

/** B as it is seen on a part that was unwrapped for A. */
function fitted(standard, ratio, channel) {
  const material = standard.clone(), scale = new THREE.Matrix3().makeScale(...ratio);
  for (const map of MAPS) {
    if (!material[map]) continue;
    material[map] = material[map].clone();
    material[map].matrix.multiply(scale);
    material[map].channel = channel;
  }
  return material;
}

/** A material of the scene as B of places that were unwrapped for another: see Compare.show(). */
export function materialOn(three, scene, index) {
  return ({ object }) => {
    const { mesh } = object.userData, a = scene.materials[mesh.material], b = scene.materials[index];
    const ratio = ratioOf(a, b), channel = a?.normal_map?.tex_coord ?? a?.haptic?.height?.texCoord ?? 0;
    return { mesh, geometry: object.geometry, standard: fitted(three.standard[index], ratio, channel), material: b, ratio };
  };
}

/** How far B's surface may lie from A's (mm): they are the same but for rounding. */
const SAME_MM = 0.1;

export class Compare {
  constructor(three, scene) {
    Object.assign(this, { three, scene });
    this.group = new THREE.Group();
    this.plane = new THREE.Plane();
    three.scene.add(this.group);
    three.renderer.localClippingEnabled = true;
    three.marks.push(this);
  }

  /**
   * Shows B on the far half of a use along its longest side.
   * @param second of a place of Surface gives {mesh, geometry, standard, material, ratio} of B there, by which the mesh's
   * coordinates grow for it, or null where B is not; none ends the comparison
   */
  show(use, second) {
    for (const { userData } of this.group.children) for (const made of [userData.standard, userData.shader]) made.dispose();
    this.group.clear();
    this.use = second ? use : null;
    const places = second ? this.three.surface.places.filter(({ object }) => object.userData.use === use) : [], box = new THREE.Box3();
    for (const place of places) {
      const b = second(place);
      if (!b) continue;
      box.union(place.object.geometry.boundingBox.clone().applyMatrix4(place.toScene));
      this.group.add(this.half(place, b));
    }
    const size = box.getSize(new THREE.Vector3()), axis = size.x >= size.y && size.x >= size.z ? [1, 0, 0] : size.z >= size.y ? [0, 0, 1] : [0, 1, 0];
    this.inScene = new THREE.Plane().setFromNormalAndCoplanarPoint(new THREE.Vector3(...axis), box.getCenter(new THREE.Vector3()));
    this.group.updateWorldMatrix(true, true);
    this.surface = new Surface(this.group.children, this.three.scene);
    if (this.shown) this.view(this.shown, this.range);
    this.fit();
    this.three.invalidate();
  }

  half({ object, toScene }, { mesh, geometry, standard, material, ratio }) {
    const half = new THREE.Mesh(geometry, standard);
    half.userData = { ...object.userData, mesh, material, standard, shader: shadingOf(material, mesh, false), ratio };
    half.matrixAutoUpdate = false;
    half.matrix.copy(toScene);
    for (const made of [standard, half.userData.shader])
      Object.assign(made, { clipping: true, clippingPlanes: [this.plane], side: object.material.side, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 });
    return half;
  }

  /** Follows the view of the scene. */
  view(view, range) {
    Object.assign(this, { shown: view, range });
    for (const half of this.group.children) {
      half.material = view.kind === 0 ? half.userData.standard : half.userData.shader;
      applyView(half.userData.shader, view, range, half.userData.material);
    }
  }

  /** The plane follows the scene's size. */
  fit() { if (this.group.children.length) this.plane.copy(this.inScene).applyMatrix4(this.three.scene.matrixWorld); }

  /** What is felt at a spot of the scene: {spot, material, ratio}; on B's side the spot is B's own. */
  at(spot) {
    const isOnB = this.group.children.length && spot.use === this.use && this.inScene.distanceToPoint(spot.point) > 0;
    const onB = isOnB && this.surface.nearest(spot.point, SAME_MM);
    if (!onB) return { spot, material: this.scene.materials[spot.mesh.material], ratio: [1, 1] };
    const { material, ratio } = onB.object.userData;
    return { spot: { ...onB, distance: spot.distance, depth: spot.depth }, material, ratio };
  }
}
