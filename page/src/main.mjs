// SPDX-License-Identifier: MIT
// Puts the page together.
import * as THREE from 'three';
import { fillCards, repaintCards } from './cards.mjs';
import { number } from './colour.mjs';
import { Compare, materialOn } from './compare.mjs';
import { load } from './data.mjs';
import { count, element } from './dom.mjs';
import { fillIcons } from './icons.mjs';
import { showLegend } from './legend.mjs';
import { Live } from './live.mjs';
import { Looks } from './looks.mjs';
import { Notes } from './notes.mjs';
import { PartsList } from './parts_list.mjs';
import { SceneView } from './scene_view.mjs';
import { fillTables } from './tables.mjs';
import { showTab, startTabs } from './tabs.mjs';
import { Touch } from './touch.mjs';
import { UvView } from './uv_view.mjs';
import { Headset } from './xr/headset.mjs';
import { VIEWS, checkerText, rangeOf, reasonOff, valueOf } from './views.mjs';

const $ = (id) => document.getElementById(id);

function problem(text) {
  $('problem').hidden = false;
  $('problem').append(element('div', {}, text));
}

class Page {
  constructor(data) {
    this.data = data;
    this.scene = data.scene;
    this.view = VIEWS[0];
    this.ranges = new Map();
    this.b = null;
  }

  start() {
    const { scene, data } = this;
    fillIcons();
    if (data.live) for (const node of document.querySelectorAll('[role=tab][data-live]')) node.hidden = false;
    startTabs();
    this.writeHead();
    this.theme();
    this.listViews();
    this.touch = new Touch(scene, reasonOff(VIEWS[7], scene));
    fillTables(data, this.touch, (name) => this.selectByName(name));
    this.openViews();
    this.list = new PartsList(scene.finest_instances, (use) => this.nameOf(use), (use) => this.select(use, true));
    this.tools();
    this.listMaterials();
    this.switchTo(this.view);
    this.selectFirst();
    this.notes = new Notes(data, this);
    this.headset = new Headset(this);
    this.headset.offer();
    if (data.live) this.live = new Live(data.title, this.three);
    if (data.looks) this.looks = new Looks(data.looks, this.three);
    return fillCards($('cards'), scene, data.report, this.three);
  }

  writeHead() {
    const { scene, data } = this;
    document.title = `${data.title} · Papilla`;
    $('title').textContent = data.title;
    const fewer = scene.triangles_shown < scene.triangles;
    $('summary').textContent = `${count(scene.triangles, 'triangle')} in ${count(scene.parts.length - this.coarserParts(), 'part')}; `
      + (scene.levels.length ? `coarser levels of detail at ${count(scene.levels.length, 'place')}, by size on the screen; ` : '')
      + (fewer ? `${scene.triangles_shown.toLocaleString('en')} shown, simplified for this page by about ${number(scene.error_mm)} mm at most` : 'all of them shown');
    $('summary').title = $('summary').textContent;
    $('footer').textContent = data.live ? `Served by ${data.program}, on this machine only. The samples come from its player; nothing is loaded from anywhere else.`
      : data.looks ? `Served by ${data.program}, on this machine only. Nothing is loaded from anywhere else.`
      : `Written by ${data.program}. Everything is in this file; nothing is loaded from anywhere.`;
  }

  openViews() {
    if (!this.scene.triangles) return problem('The file has no triangles: there is nothing to show.');
    if (reasonOff(VIEWS[1], this.scene)) problem('No part has texture coordinates: the views of distortion are off.');
    if (reasonOff(VIEWS[5], this.scene)) problem(`The views of touch are off: ${reasonOff(VIEWS[5], this.scene)}.`);
    try {
      this.three = new SceneView($('canvas3d'), this.scene, (hit) => this.pick(hit), (hit) => this.hover(hit));
      this.uv = new UvView($('canvasuv'), this.scene, (hit) => this.pickUv(hit));
      this.compare = new Compare(this.three, this.scene);
      this.touch.compare = this.compare;
      this.paint();
    } catch (error) {
      problem(`The browser can't draw in 3D (${error.message}); numbers, materials and touch work without.`);
    }
  }

