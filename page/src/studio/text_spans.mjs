// SPDX-License-Identifier: MIT
// Places of an outline in a recipe's text (docs/studio.md), kept right while pieces of the text are replaced.

export const pieceOf = (text, [begin, end]) => text.slice(begin, end);
export const spliced = (text, [begin, end], piece) => text.slice(0, begin) + piece + text.slice(end);

/** Moves every place behind a piece that now has another length, as the text did. */
export function moveSpans(textures, [, end], change) {
  const move = (span) => {
    if (span[0] >= end) span[0] += change;
    if (span[1] >= end) span[1] += change;
  };
  for (const { text, parameters } of textures) {
    move(text);
    for (const { value, numbers, colours } of parameters) {
      move(value);
      for (const { at } of [...numbers, ...colours]) move(at);
    }
  }
}
