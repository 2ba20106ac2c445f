// SPDX-License-Identifier: MIT
// The decals of the scene as the server cuts them.
import { blob } from './api.mjs';
import { ShownPieces } from './shown_pieces.mjs';

/** In front of what they lie on, also where the depths of a picture are coarse. */
const PULL = -2;

export class ShownDecals extends ShownPieces {
  /** @param handlers of ShownPieces */
  constructor(view, handlers) {
    super(view, 'decal', handlers);
    view.levels.isCovered = ({ data: { part, slot } }, use) => this.group.children.some(({ visible, userData: { piece } }) => visible && piece.part === part && piece.slot === slot && piece.use === use);
  }

  piecesOf({ patches }) { return patches; }
  pictureOf(name, i, image) { return blob('decal-picture', { id: name, image }); }

  dress(mesh) {
    Object.assign(mesh.material, { polygonOffset: true, polygonOffsetFactor: PULL, polygonOffsetUnits: PULL });
    mesh.renderOrder = 1 + mesh.userData.number;  // Later ones lie on earlier ones.
  }

  /** The decal that a ray meets first, where no surface hides it. */
  numberAt(ray) {
    const [hit] = ray.intersectObjects(this.group.children.filter(({ visible }) => visible), false);
    if (!hit) return null;
    const surface = this.view.hitOf(ray);
    return !surface || hit.distance <= surface.point.distanceTo(ray.ray.origin) + Math.max(1, hit.distance / 1000) ? hit.object.userData.number : null;
  }
}
