// SPDX-License-Identifier: MIT
// Pictures on a slow machine: while they change they are drawn in half the resolution, down to a quarter where a full one
// takes a second; the longer that is, the longer it waits for the next change before it begins one.
const SLOW_MS = 30, MOVING_MS = 60;
const REST_MS = 250, LONGEST_REST_MS = 3000;
/** The first pictures wait for shaders and textures. */
const UNMEASURED = 2;
const LOOK_MS = 4;

export class Pace {
  /** @param onChange called with whether the picture is coarse now; it is to be drawn again */
  constructor(renderer, onChange) {
    Object.assign(this, { renderer, onChange, ratio: Math.min(window.devicePixelRatio, 2), pictures: 0, fullMs: 0, isCoarse: false, isHeld: false });
    renderer.setPixelRatio(this.ratio);
  }

  /** Of every change that more will follow soon. */
  changing() {
    if (this.fullMs > SLOW_MS) this.setCoarse(true);
    clearTimeout(this.resting);
    if (!this.isHeld) this.resting = setTimeout(() => this.setCoarse(false), Math.min(Math.max(REST_MS, this.fullMs / 2), LONGEST_REST_MS));
  }

  /** While changes are under way, as whoever makes them needs the processors that a full picture would take. */
  hold(isHeld) {
    if (this.isHeld === isHeld) return;
    this.isHeld = isHeld;
    if (isHeld) clearTimeout(this.resting);
    else if (this.isCoarse) this.changing();
  }

  setCoarse(isCoarse) {
    if (this.isCoarse === isCoarse || this.renderer.xr.isPresenting) return;
    this.isCoarse = isCoarse;
    const divisor = Math.min(Math.max(Math.sqrt(this.fullMs / MOVING_MS), 2), 4);
    this.renderer.setPixelRatio(isCoarse ? this.ratio / divisor : this.ratio);
    this.onChange(isCoarse);
  }

  draw(render) {
    const begin = performance.now();
    render();
    if (++this.pictures > UNMEASURED && !this.isCoarse && !this.fence) this.measure(begin);
  }

  /** How long a full picture takes, without waiting for it. */
  measure(begin) {
    const gl = this.renderer.getContext();
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost()) return setTimeout(look, LOOK_MS);
      gl.deleteSync(this.fence);
      this.fence = null;
      this.fullMs = performance.now() - begin;
      return undefined;
    };
    setTimeout(look, LOOK_MS);
  }
}
