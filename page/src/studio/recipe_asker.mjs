// SPDX-License-Identifier: MIT
// Asks the server how a recipe looks: one request at a time, the newest text next, those between left out. What takes long
// is asked for coarsely while it changes.
import { ConnectionBroke, parseFramed, postBytes } from './api.mjs';
import { pixelsOf } from './recipe_picture.mjs';

const SIDE = 512, COARSE = 256, SLOW_MS = 100, REST_MS = 150, PATIENCE_MS = 500;

export class RecipeAsker {
  /** @param onAnswer({problem, textures, uses_time, needs_atlas, look, surfaces, under_way, surface_problems}, what was asked) @param onError(error) */
  constructor(onAnswer, onError) { Object.assign(this, { onAnswer, onError, wanted: null, answered: null, took: 0 }); }

  /** @param wanted {material, text, time} */
  ask(wanted) {
    this.want({ ...wanted, side: this.took > SLOW_MS ? COARSE : SIDE });
    clearTimeout(this.resting);
    this.resting = setTimeout(() => { if (!this.isFine) this.want({ ...this.wanted, side: SIDE }); }, REST_MS);
  }

  /** The same once more: the server has another answer. */
  again() { if (this.wanted) this.want({ ...this.wanted }); }

  get isFine() { return this.wanted.side === SIDE; }

  want(wanted) {
    this.wanted = wanted;
    if (!this.isRunning) this.run();
    else if (!this.isInterrupted && performance.now() - this.sentAt > PATIENCE_MS) this.interrupt();
  }

  /** What takes long gives way to what is newer, but never twice in a row, so that something is always shown. */
  interrupt() {
    this.isInterrupted = true;
    this.controller.abort();
  }

  /** Once: a request that was given up may reach the server after the newest, which then gives way to it. */
  mayRepeat(wanted) {
    const isFirst = this.repeated !== wanted;
    this.repeated = wanted;
    return isFirst;
  }

  async run() {
    this.isRunning = true;
    while (this.wanted !== this.answered) {
      const { wanted } = this;
      this.controller = new AbortController();
      this.sentAt = performance.now();
      try {
        const framed = parseFramed(await postBytes('recipe', wanted, { signal: this.controller.signal })), { json } = framed;
        this.took = (performance.now() - this.sentAt) * (SIDE / wanted.side) ** 2;
        await this.drawn;  // Of the look before: a page that draws slowly is not overrun.
        for (const look of json.surfaces ?? [json.look]) for (const name of ['color', 'normal', 'shine']) if (look) look[name] = pixelsOf(look[name], framed);
        this.isInterrupted = false;
        if (json.cancelled && this.mayRepeat(wanted)) continue;
        this.answered = wanted;
        if (!json.cancelled) this.onAnswer(json, wanted);
        this.drawn = new Promise(requestAnimationFrame);
      } catch (error) {
        if (error.name === 'AbortError' || (error instanceof ConnectionBroke && this.mayRepeat(wanted))) continue;
        this.answered = wanted;
        this.onError(error);
      }
    }
    this.isRunning = false;
  }
}
