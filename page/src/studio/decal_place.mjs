// SPDX-License-Identifier: MIT
// Where a decal lies and how it is turned, as keys of MATERIALS.json. No page in here, so that it can be tested alone.
import { angleOf, axesAt, directionOf } from './direction.mjs';

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (a, s, b) => a.map((x, i) => x + s * b[i]);
const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));
const rounded = (numbers, digits) => numbers.map((x) => Number(x.toFixed(digits)) + 0);

/** A decal in the middle of which a point lies, which looks against a normal, turned by degrees: 0 is as upright as the surface allows, and they grow counter-clockwise. */
export const placedAt = (point, normal, sceneUp, degrees) => ({ at: rounded(point, 3), direction: rounded(normal.map((x) => -x), 6), up: directionOf(degrees, axesAt(unit(normal), sceneUp)) });

/** Unit axes of a decal: right of the picture, up the picture, out of the surface. */
export function axesOf({ direction, up }) {
  const forward = unit(direction), right = unit(cross(forward, up));
  return { right, up: cross(right, forward), out: forward.map((x) => -x) };
}

export function turnOf(decal, sceneUp) {
  const { out, up } = axesOf(decal);
  return angleOf(up, axesAt(out, sceneUp));
}

export const turnedTo = (decal, sceneUp, degrees) => placedAt(decal.at, axesOf(decal).out, sceneUp, (degrees % 360 + 360) % 360);

/** The place that lies so many millimetres right of the picture's middle, and above it. */
export function movedBy(decal, right, up) {
  const axes = axesOf(decal);
  return along(along(decal.at, right, axes.right), up, axes.up);
}

/** The corners of the picture's plane, from the lower left one on, and the end of a mark that points up from the middle of its upper edge. */
export function frameOf(decal) {
  const [width, height] = decal.size_mm, corner = (x, y) => movedBy(decal, x * width / 2, y * height / 2);
  return { corners: [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)], mark: [corner(0, 1), movedBy(decal, 0, height / 2 + Math.min(width, height) / 5)] };
}

const PREFERRED_MM = 80, LEAST_DEPTH_MM = 5;

/** Of a new decal: at most a quarter of the scene wide, as deep as half of its longer side. */
export function firstSize([pxWidth, pxHeight], diagonalMm) {
  const digits = (x) => Number(x.toPrecision(3)), width = digits(Math.min(PREFERRED_MM, diagonalMm / 4)), height = digits(width * pxHeight / pxWidth);
  return { size_mm: [width, height], depth_mm: digits(Math.max(LEAST_DEPTH_MM, Math.max(width, height) / 2)) };
}

const SELECTORS = ['part', 'mesh', 'node', 'instance', 'assembly', 'layer', 'cad_material', 'cad_colour', 'gltf_material', 'not'];

/** Whether it is for some surfaces alone. */
export const isForSome = (decal) => SELECTORS.some((key) => key in decal);

/** Whether it is for one part that is named as the studio does it, so that it may be given to another. */
export const isForOnePart = (decal) => 'part' in decal && SELECTORS.every((key) => !(key in decal) || (['part', 'node'].includes(key) && !/(^|[^\\])[*?[]/.test(decal[key])));
