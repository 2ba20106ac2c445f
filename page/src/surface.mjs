// SPDX-License-Identifier: MIT
// Spots on the surface of a scene: where a ray meets it, and which is nearest to a point. Lengths in mm, in the frame of
// the scene: y up, not scaled for a headset.
import * as THREE from 'three';
import { MeshBVH } from 'three-mesh-bvh';

const trees = new WeakMap();

/** Of the triangles at rest; made when it is first needed. */
function treeOf(mesh) {
  if (!trees.has(mesh)) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(mesh.data.positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(mesh.data.indices, 1));
    trees.set(mesh, new MeshBVH(geometry, { indirect: true }));  // faces keep their numbers
  }
  return trees.get(mesh);
}

/** Corners of a face as vectors of a column of the mesh's data. */
const cornersOf = ({ data }, face, column = data.positions) => [0, 1, 2].map((k) => new THREE.Vector3().fromArray(column, 3 * data.indices[3 * face + k]));

export class Surface {
  /** @param objects meshes with {use, mesh} as userData, in place, @param scene a group that they are in, whose frame counts */
  constructor(objects, scene) {
    const fromWorld = scene.matrixWorld.clone().invert();
    this.places = objects.map((object) => {
      const toScene = fromWorld.clone().multiply(object.matrixWorld);
      if (!object.geometry.boundingBox) object.geometry.computeBoundingBox();
      return { object, toScene, toLocal: toScene.clone().invert(), scale: Math.cbrt(Math.abs(toScene.determinant())), mirrored: toScene.determinant() < 0, box: object.geometry.boundingBox };
    });
  }

  /** {use, mesh, object, face, local, point, normal, bary, uv}: everything of a spot. */
  spot(place, face, local) {
    const { use, mesh } = place.object.userData, corners = cornersOf(mesh, face), bary = new THREE.Vector3();
    THREE.Triangle.getBarycoord(local, ...corners, bary);
    const weights = bary.toArray().map((w) => Number.isFinite(w) ? w : 1 / 3), uv = new THREE.Vector2(), normal = new THREE.Vector3();
    cornersOf(mesh, face, mesh.data.normals).forEach((n, k) => normal.addScaledVector(n, weights[k]));
    weights.forEach((w, k) => {
      const i = 2 * mesh.data.indices[3 * face + k];
      uv.x += w * mesh.data.uv[i];
      uv.y += w * mesh.data.uv[i + 1];
    });
    normal.applyNormalMatrix(new THREE.Matrix3().getNormalMatrix(place.toScene)).normalize();
    return { use, mesh, object: place.object, face, local, point: local.clone().applyMatrix4(place.toScene), normal, bary: weights, uv, place };
  }

  /** The first spot on a ray, seen as it is drawn: back sides only where the material shows them. */
  meet(origin, direction, far = Infinity, among = this.places) {
    let best = null, nearest = far;
    const ray = new THREE.Ray(), at = new THREE.Vector3();
    for (const place of among) {
      if (!place.object.parent.visible) continue;
      ray.set(origin, direction).applyMatrix4(place.toLocal);  // the direction is of unit length again
      if (!ray.intersectsBox(place.box)) continue;
      const { side } = place.object.material, drawn = side === THREE.DoubleSide ? side : place.mirrored ? THREE.BackSide : THREE.FrontSide;
      const hit = treeOf(place.object.userData.mesh).raycastFirst(ray, drawn);
      if (!hit) continue;
      const distance = at.copy(hit.point).applyMatrix4(place.toScene).distanceTo(origin);
      if (distance < nearest) [nearest, best] = [distance, { place, face: hit.faceIndex, local: hit.point.clone() }];
    }
    return best && { ...this.spot(best.place, best.face, best.local), distance: nearest };
  }

  /** The spot nearest to a point, within `reach`. `depth` is how far the point lies behind the surface (mm), negative before it. */
  nearest(point, reach) {
    let best = null, nearest = reach;
    const local = new THREE.Vector3();
    for (const place of this.places) {
      if (!place.object.parent.visible) continue;
      local.copy(point).applyMatrix4(place.toLocal);
      if (place.box.distanceToPoint(local) * place.scale > nearest) continue;
      const found = treeOf(place.object.userData.mesh).closestPointToPoint(local, {}, 0, nearest / place.scale);
      if (!found) continue;
      const distance = found.distance * place.scale;
      if (distance < nearest) [nearest, best] = [distance, { place, face: found.faceIndex, local: found.point.clone() }];
    }
    if (!best) return null;
    const spot = this.spot(best.place, best.face, best.local);
    return { ...spot, distance: nearest, depth: Math.sign(spot.point.clone().sub(point).dot(spot.normal)) * nearest };
  }

  /** Points spread over a use and the way they face, about `count`. */
  samples(use, count) {
    const out = [];
    for (const place of this.places.filter(({ object }) => object.userData.use === use)) {
      const { mesh } = place.object.userData, faces = mesh.data.indices.length / 3, step = Math.max(1, Math.floor(faces / count));
      const turn = place.mirrored ? -1 : 1;
      for (let face = 0; face < faces; face += step) {
        const [a, b, c] = cornersOf(mesh, face).map((v) => v.applyMatrix4(place.toScene));
        const normal = b.clone().sub(a).cross(c.clone().sub(a)).multiplyScalar(turn / 2), point = a.add(b).add(c).divideScalar(3);
        out.push({ point, normal });
      }
    }
    return out;
  }
}