  theme() {
    $('theme').addEventListener('click', () => {
      const dark = document.documentElement.dataset.theme ? document.documentElement.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
      document.documentElement.dataset.theme = dark ? 'light' : 'dark';
      this.paint();
    });
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.paint());
  }

  paint() {
    const style = getComputedStyle(document.documentElement);
    this.three?.setBackground(style.getPropertyValue('--scene').trim());
    this.uv?.setBackground(style.getPropertyValue('--card').trim());
    this.touch.repaint();
    this.live?.repaint();
    repaintCards();
  }

  listViews() {
    VIEWS.forEach((view, i) => {
      const why = reasonOff(view, this.scene) ?? (this.scene.triangles ? null : 'there are no triangles');
      const input = element('input', { type: 'radio', name: 'view', value: view.id, id: `view-${view.id}` });
      const label = element('label', why ? { 'data-off': '', title: `Off: ${why}` } : {}, input, element('kbd', {}, String(i + 1)), view.name);
      input.disabled = Boolean(why);
      input.checked = view === this.view;
      input.addEventListener('change', () => this.switchTo(view));
      $('views').append(label);
    });
  }

  tools() {
    const { three } = this;
    const onClick = (id, action) => $(id).addEventListener('click', () => three && action());
    onClick('go-home', () => three.goHome());
    onClick('go-outside', () => three.frameAll());
    onClick('go-frame', () => three.frameSelected());
    onClick('zoom-in', () => three.zoomBy(1.25));
    onClick('zoom-out', () => three.zoomBy(1 / 1.25));
    onClick('touch-mode', () => showTab($('touch').hidden ? 'tab-touch' : 'tab-parts'));
    onClick('full-screen', () => document.fullscreenElement ? document.exitFullscreen() : document.querySelector('.stage').requestFullscreen());
    if (three && !three.seat) $('go-home').disabled = true;
    document.querySelector('.panel [role=tablist]').addEventListener('choose', ({ detail }) => {
      const on = detail === 'tab-touch';
      this.touch.useScene(three, on);
      $('touch-mode').setAttribute('aria-pressed', String(on));
    });
    document.addEventListener('keydown', (e) => this.keys(e));
  }

  keys(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || /INPUT|SELECT|TEXTAREA/.test(event.target.tagName) && event.target.type !== 'radio') return;
    const view = VIEWS[Number(event.key) - 1];
    if (view && !$(`view-${view.id}`).disabled) this.switchTo(view);
    if (event.key.toLowerCase() === 't') $('touch-mode').click();
  }

  switchTo(view) {
    this.view = view;
    $(`view-${view.id}`).checked = true;
    if (!this.ranges.has(view.id)) this.ranges.set(view.id, rangeOf(view, this.scene));
    const { range } = this;
    this.three?.setView(view, range);
    this.compare?.view(view, range);
    this.uv?.setView(view, range);
    showLegend(view, range, checkerText(this.scene));
  }

  get range() { return this.ranges.get(this.view.id); }

  wear(on) { this.three.wear(on); }

  say(text) { $('picked').textContent = text; }

  /** Parts that are nothing but coarser levels of detail. */
  coarserParts() {
    const { instances, finest_instances: finest } = this.scene, parts = new Set(instances.slice(finest).map(({ part }) => part));
    for (const { part } of instances.slice(0, finest)) parts.delete(part);
    return parts.size;
  }

  nameOf(use) {
    const { name, part } = this.scene.instances[use];
    return name || this.scene.parts[part].name || `part ${part}`;
  }

  /** Materials that B can be, each look once. */
  listMaterials() {
    const list = $('compare');
    this.choices = this.scene.materials.map(({ name }, i) => ({ name: name || `material ${i}`, group: '' }));
    list.add(new Option('nothing', ''));
    this.choices.forEach(({ name }, i) => list.add(new Option(name, i)));
    list.addEventListener('change', () => this.compareWith(list.value === '' ? null : Number(list.value)));
  }

  /** @param index of the material that is B, or null */
  compareWith(index) {
    this.b = index;
    this.compare?.show(this.selected, index === null ? null : materialOn(this.three, this.scene, index));
    $('compare').value = index ?? '';
    $('compare-text').hidden = index === null;
    if (index !== null) $('compare-text').textContent = `One half of ${this.nameOf(this.selected)} is ${this.scene.materials[index].name}, its grain in its own size.`;
  }

  /** The part with uv, so that the layout is not empty, that the first view shows most of. */
  selectFirst() {
    const { parts, instances } = this.scene;
    if (!this.scene.triangles) return;
    const hasUv = (use) => parts[instances[use].part].meshes.some((m) => m.uv);
    const seen = this.three?.seen() ?? [];
    this.select(seen.find(hasUv) ?? seen[0] ?? Math.max(0, instances.findIndex((_, use) => hasUv(use))), false);
    if (this.three) this.three.outline.visible = false;  // nobody chose it yet
  }

  selectByName(name) {
    const use = this.scene.instances.findIndex((u, i) => this.nameOf(i) === name || this.scene.parts[u.part].name === name);
    if (use >= 0) { this.select(use, true); $('scene').scrollIntoView(); }
  }

  select(use, frame) {
    if (this.selected !== use) {
      this.selected = use;
      this.list.select(use);
      this.uv?.show(use);
      const part = this.scene.parts[this.scene.instances[use].part];
      $('uv-text').textContent = part.meshes.some((m) => m.uv) ? `${this.nameOf(use)}: orange lines are borders of charts. Click picks in 3D.` : `${this.nameOf(use)} has no texture coordinates.`;
      $('canvasuv').dataset.part = this.nameOf(use);
      if (this.compare?.use !== undefined && this.compare.use !== null) this.compareWith(null);
    }
    this.three?.select(use, frame);
    const { meshes } = this.scene.parts[this.scene.instances[use].part];
    this.touch.follow(meshes.map((m) => this.scene.materials[m.material]).find((m) => m?.relief));
    this.describe(use);
  }

  describe(use, hit) {
    const part = this.scene.parts[this.scene.instances[use].part];
    const names = [...new Set(part.meshes.map((m) => this.scene.materials[m.material]?.name ?? 'no material'))];
    let text = `${this.nameOf(use)}: ${count(part.triangles, 'triangle')}, ${names.slice(0, 3).join(', ')}`;
    if (hit) text += `; ${this.readout(hit)}`;
    this.say(text);
  }

  /** Values at a spot, all views at once. */
  readout({ mesh, face, bary, uv }) {
    const material = this.scene.materials[mesh.material], { indices, measured } = mesh.data;
    const near = indices[3 * face + bary.indexOf(Math.max(...bary))];
    const at = measured.subarray(3 * near, 3 * near + 3), parts = [];
    for (const view of VIEWS.slice(2, 7)) {
      const value = valueOf(view, material, at);
      if (Number.isFinite(value)) parts.push(`${view.name} ${number(value)} ${view.unit}`.trim());
    }
    if (mesh.uv) parts.push(`uv ${number(uv.x)}, ${number(uv.y)}`);
    return parts.join(', ');
  }

  pick(hit) {
    if (!hit) return;
    this.spot = hit;
    this.select(hit.use, false);
    this.touch.follow(this.scene.materials[hit.mesh.material]);
    this.describe(hit.use, hit);
    this.three.mark(hit.use, hit.mesh, hit.local);
    if (hit.mesh.uv) this.uv.mark(hit.uv.x, hit.uv.y);
  }

  hover(hit) {
    $('canvas3d').title = hit ? `${this.nameOf(hit.use)}: ${this.readout(hit)}` : '';
  }

  pickUv(hit) {
    const { positions, indices } = hit.mesh.data, local = this.three.marker.position.clone().set(0, 0, 0);
    hit.bary.forEach((weight, k) => {
      const i = 3 * indices[3 * hit.face + k];
      local.x += weight * positions[i];
      local.y += weight * positions[i + 1];
      local.z += weight * positions[i + 2];
    });
    this.describe(hit.use, hit);
    const place = this.three.surface.places.find(({ object: { userData } }) => userData.use === hit.use && userData.mesh === hit.mesh);
    this.spot = this.three.surface.spot(place, hit.face, local);
    this.three.mark(hit.use, hit.mesh, local);
    this.uv.mark(hit.uv.x, hit.uv.y);
  }

  /** Looks at a note as who took it did. */
  visit({ place_m: place, camera, view, zoom }) {
    const known = VIEWS.find(({ id }) => id === view);
    if (known && !$(`view-${known.id}`).disabled) this.switchTo(known);
    const eye = new THREE.Vector3(...camera.position_m).multiplyScalar(1000), spot = new THREE.Vector3(...place).multiplyScalar(1000);
    this.three?.lookFrom(eye, new THREE.Vector3(...camera.look), eye.distanceTo(spot), zoom ?? 1);
  }
}

load().then((data) => {
  globalThis.papilla = new Page(data);  // for the console of the browser
  return globalThis.papilla.start();
}).then(() => { document.body.dataset.ready = 'yes'; }, (error) => {
  problem(`The page can't be shown: ${error.message}`);
  console.error(error);
});
