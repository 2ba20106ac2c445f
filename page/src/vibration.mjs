// SPDX-License-Identifier: MIT
// The acceleration that a stroke over a relief gives to what follows it, as a signal: the player's formula and filters.
// No page in here, so that it can be tested alone.
import { forceAt, sample } from './force.mjs';

const LOW_HZ = 20, HIGH_HZ = 1000, FADE_S = 5e-3, RIPPLE_DB = 0.1, SECTIONS = 4, LEAST_LOAD_N = 1e-3;
/** Of what follows the surface. */
export const MASS_KG = 0.02;
/** m/s² that become 1. */
export const FULL_SCALE = 50;

/** A filter of order 2 in transposed direct form II. */
class Section {
  constructor(b, a) { [this.b, this.a, this.z1, this.z2] = [b, a, 0, 0]; }

  next(x) {
    const y = this.b[0] * x + this.z1;
    this.z1 = this.b[1] * x - this.a[0] * y + this.z2;
    this.z2 = this.b[2] * x - this.a[1] * y;
    return y;
  }
}

function butterworthHighPass(hz, rate) {
  const w = Math.tan(Math.PI * hz / rate), d = Math.SQRT2 * w, a0 = 1 + d + w * w;
  return new Section([1 / a0, -2 / a0, 1 / a0], [2 * (w * w - 1) / a0, (1 - d + w * w) / a0]);
}

/** Of order 8, the middle of its ripple at 1. */
function chebyshevLowPass(hz, rate) {
  const w = Math.tan(Math.PI * hz / rate), ripple = Math.sqrt(10 ** (RIPPLE_DB / 10) - 1);
  const order = 2 * SECTIONS, mu = Math.asinh(1 / ripple) / order, gain = 2 / (1 + Math.sqrt(1 + ripple * ripple));
  return Array.from({ length: SECTIONS }, (_, k) => {
    const angle = Math.PI * (2 * k + 1) / (2 * order);
    const re = w * Math.sinh(mu) * Math.sin(angle), im = w * Math.cosh(mu) * Math.cos(angle);
    const w2 = re * re + im * im, d = 2 * re, a0 = 1 + d + w2, b = (k === 0 ? gain : 1) * w2 / a0;
    return new Section([b, 2 * b, b], [2 * (w2 - 1) / a0, (1 - d + w2) / a0]);
  });
}

/** Linear up to half, then rounded off to 1. */
export function roundedOff(x) {
  const beyond = Math.abs(x) - 0.5;
  return beyond <= 0 ? x : Math.sign(x) * (0.5 + 0.5 * Math.tanh(2 * beyond));
}

/**
 * a = F/m · tanh(m/F · (B ∗ h″)): h the height in metres under the probe, read at every sample of the curve through its
 * places, B the band of 20 Hz to 1 kHz, F the normal force, m = 20 g. A relief A·sin(2πx/λ) passed at the speed v
 * sounds with v/λ and A·(2πv/λ)².
 */
export class Vibration {
  constructor(sampleRate) {
    this.rate = sampleRate;
    this.highPass = butterworthHighPass(LOW_HZ / 3, sampleRate);
    this.lowPass = chebyshevLowPass(HIGH_HZ, sampleRate);
    this.path = [];
    this.phase = this.touching = this.fade = this.height = this.before = 0;
  }

  /** The probe was lifted, or moved without having been followed. */
  lift() {
    this.path = [];
    this.touching = 0;
  }

  /**
   * Samples in m/s² of the way to the place before this one, whose velocity is known now.
   * @param at mm; @param time seconds; @param depth mm below the mean of the relief
   */
  move(surface, at, time, depth) {
    this.path.push({ at, time });
    if (this.path.length > 4) this.path.shift();
    const n = this.path.length;
    if (n < 3) return new Float32Array(0);
    const [p, b, c] = [this.path[Math.max(n - 4, 0)], this.path[n - 3], this.path[n - 2]];
    const velocity = (from, to) => to.at.map((x, i) => (x - from.at[i]) / (to.time - from.time));
    return this.segment(surface, b, c, velocity(p === b ? b : p, c), velocity(b, this.path[n - 1]), depth);
  }

  /** Along the cubic of Hermite from b to c. */
  segment(surface, b, c, vb, vc, depth) {
    const seconds = c.time - b.time, samples = [];
    let phase = this.phase;
    for (; phase < seconds * this.rate; phase += 1) {
      const t = phase / (seconds * this.rate), t2 = t * t, t3 = t2 * t;
      const at = b.at.map((x, i) => (2 * t3 - 3 * t2 + 1) * x + (t3 - 2 * t2 + t) * seconds * vb[i] + (3 * t2 - 2 * t3) * c.at[i] + (t3 - t2) * seconds * vc[i]);
      samples.push(this.next(sample(surface, ...at).h / 1000, forceAt(surface, ...at, depth, 0, 0).normal));
    }
    this.phase = phase - seconds * this.rate;
    return Float32Array.from(samples);
  }

  next(height, load) {
    const touches = load > LEAST_LOAD_N;
    let a = 0;
    if (touches) {
      // The first two heights of a contact make no difference of second order.
      if (++this.touching > 2) a = (height - 2 * this.height + this.before) * this.rate * this.rate;
      [this.before, this.height] = [this.height, height];
    } else {
      this.touching = 0;
    }
    a = this.lowPass.reduce((x, section) => section.next(x), this.highPass.next(a));
    this.fade = Math.min(Math.max(this.fade + (touches ? 1 : -1) / (FADE_S * this.rate), 0), 1);
    if (!touches) return 0;
    const most = load / MASS_KG;
    return (0.5 - 0.5 * Math.cos(Math.PI * this.fade)) * most * Math.tanh(a / most);
  }
}
