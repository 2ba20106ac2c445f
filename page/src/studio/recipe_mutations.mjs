// SPDX-License-Identifier: MIT
// Variations of a recipe as a grid of pictures, of which one is taken: evolution by the eye.
import { element } from '../dom.mjs';
import { parseFramed, postBytes } from './api.mjs';
import { drawPixels, pictureCanvas, pixelsOf } from './recipe_picture.mjs';
import { T } from './texts.mjs';

const COUNT = 9, SIDE = 96;

export class RecipeMutations {
  /** @param recipe() gives {text, time} @param onTake(text) @param say(text, isProblem) */
  constructor(host, { recipe, onTake, say }) {
    Object.assign(this, { recipe, onTake, say, seed: 1 });
    this.strength = element('input', { type: 'range', min: '0.02', max: '0.6', step: '0.02', value: '0.2', id: 'mutation-strength', 'aria-label': T.recipe.strength });
    const button = element('button', { type: 'button', id: 'mutate' }, T.recipe.mutate);
    button.addEventListener('click', () => this.make());
    this.grid = element('div', { class: 'mutations', id: 'mutations' });
    host.append(element('h2', {}, T.recipe.mutations), element('div', { class: 'row' }, button, element('span', {}, T.recipe.strength), this.strength), this.grid);
  }

  clear() { this.grid.replaceChildren(); }

  async make() {
    const { text, time } = this.recipe(), { seed } = this;
    this.seed += COUNT;
    try {
      const framed = parseFramed(await postBytes('recipe-mutations', { text, time, seed, count: COUNT, strength: this.strength.valueAsNumber, side: SIDE }));
      if (framed.json.mutations.every((mutant) => mutant.text === framed.json.mutations[0].text)) this.say(T.recipe.nothingVaries, true);
      this.grid.replaceChildren(...framed.json.mutations.map((mutant, i) => {
        const canvas = pictureCanvas(SIDE), button = element('button', { type: 'button', title: mutant.text, 'aria-label': T.recipe.mutant(i + 1) }, canvas);
        drawPixels(canvas, pixelsOf(mutant.picture, framed));
        button.addEventListener('click', () => this.onTake(mutant.text));
        return button;
      }));
    } catch (error) {
      this.say(error.message, true);
    }
  }
}
