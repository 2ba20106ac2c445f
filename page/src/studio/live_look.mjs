// SPDX-License-Identifier: MIT
// A recipe that is being written, as pixels on the surfaces of its material; what was there before comes back.
import { pixelTexture } from '../textures.mjs';

const MAPS = [['color', 'map', true], ['normal', 'normalMap', false], ['shine', 'roughnessMap', false]];
const KEPT = ['map', 'normalMap', 'roughnessMap', 'metalnessMap', 'roughness', 'metalness'];

export class LiveLook {
  constructor(view) { Object.assign(this, { view, textures: new Map(), kept: new Map(), keys: new Set(), look: null }); }

  /** @param keys of surfaces @param look {side, roughness, metallic, color, normal, shine}, pixels or null */
  show(keys, look) {
    for (const key of this.keys) if (!keys.has(key)) this.restore(this.view.surfaces.get(key));
    Object.assign(this, { keys, look });
    this.fresh = new Set();  // Textures that have the look's pixels.
    for (const key of keys) this.dress(this.view.surfaces.get(key));
    this.view.changing();
  }

  /** A surface that the view has anew. */
  dressAgain(key) { if (this.look && this.keys.has(key)) this.dress(this.view.surfaces.get(key)); }

  /** One texture for all surfaces that show it at the same place. */
  textureOf([pixels, , isColour], place) {
    const name = JSON.stringify([pixels, { ...place, image: null, name: null, factor: null }]);
    if (this.fresh.has(name)) return this.textures.get(name);
    this.fresh.add(name);
    const { side } = this.look;
    this.textures.set(name, pixelTexture(this.textures.get(name), this.look[pixels], { width: side, height: side }, place, isColour));
    return this.textures.get(name);
  }

  dress(shown) {
    const place = shown?.data.look.normal_map ?? shown?.data.look.base_map, material = shown?.material;
    if (!place || !shown.hasUv) return;
    if (!this.kept.has(material)) this.kept.set(material, Object.fromEntries([...KEPT.map((name) => [name, material[name]]), ['color', material.color.clone()]]));
    const before = this.mapsOf(material);
    for (const map of MAPS) material[map[1]] = this.look[map[0]] ? this.textureOf(map, place) : null;
    material.metalnessMap = material.roughnessMap;
    const { color, roughness, metalness } = this.kept.get(material), hasColour = Boolean(this.look.color);
    if (hasColour) material.color.setRGB(1, 1, 1); else material.color.copy(color);
    Object.assign(material, hasColour ? { roughness: this.look.roughness, metalness: this.look.metallic } : { roughness, metalness });
    if (before !== this.mapsOf(material)) material.needsUpdate = true;
  }

  mapsOf(material) { return MAPS.map(([, name]) => Boolean(material[name])).join(); }

  restore(shown) {
    const kept = this.kept.get(shown?.material);
    if (!kept) return;
    const { color, ...rest } = kept, { material } = shown;
    Object.assign(material, rest);
    material.color.copy(color);
    material.needsUpdate = true;
    this.kept.delete(material);
  }

  hide() {
    if (!this.look) return;
    for (const key of this.keys) this.restore(this.view.surfaces.get(key));
    for (const texture of this.textures.values()) texture?.dispose();
    this.textures.clear();
    this.kept.clear();
    Object.assign(this, { keys: new Set(), look: null });
    this.view.draw();
  }
}
