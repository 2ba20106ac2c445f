// SPDX-License-Identifier: MIT
// Decals of the document: pictures that are put onto the scene, moved and turned there, and seen as the bake makes them.
import * as THREE from 'three';
import { post, upload } from './api.mjs';
import { DecalHandle } from './decal_handle.mjs';
import { DecalPanel } from './decal_panel.mjs';
import { axesOf, firstSize, isForOnePart, movedBy, placedAt, turnOf, turnedTo } from './decal_place.mjs';
import { ShownDecals } from './shown_decals.mjs';
import { T as TEXTS } from './texts.mjs';

const T = TEXTS.decals;

export class Decals {
  /** @param host the panel @param tab that shows it @param studio with state, view, edit(), say(), openTab(), progress(), failed(), refreshSoon() */
  constructor(host, tab, studio) {
    Object.assign(this, { tab, studio, view: studio.view, number: null, placing: null, wanted: null });
    this.shown = new ShownDecals(this.view, { shown: (number) => this.told(number), failed: (error) => studio.failed(error) });
    this.handle = new DecalHandle(this.view, {
      isWanted: () => this.panel.isOpen, numberAt: (ray) => this.placing ? null : this.shown.numberAt(ray), choose: (number) => this.choose(number),
      moved: (hit, isDone) => this.moveTo(hit, isDone), turnBy: (degrees) => this.turnBy(degrees), dropped: () => this.drop(),
    });
    this.panel = new DecalPanel(host, {
      add: () => this.ask((file) => this.begin(file)), giveUp: () => this.place(null), middle: () => this.placeInMiddle(), choose: (number) => this.choose(number),
      set: (values, what) => this.set(values, T.did.set(this.name, what)), turn: (degrees) => this.turnTo(degrees), move: (right, up) => this.moveBy(right, up), only: (on) => this.setOnly(on),
      picture: () => this.ask((file) => this.exchange(file)), place: () => this.place({ name: this.name, number: this.number }), go: () => this.go(), remove: () => this.remove(),
    });
    this.files = Object.assign(document.createElement('input'), { type: 'file', accept: 'image/*', hidden: true, id: 'decal-file' });
    this.files.addEventListener('change', () => { const [file] = this.files.files; this.files.value = ''; if (file) this.onFile(file); });
    host.append(this.files);
    new ResizeObserver(() => this.view.draw()).observe(host);  // The frame is there with the panel.
    document.addEventListener('keydown', (event) => { if (event.key === 'Escape' && this.placing) this.place(null); });
    studio.socket.on('failed', () => studio.refreshSoon());  // A surface that can't be made is taken as it was read.
  }

  // ---- The document.

  get decals() { return this.studio.state?.document.decals ?? []; }
  get decal() { return this.decals[this.number]; }
  get name() { return this.decal.name ?? this.decal.picture; }
  get sceneUp() { return this.view.scene?.z_up ? [0, 0, 1] : [0, 1, 0]; }

  /** Another scene. */
  clear() { this.shown.keepFirst(0); }

  /** A new state. */
  setDocument() {
    const { length } = this.decals;
    if (this.number === null ? length : this.number >= length) this.number = length ? length - 1 : null;
    if (this.placing?.number >= length) this.place(null);
    this.shown.keepFirst(length);
    this.count();
    this.showChosen();
  }

  showChosen() {
    this.panel.show(this.decals, this.number, this.sceneUp);
    this.handle.show(this.decal ?? null);
    if (this.decal) this.told(this.number);
  }

  /** Fetches those whose surfaces are there. */
  showReady() {
    const { surfaces = [], decals = [] } = this.studio.state, ready = new Set(surfaces.filter((s) => s.ready || s.problem).map(({ name }) => name));
    return this.shown.show(decals.filter((decal) => decal.surfaces.every((name) => ready.has(name))));
  }

  count() { document.body.dataset.decals = this.shown.data.size; }

  told(number) {
    this.count();
    if (number === this.number) this.panel.tell(this.shown.data.get(number), this.studio.state.decals[number]?.problem || this.shown.problems.get(number));
  }

  choose(number) {
    this.number = number;
    this.showChosen();
  }

  // ---- Changes.

  editOf(values, more = {}) { return { kind: 'set-decal', decal: this.number, values, ...more }; }
  set(values, title, more) { return this.studio.edit([this.editOf(values, more)], title); }
  turnTo(degrees) { return this.set({ '/up': turnedTo(this.decal, this.sceneUp, degrees).up }, T.did.set(this.name, T.turn)); }
  turnBy(degrees) { return this.turnTo(Math.round(turnOf(this.decal, this.sceneUp) + degrees)); }

  async remove() {
    await this.studio.edit([{ kind: 'remove-decal', decal: this.number }], T.did.remove(this.name));
    (this.decals.length ? this.panel.list : this.panel.add).focus();
  }

  /** Keys of a decal in whose middle a place of the scene lies. @param hit of View.hitOf() */
  keysAt({ point, smooth }, degrees) {
    const { root } = this.view, turn = root.getWorldQuaternion(new THREE.Quaternion()).invert();
    return placedAt(root.worldToLocal(point.clone()).toArray(), smooth.clone().applyQuaternion(turn).toArray(), this.sceneUp, degrees);
  }

  /** The change that brings the chosen decal to a place: one that is for a part goes over to that one. */
  editTo(hit) {
    const { at, direction, up } = this.keysAt(hit, turnOf(this.decal, this.sceneUp));
    return this.editOf({ '/at': at, '/direction': direction, '/up': up }, isForOnePart(this.decal) ? { onto: hit.use } : {});
  }

