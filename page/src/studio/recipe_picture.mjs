// SPDX-License-Identifier: MIT
// Pixels of the server as a canvas, and pictures of recipes that are kept by their text.
import { element } from '../dom.mjs';
import { parseFramed, postBytes } from './api.mjs';

const SIDE = 64, MOST_KEPT = 400, MOST_AT_ONCE = 64;

/** @param place {at, bytes} or null @param framed of parseFramed() */
export const pixelsOf = (place, { buffer, at }) => place && new Uint8Array(buffer, at + place.at, place.bytes);

export function pictureCanvas(side, label) {
  return element('canvas', { width: side, height: side, class: 'recipe-picture', ...(label ? { role: 'img', 'aria-label': label } : { 'aria-hidden': 'true' }) });
}

export function drawPixels(canvas, pixels) {
  const context = canvas.getContext('2d');
  if (pixels) context.putImageData(new ImageData(new Uint8ClampedArray(pixels), canvas.width, canvas.height), 0, 0);
  else context.clearRect(0, 0, canvas.width, canvas.height);
}

export class RecipePictures {
  constructor() { this.kept = new Map(); }

  canvas() { return pictureCanvas(SIDE); }

  /** Draws recipes on canvases, the newest request alone. @param wanted [{text, canvas}] */
  async draw(wanted, time) {
    const number = this.asked = (this.asked ?? 0) + 1, nameOf = (text) => `${time} ${text}`;
    const missing = [...new Set(wanted.map(({ text }) => text))].filter((text) => !this.kept.has(nameOf(text))).slice(0, MOST_AT_ONCE);
    if (missing.length) {
      const framed = parseFramed(await postBytes('recipe-pictures', { texts: missing, time, side: SIDE }));
      for (const [i, place] of framed.json.pictures.entries()) this.kept.set(nameOf(missing[i]), pixelsOf(place, framed));
      for (const name of [...this.kept.keys()].slice(0, Math.max(0, this.kept.size - MOST_KEPT))) this.kept.delete(name);
    }
    if (number === this.asked) for (const { text, canvas } of wanted) drawPixels(canvas, this.kept.get(nameOf(text)));
  }
}
