// SPDX-License-Identifier: MIT
// The page's force against closed forms.
import assert from 'node:assert/strict';
import { forceAt, sample } from '../../page/src/force.mjs';

/** h = a sin(2 pi x / size) over 10 mm. */
function waves(a, samples = 256) {
  const mm = new Float32Array(samples * samples);
  for (let y = 0; y < samples; ++y) for (let x = 0; x < samples; ++x) mm[y * samples + x] = a * Math.sin(2 * Math.PI * (x + 0.5) / samples);
  return { relief: { width: samples, height: samples, mm }, size: [10, 10], mean: 0, stiffness: 1000, damping: 0, staticFriction: 0, dynamicFriction: 0, stribeckVelocity: 0.01 };
}
const near = (a, b, tolerance) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);

const surface = waves(0.2);
for (const x of [0.3, 2.5, 4.9, 9.99, 12.3, -0.4]) {
  const { h, slope } = sample(surface, x, 3.3);
  near(h, 0.2 * Math.sin(0.2 * Math.PI * x), 1e-6);
  near(slope[0], 0.04 * Math.PI * Math.cos(0.2 * Math.PI * x), 1e-4);
  near(slope[1], 0, 1e-6);
}

// On a plane: k times the depth, straight up; nothing when free.
const plane = waves(0);
near(forceAt(plane, 1, 1, 0.5, 0, 0).force[2], 0.5, 1e-9);
assert.equal(forceAt(plane, 1, 1, -0.1, 10, 0).total, 0);

// Coulomb friction against the way, far above the Stribeck velocity.
const rough = { ...plane, staticFriction: 0.8, dynamicFriction: 0.3 };
near(forceAt(rough, 1, 1, 0.5, 300, 0).force[0], -0.3 * 0.5, 1e-9);
near(forceAt(rough, 1, 1, 0.5, 1e-3, 0).friction, 0.8 * 0.5, 1e-4);

// On a slope the force stands on the surface, and is k times the depth along its normal.
const { force, normal } = forceAt(surface, 10, 0, 0.5, 0, 0);
const slope = 0.04 * Math.PI;
near(force[0] / force[2], -slope, 1e-4);
near(normal, 1000 * 0.5e-3 / Math.hypot(slope, 1), 1e-5);

// Damping resists the way up the slope and never pulls.
const damped = { ...surface, damping: 5 };
assert.ok(forceAt(damped, 10, 0, 0.5, 100, 0).normal > normal);
assert.equal(forceAt(damped, 10, 0, 0.5, -1e6, 0).normal, 0);
