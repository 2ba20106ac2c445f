// SPDX-License-Identifier: MIT
// Sliders, colour pickers and choices for what a texture of a recipe says: each writes its own piece of the text.
import { element } from '../dom.mjs';
import { pieceOf } from './text_spans.mjs';
import { T } from './texts.mjs';

const OPEN = 1e299, STEPS = 200, DIGITS = 4;

const written = (value) => String(Number(value.toPrecision(DIGITS)));
const hexOf = (rgb) => `#${rgb.map((c) => Math.round(255 * c).toString(16).padStart(2, '0')).join('')}`;
const colourOf = (hex) => `<${[1, 3, 5].map((i) => Number((parseInt(hex.slice(i, i + 2), 16) / 255).toFixed(3))).join(',')}>`;

/** Where a slider ends: the parameter's range as far as that is of use, else around the value. */
export function rangeOf(value, info) {
  const reach = 2 * Math.max(Math.abs(value), Math.abs(Number(info?.preset)) || 0, 0.5), isWhole = info?.kind === 'number' || info?.kind === 'integer';
  const low = isWhole && info.low > -OPEN ? Math.max(info.low, value - 10 * reach) : value < 0 || isWhole ? value - reach : 0;
  const high = isWhole && info.high < OPEN ? Math.min(info.high, value + 10 * reach) : value + reach;
  return [Math.min(low, value), Math.max(high, value)];
}

export class RecipeControls {
  /** @param onPiece(span, piece) replaces a piece of the text */
  constructor(host, onPiece) {
    Object.assign(this, { onPiece });
    this.title = element('h2', {});
    this.rows = element('div', { id: 'recipe-controls' });
    this.more = element('select', { id: 'recipe-parameter', 'aria-label': T.recipe.parameter });
    const add = element('button', { type: 'button', id: 'parameter-add' }, T.recipe.add);
    add.addEventListener('click', () => this.add());
    host.append(this.title, this.rows, element('div', { class: 'row' }, this.more, add));
  }

  /** The parameters of a type, its own before those of all. */
  setLanguage({ types, common }) { this.parametersOf = (type) => [...types[type]?.parameters ?? [], ...common]; }

  /** @param texture of the outline @param text that it is of */
  show(texture, text) {
    const shape = JSON.stringify([texture.head, texture.type, texture.parameters.map(({ name, numbers, colours }) => [name, numbers.length, colours.length])]);
    this.texture = texture;
    this.text = text;
    if (shape !== this.shape) {
      this.shape = shape;
      this.title.textContent = T.recipe.of(texture.head);
      this.updates = [];
      const all = new Map(this.parametersOf(texture.type).map((p) => [p.name, p]).reverse());  // Its own win.
      this.rows.replaceChildren(...texture.parameters.flatMap((parameter, i) => this.rowsOf(parameter, i, all.get(parameter.name))));
      const given = new Set(texture.parameters.map(({ name }) => name));
      this.more.replaceChildren(...[...all.values()].filter(({ name }) => !given.has(name)).sort((a, b) => a.name.localeCompare(b.name)).map((p) => element('option', { value: p.name, title: p.note }, p.name)));
      this.all = all;
    }
    for (const update of this.updates) update();
  }

  rowsOf({ numbers, colours }, i, info) {
    const rows = [], name = this.texture.parameters[i].name, parts = numbers.length + colours.length;
    const label = (k) => parts > 1 ? `${name} ${k + 1}` : name;
    if (info?.kind === 'flag') rows.push(this.choice(name, i, ['false', 'true'], info));
    else if (info?.kind === 'choice') rows.push(this.choice(name, i, info.note.split(' '), info));
    for (const k of colours.keys()) rows.push(this.colour(label(k), i, k, info));
    for (const k of numbers.keys()) rows.push(this.slider(label(colours.length + k), i, k, info));
    if (!rows.length) rows.push(this.row(name, info, element('span', { class: 'note' }, T.recipe.inText)));
    const remove = element('button', { type: 'button', 'aria-label': T.recipe.removeOf(name), title: T.recipe.removeOf(name) }, '×');
    remove.addEventListener('click', () => {
      const { value } = this.texture.parameters[i];
      this.onPiece([this.text.lastIndexOf('|', value[0]), value[1]], '');
    });
    rows[0].append(remove);
    return rows;
  }

  row(name, info, ...controls) {
    return element('div', { class: 'recipe-row', 'data-parameter': name, ...(info ? { title: info.note } : {}) }, element('span', {}, name), ...controls);
  }

  /** Shows values that come from elsewhere, but not to the hand that holds the control. */
  keep(node, value) { this.updates.push(() => { if (document.activeElement !== node) node.value = value(); }); }

  slider(name, i, k, info) {
    const at = () => this.texture.parameters[i].numbers[k], { value } = at(), [low, high] = rangeOf(value, info), step = info?.kind === 'integer' ? 1 : (high - low) / STEPS;
    const slider = element('input', { type: 'range', min: low, max: high, step: step || 'any', 'aria-label': name });
    const box = element('input', { type: 'number', step: 'any', 'aria-label': T.recipe.number(name) });
    const write = (from, other) => {
      if (!Number.isFinite(from.valueAsNumber)) return;
      const number = at();
      number.value = Number(written(from.valueAsNumber));
      other.value = number.value;
      this.onPiece(number.at, written(number.value));
    };
    slider.addEventListener('input', () => write(slider, box));
    box.addEventListener('input', () => write(box, slider));
    for (const node of [slider, box]) this.keep(node, () => at().value);
    return this.row(name, info, slider, box);
  }

  colour(name, i, k, info) {
    const at = () => this.texture.parameters[i].colours[k], picker = element('input', { type: 'color', 'aria-label': name });
    picker.addEventListener('input', () => this.onPiece(at().at, colourOf(picker.value)));
    this.keep(picker, () => hexOf(at().rgb));
    return this.row(name, info, picker);
  }

  choice(name, i, words, info) {
    const at = () => this.texture.parameters[i].value, select = element('select', { 'aria-label': name }, ...words.map((word) => element('option', { value: word }, word)));
    select.addEventListener('change', () => this.onPiece(at(), select.value));
    this.keep(select, () => pieceOf(this.text, at()));
    return this.row(name, info, select);
  }

  add() {
    const info = this.all.get(this.more.value), end = this.texture.text[1];
    if (info) this.onPiece([end, end], `|${info.name}=${info.preset || 0}`);
  }
}
