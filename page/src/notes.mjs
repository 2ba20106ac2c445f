// SPDX-License-Identifier: MIT
// Notes at spots of the scene: listed, pinned to the surface, kept in review.json.
import * as THREE from 'three';
import { download, element } from './dom.mjs';
import { icon } from './icons.mjs';

const $ = (id) => document.getElementById(id);
const VERSION = 1, PIN = 0.045;

const metres = (point) => point.toArray().map((c) => Number((c / 1000).toFixed(5)));

/** A number in a drop, as a picture that always turns to the camera. */
function pin(number) {
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

/** What is no note of this version is left out. @throws Error for what is no review at all */
export function parseReview(text) {
  const review = JSON.parse(text);
  if (review?.papilla_review !== VERSION || !Array.isArray(review.notes)) throw new Error('this is no review.json of this version');
  const isPoint = (v) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
  return review.notes.filter((note) => typeof note?.text === 'string' && isPoint(note.place_m) && isPoint(note.camera?.position_m) && isPoint(note.camera?.look));
}

export class Notes {
  /** @param data of the page, @param page shows views */
  constructor(data, page) {
    Object.assign(this, { data, page, list: [], pins: new THREE.Group() });
    page.three?.scene.add(this.pins);
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

  /** @param position mm, @param look a unit vector, @param where 'page' or 'headset' */
  add(spot, text, position, look, where, picture) {
    const note = {
      text, part: this.page.nameOf(spot.use), material: this.data.scene.materials[spot.mesh.material]?.name ?? null, place_m: metres(spot.point),
      view: this.page.view.id, camera: { position_m: metres(position), look: look.toArray().map((c) => Number(c.toFixed(4))) }, taken_in: where,
      time: new Date().toISOString(), picture,
    };
    this.list.push(note);
    this.show();
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
    text.addEventListener('change', () => { note.text = text.value; });
    const go = element('button', { type: 'button' }, icon('place'), ' Go there'), remove = element('button', { type: 'button', 'aria-label': `Remove note ${i + 1}` }, icon('remove'));
    go.addEventListener('click', () => this.page.visit(note));
    remove.addEventListener('click', () => { this.list.splice(i, 1); this.show(); });
    const picture = typeof note.picture === 'string' && note.picture.startsWith('data:image/') ? [element('img', { src: note.picture, alt: `Picture of note ${i + 1}` })] : [];
    return element('li', {}, element('b', {}, `${i + 1} ${note.part}`), ...picture, text, element('div', { class: 'row' }, go, remove));
  }
}
