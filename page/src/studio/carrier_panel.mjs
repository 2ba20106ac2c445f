// SPDX-License-Identifier: MIT
// The list of carriers and the fields of the chosen one.
import { number as shown } from '../colour.mjs';
import { element } from '../dom.mjs';
import { FieldPanel, fill, valueAt } from './field_panel.mjs';
import { later } from './later.mjs';
import { T as TEXTS } from './texts.mjs';

const T = TEXTS.carriers;
/** Keys that are one number, or nothing: of any carrier, of a picture from a file, of a rendered one. */
const NUMBERS = {
  contrast: { pointer: '/contrast', least: 0, most: 100 }, brightness: { pointer: '/brightness', least: -1, most: 1 },
  roughness: { pointer: '/roughness', least: 0, most: 1 }, metallic: { pointer: '/metallic', least: 0, most: 1 },
};
const LEAST_MM = 0.001, MOST_RELIEF_MM = 20;
const isSame = (a, b) => a.every((x, i) => x === b[i]);

export class CarrierPanel extends FieldPanel {
  /** @param handlers add(), render(), choose(number), set(values, what), picture(), remove() */
  constructor(host, handlers) {
    super('carrier', T, handlers);
    this.add = this.button('carrier-add', T.add, 'add');
    this.fields = element('div', { id: 'carrier-fields' }, ...this.rows());
    host.append(element('section', { 'aria-labelledby': 'carriers-title' }, element('h2', { id: 'carriers-title' }, T.title), element('p', { class: 'note' }, T.help),
      element('div', { class: 'row' }, this.add, this.button('carrier-render', T.render, 'render')), this.listOf('carriers', T.list), this.fields));
    this.show([], null);
  }

  static nameOf({ name, picture }) { return name ?? (picture?.render ? T.ownPicture : picture); }

  /** Boxes of one array: all empty is the default. */
  boxes(ids, pointer, without, [low, high], what) {
    const boxes = ids.map((id) => this.numberBox(id, low, high));
    const set = () => {
      const values = boxes.map((node, i) => Number.isFinite(node.valueAsNumber) ? node.valueAsNumber : without[i]);
      if (boxes.every((node) => node.checkValidity())) this.handlers.set({ [pointer]: isSame(values, without) ? null : values }, what);
    };
    for (const node of boxes) later(node, set);
    return boxes;
  }

  rows() {
    const set = (values, what) => this.handlers.set(values, what), check = (node, text) => element('div', { class: 'row' }, node, element('label', { for: node.id }, text));
    this.name = later(element('input', { id: 'carrier-name', autocomplete: 'off' }), () => set({ '/name': this.name.value || null }, T.name));
    this.picture = element('span', { id: 'carrier-picture' });
    this.scale = this.boxes(['scale-width', 'scale-height'], '/scale', [1, 1], [0.01, 100], T.scale);
    this.crop = this.boxes(['left', 'top', 'right', 'bottom'], '/crop', [0, 0, 1, 1], [0, 1], T.crop);
    this.cut = element('select', { id: 'carrier-cut' }, ...Object.entries(T.cuts).map(([value, text]) => element('option', { value }, text)));
    this.cut.addEventListener('change', () => set({ '/cut_out': { alpha: null, none: 'none', color: { color: '#ffffff' } }[this.cut.value] }, T.cut));
    this.color = element('input', { id: 'carrier-color', type: 'color' });
    this.color.addEventListener('change', () => set({ '/cut_out/color': this.color.value }, T.cut));
    this.tolerance = this.writes(this.numberBox('tolerance', 0, 1), false, (value) => set({ '/cut_out/tolerance': value }, T.tolerance));
    this.numbers = Object.fromEntries(Object.entries(NUMBERS).map(([id, { pointer, least, most }]) => [id, this.writes(this.numberBox(id, least, most), false, (value) => set({ [pointer]: value }, T.numbers[id]))]));
    this.relief = this.writes(this.numberBox('relief', LEAST_MM, MOST_RELIEF_MM), false, (mm) => set(mm === null ? { '/height': null } : { '/height/depth_mm': mm }, T.relief));
    this.pixels = this.writes(this.numberBox('pixels', 16, 4096), false, (value) => set({ '/picture/pixels': value === null ? null : Math.round(value) }, T.pixels));
    this.felt = element('input', { id: 'carrier-felt', type: 'checkbox' });
    this.felt.addEventListener('change', () => set({ '/picture/felt': this.felt.checked ? null : false }, T.felt));
    this.ofPart = this.row(T.scale, this.scale, [TEXTS.width, TEXTS.height]);
    this.ofColor = element('div', {}, this.row(T.color, [this.color]), this.row(T.tolerance, [this.tolerance]));
    this.ofFile = element('div', {}, this.row(T.cropBegin, this.crop.slice(0, 2), T.begins), this.row(T.cropEnd, this.crop.slice(2), T.ends), this.row(T.cut, [this.cut]), this.ofColor, this.row(T.relief, [this.relief]));
    this.ofRender = element('div', {}, this.row(T.pixels, [this.pixels]), check(this.felt, T.felt));
    return [
      element('h3', { id: 'carrier-title' }), this.row(T.name, [this.name]), element('div', { class: 'row' }, this.picture, this.button('carrier-other', T.other, 'picture')),
      this.ofPart, this.ofFile, this.ofRender, ...Object.entries(this.numbers).map(([id, node]) => this.row(T.numbers[id], [node])),
      element('div', { class: 'row' }, this.button('carrier-remove', T.remove, 'remove')), this.note = element('p', { id: 'carrier-note', class: 'note', role: 'status' }),
    ];
  }

  /** @param carriers of the document @param number of the chosen one, or null */
  show(carriers, number) {
    this.showList(carriers.map((carrier) => CarrierPanel.nameOf(carrier)), number);
    const carrier = number === null ? undefined : carriers[number];
    this.fields.hidden = !carrier;
    if (!carrier) return;
    const { picture, cut_out: cut } = carrier, isRendered = Boolean(picture.render);
    this.fields.firstChild.textContent = CarrierPanel.nameOf(carrier);
    this.picture.textContent = isRendered ? T.ownPicture : picture;
    fill(this.name, carrier.name);
    this.scale.forEach((node, i) => fill(node, carrier.scale?.[i]));
    this.crop.forEach((node, i) => fill(node, carrier.crop?.[i]));
    fill(this.cut, typeof cut === 'object' ? 'color' : cut ?? 'alpha');
    fill(this.color, cut?.color);
    fill(this.tolerance, cut?.tolerance);
    for (const [id, { pointer }] of Object.entries(NUMBERS)) fill(this.numbers[id], valueAt(carrier, pointer));
    fill(this.relief, carrier.height?.depth_mm);
    fill(this.pixels, picture.pixels);
    this.felt.checked = picture.felt !== false;
    this.ofPart.hidden = 'at' in carrier;
    this.ofFile.hidden = isRendered;
    this.ofRender.hidden = !isRendered;
    this.ofColor.hidden = this.cut.value !== 'color';
  }

  /** @param told by the server of all of them, if they are there @param problem why they are not, or '' */
  tell(told, number, problem) {
    const entry = told?.entries[number], warnings = [problem, ...told?.warnings ?? []].filter(Boolean);
    this.note.textContent = warnings.length ? warnings.join('; ') : entry ? T.stands(entry.carriers, shown(entry.triangles), shown(entry.saved)) : T.waits;
    this.note.dataset.problem = warnings.length > 0;
  }
}
