// SPDX-License-Identifier: MIT
// The list of decals and the fields of the chosen one. It tells what people want; what becomes of it is Decals' affair.
import { number as shown } from '../colour.mjs';
import { element } from '../dom.mjs';
import { isForSome, turnOf } from './decal_place.mjs';
import { FieldPanel, fill, valueAt } from './field_panel.mjs';
import { later } from './later.mjs';
import { T as TEXTS } from './texts.mjs';

const T = TEXTS.decals;
const MOVES = { left: ['←', -1, 0], up: ['↑', 0, 1], down: ['↓', 0, -1], right: ['→', 1, 0] };
/** Keys that are one number, or nothing. */
const NUMBERS = {
  depth: { pointer: '/depth_mm', least: 0.001, most: 1e6, needed: true }, angle: { pointer: '/max_angle', least: 0, most: 90 }, offset: { pointer: '/offset_mm', least: 0, most: 100 },
  roughness: { pointer: '/roughness', least: 0, most: 1 }, metallic: { pointer: '/metallic', least: 0, most: 1 },
};
const LEAST_MM = 0.001, MOST_RELIEF_MM = 20;

export class DecalPanel extends FieldPanel {
  /** @param handlers add(), pick(), giveUp(), middle(), choose(number), set(values, what), turn(degrees), move(right, up), only(on), picture(), place(), go(), remove() */
  constructor(host, handlers) {
    super('decal', T, handlers);
    Object.assign(this, { host, decal: null });
    this.add = this.button('decal-add', T.add, 'add');
    this.middle = this.button('decal-middle', T.middle, 'middle');
    this.cancel = this.button('decal-cancel', TEXTS.cancel, 'giveUp');
    this.status = element('p', { id: 'decal-status', role: 'status', class: 'note' });
    this.fields = element('div', { id: 'decal-fields' }, ...this.rows());
    host.replaceChildren(element('p', { class: 'note' }, T.help), element('div', { class: 'row' }, this.add, this.middle, this.cancel), this.status, this.listOf('decals', T.list), this.fields);
    this.setPlacing(null);
  }

  get isOpen() { return !this.host.hidden; }

  rows() {
    const { handlers } = this, set = (values, what) => handlers.set(values, what);
    this.name = later(element('input', { id: 'decal-name', autocomplete: 'off' }), () => set({ '/name': this.name.value || null }, T.name));
    this.picture = element('span', { id: 'decal-picture' });
    this.sizes = ['width', 'height'].map((id) => this.numberBox(id, LEAST_MM, 1e6));
    this.keeps = element('input', { id: 'decal-keeps', type: 'checkbox' });
    this.keeps.checked = true;
    this.sizes.forEach((node, i) => this.writes(node, true, (mm) => set({ '/size_mm': this.sizeWith(i, mm) }, T.size)));
    this.turn = this.writes(this.numberBox('turn', -360, 360), true, (degrees) => handlers.turn(degrees));
    this.places = ['x', 'y', 'z'].map((axis) => this.numberBox(axis, -1e9, 1e9));
    for (const node of this.places) this.writes(node, true, () => set({ '/at': this.places.map((p) => p.valueAsNumber || 0) }, T.place));
    this.step = this.numberBox('step', LEAST_MM, 1e6);
    this.step.value = 1;
    const arrows = Object.entries(MOVES).map(([id, [arrow, right, up]]) => {
      const node = element('button', { type: 'button', id: `decal-${id}`, 'aria-label': T.moves[id] }, arrow);
      node.addEventListener('click', () => handlers.move(right * this.step.valueAsNumber, up * this.step.valueAsNumber));
      return node;
    });
    this.only = element('input', { id: 'decal-only', type: 'checkbox' });
    this.only.addEventListener('change', () => handlers.only(this.only.checked));
    this.numbers = Object.fromEntries(Object.entries(NUMBERS).map(([id, { pointer, least, most, needed }]) => [id, this.writes(this.numberBox(id, least, most), needed, (value) => set({ [pointer]: value }, T.numbers[id]))]));
    this.relief = this.writes(this.numberBox('relief', LEAST_MM, MOST_RELIEF_MM), false, (mm) => set(mm === null ? { '/height': null } : { '/height/depth_mm': mm }, T.relief));
    this.from = element('select', { id: 'decal-from' }, ...Object.entries(T.froms).map(([value, text]) => element('option', { value }, text)));
    this.from.addEventListener('change', () => set({ '/height/from': this.from.value }, T.from));
    const check = (node, text) => element('div', { class: 'row' }, node, element('label', { for: node.id }, text));
    return [
      element('h2', { id: 'decal-title' }), this.row(T.name, [this.name]), element('div', { class: 'row' }, this.picture, this.button('decal-other', T.other, 'picture')),
      this.row(T.size, this.sizes, [TEXTS.width, TEXTS.height]), check(this.keeps, T.keeps), this.row(T.turn, [this.turn]),
      this.row(T.place, this.places, ['x', 'y', 'z']), this.row(T.step, [this.step]), element('div', { class: 'row' }, ...arrows), check(this.only, T.only),
      ...Object.entries(this.numbers).map(([id, node]) => this.row(T.numbers[id], [node])), this.row(T.relief, [this.relief]), this.row(T.from, [this.from]),
      element('div', { class: 'row' }, this.button('decal-place', T.anew, 'place'), this.button('decal-go', T.go, 'go'), this.button('decal-remove', T.remove, 'remove')),
      this.note = element('p', { id: 'decal-note', class: 'note', role: 'status' }),
    ];
  }

  /** Both sides of the picture when one is given. */
  sizeWith(i, mm) {
    const [width, height] = this.decal.size_mm, other = this.keeps.checked ? Number((mm * (i ? width / height : height / width)).toPrecision(6)) : [width, height][1 - i];
    return i ? [other, mm] : [mm, other];
  }

  /** @param what is to be placed by a press on the scene: its name, or null */
  setPlacing(what) {
    this.middle.hidden = this.cancel.hidden = what === null;
    this.status.textContent = what === null ? '' : T.press(what);
  }

  /** @param decals of the document @param number of the chosen one, or null @param sceneUp what is up there */
  show(decals, number, sceneUp) {
    this.decal = number === null ? null : decals[number];
    this.showList(decals.map((decal) => decal.name ?? decal.picture), number);
    this.fields.hidden = !this.decal;
    if (!this.decal) return;
    const { decal } = this;
    this.fields.firstChild.textContent = decal.name ?? decal.picture;
    this.picture.textContent = decal.picture;
    fill(this.name, decal.name);
    this.sizes.forEach((node, i) => fill(node, decal.size_mm[i]));
    fill(this.turn, turnOf(decal, sceneUp));
    this.places.forEach((node, i) => fill(node, decal.at[i]));
    this.only.checked = isForSome(decal);
    for (const [id, { pointer }] of Object.entries(NUMBERS)) fill(this.numbers[id], valueAt(decal, pointer));
    fill(this.relief, decal.height?.depth_mm);
    this.from.disabled = !decal.height || 'picture' in decal.height;
    fill(this.from, decal.height?.from ?? 'auto');
  }

  /** @param data of the server's decal, if it is there @param problem why it is not, or '' */
  tell(data, problem) {
    const warnings = [problem, ...data?.warnings ?? []].filter(Boolean);
    this.note.textContent = warnings.length ? warnings.join('; ') : data ? T.covers(shown(data.area_mm2 / 100), data.triangles) : T.waits;
    this.note.dataset.problem = warnings.length > 0;
  }
}
