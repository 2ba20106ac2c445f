// SPDX-License-Identifier: MIT
// The views: what is drawn, over which range, and why a view is off.
import { mmPerUv } from './data.mjs';

const NO_UV = 'no part has texture coordinates';
const NO_TAG = 'no material has a haptic tag (extras.haptic): the file was not baked by Papilla, or the tag was lost';
const NO_MAP = 'no material has a height map that can be read';

export const texturePx = (material) => material?.relief?.width ?? 1024;

/** A value of every material or vertex; `kind` is the shader's number. `log` scales are of powers. */
export const VIEWS = [
  { id: 'textured', name: 'textured', kind: 0 },
  { id: 'checker', name: 'checker', kind: 1, needs: 'uv' },
  { id: 'stretch', name: 'stretch', kind: 2, needs: 'uv', column: 0, unit: '', log: true, centre: 1, what: 'Stretch L2 (1: none)' },
  { id: 'angle', name: 'angle', kind: 3, needs: 'uv', column: 1, unit: '°', what: 'Error of corner angles' },
  { id: 'density', name: 'texel density', kind: 4, needs: 'uv', column: 2, unit: 'texels/mm', log: true, what: 'Texel density (1024 px a repeat without height map)' },
  { id: 'stiffness', name: 'stiffness', kind: 5, needs: 'tag', unit: 'N/m', what: 'Stiffness', of: (tag) => tag.stiffness ?? 500 },
  { id: 'friction', name: 'friction', kind: 5, needs: 'tag', unit: '', what: 'Dynamic friction', of: (tag) => tag.dynamicFriction ?? tag.staticFriction ?? 0 },
  { id: 'height', name: 'height', kind: 6, needs: 'map', unit: 'mm', what: 'Height of the relief' },
];

/** Why a view can't be shown, or nothing. */
export function reasonOff(view, scene) {
  const hasUv = scene.parts.some((part) => part.meshes.some((mesh) => mesh.uv));
  if (view.needs === 'uv' && !hasUv) return NO_UV;
  if (view.needs === 'tag' && !scene.materials.some((m) => m.haptic)) return NO_TAG;
  if (view.needs === 'map' && !scene.materials.some((m) => m.haptic)) return NO_TAG;
  if (view.needs === 'map' && !(hasUv && scene.materials.some((m) => m.relief))) return hasUv ? NO_MAP : NO_UV;
  return null;
}

/** The value that the view shows of a vertex of a material; NaN when there is none. */
export function valueOf(view, material, measured) {
  if (view.of) return material?.haptic ? view.of(material.haptic) : NaN;
  if (view.column === undefined || !(measured[view.column] >= 0)) return NaN;
  return view.id === 'density' ? measured[2] * texturePx(material) : measured[view.column];
}

function percentiles(values, low, high) {
  values.sort((a, b) => a - b);
  const at = (share) => values[Math.min(values.length - 1, Math.floor(share * values.length))];
  return [at(low), at(high)];
}

/** The ends of the view's scale over the whole scene. */
export function rangeOf(view, scene) {
  if (view.of) return [0, Math.max(...scene.materials.filter((m) => m.haptic).map((m) => view.of(m.haptic)), 1e-9)];
  if (view.id === 'height') {
    let low = Infinity, high = -Infinity;
    for (const { relief } of scene.materials) if (relief) for (const h of relief.mm) { low = Math.min(low, h); high = Math.max(high, h); }
    return [low, high];
  }
  if (view.column === undefined) return [0, 1];
  const values = [];
  for (const part of scene.parts)
    for (const mesh of part.meshes) {
      const { measured } = mesh.data, step = Math.max(1, Math.floor(mesh.vertices / 5000));
      for (let i = 0; i < mesh.vertices; i += step) {
        const value = valueOf(view, scene.materials[mesh.material], measured.subarray(3 * i, 3 * i + 3));
        if (Number.isFinite(value)) values.push(value);
      }
    }
  if (!values.length) return [0, 1];
  const [low, high] = percentiles(values, 0.01, 0.99);
  if (view.centre) {
    const far = Math.max(high, 1 / low, 1.05);
    return [1 / far, far];
  }
  if (view.log) return [low / 1.02, Math.max(high, 1.02 * low)];
  return [0, Math.max(high, 1)];
}

/** The value at a share of the view's scale. */
export const valueAt = (view, [low, high], t) => view.log ? low * (high / low) ** t : low + (high - low) * t;

export function legendText(view, checker) {
  if (view.id === 'textured') return 'as it is seen';
  if (view.id === 'checker') return checker;
  return 'A line every tenth of the scale; hatched where there is no value.';
}

export const checkerText = (scene) => scene.materials.some(mmPerUv) ? 'Squares of 10 mm; of an eighth of a repeat where the file gives no size.' : 'Squares of an eighth of a repeat; the file gives no size in mm.';
