// SPDX-License-Identifier: MIT
// The page's vibration against closed forms: frequency v/λ, amplitude A (2πv/λ)², no clicks.
import assert from 'node:assert/strict';
import { Vibration, roundedOff } from '../../page/src/vibration.mjs';

const RATE = 48000;

/** Waves of the length `wave` (mm) along x over 16 mm; so stiff that the load limits nothing. */
function surfaceOf(amplitude, wave) {
  const width = 1024, height = 4, mm = new Float32Array(width * height);
  for (let i = 0; i < mm.length; ++i) mm[i] = amplitude * Math.sin(2 * Math.PI * (i % width + 0.5) / width * 16 / wave);
  return { relief: { width, height, mm }, size: [16, 16], mean: 0, stiffness: 1e6, damping: 0, staticFriction: 0, dynamicFriction: 0, stribeckVelocity: 0.01 };
}

/** A stroke of places that come at uneven times, as those of a mouse do. */
function stroke(surface, speed, seconds, { depth = 1, lifts = () => false } = {}) {
  const vibration = new Vibration(RATE), samples = [];
  let time = 0;
  for (let i = 0; time < seconds; ++i) {
    if (lifts(i)) vibration.lift();
    samples.push(...vibration.move(surface, [1 + speed * time, 2], time, depth));
    time += 0.012 + 0.008 * (i * 7919 % 13) / 13;
  }
  return samples;
}

function toneOf(samples) {
  const rest = samples.slice(samples.length >> 2), crossings = [];
  for (let i = 0; i + 1 < rest.length; ++i) if (rest[i] <= 0 && rest[i + 1] > 0) crossings.push(i + rest[i] / (rest[i] - rest[i + 1]));
  const hz = (crossings.length - 1) * RATE / (crossings.at(-1) - crossings[0]);
  return { hz, amplitude: Math.sqrt(2 * rest.reduce((sum, a) => sum + a * a, 0) / rest.length) };
}
const near = (a, b, share, what) => assert.ok(Math.abs(a - b) <= share * Math.abs(b), `${what}: ${a} is not ${b}`);

for (const [wave, speed] of [[2, 100], [1, 100], [4, 80], [0.5, 100], [2, 130], [0.25, 200]]) {
  const amplitude = 5e-3, hz = speed / wave, tone = toneOf(stroke(surfaceOf(amplitude, wave), speed, 0.6));
  near(tone.hz, hz, 5e-3, `${wave} mm at ${speed} mm/s`);
  near(tone.amplitude, amplitude / 1000 * (2 * Math.PI * hz) ** 2, 0.03, `${wave} mm at ${speed} mm/s`);
}

// Beyond the band, 2500 Hz: nothing.
{
  const hz = 2500, tone = toneOf(stroke(surfaceOf(2e-3, 0.125), 312.5, 0.4));
  assert.ok(tone.amplitude < 2e-3 * 2e-6 * (2 * Math.PI * hz) ** 2, `${tone.amplitude}`);
}

// A light hand is thrown off no faster than it presses, and no contact makes no sound.
{
  const light = { ...surfaceOf(0.05, 1), stiffness: 100 };
  const samples = stroke(light, 200, 0.4, { depth: 2 });
  const most = 100 * 2.05e-3 / 0.02;
  assert.ok(samples.every((a) => Math.abs(a) <= most));
  assert.ok(samples.every((a) => Number.isFinite(a)));
  assert.ok(stroke(light, 200, 0.4, { depth: -2 }).every((a) => a === 0));
}

// Contact that begins and ends clicks not: nothing beyond the waves' own amplitude.
{
  const amplitude = 0.02, hz = 100, samples = stroke(surfaceOf(amplitude, 1), 100, 1, { lifts: (i) => i % 5 === 0 });
  assert.ok(samples.length > 0);
  const largest = samples.reduce((most, a) => Math.max(most, Math.abs(a)), 0);
  assert.ok(largest < 1.3 * amplitude / 1000 * (2 * Math.PI * hz) ** 2, `${largest}`);
}

// The shoulder of the full scale.
assert.equal(roundedOff(0.4), 0.4);
assert.ok(Math.abs(roundedOff(-1e3) + 1) < 1e-9);
assert.ok(Math.abs(roundedOff(0.5 + 1e-6) - 0.5 - 1e-6) < 1e-9);
