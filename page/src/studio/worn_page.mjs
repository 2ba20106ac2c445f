// SPDX-License-Identifier: MIT
// The studio as the headset takes it (WornPage of xr/headset.mjs).
import * as THREE from 'three';
import { Compare } from '../compare.mjs';
import { noteOf } from '../notes.mjs';
import { VIEWS, rangeOf } from '../views.mjs';
import { bytes, filesOf, parseSurface, post } from './api.mjs';
import { geometryOf } from './surface_look.mjs';
import { T } from './texts.mjs';
import { WornView } from './worn_view.mjs';

export class WornPage {
  constructor(studio) {
    const three = new WornView(studio.view, (text, isProblem) => this.say(text, isProblem));
    Object.assign(this, { studio, three, scene: three, compare: new Compare(three, three), view: VIEWS[0], chosen: null, spot: null, answers: new Map(), tries: 0 });
    this.notes = { get list() { return studio.review.notes; }, add: (...seen) => studio.review.put(noteOf(this, ...seen)) };
    studio.socket.on('ready', ({ surface }) => this.told(surface, null));
    studio.socket.on('failed', ({ surface, problem }) => this.told(surface, problem));
  }

  // ---- What is shown.

  get range() { return rangeOf(this.view, this.three); }

  switchTo(view) {
    this.view = view;
    this.three.canvas.dataset.view = view.id;
    this.compare.view(view, this.range);
  }

  nameOf(use) {
    const { scene } = this.studio, { path, part } = scene.uses[use];
    return path.split('/').at(-1) || scene.parts[part].name;
  }

  pick(spot) {
    if (this.chosen) this.compareWith(null);
    this.spot = spot;
    this.studio.select([spot.object.userData.key], false);
    this.three.outlineOf(spot);
  }

  say(text, isProblem) { this.studio.say(text, isProblem); }

  wear(on) {
    this.spot = null;
    this.compareWith(null);
    this.view = VIEWS.find(({ id }) => id === this.studio.view.overlay) ?? VIEWS[0];
    this.three.wear(on);
  }

  // ---- Another material beside.

  /** Materials of the document, then those of the library. */
  get choices() {
    const own = Object.keys(this.studio.state?.document.materials ?? {}).map((material) => ({ name: material, group: T.inUse, what: { material } }));
    return [...own, ...this.studio.library.map((m) => ({ name: m.names.en, group: m.name.split('/')[0], what: { library: m.name } }))];
  }

  /** The list may change: what is chosen stays. */
  get b() {
    const index = this.choices.findIndex(({ what }) => JSON.stringify(what) === JSON.stringify(this.chosen));
    return index < 0 ? null : index;
  }

  /** The server makes the picked surface of a choice, as if it had been assigned; shown when it is there. */
  async compareWith(index) {
    const { spot } = this, attempt = ++this.tries;
    this.chosen = spot && index !== null ? this.choices[index].what : null;
    this.values = this.chosen && this.valuesOf(this.chosen);
    this.showSecond(null);
    if (!this.chosen) return;
    try {
      const b = await this.surfaceOf(spot, this.chosen);
      if (attempt !== this.tries) return;
      const second = await this.secondOf(b);
      await this.three.loadReliefs([b]);
      if (attempt === this.tries) this.showSecond(second, spot);
    } catch (error) {
      this.say(error.message, true);
      if (attempt === this.tries) this.chosen = null;
    }
  }

  /** What the document says of a choice. */
  valuesOf({ material }) { return JSON.stringify(this.studio.state.document.materials[material] ?? null); }

  /** The document may have changed: B is made anew where its material has. */
  documentChanged() {
    if (this.chosen && this.valuesOf(this.chosen) !== this.values) this.compareWith(this.b);
  }

  /** {data, files} of the surface at a spot, of another material. */
  async surfaceOf({ use, object: { userData: { key } } }, what) {
    const shown = this.studio.view.surfaces.get(key), { edits } = this.studio.editOf(what, [key]);
    const { surfaces } = await post('try', { edits }), wanted = surfaces.find((s) => s.part === shown.data.part && s.slot === shown.data.slot && s.uses.includes(use));
    if (!wanted) return shown;  // It is of that material.
    if (!wanted.ready) await this.until(wanted.name);
    return { data: parseSurface(await bytes('surface', { id: wanted.name })), files: filesOf({ id: wanted.name }) };
  }

  async secondOf({ data, files }) {
    const geometry = geometryOf(data.arrays), mesh = this.three.meshOf(data, geometry), standard = await this.studio.view.looks.materialOf(data.look, files.picture);
    return { mesh, geometry, standard, material: this.three.looks[mesh.material], ratio: [1, 1] };
  }

  /** B on the picked surface of the picked use, or none. */
  showSecond(second, spot) {
    const before = this.three.second, key = spot?.object.userData.key;
    this.three.second = second;
    this.compare.show(spot?.use, second && (({ object }) => object.userData.key === key ? second : null));
    before?.geometry.dispose();
    if (second) this.three.takeSoon();
  }

  until(name) {
    return new Promise((resolve, reject) => {
      this.waiting = { name, resolve, reject };
      if (this.answers.has(name)) this.settle(name);
    });
  }

  /** The server made a surface, or could not. */
  told(name, problem) {
    this.answers.set(name, problem);
    if (this.waiting?.name === name) this.settle(name);
  }

  settle(name) {
    const problem = this.answers.get(name), { resolve, reject } = this.waiting;
    this.waiting = null;
    if (problem) reject(new Error(problem));
    else resolve();
  }
}
