// SPDX-License-Identifier: MIT
// Directions along a surface as an angle at one of its places. No page in here, so that it can be tested alone.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, s) => a.map((x) => s * x);
const sum = (a, b) => a.map((x, i) => x + b[i]);
const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));
const flattened = (a, normal) => sum(a, scaled(normal, -dot(a, normal)));

/** The place of a surface where its arrow stands: the centroid of the triangle that is nearest to that of all, with its normal. */
export function anchorOf({ positions, indices }) {
  const corner = (i) => [positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]];
  const triangles = [];
  let whole = 0, middle = [0, 0, 0];
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => corner(indices[i + k])), doubled = cross(sum(b, scaled(a, -1)), sum(c, scaled(a, -1))), area = Math.hypot(...doubled) / 2;
    if (!(area > 0)) continue;
    const centre = scaled(sum(sum(a, b), c), 1 / 3);
    triangles.push({ centre, normal: unit(doubled) });
    whole += area;
    middle = sum(middle, scaled(centre, area));
  }
  if (!triangles.length) return null;
  middle = scaled(middle, 1 / whole);
  const far = ({ centre }) => Math.hypot(...sum(centre, scaled(middle, -1)));
  const { centre: point, normal } = triangles.reduce((best, one) => far(one) < far(best) ? one : best);
  return { point, normal };
}

/** Axes of the angle: 0 is as upright as the surface allows, 90 degrees turn it counter-clockwise seen from outside. */
export function axesAt(normal, up) {
  let zero = flattened(up, normal);
  if (Math.hypot(...zero) < 1e-3) zero = flattened(Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], normal);
  zero = unit(zero);
  return { zero, quarter: cross(normal, zero) };
}

export function directionOf(degrees, { zero, quarter }) {
  const a = degrees * Math.PI / 180;
  return sum(scaled(zero, Math.cos(a)), scaled(quarter, Math.sin(a))).map((x) => Math.round(1e6 * x) / 1e6 + 0);
}

/** In [0, 360). */
export function angleOf(direction, { zero, quarter }) {
  const degrees = Math.atan2(dot(direction, quarter), dot(direction, zero)) * 180 / Math.PI;
  return (Math.round(10 * degrees) / 10 + 360) % 360;
}
