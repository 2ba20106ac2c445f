// SPDX-License-Identifier: MIT
// The scene for a stand-alone headset: the parts of a material in one piece, coarser where there are too many triangles,
// and pictures that fit its memory.
import * as THREE from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { applyView, shadingOf } from '../shading.mjs';
import { textureBytes } from '../textures.mjs';

/** Of one eye; a frame draws two, with room left for menu and hands. */
export const MOST_TRIANGLES = 225000;
export const MOST_TEXTURE_BYTES = 256 * 2 ** 20;
const MAPS = ['map', 'normalMap', 'roughnessMap'];

/** The uses' triangles, those of the largest meshes coarser until all are few enough. */
function chosen(places) {
  const list = places.map((place) => ({ place, data: place.object.userData.mesh.data, coarse: false }));
  let sum = list.reduce((n, { data }) => n + data.indices.length / 3, 0);
  for (const entry of [...list].sort((a, b) => b.data.indices.length - a.data.indices.length)) {
    if (sum <= MOST_TRIANGLES) break;
    if (!entry.data.coarse.length) continue;
    entry.coarse = true;
    sum -= (entry.data.indices.length - entry.data.coarse.length) / 3;
  }
  return list;
}

function placedGeometry({ place, data, coarse }) {
  const { positions, normals, uv, uv1, measured } = data, indices = (coarse ? data.coarse : data.indices).slice();
  const geometry = new THREE.BufferGeometry();
  for (const [name, values, size] of [['position', positions.slice(), 3], ['normal', normals.slice(), 3], ['uv', uv, 2], ['uv1', uv1, 2], ['measured', measured, 3]])
    geometry.setAttribute(name, new THREE.BufferAttribute(values, size));
  if (place.mirrored) for (let t = 0; t < indices.length; t += 3) [indices[t], indices[t + 1]] = [indices[t + 1], indices[t]];
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  return geometry.applyMatrix4(place.toScene);
}

/** Whether a piece is of these entries of chosen(). */
const isMadeOf = ({ userData }, entries = []) => userData.entries.length === entries.length
  && userData.entries.every(({ place, coarse }, i) => place.object === entries[i].place.object && coarse === entries[i].coarse);

/** Everything but places with levels of detail, which choose for themselves. */
export class Merged {
  /** @param three of WornPage, @param page whose materials count when a piece is made */
  constructor(three, page) {
    Object.assign(this, { three, page, group: new THREE.Group(), pieces: new Map(), places: [] });
    this.update();
  }

  /** Takes the surfaces that are there now: pieces of which a part came, went or changed are made anew. */
  update() {
    const { three } = this, wanted = new Map();
    this.places = three.surface.places.filter(({ object }) => object.parent === three.root);
    for (const entry of chosen(this.places)) {
      const { mesh } = entry.place.object.userData, key = `${mesh.material} ${mesh.uv}`;
      if (!wanted.has(key)) wanted.set(key, { mesh, entries: [] });
      wanted.get(key).entries.push(entry);
    }
    for (const [key, piece] of this.pieces) if (!isMadeOf(piece, wanted.get(key)?.entries)) this.remove(key, piece);
    for (const [key, { mesh, entries }] of wanted) {
      if (!this.pieces.has(key)) this.add(key, mesh, entries);
      this.pieces.get(key).userData.standard = three.standard[mesh.material] ?? three.plain;
    }
    if (this.group.parent) this.show(true);
  }

  add(key, mesh, entries) {
    const piece = new THREE.Mesh(mergeGeometries(entries.map(placedGeometry))), material = this.page.scene.materials[mesh.material];
    piece.userData = { entries, shader: shadingOf(material, mesh, false), material };
    this.pieces.set(key, piece);
    this.group.add(piece);
  }

  remove(key, piece) {
    this.pieces.delete(key);
    this.group.remove(piece);
    piece.geometry.dispose();
    piece.userData.shader.dispose();
  }

  view(view, range) {
    for (const piece of this.group.children) {
      piece.material = view.kind === 0 ? piece.userData.standard : piece.userData.shader;
      applyView(piece.userData.shader, view, range, piece.userData.material);
    }
  }

  /** The pieces stand in for the parts, or leave again. */
  show(on) {
    for (const { object } of this.places) object.visible = !on;
    if (on) this.three.scene.add(this.group);
    else this.three.scene.remove(this.group);
  }

  dispose() { for (const [key, piece] of this.pieces) this.remove(key, piece); }
}

/** Textures of materials, each once. */
const texturesOf = (materials) => [...new Set(materials.flatMap((material) => MAPS.map((map) => material[map]).filter(Boolean)))];

export const bytesOfTextures = (materials) => texturesOf(materials).reduce((sum, texture) => sum + textureBytes(texture), 0);

/** Halves the largest pictures until all fit. @returns their bytes then */
export function fitTextures(materials, most = MOST_TEXTURE_BYTES) {
  const textures = texturesOf(materials).filter(({ image }) => image instanceof ImageBitmap);
  for (let bytes = bytesOfTextures(materials); bytes > most; bytes = bytesOfTextures(materials)) {
    const largest = textures.reduce((a, b) => textureBytes(b) > textureBytes(a) ? b : a, textures[0]);
    if (!largest || largest.image.width < 2 || largest.image.height < 2) break;
    const { width, height } = largest.image, half = new OffscreenCanvas(width >> 1, height >> 1);
    half.getContext('2d').drawImage(largest.image, 0, 0, half.width, half.height);
    largest.dispose();
    largest.image = half.transferToImageBitmap();
    largest.needsUpdate = true;
  }
  return bytesOfTextures(materials);
}
