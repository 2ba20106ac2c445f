// SPDX-License-Identifier: MIT
// A photograph with its lattice, and the cell that repeats.
import { number } from './colour.mjs';

/** A photograph over the whole canvas, and on it the lines of a lattice of these vectors; `size` is what the photograph shows, in their unit. */
export function drawLattice(canvas, image, vectors, size) {
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  if (!vectors) return;
  const px = vectors.map(([x, y]) => [x / size[0] * canvas.width, y / size[1] * canvas.height]);
  for (const [width, colour] of [[3, '#000'], [1.2, '#ffb000']]) {
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.beginPath();
    for (let k = -60; k <= 60; ++k)
      for (const [a, b] of [[px[0], px[1]], [px[1], px[0]]]) {
        context.moveTo(k * a[0] - 60 * b[0], k * a[1] - 60 * b[1]);
        context.lineTo(k * a[0] + 60 * b[0], k * a[1] + 60 * b[1]);
      }
    context.stroke();
  }
}

/** The unit cell of the lattice, as large as fits. */
export function drawPrimitive(canvas, image, vectors, size) {
  const context = canvas.getContext('2d');
  const px = vectors.map(([x, y]) => [x / size[0] * image.width, y / size[1] * image.height]);
  // The cell that begins within the picture, whose borders need not match.
  const first = [0, 1].map((k) => Math.max(0, -px[0][k]) + Math.max(0, -px[1][k]));
  const corners = [[0, 0], px[0], [px[0][0] + px[1][0], px[0][1] + px[1][1]], px[1]].map((c) => c.map((x, k) => x + first[k]));
  const low = [0, 1].map((k) => Math.min(...corners.map((c) => c[k]))), high = [0, 1].map((k) => Math.max(...corners.map((c) => c[k])));
  const scale = 0.96 * canvas.width / Math.max(high[0] - low[0], high[1] - low[1]);
  context.translate(canvas.width / 2, canvas.height / 2);
  context.scale(scale, scale);
  context.translate(-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2);
  context.beginPath();
  corners.forEach((c) => context.lineTo(...c));
  context.closePath();
  context.clip();
  for (const x of [-1, 0, 1]) for (const y of [-1, 0, 1]) context.drawImage(image, x * image.width, y * image.height);
}

/** Length in mm and angle from the picture's rows, upwards, of a vector whose y runs down. */
export function vectorText([x, y]) {
  const length = Math.hypot(x, y), degrees = Math.round(10 * Math.atan2(-y, x) * 180 / Math.PI) / 10;
  return `${number(length)} mm, ${number(degrees === 0 ? 0 : degrees)}°`;
}
