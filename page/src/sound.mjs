// SPDX-License-Identifier: MIT
// The force as sound: what changes of it along the way that the probe went, in the time that it took.
import { forceAt } from './force.mjs';

const MOST_SECONDS = 0.12;

export class Sound {
  async start() {
    this.context ??= new AudioContext();
    await this.context.resume();
    this.end = 0;
    this.on = true;
    this.slow = 0;
  }

  stop() {
    this.on = false;
    return this.context?.suspend();
  }

  /** The probe went from a to b (mm) in `seconds`. */
  play(surface, a, b, seconds, depth) {
    if (!this.on) return;
    const rate = this.context.sampleRate, count = Math.floor(Math.min(seconds, MOST_SECONDS) * rate);
    if (count < 32) return;
    const buffer = this.context.createBuffer(1, count, rate), out = buffer.getChannelData(0);
    const vx = (b[0] - a[0]) / seconds, vy = (b[1] - a[1]) / seconds;
    for (let i = 0; i < count; ++i) {
      const t = i / count;
      const { total } = forceAt(surface, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), depth, vx, vy);
      if (!this.primed) { this.slow = total; this.primed = true; }
      this.slow += (total - this.slow) * 125 / rate;  // what is below about 20 Hz is felt, not heard
      out[i] = Math.tanh(4 * (total - this.slow));
    }
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.context.destination);
    const now = this.context.currentTime;
    if (this.end < now || this.end > now + 0.15) this.end = now + 0.01;
    source.start(this.end);
    this.end += count / rate;
  }
}
