// SPDX-License-Identifier: MIT
// The recipe of a material: text, layers, sliders and variations write one text, which is seen on the scene at once and
// kept in the document as one change.
import { element } from '../dom.mjs';
import { get, post } from './api.mjs';
import { freeName } from './free_name.mjs';
import { LiveLook } from './live_look.mjs';
import { RecipeAsker } from './recipe_asker.mjs';
import { RecipeAtlases } from './recipe_atlases.mjs';
import { RecipeControls } from './recipe_controls.mjs';
import { RecipeMutations } from './recipe_mutations.mjs';
import { RecipeText } from './recipe_text.mjs';
import { RecipeTree } from './recipe_tree.mjs';
import { moveSpans, spliced } from './text_spans.mjs';
import { T } from './texts.mjs';

const REST_MS = 200, FIRST = 'leather', SIZE_MM = [40, 40];

export class RecipePanel {
  /** @param studio with state, edit(), view, say(), selected, slots(), openTab() @param tab that shows the panel */
  constructor(host, tab, studio) {
    Object.assign(this, { host, tab, studio, material: null, kept: null, time: 0, looks: 0, outline: null });
    this.live = new LiveLook(studio.view);
    this.atlases = new RecipeAtlases();
    this.asker = new RecipeAsker((answer, wanted) => this.answer(answer, wanted), (error) => studio.say(error.message, true));
    const say = (text, isProblem) => studio.say(text, isProblem);
    host.append(this.start(), this.editor = element('div', { hidden: '' }));
    this.editor.append(this.head());
    this.text = new RecipeText(this.editor, () => this.changed());
    this.editor.append(this.timeRow());
    this.tree = new RecipeTree(this.editor, { onPick: () => this.showTexture(), onLayers: (change) => this.layers(change), say });
    this.controls = new RecipeControls(this.editor, (span, piece) => this.write(span, piece));
    this.mutations = new RecipeMutations(this.editor, { recipe: () => this.now, onTake: (text) => this.replace(text), say });
    this.ready = get('recipe-language').then((language) => this.setLanguage(language));
  }

  // ---- Parts of the panel.

  /** A new material from a recipe of the library. */
  start() {
    this.from = element('select', { id: 'recipe-from', 'aria-label': T.recipe.from });
    this.name = element('input', { id: 'recipe-name', autocomplete: 'off', 'aria-label': T.recipe.name, placeholder: T.recipe.name });
    const button = element('button', { type: 'button', id: 'recipe-new' }, T.recipe.create);
    button.addEventListener('click', () => this.create());
    return element('div', {}, element('p', { class: 'note' }, T.recipe.help), element('div', { class: 'row' }, this.from, this.name, button));
  }

  head() {
    const button = (id, text, work) => { const node = element('button', { type: 'button', id }, text); node.addEventListener('click', work); return node; };
    this.title = element('h2', { id: 'recipe-title' });
    this.keepButton = button('recipe-keep', T.recipe.keep, () => this.keep());
    this.revertButton = button('recipe-revert', T.recipe.revert, () => this.revert());
    this.shown = element('select', { id: 'recipe-show', 'aria-label': T.recipe.shown }, ...Object.entries(T.recipe.shows).map(([value, text]) => element('option', { value }, text)));
    this.shown.addEventListener('change', () => this.studio.edit([{ kind: 'set', material: this.material, values: { '/show': this.shown.value } }], T.did.set(this.material, T.recipe.shown)).then(() => this.changed()));
    this.state = element('span', { id: 'recipe-state', role: 'status' });
    this.note = element('p', { class: 'note', id: 'recipe-note' });
    return element('div', {}, this.title, element('div', { class: 'row' }, this.keepButton, this.revertButton, this.state), element('div', { class: 'row' }, element('span', {}, T.recipe.shown), this.shown), this.note);
  }

  timeRow() {
    this.timeBox = element('input', { type: 'range', id: 'recipe-time', min: '0', max: '1', step: '0.01', value: '0', 'aria-label': T.recipe.time });
    this.timeText = element('output', { for: 'recipe-time' }, '0');
    this.timeBox.addEventListener('input', () => { this.time = this.timeBox.valueAsNumber; this.changed(); });
    return this.timeLine = element('div', { class: 'recipe-row' }, element('span', {}, T.recipe.time), this.timeBox, this.timeText);
  }

