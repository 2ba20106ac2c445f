// SPDX-License-Identifier: MIT
// Colours that every kind of colour vision tells apart, and numbers for people.

/** Viridis, which grows evenly in lightness: nine of its colours, sRGB. */
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

/** Curves of one plot: colours of Okabe and Ito (Color Universal Design, 2008), each with a dash of its own. */
const CURVES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#7f7f7f'];
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3], [4, 2], [12, 4], [1, 2]];
export const curve = (i) => ({ stroke: CURVES[i % CURVES.length], width: 2, dash: DASHES[(i + Math.floor(i / CURVES.length)) % DASHES.length] });

const TINY = 1e-4, GROUPED = 1e4;

/** Three significant digits without powers of ten, whole numbers with all of theirs; what is next to nothing is ~0. */
export function number(x) {
  if (!Number.isFinite(x)) return '–';
  if (x !== 0 && Math.abs(x) < TINY) return '~0';
  const shown = Number.isInteger(x) ? x : Number(x.toPrecision(3));
  return Math.abs(shown) >= GROUPED ? shown.toLocaleString('en') : String(shown);
}

/** Of a logarithmic axis, where small is not nothing. */
export const tick = (x) => Math.abs(Math.log10(x)) > 3 ? x.toExponential(0).replace('e+', 'e') : String(Number(x.toPrecision(3)));
