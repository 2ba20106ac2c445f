// SPDX-License-Identifier: MIT
// A recipe that is being written, as pixels on the surfaces of its material; what was there before comes back.
import { pixelTexture } from '../textures.mjs';

const MAPS = [['color', 'map', true], ['normal', 'normalMap', false], ['shine', 'roughnessMap', false]];
const KEPT = ['map', 'normalMap', 'roughnessMap', 'metalnessMap', 'roughness', 'metalness'];
const REPEAT = 10497, ON_ATLAS = { wrap: [REPEAT, REPEAT], tex_coord: 0 };

export class LiveLook {
  constructor(view) { Object.assign(this, { view, textures: new Map(), kept: new Map(), looks: new Map() }); }

  /** @param looks {look: {width, height, roughness, metallic, color, normal, shine}, geometry} by the key of their surface; pixels may be null; without geometry it is a tile for the surface's own */
  show(looks) {
    for (const key of this.looks.keys()) if (!looks.has(key)) this.restore(this.view.surfaces.get(key));
    this.looks = looks;
    this.fresh = new Set();  // Textures that have the look's pixels.
    for (const key of looks.keys()) this.dress(key);
    this.view.changing();
  }

  /** A surface that the view has anew. */
  dressAgain(key) { if (this.looks.has(key)) this.dress(key); }

  /** One texture for all surfaces that show a tile at the same place; one for each that has an atlas. */
  textureOf([pixels, , isColour], key, place) {
    const { look, geometry } = this.looks.get(key), name = JSON.stringify([pixels, geometry ? key : { ...place, image: null, name: null, factor: null }]);
    if (this.fresh.has(name)) return this.textures.get(name);
    this.fresh.add(name);
    this.textures.set(name, pixelTexture(this.textures.get(name), look[pixels], look, place, isColour));
    return this.textures.get(name);
  }

  dress(key) {
    const { look, geometry = null } = this.looks.get(key), shown = this.view.surfaces.get(key), material = shown?.material;
    const place = geometry ? ON_ATLAS : shown?.data.look.normal_map ?? shown?.data.look.base_map;
    if (!shown || !place || (!geometry && !shown.hasUv)) return;
    if (!this.kept.has(material)) this.kept.set(material, { ...Object.fromEntries(KEPT.map((name) => [name, material[name]])), color: material.color.clone(), normalScale: material.normalScale.clone() });
    const before = this.mapsOf(material);
    for (const map of MAPS) material[map[1]] = look[map[0]] ? this.textureOf(map, key, place) : null;
    material.metalnessMap = material.roughnessMap;
    const { color, normalScale, roughness, metalness } = this.kept.get(material), hasColour = Boolean(look.color);
    if (geometry) material.normalScale.set(1, -1); else material.normalScale.copy(normalScale);
    if (hasColour) material.color.setRGB(1, 1, 1); else material.color.copy(color);
    Object.assign(material, hasColour ? { roughness: look.roughness, metalness: look.metallic } : { roughness, metalness });
    if (before !== this.mapsOf(material)) material.needsUpdate = true;
    this.view.lay(shown, geometry);
  }

  mapsOf(material) { return MAPS.map(([, name]) => Boolean(material[name])).join(); }

  restore(shown) {
    const kept = this.kept.get(shown?.material);
    if (!kept) return;
    const { color, normalScale, ...rest } = kept, { material } = shown;
    Object.assign(material, rest);
    material.color.copy(color);
    material.normalScale.copy(normalScale);
    material.needsUpdate = true;
    this.kept.delete(material);
    this.view.lay(shown, null);
  }

  hide() {
    if (!this.looks.size) return;
    for (const key of this.looks.keys()) this.restore(this.view.surfaces.get(key));
    for (const texture of this.textures.values()) texture?.dispose();
    this.textures.clear();
    this.kept.clear();
    this.looks = new Map();
    this.view.draw();
  }
}
