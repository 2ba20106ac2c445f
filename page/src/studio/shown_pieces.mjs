// SPDX-License-Identifier: MIT
// Meshes that the server makes of pictures on the scene, fetched anew where they have changed.
import * as THREE from 'three';
import { ConnectionBroke, arraysOf, bytes, parseFramed } from './api.mjs';
import { geometryOf } from './surface_look.mjs';

export class ShownPieces {
  /** @param path of the server that has them by {id: name} @param handlers shown(number) when those of a number are there or could not be made, as `problems` tells; failed(error) where a connection broke */
  constructor(view, path, handlers) {
    Object.assign(this, { view, path, handlers, group: new THREE.Group(), wanted: new Map(), data: new Map(), problems: new Map() });
    view.marks.push(this);
  }

  /** The meshes of an answer: [{look, arrays, use, and world where that is not the use's}]. */
  piecesOf() { return []; }
  /** The blob of a picture of the look of a piece. */
  pictureOf() { return null; }
  /** Before a mesh is shown. */
  dress() {}

  /** @param all of the state, or some of them: {number, name} */
  show(all) { return Promise.all(all.map((one) => this.fetch(one))); }

  /** Takes away those behind the first so many. */
  keepFirst(count) {
    for (const number of [...this.wanted.keys()]) if (number >= count) { this.wanted.delete(number); this.drop(number); }
  }

  async fetch({ number, name }) {
    if (this.wanted.get(number) === name) return;
    this.wanted.set(number, name);
    const isWanted = () => this.wanted.get(number) === name;
    try {
      const { json, buffer, at } = parseFramed(await bytes(this.path, { id: name })), pieces = this.piecesOf(json);
      const materials = await Promise.all(pieces.map(({ look }, i) => this.view.looks.materialOf(look, (image) => this.pictureOf(name, i, image))));
      if (!isWanted()) return;
      this.drop(number);
      pieces.forEach((piece, i) => this.add(number, { ...piece, arrays: arraysOf(piece.arrays, buffer, at) }, materials[i]));
      this.data.set(number, { ...json, name });
    } catch (error) {
      if (!isWanted()) return;
      if (error instanceof ConnectionBroke) {
        this.wanted.delete(number);
        this.handlers.failed(error);
        return;
      }
      this.drop(number);
      this.problems.set(number, error.message);
    }
    this.view.draw();
    this.handlers.shown(number);
  }

  add(number, piece, material) {
    if (!this.group.parent) this.view.root.add(this.group);  // A new scene empties the root.
    const mesh = new THREE.Mesh(geometryOf(piece.arrays), material);
    mesh.matrixAutoUpdate = false;
    mesh.matrix.set(...piece.world ?? this.view.scene.uses[piece.use].world);
    mesh.userData = { number, piece };
    this.dress(mesh);
    this.group.add(mesh);
    mesh.updateMatrixWorld(true);
  }

  drop(number) {
    for (const mesh of this.meshesOf(number)) {
      mesh.removeFromParent();
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.data.delete(number);
    this.problems.delete(number);
    this.view.draw();
  }

  meshesOf(number) { return this.group.children.filter((mesh) => mesh.userData.number === number); }

  /** The surface of a piece, as the view has it. */
  surfaceOf({ part, slot, use }) { return [...this.view.surfaces.values()].find((shown) => shown.data.part === part && shown.data.slot === slot && shown.uses.includes(use)); }

  /** As their surfaces are shown; called before each picture. */
  fit() {
    const { hidden, overlay } = this.view;
    for (const mesh of this.group.children) mesh.visible = overlay === 'textured' && !(hidden.size && hidden.has(this.surfaceOf(mesh.userData.piece)?.key));
  }
}
