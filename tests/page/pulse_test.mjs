// SPDX-License-Identifier: MIT
// The strength of a controller's pulses against its closed form.
import assert from 'node:assert/strict';
import { LEAST, Pulse } from '../../page/src/xr/pulse.mjs';
import { strengthOf, waves } from './waves.mjs';

const FRAME = 1 / 72;

/** The strength after a stroke of `speed` mm/s at `depth` mm over a wave's surface. */
function stroke(surface, speed, depth) {
  const pulse = new Pulse();
  let strength = 0;
  for (let i = 0; i < 30; ++i) strength = pulse.move(surface, [speed * i * FRAME, 3], i * FRAME, depth);
  return strength;
}

// Whole waves in the 60 ms that are looked at: v/λ a multiple of 50/3 Hz.
for (const [amplitude, wave, speed, stiffness, friction] of [[0.02, 2, 100, 1000, 0], [0.02, 2, 100, 1000, 0.3], [0.01, 1, 100, 2000, 0.5], [0.04, 2, 200, 4000, 0.2], [0.05, 4, 200, 3000, 0.4]]) {
  const surface = waves({ amplitude, wave, stiffness, friction }), found = stroke(surface, speed, 1), wanted = strengthOf({ amplitude, wave, speed, stiffness, friction });
  assert.ok(Math.abs(found - wanted) < 0.06 * wanted, `A ${amplitude} mm, λ ${wave} mm, v ${speed} mm/s, k ${stiffness}, μ ${friction}: ${found} is not ${wanted}`);
}

// More of anything that is felt is more; nothing where nothing moves, on a plane, or in the air.
const base = { amplitude: 0.02, wave: 2, stiffness: 1000, friction: 0.3 };
assert.ok(stroke(waves({ ...base, amplitude: 0.04 }), 100, 1) > 1.8 * stroke(waves(base), 100, 1));
assert.ok(stroke(waves(base), 200, 1) > 3 * stroke(waves(base), 100, 1));
assert.ok(stroke(waves({ ...base, friction: 0.9, stiffness: 8000 }), 100, 1) > 1.5 * stroke(waves({ ...base, stiffness: 8000 }), 100, 1));
assert.ok(stroke(waves({ ...base, amplitude: 0 }), 100, 1) < LEAST);
assert.equal(stroke(waves(base), 100, -1), 0);
assert.ok(stroke(waves(base), 0, 1) < LEAST);
assert.ok(stroke(waves({ ...base, amplitude: 0.4, stiffness: 1e5 }), 400, 3) <= 1);
