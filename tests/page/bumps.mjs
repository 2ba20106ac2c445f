// SPDX-License-Identifier: MIT
// A picture of bumps on an oblong lattice that is turned, as a camera would take it.
import { encode } from 'fast-png';

/** @param size [width, height] mm, @param pxPerMm, @param periods mm along the lattice's two axes, @param degrees from the picture's rows towards its columns @returns {png, vectors in mm, y down} */
export function bumps({ size, pxPerMm, periods, degrees }) {
  const a = degrees * Math.PI / 180, [c, s] = [Math.cos(a), Math.sin(a)], [width, height] = size.map((mm) => Math.round(mm * pxPerMm)), data = new Uint8Array(width * height);
  for (let j = 0; j < height; ++j)
    for (let i = 0; i < width; ++i) {
      const x = (i + 0.5) / pxPerMm, y = (j + 0.5) / pxPerMm, u = c * x + s * y, v = -s * x + c * y;
      data[j * width + i] = Math.round(127.5 + 55 * (Math.cos(2 * Math.PI * u / periods[0]) + Math.cos(2 * Math.PI * v / periods[1])));
    }
  return { png: Buffer.from(encode({ width, height, data, depth: 8, channels: 1 })), vectors: [[c * periods[0], s * periods[0]], [-s * periods[1], c * periods[1]]] };
}

/** Whether two vectors span the lattice of two others: each is a whole sum of them, and the cells are equally large. */
export function spanTheSame(found, vectors, tolerance) {
  const cross = ([ax, ay], [bx, by]) => ax * by - ay * bx, cell = cross(...vectors);
  const shares = found.map((v) => [cross(v, vectors[1]) / cell, cross(vectors[0], v) / cell]);
  return shares.flat().every((x) => Math.abs(x - Math.round(x)) < tolerance) && Math.abs(Math.abs(cross(...shares.map((v) => v.map(Math.round)))) - 1) < 1e-9;
}
