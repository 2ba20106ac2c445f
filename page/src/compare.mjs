// SPDX-License-Identifier: MIT
// A second material on one half of a part, each grain in its own size: A and B side by side on the same surface.
import * as THREE from 'three';
import { mmPerUv } from './data.mjs';
import { applyView, shadingOf } from './shading.mjs';

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

export class Compare {
  constructor(three, scene) {
    Object.assign(this, { three, scene });
    this.group = new THREE.Group();
    this.plane = new THREE.Plane();
    three.scene.add(this.group);
    three.renderer.localClippingEnabled = true;
    three.marks.push(this);
  }

  /** Shows a material on the far half of a use along its longest side; none ends it. */
  show(use, index) {
    this.group.clear();
    this.use = index === null ? null : use;
    if (index === null) return this.three.invalidate();
    this.index = index;
    const places = this.three.surface.places.filter(({ object }) => object.userData.use === use), box = new THREE.Box3();
    for (const { object, toScene } of places) box.union(object.geometry.boundingBox.clone().applyMatrix4(toScene));
    const size = box.getSize(new THREE.Vector3()), axis = size.x >= size.y && size.x >= size.z ? [1, 0, 0] : size.z >= size.y ? [0, 0, 1] : [0, 1, 0];
    this.inScene = new THREE.Plane().setFromNormalAndCoplanarPoint(new THREE.Vector3(...axis), box.getCenter(new THREE.Vector3()));
    for (const place of places) this.group.add(this.half(place));
    this.view(this.shown, this.range);
    this.fit();
    this.three.invalidate();
  }

  half({ object, toScene }) {
    const { mesh } = object.userData, a = this.scene.materials[mesh.material], b = this.scene.materials[this.index];
    const ratio = ratioOf(a, b), channel = a?.normal_map?.tex_coord ?? a?.haptic?.height?.texCoord ?? 0;
    const half = new THREE.Mesh(object.geometry, fitted(this.three.standard[this.index], ratio, channel));
    half.userData = { standard: half.material, shader: shadingOf(b, mesh, false), ratio };
    half.matrixAutoUpdate = false;
    half.matrix.copy(toScene);
    for (const material of [half.userData.standard, half.userData.shader])
      Object.assign(material, { clipping: true, clippingPlanes: [this.plane], side: object.material.side, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 });
    return half;
  }

  /** Follows the view of the scene. */
  view(view, range) {
    Object.assign(this, { shown: view, range });
    for (const half of this.group.children) {
      half.material = view.kind === 0 ? half.userData.standard : half.userData.shader;
      applyView(half.userData.shader, view, range, this.scene.materials[this.index]);
    }
  }

  /** The plane follows the scene's size. */
  fit() { if (this.group.children.length) this.plane.copy(this.inScene).applyMatrix4(this.three.scene.matrixWorld); }

  /** What is felt at a spot, and by what its coordinates grow. */
  at({ use, mesh, point }) {
    if (this.group.children.length && use === this.use && this.inScene.distanceToPoint(point) > 0)
      return { material: this.scene.materials[this.index], ratio: this.group.children[0].userData.ratio };
    return { material: this.scene.materials[mesh.material], ratio: [1, 1] };
  }
}
