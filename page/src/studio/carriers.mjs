// SPDX-License-Identifier: MIT
// Carriers of the document: pictures instead of parts, seen as the bake makes them.
import { CarrierPanel } from './carrier_panel.mjs';
import { ShownCarriers } from './shown_carriers.mjs';
import { T as TEXTS } from './texts.mjs';

const T = TEXTS.carriers;

export class Carriers {
  /** @param host the panel of decals, below which they stand @param studio with state, view, decals, selected, surfacesOf(), edit(), say(), failed() */
  constructor(host, studio) {
    Object.assign(this, { studio, number: null });
    this.shown = new ShownCarriers(studio.view, { shown: () => this.told(), failed: (error) => studio.failed(error) });
    this.panel = new CarrierPanel(host, {
      add: () => studio.decals.ask((file) => this.addFile(file)), render: () => this.add({ '/picture': { render: true } }, T.ownPicture), choose: (number) => this.choose(number),
      set: (values, what) => studio.edit([{ kind: 'set-carrier', carrier: this.number, values }], T.did.set(this.name, what)),
      picture: () => studio.decals.ask((file) => this.exchange(file)), remove: () => this.remove(),
    });
  }

  get carriers() { return this.studio.state?.document.replace ?? []; }
  get name() { return CarrierPanel.nameOf(this.carriers[this.number]); }

  /** Another scene. */
  clear() { this.shown.keepFirst(0); }

  /** A new state. */
  setDocument() {
    const { length } = this.carriers;
    if (this.number === null ? length : this.number >= length) this.number = length ? length - 1 : null;
    if (!length) this.shown.keepFirst(0);
    this.choose(this.number);
  }

  /** Fetches them when all of what they stand for is there. */
  showReady() {
    const { surfaces = [], carriers } = this.studio.state, ready = new Set(surfaces.filter((s) => s.ready || s.problem).map(({ name }) => name));
    return carriers?.surfaces.every((name) => ready.has(name)) ? this.shown.showAll(carriers) : undefined;
  }

  choose(number) {
    this.number = number;
    this.panel.show(this.carriers, number);
    this.told();
  }

  told() {
    const { number, shown } = this, { carriers } = this.studio.state;
    document.body.dataset.carriers = shown.told?.rectangles.length ?? 0;
    if (number !== null) this.panel.tell(shown.told, number, carriers?.problems[number] || shown.problem);
  }

  async exchange(file) {
    const taken = await this.studio.decals.take(file);
    if (taken) this.panel.handlers.set({ '/picture': taken.picture }, T.picture);
  }

  async addFile(file) {
    if (!this.studio.selected.size) return this.studio.say(T.selectFirst, true);
    const taken = await this.studio.decals.take(file);
    return taken && this.add({ '/picture': taken.picture }, taken.picture);
  }

  /** One for each part that is selected: where it lies and how large it is tells the bake. */
  async add(values, name) {
    const uses = new Map(this.studio.surfacesOf(this.studio.selected).map((surface) => [surface.part, surface.uses[0]]));
    if (!uses.size) return this.studio.say(T.selectFirst, true);
    const edits = [...uses.values()].map((use) => ({ kind: 'add-carrier', values, onto: use }));
    if (await this.studio.edit(edits, T.did.add(name))) this.choose(this.carriers.length - 1);
    return undefined;
  }

  async remove() {
    await this.studio.edit([{ kind: 'remove-carrier', carrier: this.number }], T.did.remove(this.name));
    (this.carriers.length ? this.panel.list : this.panel.add).focus();
  }
}