  setLanguage(language) {
    this.language = language;
    const names = Object.keys(language.recipes);
    this.from.replaceChildren(...names.map((name) => element('option', { value: name, title: language.recipes[name] }, name)));
    this.from.value = FIRST;
    this.tree.setRecipes(names);
    this.controls.setLanguage(language);
  }

  // ---- What is edited.

  get now() { return { text: this.text.value, time: this.time }; }
  get isChanged() { return this.material !== null && (this.text.value !== this.kept.text || this.time !== this.kept.time); }

  /** Whether a text of MATERIALS.json is a recipe. */
  isRecipe(text) {
    const head = String(text ?? '').split('|')[0].trim();
    return Boolean(this.language) && (head in this.language.types || head in this.language.recipes);
  }

  /** The text of a library's recipe as a new material, for what is selected if anything is. */
  async create() {
    await this.ready;
    const text = this.language.recipes[this.from.value], name = freeName(this.name.value.trim() || this.from.value, this.studio.state.document.materials);
    const surfaces = this.studio.slots([...this.studio.selected]), add = { kind: 'add', material: name, values: { '/texture': text, '/size_mm': SIZE_MM, '/show': 'picture' } };
    if (await this.studio.edit(surfaces.length ? [add, { kind: 'assign', surfaces, material: name }] : [add], T.did.add(name))) await this.open(name);
  }

  /** A material of the list: one of the library comes into the document. @param what {material} or {library} */
  async openChosen({ material, library: id }) {
    if (!id) return this.open(material);
    if (!(id in this.studio.state.document.materials) && !await this.studio.edit([{ kind: 'add', material: id, values: { '/material': `library:${id}` } }], T.did.add(id))) return undefined;
    return this.open(id);
  }

  async open(material) {
    try {
      await this.ready;
      const { text, time } = await get('recipe-of', { material });
      this.close();
      Object.assign(this, { material, kept: { text, time } });
      this.seen = this.entry();
      this.title.textContent = material;
      this.editor.hidden = false;
      this.mutations.clear();
      this.studio.openTab(this.tab);
      this.shown.value = JSON.parse(this.seen).show ?? 'auto';
      this.put({ text, time });
    } catch (error) {
      this.studio.say(error.message, true);
    }
  }

  close() {
    this.live.hide();
    this.atlases.clear();
    Object.assign(this, { material: null, outline: null });
    this.editor.hidden = true;
  }

  put({ text, time }) {
    this.time = time;
    this.timeBox.value = time;
    this.replace(text);
  }

  replace(text) {
    this.text.value = text;
    this.changed();
  }

  revert() { this.put(this.kept); }

  /** One piece of the text is replaced; the places of the others are known without asking. */
  write(span, piece) {
    const [begin, end] = span;
    this.text.value = spliced(this.text.value, [begin, end], piece);
    moveSpans(this.outline, [begin, end], piece.length - (end - begin));
    this.controls.text = this.text.value;
    this.changed();
  }

  async layers(change) {
    const text = this.text.value;
    try {
      const { text: changed } = await post('recipe-layers', { text, ...change });
      if (text === this.text.value) this.replace(changed);
    } catch (error) {
      this.studio.say(error.message, true);
    }
  }

  changed() {
    this.mark();
    this.asker.ask({ material: this.material, ...this.now });
  }

  mark() {
    const { isChanged } = this;
    this.state.textContent = isChanged ? T.recipe.notKept : T.recipe.isKept;
    this.keepButton.disabled = this.revertButton.disabled = !isChanged;
    this.timeText.textContent = this.time.toFixed(2);
  }

  // ---- What the server says.

