// SPDX-License-Identifier: MIT
// The triangles of surfaces at the coordinates of their atlases, fetched once by the atlas' name.
import { arraysOf, bytes, parseFramed } from './api.mjs';
import { geometryOf } from './surface_look.mjs';

export class RecipeAtlases {
  constructor() { this.fetched = new Map(); }

  /** A promise of the geometry. */
  geometry(name) {
    if (!this.fetched.has(name)) this.fetched.set(name, this.fetch(name).catch((error) => { this.fetched.delete(name); throw error; }));
    return this.fetched.get(name);
  }

  async fetch(name) {
    const { json, buffer, at } = parseFramed(await bytes('recipe-atlas', { id: name }));
    return geometryOf(arraysOf(json.arrays, buffer, at));
  }

  clear() {
    for (const one of this.fetched.values()) one.then((geometry) => geometry.dispose(), () => {});
    this.fetched.clear();
  }
}
