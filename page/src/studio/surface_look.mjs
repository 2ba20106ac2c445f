// SPDX-License-Identifier: MIT
// Geometry, material and textures of a surface of the server.
import * as THREE from 'three';
import { placed } from '../textures.mjs';
import { ConnectionBroke } from './api.mjs';

/** Three columns: the third, of texel density, is not measured here. */
function measuredColumns(pairs) {
  const columns = new Float32Array(1.5 * pairs.length).fill(-1);
  for (let i = 0; i < pairs.length / 2; ++i) columns.set(pairs.subarray(2 * i, 2 * i + 2), 3 * i);
  return columns;
}

/** @param arrays of parseSurface(); without `measured` nothing of the uv's quality can be shown */
export function geometryOf({ positions, normals, uv, uv1, measured = new Float32Array(0), indices }) {
  const geometry = new THREE.BufferGeometry();
  for (const [name, values, size] of [['position', positions, 3], ['normal', normals, 3], ['uv', uv, 2], ['measured', measuredColumns(measured), 3]])
    geometry.setAttribute(name, new THREE.BufferAttribute(values, size));
  geometry.setAttribute('uv1', uv1 ? new THREE.BufferAttribute(uv1, 2) : geometry.getAttribute('uv'));
  return geometry.setIndex(new THREE.BufferAttribute(indices, 1));
}

/** Where a surface has no uv they are all 0, upside down 1. */
export const hasCoordinates = ({ uv }) => uv.some((x, i) => x !== i % 2);

export class SurfaceLooks {
  constructor() { this.textures = new Map(); }

  clear() {
    for (const texture of this.textures.values()) texture.then((made) => made?.dispose(), () => {});
    this.textures.clear();
  }

  /** @param picture gives the blob of a picture by its number in the look */
  async materialOf(look, picture) {
    const [r, g, b, a] = look.color, blend = look.alpha_mode === 'BLEND';
    const material = new THREE.MeshStandardMaterial({
      color: new THREE.Color(r, g, b), roughness: look.roughness, metalness: look.metallic, emissive: new THREE.Color(...look.emissive),
      side: look.double_sided ? THREE.DoubleSide : THREE.FrontSide, transparent: blend, opacity: blend ? a : 1, depthWrite: !blend,
      alphaTest: look.alpha_mode === 'MASK' ? look.alpha_cutoff : 0,
    });
    const [base, normal, shine] = await Promise.all([this.mapOf(look.base_map, true, picture), this.mapOf(look.normal_map, false, picture), this.mapOf(look.shine_map, false, picture)]);
    material.map = base;
    material.normalMap = normal;
    if (normal) material.normalScale.set(look.normal_map.factor, -look.normal_map.factor);  // Without tangents v runs the other way.
    material.roughnessMap = material.metalnessMap = shine;
    return material;
  }

  /** A picture as a texture: one for all that show the same picture at the same place. One that did not come whole is asked for again the next time. */
  mapOf(map, isColour, picture) {
    if (!map) return null;
    const name = JSON.stringify([{ ...map, image: null }, isColour]);
    if (!this.textures.has(name)) this.textures.set(name, this.textureOf(map, isColour, picture).catch((error) => { this.textures.delete(name); throw error; }));
    return this.textures.get(name);
  }

  async textureOf(map, isColour, picture) {
    const bitmap = await picture(map.image).then((blob) => createImageBitmap(blob, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' })).catch((error) => {
      if (error instanceof ConnectionBroke) throw error;
      return null;
    });
    return bitmap && placed(new THREE.Texture(bitmap), map, isColour);
  }
}
