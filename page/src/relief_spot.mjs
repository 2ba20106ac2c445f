// SPDX-License-Identifier: MIT
// Where a spot of the surface lies in the relief of its material, and how the relief lies on the surface there.
import * as THREE from 'three';
import { uvMatrix } from './shading.mjs';

const matrices = new WeakMap();

function heightMatrix(material) {
  if (!matrices.has(material)) matrices.set(material, uvMatrix(material.haptic.height.uvTransform));
  return matrices.get(material);
}

/**
 * @param surface of surfaceOf(), @param spot of Surface, @param ratio by which the coordinates grow
 * @returns {at, axes}: mm along the relief from its upper left corner, repeats counted on; unit vectors of the scene along
 * its x and y. Null where the coordinates are of no size.
 */
export function reliefSpot(material, surface, { mesh, face, bary, normal, place }, ratio = [1, 1]) {
  const { positions, indices } = mesh.data, coordinates = material.haptic.height.texCoord === 1 ? mesh.data.uv1 : mesh.data.uv;
  const matrix = heightMatrix(material), grown = new THREE.Vector2(...ratio), points = [], places = [];
  for (let k = 0; k < 3; ++k) {
    const i = indices[3 * face + k], uv = new THREE.Vector2().fromArray(coordinates, 2 * i).multiply(grown).applyMatrix3(matrix);
    places.push([uv.x * surface.size[0], uv.y * surface.size[1]]);
    points.push(new THREE.Vector3().fromArray(positions, 3 * i).applyMatrix4(place.toScene));
  }
  const at = [0, 1].map((c) => places.reduce((sum, p, k) => sum + bary[k] * p[c], 0));
  const [[ax, ay], [bx, by]] = [1, 2].map((k) => [places[k][0] - places[0][0], places[k][1] - places[0][1]]), area = ax * by - ay * bx;
  if (!area) return null;
  const [p, q] = [1, 2].map((k) => points[k].sub(points[0]));
  const x = p.clone().multiplyScalar(by).addScaledVector(q, -ay).divideScalar(area), y = q.multiplyScalar(ax).addScaledVector(p, -bx).divideScalar(area);
  return { at, axes: [x, y].map((axis) => axis.projectOnPlane(normal).normalize()) };
}
