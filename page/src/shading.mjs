// SPDX-License-Identifier: MIT
// The material of all views but the textured one, for the scene and for the uv layout.
import * as THREE from 'three';
import { viridisBytes } from './colour.mjs';
import { mmPerUv } from './data.mjs';
import { texturePx } from './views.mjs';

const ramp = new THREE.DataTexture(viridisBytes(256), 256, 1);
ramp.magFilter = ramp.minFilter = THREE.LinearFilter;
ramp.needsUpdate = true;

const noHeight = new THREE.DataTexture(new Float32Array(1), 1, 1, THREE.RedFormat, THREE.FloatType);
noHeight.needsUpdate = true;

const WRAP = { repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping };
const heightTextures = new WeakMap();

function heightTexture(material) {
  const { relief, haptic } = material;
  if (!heightTextures.has(relief)) {
    const texture = new THREE.DataTexture(relief.mm, relief.width, relief.height, THREE.RedFormat, THREE.FloatType);
    texture.magFilter = texture.minFilter = THREE.NearestFilter;
    [texture.wrapS, texture.wrapT] = (haptic.height.wrap ?? ['repeat', 'repeat']).map((w) => WRAP[w] ?? WRAP.repeat);
    texture.needsUpdate = true;
    heightTextures.set(relief, texture);
  }
  return heightTextures.get(relief);
}

export function uvMatrix(transform) {
  const { offset = [0, 0], rotation = 0, scale = [1, 1] } = transform ?? {};
  const c = Math.cos(rotation), s = Math.sin(rotation);
  return new THREE.Matrix3(c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1], 0, 0, 1);
}

const vertexShader = `
attribute vec3 measured; attribute vec2 uv1;
varying vec3 vMeasured; varying vec3 vNormal; varying vec2 vUv, vHeightUv;
uniform bool flat_, heightOnUv1;
void main() {
  vMeasured = measured; vUv = uv; vHeightUv = heightOnUv1 ? uv1 : uv; vNormal = normalMatrix * normal;
  vec4 place = flat_ ? vec4(uv.x, -uv.y, 0.0, 1.0) : vec4(position, 1.0);
  gl_Position = projectionMatrix * modelViewMatrix * place;
}`;

const fragmentShader = `
varying vec3 vMeasured; varying vec3 vNormal; varying vec2 vUv, vHeightUv;
uniform bool flat_, hasUv, hasHeight, isLog;
uniform int kind; uniform float constant, texturePx; uniform vec2 range, cells;
uniform sampler2D ramp, heights; uniform mat3 heightMatrix;
vec3 hatch() { return mod(gl_FragCoord.x + gl_FragCoord.y, 8.0) < 2.0 ? vec3(0.35) : vec3(0.6); }
void main() {
  float light = flat_ ? 1.0 : 0.45 + 0.55 * abs(normalize(vNormal).z);
  vec3 colour;
  if (kind == 0) colour = vec3(0.62, 0.68, 0.74);
  else if (kind == 1) {
    vec2 cell = floor(vUv * cells);
    colour = !hasUv ? hatch() : mod(cell.x + cell.y, 2.0) < 0.5 ? vec3(0.93) : vec3(0.16);
  } else {
    float value = constant; bool has = constant >= 0.0;
    if (kind == 2) { value = vMeasured.x; has = value >= 0.0; }
    if (kind == 3) { value = vMeasured.y; has = value >= 0.0; }
    if (kind == 4) { value = vMeasured.z * texturePx; has = value >= 0.0; }
    if (kind == 6) { value = texture2D(heights, (heightMatrix * vec3(vHeightUv, 1.0)).xy).r; has = hasHeight && hasUv; }
    float t = isLog ? log(max(value, 1e-9) / range.x) / log(range.y / range.x) : (value - range.x) / max(range.y - range.x, 1e-9);
    colour = texture2D(ramp, vec2(clamp(t, 0.002, 0.998), 0.5)).rgb;
    if (kind >= 2 && kind <= 4) {
      float lines = abs(fract(t * 10.0) - 0.5) / max(fwidth(t * 10.0), 1e-6);
      if (lines < 0.7 && t > 0.0 && t < 1.0 && fwidth(t * 10.0) < 0.5) colour *= 0.35;
    }
    if (!has) colour = hatch();
  }
  gl_FragColor = vec4(colour * light, 1.0);
}`;

/** What a client draws: glTF's back sides are not, unless the material says so. */
export const sideOf = (material) => material?.double_sided ? THREE.DoubleSide : THREE.FrontSide;

/** @param flat drawn in the plane of its uv */
export function shadingOf(material, mesh, flat) {
  const perUv = mmPerUv(material);
  const shader = new THREE.ShaderMaterial({
    vertexShader, fragmentShader, side: flat ? THREE.DoubleSide : sideOf(material),
    uniforms: {
      flat_: { value: flat }, hasUv: { value: mesh.uv }, hasHeight: { value: Boolean(material?.relief) }, isLog: { value: false },
      kind: { value: 0 }, constant: { value: -1 }, texturePx: { value: texturePx(material) }, range: { value: new THREE.Vector2(0, 1) },
      cells: { value: new THREE.Vector2(perUv ? perUv[0] / 10 : 8, perUv ? perUv[1] / 10 : 8) },
      ramp: { value: ramp }, heights: { value: material?.relief ? heightTexture(material) : noHeight },
      heightOnUv1: { value: material?.haptic?.height?.texCoord === 1 },
      heightMatrix: { value: uvMatrix(material?.haptic?.height?.uvTransform) },
    },
  });
  return shader;
}

export function applyView(shader, view, range, material) {
  const { uniforms } = shader;
  uniforms.kind.value = view.kind;
  uniforms.isLog.value = Boolean(view.log);
  uniforms.range.value.set(...range);
  uniforms.constant.value = view.of && material?.haptic ? view.of(material.haptic) : -1;
}
