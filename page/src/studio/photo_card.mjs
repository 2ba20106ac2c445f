// SPDX-License-Identifier: MIT
// What the analysis made of a material's picture: class, lattice on the picture, relief, roughness, and what is uncertain.
import { number } from '../colour.mjs';
import { element } from '../dom.mjs';
import { drawLattice, drawPrimitive, vectorText } from '../lattice_picture.mjs';
import { drawRelief } from '../relief_picture.mjs';
import { get } from './api.mjs';
import { T as TEXTS } from './texts.mjs';

const T = TEXTS.card, SIDE_PX = 480;

const floatsOf = (base64) => new Float32Array(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer);

function tile(caption, [width, height], draw) {
  const scale = SIDE_PX / Math.max(width, height);
  const canvas = element('canvas', { width: Math.max(1, Math.round(scale * width)), height: Math.max(1, Math.round(scale * height)), role: 'img', 'aria-label': caption });
  draw(canvas);
  return element('figure', {}, canvas, element('figcaption', {}, caption));
}

export class PhotoCard {
  /** @param own the list of the document's materials, whose chosen one is shown */
  constructor(host, own, say) {
    Object.assign(this, { host, say, materials: {} });
    own.addEventListener('focusin', ({ target }) => this.show(target.dataset.material));
  }

  /** The document's materials; the one that is shown is made anew where it has changed. */
  setDocument(materials) {
    this.materials = materials ?? {};
    if (this.name && JSON.stringify(this.materials[this.name]) !== this.shown) this.show(this.name);
  }

  async show(name) {
    const material = this.materials[name];
    this.name = name;
    if (!material || !(material.texture || material.height?.images || material.material)) return this.hide();
    const text = this.shown = JSON.stringify(material);
    this.host.hidden = false;
    this.host.replaceChildren(element('h3', {}, name), element('p', { class: 'note', role: 'status' }, T.working));
    try {
      const data = await get('card', { material: name });
      const image = new Image();
      image.src = `data:image/png;base64,${data.photo}`;
      await image.decode();
      if (this.shown === text && this.name === name) this.draw(data, image);
    } catch (error) {
      if (this.shown === text && this.name === name) this.host.replaceChildren(element('h3', {}, name), element('p', { class: 'note' }, error.message));
    }
    return undefined;
  }

  hide() {
    this.shown = null;
    this.host.hidden = true;
  }

  draw(data, image) {
    const shows = data.picture.shows_mm, relief = { ...data.relief, mm: floatsOf(data.relief.mm) };
    const tiles = [data.lattice ? tile(T.lattice, shows, (c) => drawLattice(c, image, data.period_mm, shows)) : tile(T.picture, shows, (c) => drawLattice(c, image, null, shows))];
    if (data.lattice) tiles.push(tile(T.primitive, [1, 1], (c) => drawPrimitive(c, image, data.period_mm, shows)));
    tiles.push(tile(T.relief, data.relief.size_mm, (c) => drawRelief(c, relief, data.relief.size_mm)));
    const rows = Object.entries(this.rows(data)).flatMap(([id, value]) => [element('dt', {}, T.rows[id]), element('dd', { 'data-row': id }, value)]);
    const doubts = data.doubts.map((text) => element('li', {}, text));
    this.host.replaceChildren(element('h3', {}, data.name), element('div', { class: 'tiles' }, ...tiles), element('dl', {}, ...rows),
      element('h4', {}, T.uncertain), doubts.length ? element('ul', { class: 'note' }, ...doubts) : element('p', { class: 'note' }, T.nothing));
    this.host.dataset.card = data.name;
  }

  rows({ picture, class: kind, lattice, group, period_mm: period, height, roughness }) {
    const percent = (share) => `${Math.round(100 * share)} %`;
    return {
      size: `${picture.shows_mm.map(number).join(' × ')} mm, ${picture.width} × ${picture.height}`,
      class: kind.name.replaceAll('_', ' '),
      order: T.order(percent(kind.strongly_ordered), percent(kind.weakly_ordered), percent(kind.disordered)),
      lattice: lattice ? `${period.map(vectorText).join('; ')}; ${group}` : T.noLattice,
      relief: T.depth(number(height.depth_mm), number(height.rms_mm), `${height.method.replaceAll('_', ' ')}: ${height.reason}`),
      repeat: `${picture.size_mm.map(number).join(' × ')} mm`,
      roughness: T.roughness(number(roughness.rms_mm), roughness.fractal_dimension === null ? null : number(roughness.fractal_dimension)),
      overlay: roughness.overlay ? T.overlay(number(roughness.overlay.rms_mm), number(roughness.overlay.hurst), ...roughness.overlay.wavelength_range_mm.map(number)) : TEXTS.none,
    };
  }
}
