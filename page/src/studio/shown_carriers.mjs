// SPDX-License-Identifier: MIT
// The carriers of the scene as the server makes them, all at once: one may stand for what another has left.
import { blob } from './api.mjs';
import { ShownPieces } from './shown_pieces.mjs';

const ALL = 0;

export class ShownCarriers extends ShownPieces {
  /** @param handlers of ShownPieces */
  constructor(view, handlers) {
    super(view, 'carriers', handlers);
    view.standIns = this;
  }

  piecesOf({ rectangles }) { return rectangles; }
  pictureOf(name, i, image) { return blob('carrier-picture', { id: name, rectangle: i, image }); }

  get told() { return this.data.get(ALL); }
  get problem() { return this.problems.get(ALL); }

  /** @param wanted {name} of the state, or null */
  async showAll(wanted) {
    if (wanted) await this.show([{ number: ALL, name: wanted.name }]);
  }

  /** Those that stand for a part, which a press on them picks. */
  pickable() {
    const meshes = this.group.children.filter(({ visible, userData: { piece } }) => visible && piece.use !== null);
    for (const mesh of meshes) mesh.userData.use = mesh.userData.piece.use, mesh.userData.key = this.surfaceOf(mesh.userData.piece)?.key;
    return meshes.filter(({ userData: { key } }) => key !== undefined);
  }
}
