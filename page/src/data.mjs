// SPDX-License-Identifier: MIT
// What the program put into the page: JSON, and streams in base64.
import { MeshoptDecoder } from 'meshoptimizer/decoder';
import { decode as decodePng } from 'fast-png';

const NO_VALUE = 65535;

export function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Channel 1 where something lies on it, else the channel that is shown. */
function decodeUv1(mesh, uv) {
  if (!mesh.uv1_stream) return uv;
  const codes = new Uint16Array(2 * mesh.vertices), out = new Float32Array(2 * mesh.vertices);
  MeshoptDecoder.decodeVertexBuffer(new Uint8Array(codes.buffer), mesh.vertices, 4, bytesOf(mesh.uv1_stream));
  for (let i = 0; i < out.length; ++i) out[i] = mesh.uv1_low[i % 2] + (mesh.uv1_high[i % 2] - mesh.uv1_low[i % 2]) * codes[i] / 65535;
  return out;
}

/** The arrays of one mesh of a part: positions in mm, uv with v downwards, stretch, angle (degrees), uv units per mm. */
function decodeMesh(mesh) {
  const packed = new Uint8Array(24 * mesh.vertices);
  const indices = new Uint32Array(3 * mesh.shown);
  MeshoptDecoder.decodeVertexBuffer(packed, mesh.vertices, 24, bytesOf(mesh.vertex_stream));
  MeshoptDecoder.decodeIndexBuffer(new Uint8Array(indices.buffer), indices.length, 4, bytesOf(mesh.index_stream));
  const coarse = new Uint32Array(3 * mesh.coarse);
  MeshoptDecoder.decodeIndexBuffer(new Uint8Array(coarse.buffer), coarse.length, 4, bytesOf(mesh.coarse_stream));
  const u16 = new Uint16Array(packed.buffer), i8 = new Int8Array(packed.buffer), n = mesh.vertices;
  const out = { positions: new Float32Array(3 * n), normals: new Float32Array(3 * n), uv: new Float32Array(2 * n), measured: new Float32Array(3 * n), indices, coarse };
  const at = (code, low, high) => low + (high - low) * code / 65535;
  const fromLog = (code) => code === NO_VALUE ? -1 : 2 ** (code / 2048 - 16);
  for (let i = 0; i < n; ++i) {
    for (let k = 0; k < 3; ++k) {
      out.positions[3 * i + k] = at(u16[12 * i + k], mesh.low[k], mesh.high[k]);
      out.normals[3 * i + k] = i8[24 * i + 12 + k] / 127;
    }
    for (let k = 0; k < 2; ++k) out.uv[2 * i + k] = at(u16[12 * i + 4 + k], mesh.uv_low[k], mesh.uv_high[k]);
    const angle = u16[12 * i + 9];
    out.measured[3 * i] = fromLog(u16[12 * i + 8]);
    out.measured[3 * i + 1] = angle === NO_VALUE ? -1 : angle * 180 / 65534;
    out.measured[3 * i + 2] = fromLog(u16[12 * i + 10]);
  }
  out.uv1 = decodeUv1(mesh, out.uv);
  return out;
}

/** A height map with all of its 16 bits: heights in mm, row by row from the top. @param bytes of a PNG */
export function decodeHeight(bytes, tag) {
  const png = decodePng(bytes);
  const full = 2 ** png.depth - 1, samples = png.data, channels = png.channels;
  const scale = tag.scale * 1000, offset = (tag.offset ?? 0) * 1000, black = tag.outward === 'black';
  const mm = new Float32Array(png.width * png.height);
  for (let i = 0; i < mm.length; ++i) {
    const v = samples[i * channels] / full;
    mm[i] = offset + scale * (black ? 1 - v : v);
  }
  return { width: png.width, height: png.height, depth: png.depth, levels: new Set(samples).size, mm };
}

export async function load() {
  const data = JSON.parse(document.getElementById('data').textContent);
  await MeshoptDecoder.ready;
  const { scene } = data;
  for (const part of scene.parts)
    for (const mesh of part.meshes) {
      mesh.data = decodeMesh(mesh);
      delete mesh.vertex_stream;
      delete mesh.uv1_stream;
      delete mesh.index_stream;
      delete mesh.coarse_stream;
    }
  scene.materials.forEach((material, index) => {
    material.index = index;
    if (material.height === null || !material.haptic) return;
    try {
      material.relief = decodeHeight(bytesOf(scene.heights[material.height].png), material.haptic.height);
    } catch (error) {
      material.warnings.push(`the page can't read the height map: ${error.message}`);
    }
  });
  return data;
}

/** Millimetres of surface per unit of uv, or null when the file does not say. */
export function mmPerUv(material) {
  const perUv = material?.haptic?.height?.metresPerUV;
  return perUv ? perUv.map((m) => 1000 * m) : null;
}
