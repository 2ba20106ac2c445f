// SPDX-License-Identifier: MIT
// A relief A·sin(2πx/λ), as surface and as the PNG of a height map, and what a controller shakes by on it.

const SIZE_MM = 16, WIDTH = 512;

/** As of surfaceOf(); lengths in mm. */
export function waves({ amplitude, wave, stiffness, friction }) {
  const height = 4, mm = new Float32Array(WIDTH * height);
  for (let i = 0; i < mm.length; ++i) mm[i] = amplitude * Math.sin(2 * Math.PI * (i % WIDTH + 0.5) / WIDTH * SIZE_MM / wave);
  return { relief: { width: WIDTH, height, mm }, size: [SIZE_MM, SIZE_MM], mean: 0, stiffness, damping: 0, staticFriction: friction, dynamicFriction: friction, stribeckVelocity: 0.001 };
}

/** Rounded √(a² + b²) / 50 m/s², a = A(2πv/λ)², b = μkA/m with m = 20 g; far below where rounding begins. */
export function strengthOf({ amplitude, wave, speed, stiffness, friction }) {
  const a = amplitude / 1000 * (2 * Math.PI * speed / wave) ** 2, b = friction * stiffness * amplitude / 1000 / 0.02, s = Math.hypot(a, b) / 50;
  return s <= 0.5 ? s : 0.5 + 0.5 * Math.tanh(2 * (s - 0.5));
}
