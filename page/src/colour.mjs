// SPDX-License-Identifier: MIT
// Viridis, which grows evenly in lightness for every kind of colour vision: nine of its colours, sRGB.
const STOPS = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [110, 206, 88], [253, 231, 37]];

export function viridis(t) {
  const x = Math.min(Math.max(t, 0), 1) * (STOPS.length - 1);
  const i = Math.min(Math.floor(x), STOPS.length - 2);
  return STOPS[i].map((low, k) => low + (STOPS[i + 1][k] - low) * (x - i));
}

export function viridisBytes(count) {
  const bytes = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) bytes.set([...viridis(i / (count - 1)).map(Math.round), 255], 4 * i);
  return bytes;
}

/** Three significant digits. */
export const number = (x) => Number.isFinite(x) ? String(Number(x.toPrecision(3))) : '–';
