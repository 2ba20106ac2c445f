// SPDX-License-Identifier: MIT
// Pressing the pointer on a surface of the scene: the server computes the contact, the page shows proxy, force and sound.
import * as THREE from 'three';
import uPlot from 'uplot';
import { number } from '../colour.mjs';
import { element } from '../dom.mjs';
import { LiveMarks } from '../live_marks.mjs';
import { axis, legend } from '../plot_look.mjs';
import { Sound } from '../sound.mjs';
import { FULL_SCALE, roundedOff } from '../vibration.mjs';
import { get } from './api.mjs';
import { ticksOf } from './feel_batch.mjs';
import { FeelHand } from './feel_hand.mjs';
import { listenFirst } from './first_listener.mjs';
import { T as TEXTS } from './texts.mjs';

const T = TEXTS.feel;
const SHOWN_S = 4, PLOT_HEIGHT = 180, STEP_PX = 4, FOLLOW_MS = 16;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Feel {
  /** @param host gets the controls @param say(text, isProblem) */
  constructor(host, { view, socket, say }) {
    Object.assign(this, { host, view, socket, say, isOn: false, press: null, samples: [[], [], [], []], strongest: 0, sound: new Sound() });
    this.marks = new LiveMarks({ scene: view.stage, marks: view.marks, camera: view.camera, controls: view.controls, canvas: view.canvas, moved: () => view.draw(), invalidate: () => view.draw() });
    this.build();
    socket.on('feel', (event) => this.told(event));
    socket.on('felt', (event) => this.take(event));
    socket.on('lost', () => this.end());
    listenFirst(view.canvas, this);
    view.canvas.addEventListener('blur', () => this.press?.byKey && this.lift());
    get('feel').then((choices) => this.setChoices(choices)).catch((error) => say(error.message, true));
  }

  build() {
    const field = (text, ...nodes) => element('div', { class: 'field' }, element('span', {}, text), ...nodes);
    const reading = (id) => element('dd', { id: `feel-${id}` }, '–');
    this.mode = element('button', { type: 'button', id: 'feel-mode', 'aria-pressed': 'false' }, T.mode);
    this.listen = element('button', { type: 'button', id: 'feel-listen', 'aria-pressed': 'false' }, T.listen);
    this.device = element('select', { id: 'feel-device', 'aria-label': T.device });
    this.model = element('select', { id: 'feel-model', 'aria-label': T.model });
    this.depth = element('input', { id: 'feel-by', type: 'range', min: '0', max: '10', step: '0.1', value: '2', 'aria-label': T.depth });
    this.depthText = element('output', { for: 'feel-by' });
    this.total = element('output', { id: 'feel-total', class: 'big' }, '0 N');
    this.chart = element('div', { id: 'feel-plot', role: 'img', 'aria-label': T.plot });
    this.notes = element('ul', { class: 'note', id: 'feel-notes' });
    this.limits = element('p', { class: 'note', id: 'feel-limits' });
    const rows = Object.entries(T.readings).flatMap(([id, text]) => [element('dt', {}, text), reading(id)]);
    this.host.replaceChildren(element('p', { class: 'note' }, T.help), element('div', { class: 'row' }, this.mode, this.listen), field(T.device, this.device), this.limits,
      field(T.model, this.model), field(T.depth, this.depth, this.depthText), this.total, element('dl', {}, ...rows), this.chart, this.notes);
    this.mode.addEventListener('click', () => this.setOn(!this.isOn));
    this.listen.addEventListener('click', () => this.setListening());
    this.device.addEventListener('change', () => this.showLimits());
    const showDepth = () => { this.depthText.value = `${this.depth.value} mm`; };
    this.depth.addEventListener('input', showDepth);
    showDepth();
    this.makePlot();
  }

  makePlot() {
    const line = (label, stroke, dash) => ({ label, stroke, width: 2, dash });
    this.plot = new uPlot({
      width: 280, height: PLOT_HEIGHT, legend, cursor: { show: false }, scales: { x: { time: false }, y: { range: (_, low, high) => [Math.min(0, low ?? 0), Math.max(high ?? 0, 0.1) * 1.05] } },
      series: [{ label: T.seconds }, line(T.curves.total, '#0072b2'), line(T.curves.press, '#009e73', [8, 4]), line(T.curves.side, '#d55e00', [2, 3])],
      axes: [axis('seconds'), axis(T.newtons)],
    }, this.samples, this.chart);
    new ResizeObserver(() => this.chart.clientWidth && this.plot.setSize({ width: this.chart.clientWidth, height: PLOT_HEIGHT })).observe(this.chart);
  }

  /** Names and limits as the server has them. */
  setChoices(choices) {
    this.choices = choices;
    this.device.replaceChildren(...choices.devices.map(({ name, title }) => element('option', { value: name }, title)));
    this.model.replaceChildren(element('option', { value: '' }, T.ownModel), ...choices.models.map(({ name, stimulus }) => element('option', { value: name }, stimulus ? `${name} (${T.stimulus})` : name)));
    this.showLimits();
  }

  get deviceNow() { return this.choices?.devices.find(({ name }) => name === this.device.value); }

  showLimits() {
    const device = this.deviceNow;
    this.limits.textContent = device ? T.limits(number(device.max_force_n), number(device.probe_radius_mm), number(1000 * device.mass_kg), number(device.delay_ms)) : '';
  }

  setOn(on) {
    this.isOn = on;
    this.mode.setAttribute('aria-pressed', String(on));
    this.view.canvas.dataset.mode = on ? 'feel' : 'look';
    if (on) return this.say(T.on);
    this.lift();
    return this.marks.hide();
  }

  async setListening() {
    const on = this.listen.getAttribute('aria-pressed') !== 'true';
    await (on ? this.sound.start() : this.sound.stop());
    this.listen.setAttribute('aria-pressed', String(on));
  }

  // ---- The pointer.

  /** A place of the view as the server names it: in the scene's own axes. */
  spotAt(place) {
    const hit = this.view.hitAt(place);
    if (!hit) return null;
    const { root } = this.view, point = root.worldToLocal(hit.point.clone()), turned = root.quaternion.clone().invert();
    return { point: point.toArray(), normal: (hit.smooth ?? hit.normal).clone().applyQuaternion(turned).toArray() };
  }

  down(event) {
    if (!this.isOn || event.button !== 0 || !this.begin({ clientX: event.clientX, clientY: event.clientY }, false)) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.view.canvas.focus();
    this.view.canvas.setPointerCapture(event.pointerId);
  }

  move(event) {
    if (!this.press || this.press.byKey) return;
    event.stopImmediatePropagation();
    this.press.place = { clientX: event.clientX, clientY: event.clientY };
  }

  up(event) {
    if (!this.press || this.press.byKey) return;
    event.stopImmediatePropagation();
    this.lift();
  }

  /** Space presses in the middle of the view and lifts; arrows move the place. */
  key(event) {
    if (!this.isOn) return;
    const way = ARROWS[event.key], stop = () => { event.preventDefault(); event.stopImmediatePropagation(); };
    if (event.key === ' ') {
      stop();
      if (event.repeat) return;
      if (this.press) return this.lift();
      const { left, top, width, height } = this.view.canvas.getBoundingClientRect();
      if (!this.begin({ clientX: left + width / 2, clientY: top + height / 2 }, true)) this.say(T.nothing);
    } else if (event.key === 'Escape' && this.press) {
      stop();
      this.lift();
    } else if (way && this.press?.byKey) {
      stop();
      const step = event.shiftKey ? STEP_PX / 4 : STEP_PX, { place } = this.press;
      this.press.place = { clientX: place.clientX + step * way[0], clientY: place.clientY + step * way[1] };
    }
  }

  // ---- A press.

  begin(place, byKey) {
    if (this.press || !this.choices) return false;
    const spot = this.spotAt(place);
    if (!spot) return false;
    const id = crypto.randomUUID(), hand = new FeelHand(this.deviceNow.probe_radius_mm);
    hand.move(spot.point, spot.normal, Number(this.depth.value));
    this.press = { id, hand, place, byKey };
    this.state('preparing');
    this.socket.send({ feel: 'press', id, device: this.device.value, model: this.model.value, point: spot.point });
    return true;
  }

  /** Tells the server where the hand is; not by frames, which wait for the graphics card. */
  follow() {
    const { press } = this;
    if (!press?.start || press.isLifted) return;
    const spot = this.spotAt(press.place);
    if (spot) press.hand.move(spot.point, spot.normal, Number(this.depth.value));
    const sample = press.hand.sample((performance.now() - press.start) / 1000);
    if (sample) this.socket.send({ feel: 'move', id: press.id, path: [sample] });
  }

  lift() {
    const { press } = this;
    if (!press || press.isLifted) return;
    press.isLifted = true;
    if (press.start) this.leave();
  }

  leave() {
    const { press } = this, { samples, end } = press.hand.lift((performance.now() - press.start) / 1000);
    this.socket.send({ feel: 'move', id: press.id, path: samples, lift: end });
  }

  told({ id, state, problem, warnings, limits }) {
    if (id !== this.press?.id) return;
    if (state === 'ready') {
      this.press.start = performance.now();
      this.showNotes(warnings, limits);
      this.state('feeling');
      this.timer = setInterval(() => this.follow(), FOLLOW_MS);
      if (!this.press.isLifted) return this.follow();
      this.socket.send({ feel: 'move', id, path: [this.press.hand.sample(0)] });
      return this.leave();
    }
    if (problem) this.say(problem, true);
    else if (state === 'fault') this.say(T.fault, true);
    return this.end();
  }

  end() {
    clearInterval(this.timer);
    this.press = null;
    this.marks.hide();
    this.total.value = '0 N';
    this.state('idle');
  }

  state(name) { document.body.dataset.feel = name; }

  // ---- What the server says.

  take(event) {
    if (event.id !== this.press?.id) return;
    const ticks = ticksOf(event), last = ticks.at(-1);
    const offset = this.press.offset ??= (this.samples[0].at(-1) ?? 0) + (this.samples[0].length ? 0.05 : 0);
    for (const tick of ticks) {
      const values = [tick.t + offset, tick.total, tick.press, tick.side];
      values.forEach((value, i) => this.samples[i].push(value));
      this.strongest = Math.max(this.strongest, tick.total);
    }
    while (this.samples[0].at(-1) - this.samples[0][0] > SHOWN_S) for (const column of this.samples) column.shift();
    this.drawSoon();
    this.showMarks(last);
    this.showReadings(ticks, event.late);
    if (event.sound.length) this.sound.queue(Float32Array.from(event.sound, (a) => roundedOff(a / FULL_SCALE)), event.sound_hz);
    this.host.dataset.ticks = Number(this.host.dataset.ticks ?? 0) + ticks.length;
  }

  showMarks({ probe, proxy, force, contact }) {
    const { root } = this.view, metres = (mm) => root.localToWorld(new THREE.Vector3(...mm)).divideScalar(1000).toArray();
    this.marks.show({ probe: metres(probe), proxy: metres(proxy), force: new THREE.Vector3(...force).applyQuaternion(root.quaternion).toArray(), contact }, this.strongest, false);
  }

  showReadings(ticks, late) {
    const first = ticks[0], last = ticks.at(-1), seconds = last.t - first.t;
    const way = (name) => Math.hypot(...last[name].map((x, i) => x - first[name][i]));
    const texts = {
      press: `${last.press.toFixed(3)} N`, side: `${last.side.toFixed(3)} N`, depth: `${Math.hypot(...last.probe.map((x, i) => x - last.proxy[i])).toFixed(3)} mm`,
      speed: `${(seconds > 0 ? way('proxy') / seconds : 0).toFixed(1)} mm/s`, contact: last.contact ? T.yes : T.no, late: String(late),
    };
    for (const [id, text] of Object.entries(texts)) this.host.querySelector(`#feel-${id}`).textContent = text;
    this.total.value = `${last.total.toFixed(3)} N${last.total > 0.999 * (this.deviceNow?.max_force_n ?? Infinity) ? `, ${T.atLimit}` : ''}`;
  }

  showNotes(warnings, limits) {
    const texts = [...limits.map((l) => T.softened(l.material, number(l.stiffness_wanted), number(l.stiffness))), ...warnings];
    this.notes.replaceChildren(...texts.map((text) => element('li', {}, text)));
  }

  drawSoon() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.plot.setData(this.samples); });
  }

  /** After a change of colours. */
  repaint() { this.plot.redraw(); }
}
