// SPDX-License-Identifier: MIT
// Checker and distortion as shading, with the colours and the legend of a scale.
import * as THREE from 'three';
import { viridis } from '../colour.mjs';
import { applyView, shadingOf } from '../shading.mjs';
import { VIEWS } from '../views.mjs';

/** Cividis (Nuñez, Anderton and Renslow 2018): nine of its colours, sRGB. */
const CIVIDIS = [[0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120], [165, 156, 116], [195, 179, 105], [254, 232, 56]];

export function colourAt(map, t) {
  if (map === 'viridis') return viridis(t);
  const x = Math.min(Math.max(t, 0), 1) * (CIVIDIS.length - 1), i = Math.min(Math.floor(x), CIVIDIS.length - 2);
  return CIVIDIS[i].map((low, k) => low + (CIVIDIS[i + 1][k] - low) * (x - i));
}

const ramps = new Map();
export function rampOf(map) {
  if (ramps.has(map)) return ramps.get(map);
  const bytes = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) bytes.set([...colourAt(map, i / 255).map(Math.round), 255], 4 * i);
  const ramp = new THREE.DataTexture(bytes, 256, 1);
  ramp.magFilter = ramp.minFilter = THREE.LinearFilter;
  ramp.needsUpdate = true;
  ramps.set(map, ramp);
  return ramp;
}

/** Lets a section cut what a shader of the page draws. */
function cut(shader) {
  shader.clipping = true;
  shader.vertexShader = `#include <clipping_planes_pars_vertex>\n${shader.vertexShader.replace(/}\s*$/, '  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);\n#include <clipping_planes_vertex>\n}')}`;
  shader.fragmentShader = `#include <clipping_planes_pars_fragment>\n${shader.fragmentShader.replace('void main() {', 'void main() {\n#include <clipping_planes_fragment>')}`;
  return shader;
}

const viewOf = (id) => VIEWS.find((view) => view.id === id);
const COLUMN = { stretch: 0, angle: 1 };

/** @param mmPerUv [x, y], 0 where unknown */
export function overlayShader(hasUv, mmPerUv) {
  const shader = cut(shadingOf(null, { uv: hasUv }, false));
  shader.uniforms.cells.value.set(...mmPerUv.map((mm) => mm > 0 ? mm / 10 : 8));
  shader.side = THREE.DoubleSide;
  return shader;
}

export function applyOverlay(shader, id, range, map) {
  applyView(shader, viewOf(id), range, null);
  shader.uniforms.ramp.value = rampOf(map);
}

/** The scale over what is shown, from the first to the last hundredth; stretch about 1. */
export function rangeOf(id, surfaces) {
  const column = COLUMN[id], values = [];
  if (column === undefined) return [0, 1];
  for (const { measured } of surfaces) {
    const step = 2 * Math.max(1, Math.floor(measured.length / 4000));
    for (let i = column; i < measured.length; i += step) if (measured[i] >= 0) values.push(measured[i]);
  }
  values.sort((a, b) => a - b);
  if (!values.length) return id === 'stretch' ? [1 / 1.05, 1.05] : [0, 1];
  const at = (share) => values[Math.min(values.length - 1, Math.floor(share * values.length))];
  if (id === 'angle') return [0, Math.max(at(0.99), 1)];
  const far = Math.max(at(0.99), 1 / Math.max(at(0.01), 1e-6), 1.05);
  return [1 / far, far];
}
