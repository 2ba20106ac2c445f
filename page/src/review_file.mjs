// SPDX-License-Identifier: MIT
// review.json (docs/vr.md). No page in here, so that it can be tested alone.
export const VERSION = 1;

/** What is no note of this version is left out. @throws Error for what is no review at all */
export function parseReview(text) {
  const review = JSON.parse(text);
  if (review?.papilla_review !== VERSION || !Array.isArray(review.notes)) throw new Error('this is no review.json of this version');
  const isPoint = (v) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
  return review.notes.filter((note) => typeof note?.text === 'string' && isPoint(note.place_m) && isPoint(note.camera?.position_m) && isPoint(note.camera?.look));
}
