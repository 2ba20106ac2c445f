// SPDX-License-Identifier: MIT
// The vibration of the stroke under the mouse as sound, in the time that it took.
import { FULL_SCALE, Vibration, roundedOff } from './vibration.mjs';

const MOST_SECONDS = 0.12;

export class Sound {
  async start() {
    this.context ??= new AudioContext();
    await this.context.resume();
    this.vibration = new Vibration(this.context.sampleRate);
    this.end = 0;
    this.on = true;
  }

  stop() {
    this.on = false;
    return this.context?.suspend();
  }

  /** The probe was lifted. */
  lift() { this.vibration?.lift(); }

  /** The probe is at `at` (mm) at a time (s). */
  play(surface, at, time, depth) {
    if (!this.on) return;
    if (time - this.last > MOST_SECONDS) this.lift();
    this.last = time;
    const samples = this.vibration.move(surface, at, time, depth);
    if (samples.length) this.queue(samples.map((a) => roundedOff(a / FULL_SCALE)), this.context.sampleRate);
  }

  /** Plays samples in [-1, 1] after those before them. */
  queue(samples, rate) {
    if (!this.on) return;
    const buffer = this.context.createBuffer(1, samples.length, rate);
    buffer.copyToChannel(samples, 0);
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.context.destination);
    const now = this.context.currentTime;
    if (this.end < now || this.end > now + 0.15) this.end = now + 0.01;
    source.start(this.end);
    this.end += samples.length / rate;
  }
}
