// SPDX-License-Identifier: MIT
// The textures of a recipe as a tree: pick one, drag a layer beside another, add and remove layers.
import { element } from '../dom.mjs';
import { RecipePictures } from './recipe_picture.mjs';
import { pieceOf } from './text_spans.mjs';
import { T } from './texts.mjs';

const DRAG_TYPE = 'application/x-papilla-layer';

export class RecipeTree {
  /** @param onPick(number) @param onLayers(change) of POST /recipe-layers @param say(text, isProblem) */
  constructor(host, { onPick, onLayers, say }) {
    Object.assign(this, { onPick, onLayers, say, textures: [], picked: 0, pictures: new RecipePictures() });
    this.tree = element('div', { role: 'tree', id: 'recipe-tree', 'aria-label': T.recipe.layers });
    this.recipes = element('select', { id: 'recipe-layer', 'aria-label': T.recipe.newLayer });
    const button = (id, text, work) => { const node = element('button', { type: 'button', id }, text); node.addEventListener('click', work); return node; };
    this.up = button('layer-up', T.recipe.lower, () => this.step(-1));
    this.down = button('layer-down', T.recipe.upper, () => this.step(1));
    this.remove = button('layer-remove', T.recipe.remove, () => this.onLayers({ kind: 'remove', layer: this.picked }));
    this.add = button('layer-add', T.recipe.add, () => this.insert());
    host.append(element('h2', {}, T.recipe.layers), this.tree, element('div', { class: 'row' }, this.up, this.down, this.remove, this.recipes, this.add));
    this.tree.addEventListener('keydown', (e) => this.key(e));
  }

  /** @param names of recipes that may be added */
  setRecipes(names) { this.recipes.replaceChildren(...names.map((name) => element('option', { value: name }, name))); }

  /** @param textures of the outline */
  show(textures) {
    this.textures = textures;
    if (this.picked >= textures.length) this.picked = 0;
    const shape = JSON.stringify(textures.map(({ head, parent, in_list: isLayer }) => [head, parent, isLayer]));
    if (shape !== this.shape) {
      this.shape = shape;
      const hadFocus = this.tree.contains(document.activeElement);
      this.tree.replaceChildren(...textures.map((texture, i) => this.row(texture, i)));
      if (hadFocus) this.tree.children[this.picked]?.focus();
    }
    this.mark();
  }

  depthOf(number) {
    let depth = 0;
    for (let at = this.textures[number].parent; at !== null; at = this.textures[at].parent) ++depth;
    return depth;
  }

  row(texture, number) {
    const row = element('div', { role: 'treeitem', class: 'layer', 'aria-level': this.depthOf(number) + 1, tabindex: '-1' }, this.pictures.canvas(), element('span', {}, texture.head));
    row.style.setProperty('--level', this.depthOf(number));
    row.draggable = texture.in_list;
    row.addEventListener('click', () => this.pick(number));
    row.addEventListener('dragstart', (e) => { e.dataTransfer.setData(DRAG_TYPE, String(number)); e.dataTransfer.effectAllowed = 'move'; });
    for (const name of ['dragover', 'dragleave', 'drop']) row.addEventListener(name, (e) => this.drag(e, row, number));
    return row;
  }

  drag(event, row, number) {
    if (!event.dataTransfer.types.includes(DRAG_TYPE) || !this.textures[number].in_list) return;
    const { top, height } = row.getBoundingClientRect(), behind = event.clientY > top + height / 2;
    if (event.type === 'dragover') row.dataset.drop = behind ? 'behind' : 'before';
    else delete row.dataset.drop;
    if (event.type === 'dragleave') return;
    event.preventDefault();
    event.stopPropagation();
    if (event.type === 'drop') this.move(Number(event.dataTransfer.getData(DRAG_TYPE)), number, behind);
  }

  move(layer, other, behind) { if (layer !== other) this.onLayers({ kind: 'move', layer, other, behind }); }

  /** The layers of the picked one's list, in order. */
  get siblings() {
    const { parent } = this.textures[this.picked] ?? {};
    return [...this.textures.keys()].filter((i) => this.textures[i].in_list && this.textures[i].parent === parent);
  }

  step(by) {
    const { siblings } = this, other = siblings[siblings.indexOf(this.picked) + by];
    if (this.textures[this.picked]?.in_list && other !== undefined) this.move(this.picked, other, by > 0);
  }

  /** Over the picked layer, or over the uppermost one; a recipe without layers gets two. */
  insert() {
    const top = [...this.textures.keys()].filter((i) => this.textures[i].in_list && this.textures[i].parent === 0).at(-1);
    const other = this.textures[this.picked]?.in_list ? this.picked : top ?? 0;
    this.onLayers({ kind: 'insert', other, behind: true, recipe: this.recipes.value });
  }

  pick(number) {
    this.picked = number;
    this.mark();
    this.tree.children[number]?.focus();
    this.onPick(number);
  }

  mark() {
    for (const [i, row] of [...this.tree.children].entries()) {
      row.setAttribute('aria-selected', String(i === this.picked));
      row.tabIndex = i === this.picked ? 0 : -1;
    }
    const { siblings } = this, place = siblings.indexOf(this.picked), isLayer = place >= 0;
    this.up.disabled = !isLayer || place === 0;
    this.down.disabled = !isLayer || place === siblings.length - 1;
    this.remove.disabled = !isLayer || siblings.length < 2;
  }

  key(event) {
    const by = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    if (event.altKey) this.step(by);
    else this.pick(Math.min(Math.max(this.picked + by, 0), this.textures.length - 1));
  }

  /** Pictures of all rows. @param text of the outline */
  draw(text, time) {
    const wanted = this.textures.map((texture, i) => ({ text: pieceOf(text, texture.text), canvas: this.tree.children[i].querySelector('canvas') }));
    return this.pictures.draw(wanted, time).catch((error) => this.say(error.message, true));
  }
}
