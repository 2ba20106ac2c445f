// SPDX-License-Identifier: MIT
// What of the scene is at a place of the window.
import * as THREE from 'three';

/** @param place {clientX, clientY} */
export function rayAt({ clientX, clientY }, canvas, camera) {
  const { left, top, width, height } = canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
  ray.setFromCamera(new THREE.Vector2(2 * (clientX - left) / width - 1, 1 - 2 * (clientY - top) / height), camera);
  return ray;
}

/** The first hit: its object's userData, point, normal of the face and smooth normal, both against the ray; null for none. @param planes what they cut away is not hit */
export function hitOf(ray, meshes, [plane]) {
  const hit = ray.intersectObjects(meshes, false).find(({ point }) => !plane || plane.distanceToPoint(point) >= 0);
  if (!hit) return null;
  const normal = hit.face.normal.clone().transformDirection(hit.object.matrixWorld);
  if (normal.dot(ray.ray.direction) > 0) normal.negate();
  const smooth = hit.normal ? hit.normal.clone().transformDirection(hit.object.matrixWorld) : normal.clone();
  if (smooth.dot(normal) < 0) smooth.negate();
  return { ...hit.object.userData, point: hit.point, normal, smooth };
}
