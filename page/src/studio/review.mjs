// SPDX-License-Identifier: MIT
// Notes at places of the scene: pins, a list, kept by the server in review.json beside the document (docs/vr.md).
import * as THREE from 'three';
import { element } from '../dom.mjs';
import { pin } from '../notes.mjs';
import { parseReview } from '../review_file.mjs';
import { get, post } from './api.mjs';
import { T as TEXTS } from './texts.mjs';

const T = TEXTS.review, PICTURE_PX = 480, METRES = 1e-3;
/** Notes say the zoom of a camera of 40 degrees, as the report page has it. */
const REPORT_FOV = 40;

const rounded = (numbers, digits) => numbers.map((x) => Number(x.toFixed(digits)));

export class Review {
  constructor(host, { view, socket, say, labelOf }) {
    Object.assign(this, { host, view, say, labelOf, notes: [], spot: null, pins: new THREE.Group() });
    view.stage.add(this.pins);
    this.add = element('button', { type: 'button', id: 'note-add' }, T.add);
    this.add.addEventListener('click', () => this.take());
    this.list = element('ol', { id: 'notes', class: 'notes' });
    host.replaceChildren(element('p', { class: 'note' }, T.help), element('div', { class: 'row' }, this.add), this.list);
    socket.on('review', () => this.load());
    this.load();
  }

  load() { return this.ask(get('review')); }

  async ask(answer) {
    try {
      this.show(parseReview(JSON.stringify(await answer)));
    } catch (error) {
      this.say(error.message, true);
    }
  }

  /** What was picked last: a note goes there. */
  pickAt(hit) { this.spot = hit; }

  get zoomOf40() { return Math.tan(REPORT_FOV / 2 * Math.PI / 180) / Math.tan(this.view.camera.fov / 2 * Math.PI / 180); }

  /** A note with what the camera sees, in metres and with Y up. */
  take() {
    const { spot, view } = this;
    if (!spot) return this.say(T.pickFirst);
    const { camera } = view, { label, material } = this.labelOf(spot.key);
    const note = {
      id: crypto.randomUUID(), text: '', part: label, material, place_m: rounded(spot.point.clone().multiplyScalar(METRES).toArray(), 5), view: view.overlay,
      camera: { position_m: rounded(camera.position.clone().multiplyScalar(METRES).toArray(), 5), look: rounded(camera.getWorldDirection(new THREE.Vector3()).toArray(), 4) },
      zoom: camera.zoom * this.zoomOf40, taken_in: 'studio', time: new Date().toISOString(), picture: this.picture(),
    };
    return this.put(note).then(() => this.list.lastElementChild?.querySelector('textarea').focus());
  }

  put(note) { return this.ask(post('review', { put: note })); }

  picture() {
    const { renderer, world, camera, canvas } = this.view, width = Math.min(PICTURE_PX, canvas.width);
    renderer.render(world, camera);
    const small = Object.assign(document.createElement('canvas'), { width, height: Math.round(width * canvas.height / canvas.width) });
    small.getContext('2d').drawImage(canvas, 0, 0, small.width, small.height);
    return small.toDataURL('image/jpeg', 0.8);
  }

  show(notes) {
    this.notes = notes;
    const typing = this.list.contains(document.activeElement) && document.activeElement.tagName === 'TEXTAREA' ? document.activeElement.dataset.id : null;
    if (typing === null || !notes.some(({ id }) => id === typing)) this.list.replaceChildren(...notes.map((note, i) => this.item(note, i)));
    this.pins.clear();
    notes.forEach((note, i) => {
      const sprite = pin(i + 1);
      sprite.position.fromArray(note.place_m).divideScalar(METRES);
      this.pins.add(sprite);
    });
    this.host.dataset.notes = notes.length;
    this.view.draw();
  }

  item(note, i) {
    const text = element('textarea', { 'aria-label': T.note(i + 1, note.part), rows: 2, 'data-id': note.id });
    text.value = note.text;
    text.addEventListener('change', () => this.ask(post('review', { put: { ...note, text: text.value } })));
    const go = element('button', { type: 'button' }, T.go), remove = element('button', { type: 'button', 'aria-label': T.removeOf(i + 1) }, T.remove);
    go.addEventListener('click', () => this.visit(note));
    remove.addEventListener('click', () => this.ask(post('review', { remove: note.id })));
    const picture = typeof note.picture === 'string' && note.picture.startsWith('data:image/') ? [element('img', { src: note.picture, alt: T.pictureOf(i + 1) })] : [];
    return element('li', {}, element('b', {}, note.part), ` ${note.taken_in ? T.takenIn[note.taken_in] ?? note.taken_in : ''}`, ...picture, text, element('div', { class: 'row' }, go, remove));
  }

  /** Looks as who took the note did. */
  visit({ place_m: place, camera: { position_m: position, look }, view: overlay, zoom }) {
    const { view } = this, eye = new THREE.Vector3(...position).divideScalar(METRES), far = eye.distanceTo(new THREE.Vector3(...place).divideScalar(METRES));
    view.setMode('orbit');
    view.camera.position.copy(eye);
    view.camera.zoom = (zoom ?? 1) / this.zoomOf40;
    view.camera.updateProjectionMatrix();
    view.controls.target.copy(eye).addScaledVector(new THREE.Vector3(...look), far);
    view.controls.update();
    if (overlay in TEXTS.overlays) view.setOverlay(overlay);
    view.draw();
  }
}
