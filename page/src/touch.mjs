// SPDX-License-Identifier: MIT
// The probe that slides over a relief under the mouse, its force as numbers, curve and sound.
import uPlot from 'uplot';
import { number } from './colour.mjs';
import { forceAt, surfaceOf } from './force.mjs';
import { axis, legend } from './plot_look.mjs';
import { drawRelief } from './relief_picture.mjs';
import { Sound } from './sound.mjs';

const $ = (id) => document.getElementById(id);
const KEPT = 400;

const feelsLike = (a, b) => a.height === b.height && a.haptic.stiffness === b.haptic.stiffness && a.haptic.backing?.stiffness === b.haptic.backing?.stiffness;

export class Touch {
  constructor(scene, reasonOff) {
    this.materials = scene.materials.filter((m) => m.relief).filter((m, i, all) => all.findIndex((o) => feelsLike(o, m)) === i);
    if (reasonOff || !this.materials.length) {
      $('touch-on').hidden = true;
      $('touch-off').hidden = false;
      $('touch-off').textContent = `Nothing to touch: ${reasonOff ?? 'no height map'}.`;
      return;
    }
    this.samples = [];
    this.sound = new Sound();
    this.makePlot();
    this.materials.forEach((m, i) => $('touch-material').add(new Option(m.name || `material ${m.index}`, i)));
    $('touch-material').addEventListener('change', (e) => this.choose(Number(e.target.value)));
    $('press').addEventListener('input', () => this.press());
    $('listen').addEventListener('click', () => this.listen());
    const canvas = $('relief');
    canvas.addEventListener('pointermove', (e) => this.move(e.offsetX / canvas.clientWidth, e.offsetY / canvas.clientHeight));
    canvas.addEventListener('pointerleave', () => this.lift());
    canvas.addEventListener('keydown', (e) => this.key(e));
    new ResizeObserver(() => this.plot.setSize({ width: $('force-plot').clientWidth, height: 260 })).observe($('force-plot'));
    this.choose(0);
  }

  makePlot() {
    this.plot = new uPlot({
      width: Math.max($('force-plot').clientWidth, 200), height: 260, legend, scales: { x: { time: false } },
      series: [{ label: 'seconds' }, { label: 'normal force [N]', stroke: '#1b7fd6', width: 2 }, { label: 'friction [N]', stroke: '#d9730d', width: 2, dash: [6, 4] }],
      axes: [axis('seconds'), axis('newtons')],
    }, [[], [], []], $('force-plot'));
  }

  /** Lays the relief of a picked material under the probe, if it has one. */
  follow(picked) {
    const index = this.materials.findIndex((m) => picked?.relief && feelsLike(m, picked));
    if (index < 0 || this.materials[index] === this.chosen) return;
    $('touch-material').value = index;
    this.choose(index);
  }

  choose(index) {
    const material = this.chosen = this.materials[index];
    this.surface = surfaceOf(material);
    this.lift();
    const { relief, size } = this.surface;
    this.image = document.createElement('canvas');
    this.image.width = this.image.height = 448;
    drawRelief(this.image, relief, size);
    let low = Infinity, high = -Infinity;
    for (const h of relief.mm) { low = Math.min(low, h); high = Math.max(high, h); }
    $('press').max = Math.max(2 * (high - low), 0.2);
    $('press').step = $('press').max / 200;
    $('press').value = (high - low);
    this.press();
    this.position = [0.5, 0.5];
    $('touch-note').textContent = `${material.name}: one repeat of ${number(size[0])} x ${number(size[1])} mm, ${relief.width} x ${relief.height} samples of ${relief.depth} bits (${relief.levels} different values), ${number(high - low)} mm from valley to peak. `
      + 'The probe is a point at a fixed depth below the mean of the relief: F = n max(0, k d - b v.n), with friction against its way. The player adds the ball of the finger, a proxy that sticks, and the maps of stiffness, friction and damping.';
    this.show();
  }

  lift() {
    this.last = null;
    this.sound.lift();
  }

  /** After a change of colours. */
  repaint() { if (this.samples?.length) this.plot.redraw(); }

  press() {
    this.depth = Number($('press').value);
    $('press-text').value = `${number(this.depth)} mm`;
  }

  async listen() {
    const on = $('listen').getAttribute('aria-pressed') !== 'true';
    await (on ? this.sound.start() : this.sound.stop());
    $('listen').setAttribute('aria-pressed', String(on));
    $('listen').textContent = on ? 'Silence' : 'Listen';
  }

  key(event) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const step = event.shiftKey ? 0.02 : 0.004;
    const next = this.position.map((p, i) => p + way[i] * step), wrapped = next.map((p) => (p + 1) % 1);
    if (next.some((p) => p < 0 || p >= 1)) this.lift();
    this.move(...wrapped);
  }

  /** @param x, y shares of the picture */
  move(x, y) {
    const now = performance.now() / 1000, at = [x * this.surface.size[0], y * this.surface.size[1]];
    this.position = [x, y];
    const seconds = this.last ? Math.max(now - this.last.time, 1e-3) : 0;
    const fresh = !this.last || seconds > 0.5;
    const v = fresh ? [0, 0] : at.map((p, i) => (p - this.last.at[i]) / seconds);
    if (fresh) this.sound.lift();
    this.sound.play(this.surface, at, now, this.depth);
    const result = forceAt(this.surface, ...at, this.depth, ...v);
    this.last = { at, time: now };
    this.start ??= now;
    this.samples.push([now - this.start, result.normal, result.friction, ...at, result.height]);
    if (this.samples.length > KEPT) this.samples.shift();
    $('force-total').value = `${result.total.toFixed(4)} N`;
    $('force-normal').textContent = `${result.normal.toFixed(4)} N`;
    $('force-side').textContent = `${result.force[0].toFixed(4)}, ${result.force[1].toFixed(4)} N`;
    $('force-height').textContent = `${result.height.toFixed(5)} mm`;
    $('force-speed').textContent = `${Math.hypot(...v).toFixed(1)} mm/s`;
    this.show();
    this.plot.setData([0, 1, 2].map((k) => this.samples.map((s) => s[k])));
  }

  show() {
    const canvas = $('relief'), context = canvas.getContext('2d');
    context.drawImage(this.image, 0, 0);
    const [x, y] = [this.position[0] * canvas.width, this.position[1] * canvas.height];
    for (const [width, colour] of [[5, '#000'], [2.5, '#ffb000']]) {
      context.lineWidth = width;
      context.strokeStyle = colour;
      context.beginPath();
      context.arc(x, y, 9, 0, 7);
      context.moveTo(x - 15, y); context.lineTo(x + 15, y); context.moveTo(x, y - 15); context.lineTo(x, y + 15);
      context.stroke();
    }
  }

  csv() {
    return ['seconds,normal_n,friction_n,x_mm,y_mm,height_mm', ...(this.samples ?? []).map((s) => s.join(','))].join('\n') + '\n';
  }
}
