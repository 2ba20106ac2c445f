// SPDX-License-Identifier: MIT
// Figures of S. Cho, S. Shin, S. Choi, Haptic texture rendering using random fractal surface, 2017.
import { lit } from './panels.mjs';

const surface = (hurst, size) => `papilla synthesize fractal --method cho --hurst ${hurst} --size ${size} --height-mm 8 --seed 3 -o h${hurst}-${size}.png --relief h${hurst}-${size}.exr`;

export const figures = [
  {
    number: '1', title: 'Midpoint displacement, iteration by iteration', columns: 4, tile: 240,
    panels: [3, 5, 9, 257].map((size) => lit(`${size} × ${size}`, `h0.75-${size}.exr`, surface(0.75, size), `--pitch ${(25.6 / (size - 1)).toFixed(4)}`)),
    differs: 'the corners of every size are drawn anew, so that the four are no refinements of each other',
  },
  {
    number: '2', title: 'Surfaces of H = 0.90 to 0.30', columns: 5, tile: 190,
    panels: ['0.90', '0.75', '0.60', '0.45', '0.30'].map((hurst) => lit(`H = ${hurst}`, `h${hurst}-257.exr`, surface(hurst, 257))),
    differs: 'lit instead of surfaces in perspective',
  },
];