  answer(answer, wanted) {
    if (wanted.material !== this.material) return;
    const isNewest = wanted.text === this.text.value;
    if (isNewest) {
      this.text.setProblem(answer.problem);
      this.timeLine.hidden = !answer.uses_time && this.time === 0;
      if (answer.textures) {
        this.outline = answer.textures;
        this.tree.show(this.outline);
        this.showTexture();
        this.drawSoon();
      }
    }
    if (answer.look || answer.surfaces) this.showLook(answer);
  }

  /** The server has laid out another surface of the material. */
  atlasCame() { if (this.material !== null) this.asker.again(); }

  showTexture() {
    if (this.outline) this.controls.show(this.outline[this.tree.picked], this.text.value);
  }

  get keys() { return new Set(this.studio.state.surfaces.filter((s) => s.material === this.material).map((s) => this.studio.keyOf(s))); }

  async showLook(answer) {
    try {
      const number = ++this.looks, looks = await this.looksOf(answer);
      if (number !== this.looks || this.material === null) return;
      this.note.textContent = this.noteOf(answer, [...looks.values()]);
      if (this.isChanged || !this.isBaked) this.live.show(looks);
      else this.live.hide();
      Object.assign(this.host.dataset, { looks: number, underWay: answer.under_way });
    } catch (error) {
      this.studio.say(error.message, true);
    }
  }

  /** By the key of the surface: one tile for all, or what each has on its atlas. */
  async looksOf({ look, surfaces }) {
    if (!surfaces) return new Map([...this.keys].map((key) => [key, { look }]));
    return new Map(await Promise.all(surfaces.map(async (one) => [this.studio.keyOf({ ...one, uses: [one.use] }), { look: one, geometry: await this.atlases.geometry(one.mesh) }])));
  }

  noteOf({ under_way: left, surface_problems: problems }, looks) {
    const { size } = this.keys;
    if (!size) return T.recipe.nowhere;
    if (problems.length) return problems[0];
    if (left) return T.recipe.layingOut(left, size);
    return looks.every(({ look }) => look.color) ? '' : T.recipe.reliefOnly;
  }

  /** Whether the scene shows what the document has. */
  get isBaked() { return this.studio.state.surfaces.every((s) => s.material !== this.material || this.studio.shown.get(this.studio.keyOf(s))?.name === s.name); }

  drawSoon() {
    clearTimeout(this.drawing);
    const text = this.text.value;
    this.drawing = setTimeout(() => { if (text === this.text.value) this.tree.draw(text, this.time); }, REST_MS);
  }

  // ---- The document.

  /** One after the other: what is changed while a change is being kept stays changed. */
  keep() {
    this.keeping = (this.keeping ?? Promise.resolve()).then(() => this.keepNow());
    return this.keeping;
  }

  async keepNow() {
    if (!this.isChanged) return;
    const { material, kept: before } = this, sent = this.now;
    this.isKeeping = true;
    this.kept = sent;
    this.mark();
    const values = { ...(sent.text !== before.text && { '/texture': sent.text }), ...(sent.time !== before.time && { '/time': sent.time }) };
    const isKept = await this.studio.edit([{ kind: 'set', material, values }], T.did.recipe(material));
    this.isKeeping = false;
    if (material !== this.material) return;
    if (!isKept) this.kept = before;
    this.mark();
    this.setDocument();
  }

  entry() { return JSON.stringify(this.studio.state.document.materials?.[this.material]); }

  /** The document may be another: by undo, or by another page. */
  setDocument() {
    if (this.material === null || this.isKeeping || this.entry() === this.seen) return;
    this.seen = this.entry();
    this.follow();
  }

  async follow() {
    const { material, seen } = this, now = seen && await get('recipe-of', { material }).catch(() => null);
    if (material !== this.material || seen !== this.seen || this.isKeeping) return;
    if (!now) { this.close(); return; }
    this.shown.value = JSON.parse(seen).show ?? 'auto';
    if (now.text === this.kept.text && now.time === this.kept.time) return;
    this.kept = { text: now.text, time: now.time };
    this.put(this.kept);
  }

  /** A surface is shown as the document has it: what is not kept yet is laid on it again. */
  dressAgain(key) {
    if (this.isChanged) this.live.dressAgain(key);
    else if (this.isBaked) this.live.hide();
  }
}