  moveTo(hit, isDone) {
    const edit = this.editTo(hit), { values } = edit;
    this.isDragged = !isDone;
    if (isDone) return this.studio.edit([edit], T.did.set(this.name, T.place)).then((done) => done || this.drop());
    this.handle.show({ ...this.decal, at: values['/at'], direction: values['/direction'], up: values['/up'] });
    return this.preview(edit);
  }

  /** As the document has it, after a drag that was given up. */
  drop() {
    this.isDragged = false;
    this.showChosen();
    this.showReady();
  }

  /** Shows what a change would make while it is dragged: one request at a time, the newest next. */
  async preview(edit) {
    this.wanted = edit;
    if (this.isAsking) return;
    this.isAsking = true;
    try {
      while (this.wanted && this.isDragged) {
        const { wanted } = this;
        this.wanted = null;
        const { decals } = await post('try', { edits: [wanted] });
        if (this.isDragged) await this.shown.show(decals);
      }
    } catch (error) {
      this.studio.say(error.message, true);
    }
    this.isAsking = false;
  }

  /** What of the scene lies under a place of a decal's picture; null when nothing does. */
  under(decal, point) {
    const { root } = this.view, { out } = axesOf(decal), half = decal.depth_mm / 2;
    const from = root.localToWorld(new THREE.Vector3(...point).addScaledVector(new THREE.Vector3(...out), half)), to = root.localToWorld(new THREE.Vector3(...point).addScaledVector(new THREE.Vector3(...out), -half));
    return this.view.hitOf(new THREE.Raycaster(from, to.clone().sub(from).normalize(), 0, from.distanceTo(to)));
  }

  /** Along the surface, as far as it reaches; else in the plane of the picture. */
  moveBy(right, up) {
    if (!Number.isFinite(right + up)) return undefined;
    const point = movedBy(this.decal, right, up), hit = this.under(this.decal, point);
    return this.studio.edit([hit ? this.editTo(hit) : this.editOf({ '/at': point.map((x) => Number(x.toFixed(3))) })], T.did.set(this.name, T.place));
  }

  setOnly(on) {
    const hit = on ? this.under(this.decal, this.decal.at) : null;
    if (on && !hit) { this.studio.say(T.nothingUnder, true); return this.showChosen(); }
    return this.set({}, T.did.set(this.name, T.only), { onto: hit?.use ?? null });
  }

  // ---- Pictures and places.

  /** @param onFile gets the file that is chosen */
  ask(onFile) {
    this.onFile = onFile;
    this.files.click();
  }

  /** Takes a picture into the folder. @returns {picture, pixels: [width, height]} or null */
  async take(file) {
    try {
      const { width, height } = await createImageBitmap(file).catch(() => ({ width: 1, height: 1 }));  // One that this browser does not know.
      const { file: picture } = await upload('photograph', file, (share) => this.studio.progress(TEXTS.sending(file.name, Math.round(100 * share)), share)).promise;
      return { picture, pixels: [width, height] };
    } catch (error) {
      this.studio.say(error.message, true);
      return null;
    } finally {
      this.studio.progress(null);
    }
  }

  /** A picture that becomes a decal at the next press on the scene, or at a place at once. */
  async begin(file, hit = null) {
    const taken = await this.take(file);
    if (!taken) return;
    this.place({ name: taken.picture, ...taken });
    if (hit) this.pick(hit);
  }

  async exchange(file) {
    const taken = await this.take(file);
    if (taken) this.set({ '/picture': taken.picture }, T.did.set(this.name, T.picture));
  }

  /** What the next press on the scene places: {name, picture, pixels}, {name, number}, or null for nothing. */
  place(what) {
    this.placing = what;
    this.panel.setPlacing(what?.name ?? null);
    if (what) this.view.canvas.dataset.mode = 'decal';
    else delete this.view.canvas.dataset.mode;
    if (what && !this.panel.isOpen) this.studio.openTab(this.tab);
  }

  /** A press on the scene. @param hit of View.hitAt() @returns whether it was meant for a decal */
  pick(hit) {
    const { placing } = this;
    if (!placing || !hit) return Boolean(placing);
    this.place(null);
    if (placing.number === undefined) this.addAt(hit, placing);
    else {
      this.number = placing.number;
      this.studio.edit([this.editTo(hit)], T.did.set(placing.name, T.place));
    }
    return true;
  }

  async addAt(hit, { picture, pixels }) {
    const { at, direction, up } = this.keysAt(hit, 0), { size_mm: size, depth_mm: depth } = firstSize(pixels, this.view.box().getSize(new THREE.Vector3()).length());
    const values = { '/picture': picture, '/at': at, '/direction': direction, '/up': up, '/size_mm': size, '/depth_mm': depth };
    if (await this.studio.edit([{ kind: 'add-decal', values, onto: hit.use }], T.did.add(picture))) this.choose(this.decals.length - 1);
  }

  placeInMiddle() {
    const { left, top, width, height } = this.view.canvas.getBoundingClientRect(), hit = this.view.hitAt({ clientX: left + width / 2, clientY: top + height / 2 });
    if (!hit) return this.studio.say(TEXTS.feel.nothing, true);
    return this.pick(hit);
  }

  /** Looks at the chosen decal from before it. */
  go() {
    const { view } = this, { out } = axesOf(this.decal), far = 3 * Math.max(...this.decal.size_mm);
    view.setMode('orbit');
    view.controls.target.copy(view.root.localToWorld(new THREE.Vector3(...this.decal.at)));
    view.camera.position.copy(view.root.localToWorld(new THREE.Vector3(...movedBy(this.decal, 0, 0)).addScaledVector(new THREE.Vector3(...out), far)));
    view.controls.update();
    view.draw();
  }

  /** Whether files that are dropped become decals. */
  get takesFiles() { return this.panel.isOpen; }
}
