// SPDX-License-Identifier: MIT
// The force on a point that slides over a relief. No page in here, so that it can be tested alone.

/** Catmull-Rom weights and their derivatives at t in [0, 1): the player's interpolation. */
function weights(t) {
  const t2 = t * t, t3 = t2 * t;
  return [
    [(-t3 + 2 * t2 - t) / 2, (3 * t3 - 5 * t2 + 2) / 2, (-3 * t3 + 4 * t2 + t) / 2, (t3 - t2) / 2],
    [(-3 * t2 + 4 * t - 1) / 2, (9 * t2 - 10 * t) / 2, (-9 * t2 + 8 * t + 1) / 2, (3 * t2 - 2 * t) / 2],
  ];
}

/** Height in mm and slope (mm per mm) of a relief that repeats, at (x, y) mm from its upper left corner. */
export function sample({ relief, size }, x, y) {
  const { width, height, mm } = relief;
  const px = x / size[0] * width - 0.5, py = y / size[1] * height - 0.5;
  const ix = Math.floor(px), iy = Math.floor(py);
  const [wx, dx] = weights(px - ix), [wy, dy] = weights(py - iy);
  const wrap = (i, n) => ((i % n) + n) % n;
  let h = 0, hx = 0, hy = 0;
  for (let j = 0; j < 4; ++j) {
    const row = wrap(iy + j - 1, height) * width;
    for (let i = 0; i < 4; ++i) {
      const v = mm[row + wrap(ix + i - 1, width)];
      h += wx[i] * wy[j] * v;
      hx += dx[i] * wy[j] * v;
      hy += wx[i] * dy[j] * v;
    }
  }
  return { h, slope: [hx * width / size[0], hy * height / size[1]] };
}

/** Force in newtons of a skin over its backing at a depth in metres: k·δ, beyond the backing's depth its own stiffness. */
export function springForce({ stiffness, backing }, depth) {
  const beyond = backing ? Math.max(0, depth - backing.depth) : 0;
  return stiffness * (depth - beyond) + (backing ? backing.stiffness * beyond : 0);
}

/**
 * The force in newtons on a point pressed to `depth` mm below the mean of the relief that moves with (vx, vy) mm/s.
 * n is the normal of the relief, δ the depth along it: F = n·max(0, springForce(δ) − b·(v·n)) − μ(|v|)·Fn along the way
 * it slides, μ = μd + (μs − μd)·exp(−(v/vs)²).
 */
export function forceAt(surface, x, y, depth, vx, vy) {
  const { h, slope } = sample(surface, x, y);
  const length = Math.hypot(slope[0], slope[1], 1);
  const n = [-slope[0] / length, -slope[1] / length, 1 / length];
  const delta = (h - surface.mean + depth) * n[2] / 1000;
  const along = (vx * n[0] + vy * n[1]) / 1000;
  const normal = delta > 0 ? Math.max(0, springForce(surface, delta) - surface.damping * along) : 0;
  const t = [vx / 1000 - along * n[0], vy / 1000 - along * n[1], -along * n[2]];
  const speed = Math.hypot(...t);
  const mu = surface.dynamicFriction + (surface.staticFriction - surface.dynamicFriction) * Math.exp(-((speed / surface.stribeckVelocity) ** 2));
  const friction = speed > 1e-9 ? mu * normal / speed : 0;
  const force = n.map((c, i) => c * normal - friction * t[i]);
  return { force, normal, friction: friction * speed, height: h, total: Math.hypot(...force) };
}

/** What forceAt() needs of a material; the tag's defaults where it is silent. */
export function surfaceOf({ haptic, relief }) {
  const still = haptic.staticFriction ?? haptic.dynamicFriction ?? 0;
  let sum = 0;
  for (const h of relief.mm) sum += h;
  const { metresPerUV = [1, 1], uvTransform = {} } = haptic.height;
  const scale = uvTransform.scale ?? [1, 1];
  return {
    relief, size: metresPerUV.map((m, i) => 1000 * m / Math.abs(scale[i] || 1)), mean: sum / relief.mm.length,
    stiffness: haptic.stiffness ?? 500, backing: haptic.backing, damping: haptic.damping ?? 0, staticFriction: still,
    dynamicFriction: haptic.dynamicFriction ?? still, stribeckVelocity: haptic.stribeckVelocity ?? 0.01,
  };
}
