// SPDX-License-Identifier: MIT
// A picture whose left half is red and whose right half is transparent, and the pixels of pictures.
import { decode, encode } from 'fast-png';

export function halves(width, height) {
  const data = new Uint8Array(4 * width * height);
  for (let i = 0; i < width * height; ++i) if (i % width < width / 2) data.set([255, 0, 0, 255], 4 * i);
  return Buffer.from(encode({ width, height, data, depth: 8, channels: 4 }));
}

/** Whether a pixel of a PNG is red above all. */
export function isRed(png, x, y) {
  const { width, channels, data } = decode(png), [r, g, b] = data.slice(channels * (width * Math.round(y) + Math.round(x)));
  return r > 60 && r > 2 * g && r > 2 * b;
}
