// SPDX-License-Identifier: MIT
// Puts the page together.
import { fillCards, repaintCards } from './cards.mjs';
import { number, viridis } from './colour.mjs';
import { load } from './data.mjs';
import { count, element } from './dom.mjs';
import { Live } from './live.mjs';
import { Looks } from './looks.mjs';
import { SceneView } from './scene_view.mjs';
import { fillTables } from './tables.mjs';
import { Touch } from './touch.mjs';
import { UvView } from './uv_view.mjs';
import { VIEWS, checkerText, legendText, rangeOf, reasonOff, valueOf } from './views.mjs';

const $ = (id) => document.getElementById(id);
const MOST_LISTED = 500;

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
  }

  start() {
    const { scene, data } = this;
    document.title = `${data.title} · Papilla`;
    $('title').textContent = data.title;
    const fewer = scene.triangles_shown < scene.triangles;
    $('summary').textContent = `${count(scene.triangles, 'triangle')} in ${count(scene.parts.length - this.coarserParts(), 'part')}; `
      + (scene.levels.length ? `coarser levels of detail at ${count(scene.levels.length, 'place')}, by size on the screen; ` : '')
      + (fewer ? `${scene.triangles_shown.toLocaleString('en')} shown, simplified for this page by about ${number(scene.error_mm)} mm at most` : 'all of them shown');
    $('footer').textContent = data.live ? `Served by ${data.program}, on this machine only. The samples come from its player; nothing is loaded from anywhere else.`
      : data.looks ? `Served by ${data.program}, on this machine only. Nothing is loaded from anywhere else.`
      : `Written by ${data.program}. Everything is in this file; nothing is loaded from anywhere.`;
    this.theme();
    this.listViews();
    this.touch = new Touch(scene, reasonOff(VIEWS[7], scene));
    fillTables(data, this.touch, (name) => this.selectByName(name));
    this.openViews();
    this.listParts('');
    $('find').addEventListener('input', (e) => this.listParts(e.target.value));
    $('parts').addEventListener('keydown', (e) => this.stepParts(e));
    document.addEventListener('keydown', (e) => this.keys(e));
    this.switchTo(this.view);
    this.selectLargest();
    if (data.live) this.live = new Live(data.title, this.three);
    if (data.looks) this.looks = new Looks(data.looks, this.three);
    return fillCards($('cards'), scene, data.report, this.three);
  }

  openViews() {
    if (!this.scene.triangles) return problem('The file has no triangles: there is nothing to show.');
    if (reasonOff(VIEWS[1], this.scene)) problem('No part has texture coordinates: the views of distortion are off.');
    if (reasonOff(VIEWS[5], this.scene)) problem(`The views of touch are off: ${reasonOff(VIEWS[5], this.scene)}.`);
    try {
      this.three = new SceneView($('canvas3d'), this.scene, (hit) => this.pick(hit), (hit) => this.hover(hit));
      this.uv = new UvView($('canvasuv'), this.scene, (hit) => this.pickUv(hit));
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
    const back = getComputedStyle(document.body).backgroundColor;
    this.three?.setBackground(back);
    this.uv?.setBackground(back);
    this.touch.repaint();
    this.live?.repaint();
    repaintCards();
  }

  listViews() {
    VIEWS.forEach((view, i) => {
      const why = reasonOff(view, this.scene) ?? (this.scene.triangles ? null : 'there are no triangles');
      const input = element('input', { type: 'radio', name: 'view', value: view.id, id: `view-${view.id}` });
      const label = element('label', why ? { 'data-off': '', title: `Off: ${why}` } : {}, input, ` ${i + 1} ${view.name}`);
      input.disabled = Boolean(why);
      input.checked = view === this.view;
      input.addEventListener('change', () => this.switchTo(view));
      $('views').append(label);
    });
  }

  keys(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || /INPUT|SELECT/.test(event.target.tagName) && event.target.type !== 'radio') return;
    const view = VIEWS[Number(event.key) - 1];
    if (view && !$(`view-${view.id}`).disabled) this.switchTo(view);
  }

  switchTo(view) {
    this.view = view;
    $(`view-${view.id}`).checked = true;
    if (!this.ranges.has(view.id)) this.ranges.set(view.id, rangeOf(view, this.scene));
    const range = this.ranges.get(view.id), plain = view.kind < 2;
    this.three?.setView(view, range);
    this.uv?.setView(view, range);
    $('legend').hidden = plain;
    $('legend-text').textContent = legendText(view, range, checkerText(this.scene));
    const context = $('legend').getContext('2d');
    for (let x = 0; x < 256; ++x) {
      const [r, g, b] = viridis(x / 255);
      context.fillStyle = (x + 12.8) % 25.6 < 1 ? '#000' : `rgb(${r} ${g} ${b})`;
      context.fillRect(x, 0, 1, 14);
    }
  }

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

  listParts(filter) {
    const wanted = filter.toLowerCase(), list = $('parts'), found = [];
    this.scene.instances.slice(0, this.scene.finest_instances).forEach((_, i) => { if (this.nameOf(i).toLowerCase().includes(wanted)) found.push(i); });
    list.replaceChildren(...found.slice(0, MOST_LISTED).map((i) => {
      const item = element('li', { role: 'option', id: `use-${i}`, 'aria-selected': String(i === this.selected) }, this.nameOf(i));
      item.addEventListener('click', () => this.select(i, true));
      return item;
    }));
    if (found.length > MOST_LISTED) list.append(element('li', {}, `and ${found.length - MOST_LISTED} more: type to find them`));
  }

  stepParts(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const items = [...$('parts').querySelectorAll('[role=option]')];
    const now = items.findIndex((item) => item.id === `use-${this.selected}`);
    const next = items[Math.min(Math.max(now + step, 0), items.length - 1)];
    if (next) this.select(Number(next.id.slice(4)), true);
  }

  /** Of those with uv, so that the layout is not empty at first. */
  selectLargest() {
    const { parts, instances } = this.scene;
    const size = ({ part }) => parts[part].meshes.some((m) => m.uv) ? parts[part].triangles : 0;
    const best = instances.reduce((most, use, i) => size(use) > size(instances[most]) ? i : most, 0);
    if (this.scene.triangles) this.select(best, false);
  }

  selectByName(name) {
    const use = this.scene.instances.findIndex((u, i) => this.nameOf(i) === name || this.scene.parts[u.part].name === name);
    if (use >= 0) { this.select(use, true); $('scene').scrollIntoView(); }
  }

  select(use, frame) {
    if (this.selected !== use) {
      document.getElementById(`use-${this.selected}`)?.setAttribute('aria-selected', 'false');
      this.selected = use;
      const item = document.getElementById(`use-${use}`);
      item?.setAttribute('aria-selected', 'true');
      item?.scrollIntoView({ block: 'nearest' });
      if (item) $('parts').setAttribute('aria-activedescendant', item.id);
      this.uv?.show(use);
      const part = this.scene.parts[this.scene.instances[use].part];
      $('uv-text').textContent = part.meshes.some((m) => m.uv) ? `${this.nameOf(use)}: orange lines are borders of charts. Click picks in 3D.` : `${this.nameOf(use)} has no texture coordinates.`;
      $('canvasuv').dataset.part = this.nameOf(use);
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
    $('picked').textContent = text;
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

  withBary(hit) { return { ...hit, bary: Array.isArray(hit.bary) ? hit.bary : hit.bary.toArray() }; }

  pick(hit) {
    if (!hit) return;
    this.select(hit.use, false);
    this.touch.follow(this.scene.materials[hit.mesh.material]);
    this.describe(hit.use, this.withBary(hit));
    this.three.mark(hit.use, hit.mesh, hit.local);
    if (hit.mesh.uv) this.uv.mark(hit.uv.x, hit.uv.y);
  }

  hover(hit) {
    $('canvas3d').title = hit ? `${this.nameOf(hit.use)}: ${this.readout(this.withBary(hit))}` : '';
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
    this.three.mark(hit.use, hit.mesh, local);
    this.uv.mark(hit.uv.x, hit.uv.y);
  }
}

load().then((data) => new Page(data).start()).then(() => { document.body.dataset.ready = 'yes'; }, (error) => {
  problem(`The page can't be shown: ${error.message}`);
  console.error(error);
});
