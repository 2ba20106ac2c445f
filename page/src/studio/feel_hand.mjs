// SPDX-License-Identifier: MIT
// The way of a hand that presses where the pointer is, as the server gets it. No page in here, so that it can be tested alone.

/** The hand comes from outside, and leaves again. */
export const APPROACH_MM = 4, APPROACH_S = 0.12, RETREAT_S = 0.06;

const along = (point, normal, mm) => point.map((x, i) => x + mm * normal[i]);

export class FeelHand {
  /** @param radius of the probe [mm]; its ball touches at a depth of 0 */
  constructor(radius) { Object.assign(this, { radius, spot: null, depth: 0, path: [], last: -1 }); }

  /** Where the pointer is on the surface: [x, y, z] mm, and the outward normal there. */
  move(point, normal, depth) { Object.assign(this, { spot: { point, normal }, depth }); }

  /** The hand at a time in seconds since the press. */
  at(t) {
    const { point, normal } = this.spot, share = Math.max(0, 1 - t / APPROACH_S);
    const away = this.lifted === undefined ? share * share : Math.min(1, (t - this.lifted) / RETREAT_S);
    const pressed = this.radius - this.depth;
    return along(point, normal, pressed + away * (APPROACH_MM + this.depth));
  }

  /** @returns a sample of the path for now, or nothing when it is no later than the last one */
  sample(t) {
    if (!(t > this.last)) return null;
    this.last = t;
    return [t, ...this.at(t)];
  }

  /** The samples of the way out, and when it ends. */
  lift(t) {
    const begin = this.lifted = Math.max(t, this.last, APPROACH_S);
    const samples = [0, 0.25, 0.5, 0.75, 1].map((share) => this.sample(begin + share * RETREAT_S)).filter(Boolean);
    return { samples, end: begin + RETREAT_S };
  }
}
