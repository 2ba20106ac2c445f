// SPDX-License-Identifier: MIT
// Notes at spots of the scene: listed, pinned to the surface, kept in review.json.
import * as THREE from 'three';
import { download, element } from './dom.mjs';
import { icon } from './icons.mjs';
import { VERSION, parseReview } from './review_file.mjs';

const $ = (id) => document.getElementById(id);
const PIN = 0.045;

const metres = (point) => point.toArray().map((c) => Number((c / 1000).toFixed(5)));

/** A number in a drop, as a picture that always turns to the camera. */
export function pin(number) {
  const canvas = Object.assign(document.createElement('canvas'), { width: 64, height: 64 }), context = canvas.getContext('2d');
  context.fillStyle = '#d55e00';
  context.strokeStyle = '#fff';
  context.lineWidth = 4;
  context.beginPath();
  context.arc(32, 26, 20, 0.75 * Math.PI, 0.25 * Math.PI);
  context.lineTo(32, 62);
  context.closePath();
  context.fill();
  context.stroke();
  context.fillStyle = '#fff';
  context.font = 'bold 24px sans-serif';
  context.textAlign = 'center';
  context.fillText(number, 32, 35);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map, sizeAttenuation: false, depthTest: false, transparent: true, toneMapped: false }));
  sprite.center.set(0.5, 0.03);
  sprite.scale.setScalar(PIN);
  sprite.renderOrder = 15;
  return sprite;
}

/** @param page {nameOf(use), scene, view} @param position mm, @param look a unit vector, @param where 'page' or 'headset' */
export function noteOf(page, spot, text, position, look, where, picture) {
  return {
    text, part: page.nameOf(spot.use), material: page.scene.materials[spot.mesh.material]?.name ?? null, place_m: metres(spot.point),
    view: page.view.id, camera: { position_m: metres(position), look: look.toArray().map((c) => Number(c.toFixed(4))) }, taken_in: where,
    time: new Date().toISOString(), picture, id: crypto.randomUUID?.() ?? `${Date.now()}-${Math.random()}`,
  };
}

export class Notes {
  /** @param data of the page, @param page shows views */
  constructor(data, page) {
    Object.assign(this, { data, page, list: [], pins: new THREE.Group() });
    page.three?.scene.add(this.pins);
    /** Where the page comes from a studio that keeps the notes. */
    this.server = document.documentElement.dataset.review ? `${document.documentElement.dataset.review}${location.search}` : null;
    if (this.server) this.ask(fetch(this.server));
    $('note-add').addEventListener('click', () => this.addAtPick());
    $('notes-save').addEventListener('click', () => this.save());
    $('notes-open').addEventListener('change', (e) => this.open(e.target));
    this.show();
  }

  take(text) {
    try {
      this.list = parseReview(text);
      this.say(`${this.list.length} of the file's notes shown.`);
    } catch (error) {
      this.say(`Can't be read: ${error.message}.`);
    }
    this.show();
  }

  /** What the server keeps after a request. */
  async ask(request) {
    try {
      const answer = await request, text = await answer.text();
      if (!answer.ok) throw new Error(JSON.parse(text).error);
      this.list = parseReview(text);
      this.show();
    } catch (error) {
      this.say(`The notes were not kept: ${error.message}.`);
    }
  }

  /** @param change {put: note} or {remove: id} */
  keep(change) { if (this.server) this.ask(fetch(this.server, { method: 'POST', body: JSON.stringify(change) })); }

  async open(input) {
    if (input.files[0]) this.take(await input.files[0].text());
    input.value = '';
  }

  say(text) { $('notes-state').textContent = text; }

  addAtPick() {
    const { spot, three } = this.page;
    if (!spot || !three) return this.say('Pick a spot in the scene first.');
    const note = this.add(spot, '', three.camera.position, three.camera.getWorldDirection(new THREE.Vector3()), 'page', three.picture(480));
    note.zoom = three.camera.zoom;
    $('notes-list').lastElementChild?.querySelector('textarea').focus();
    return undefined;
  }

  /** As noteOf(). */
  add(...seen) {
    const note = noteOf(this.page, ...seen);
    this.list.push(note);
    this.show();
    this.keep({ put: note });
    return note;
  }

  json() { return JSON.stringify({ papilla_review: VERSION, scene: this.data.scene.file, notes: this.list }, null, 2) + '\n'; }

  save() { download('review.json', this.json(), 'application/json'); }

  show() {
    this.pins.clear();
    $('notes-list').replaceChildren(...this.list.map((note, i) => this.item(note, i)));
    this.list.forEach((note, i) => {
      const sprite = pin(i + 1);
      sprite.position.fromArray(note.place_m).multiplyScalar(1000);
      this.pins.add(sprite);
    });
    this.page.three?.invalidate();
  }

  item(note, i) {
    const text = element('textarea', { 'aria-label': `Note ${i + 1}, ${note.part}` });
    text.value = note.text;
    text.addEventListener('change', () => { note.text = text.value; this.keep({ put: note }); });
    const go = element('button', { type: 'button' }, icon('place'), ' Go there'), remove = element('button', { type: 'button', 'aria-label': `Remove note ${i + 1}` }, icon('remove'));
    go.addEventListener('click', () => this.page.visit(note));
    remove.addEventListener('click', () => { this.list.splice(i, 1); this.show(); this.keep({ remove: note.id }); });
    const picture = typeof note.picture === 'string' && note.picture.startsWith('data:image/') ? [element('img', { src: note.picture, alt: `Picture of note ${i + 1}` })] : [];
    return element('li', {}, element('b', {}, `${i + 1} ${note.part}`), ...picture, text, element('div', { class: 'row' }, go, remove));
  }
}
