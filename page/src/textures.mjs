// SPDX-License-Identifier: MIT
// Pictures and pixels of the page's data as textures of the scene.
import * as THREE from 'three';
import { bytesOf } from './data.mjs';
import { uvMatrix } from './shading.mjs';

const GL_WRAP = { 33071: THREE.ClampToEdgeWrapping, 33648: THREE.MirroredRepeatWrapping };

/** An equirectangular picture of linear light, coded as RGBE, rows from the top. */
export function environmentTexture({ width, height, rgbe }) {
  const bytes = bytesOf(rgbe), half = new Uint16Array(4 * width * height), one = THREE.DataUtils.toHalfFloat(1), most = 65504;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const from = 4 * (width * y + x), to = 4 * (width * (height - 1 - y) + x), scale = 2 ** (bytes[from + 3] - 136);
      for (let k = 0; k < 3; ++k) half[to + k] = THREE.DataUtils.toHalfFloat(Math.min(bytes[from + k] * scale, most));
      half[to + 3] = one;
    }
  const texture = new THREE.DataTexture(half, width, height, THREE.RGBAFormat, THREE.HalfFloatType, THREE.EquirectangularReflectionMapping,
    THREE.RepeatWrapping, THREE.ClampToEdgeWrapping, THREE.LinearFilter, THREE.LinearFilter);
  texture.needsUpdate = true;
  return texture;
}

export async function textureOf(scene, reference, isColour) {
  const image = reference && scene.images[reference.image];
  if (!image) return null;
  const bitmap = await createImageBitmap(new Blob([bytesOf(image.bytes)], { type: image.type }), { colorSpaceConversion: 'none' })
    .catch(() => null);  // A format that this browser does not know, or a damaged picture: drawn without it.
  if (!bitmap) return null;
  return placed(new THREE.Texture(bitmap), reference, isColour);
}

/** Lays a texture where a reference has it. */
export function placed(texture, reference, isColour) {
  texture.flipY = false;
  texture.colorSpace = isColour ? THREE.SRGBColorSpace : THREE.NoColorSpace;
  [texture.wrapS, texture.wrapT] = reference.wrap.map((w) => GL_WRAP[w] ?? THREE.RepeatWrapping);
  texture.anisotropy = 8;
  texture.channel = reference.tex_coord;
  texture.matrixAutoUpdate = false;
  texture.matrix.copy(uvMatrix(reference));
  texture.needsUpdate = true;
  return texture;
}

/** Pixels as a texture at a reference's place: `before` with new ones, where it has their size. */
export function pixelTexture(before, pixels, { width, height }, reference, isColour) {
  if (!pixels) return before?.dispose() ?? null;
  if (before?.isDataTexture && before.image.width === width && before.image.height === height) {
    before.image.data = pixels;
    before.needsUpdate = true;
    return before;
  }
  before?.dispose();
  const texture = placed(new THREE.DataTexture(pixels, width, height), reference, isColour);
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  return texture;
}

/** Bytes of a texture with its mipmaps on the card, uncompressed as browsers upload it. */
export function textureBytes(texture) {
  const { width = 0, height = 0 } = texture.image ?? {};
  return width * height * (texture.type === THREE.HalfFloatType ? 8 : 4) * 4 / 3;
}
