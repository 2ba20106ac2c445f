// SPDX-License-Identifier: MIT
// How strongly a controller shakes while its tip passes over a relief. No page in here, so that it can be tested alone.
import { forceAt } from '../force.mjs';
import { FULL_SCALE, MASS_KG, Vibration, roundedOff } from '../vibration.mjs';

const RATE = 4000, WINDOW_S = 0.06;
/** Weaker pulses move no motor. */
export const LEAST = 0.01;

const amplitudeOf = (samples) => {
  const mean = samples.reduce((sum, x) => sum + x, 0) / samples.length;
  return Math.SQRT2 * Math.sqrt(samples.reduce((sum, x) => sum + (x - mean) ** 2, 0) / samples.length);
};

/**
 * Strength in [0, 1] of the pulse: s = rounded(√(a² + b²) / 50 m/s²), a the amplitude of the acceleration that the
 * relief gives to what follows it (Vibration), b = amplitude of the friction force / 20 g, both over the last 60 ms.
 * A relief A·sin(2πx/λ) passed at the speed v under stiffness k and friction μ has a = A(2πv/λ)², b = μkA/m, while the
 * tip does not leave it and v is far above the Stribeck velocity.
 */
export class Pulse {
  constructor() {
    this.vibration = new Vibration(RATE);
    this.lift();
  }

  lift() {
    this.vibration.lift();
    this.accelerations = [];
    this.frictions = [];
    this.last = null;
  }

  /** @param at mm in the relief, @param time s, @param depth mm below its mean */
  move(surface, at, time, depth) {
    const { last } = this;
    this.last = { at, time };
    this.accelerations.push(...this.vibration.move(surface, at, time, depth));
    if (last) this.addFriction(surface, last, at, time, depth);
    for (const list of [this.accelerations, this.frictions]) list.splice(0, list.length - WINDOW_S * RATE);
    if (!this.accelerations.length || !this.frictions.length) return 0;
    return roundedOff(Math.hypot(amplitudeOf(this.accelerations), amplitudeOf(this.frictions) / MASS_KG) / FULL_SCALE);
  }

  addFriction(surface, { at: from, time: before }, at, time, depth) {
    const seconds = Math.max(time - before, 1e-3), v = at.map((c, i) => (c - from[i]) / seconds), count = Math.min(Math.ceil(seconds * RATE), WINDOW_S * RATE);
    for (let i = 1; i <= count; ++i)
      this.frictions.push(forceAt(surface, ...at.map((c, k) => from[k] + (c - from[k]) * i / count), depth, ...v).friction);
  }
}
