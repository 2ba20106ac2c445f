// SPDX-License-Identifier: MIT
// Rays against surfaces of many triangles, by a tree that is built when the first ray comes near.
import { MeshBVH, acceleratedRaycast } from 'three-mesh-bvh';
import * as THREE from 'three';

const sphere = new THREE.Sphere();

/** Replaces raycast() of a mesh whose geometry does not change. */
export function quickRaycast(raycaster, hits) {
  const { geometry } = this;
  if (!geometry.index.count) return;  // All of it was taken by carriers.
  if (!geometry.boundsTree) {
    if (!geometry.boundingSphere) geometry.computeBoundingSphere();
    if (!raycaster.ray.intersectsSphere(sphere.copy(geometry.boundingSphere).applyMatrix4(this.matrixWorld))) return;
    geometry.boundsTree = new MeshBVH(geometry, { indirect: true });
  }
  acceleratedRaycast.call(this, raycaster, hits);
}
