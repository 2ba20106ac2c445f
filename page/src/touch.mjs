// SPDX-License-Identifier: MIT
// The probe that slides over the surface of the scene or over one repeat of a relief; its force as numbers, curves and sound.
import uPlot from 'uplot';
import { curve, number } from './colour.mjs';
import { forceAt, surfaceOf } from './force.mjs';
import { LiveMarks } from './live_marks.mjs';
import { axis, legend } from './plot_look.mjs';
import { reliefSpot } from './relief_spot.mjs';
import { drawRelief } from './relief_picture.mjs';
import { Sound } from './sound.mjs';

const $ = (id) => document.getElementById(id);
const KEPT = 400, PLOT_HEIGHT = 170;
/** A way in the relief that is longer than on the surface by this factor crosses a border of charts. */
const JUMP = 3, JUMP_MM = 1;

export const feelsLike = (a, b) => a.height === b.height && a.haptic.stiffness === b.haptic.stiffness && a.haptic.backing?.stiffness === b.haptic.backing?.stiffness;

const nameOf = (material) => (material.name || `material ${material.index}`).replace(/ #[0-9A-Fa-f]{6,8}$/, '');

export class Touch {
  constructor(scene, reasonOff) {
    this.scene = scene;
    this.materials = scene.materials.filter((m) => m.relief).filter((m, i, all) => all.findIndex((o) => feelsLike(o, m)) === i);
    if (reasonOff || !this.materials.length) {
      $('touch-on').hidden = true;
      $('touch-off').hidden = false;
      $('touch-off').textContent = `Nothing to touch: ${reasonOff ?? 'no height map'}.`;
      $('touch-mode').disabled = true;
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
    new ResizeObserver(() => { if ($('force-plot').clientWidth) this.plot.setSize({ width: $('force-plot').clientWidth, height: PLOT_HEIGHT }); }).observe($('force-plot'));
    this.choose(0);
  }

  /** The mouse presses on the surface of the scene while `on`. */
  useScene(three, on) {
    if (!this.samples || !three) return;
    this.marks ??= new LiveMarks(three);
    this.three = three;
    three.touch = on ? (spot) => this.probe(spot) : null;
    three.canvas.dataset.mode = on ? 'touch' : 'look';
    if (!on) this.probe(null);
  }

  /** A curve a material: normal force, and thin the friction. */
  makePlot() {
    const series = this.materials.flatMap((m, i) => [{ ...curve(i), label: `${nameOf(m)} [N]` }, { ...curve(i), width: 1, label: 'friction [N]' }]);
    this.plot = new uPlot({
      width: Math.max($('force-plot').clientWidth, 200), height: PLOT_HEIGHT, legend, scales: { x: { time: false } },
      series: [{ label: 'seconds' }, ...series.map((s, i) => ({ ...s, show: i < 2, spanGaps: false }))], axes: [axis('seconds'), axis('newtons')],
    }, [[], ...series.map(() => [])], $('force-plot'));
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
    this.index = index;
    this.surface = surfaceOf(material);
    this.lift();
    for (const i of [1, 2]) if (!this.plot.series[2 * index + i].show) this.plot.setSeries(2 * index + i, { show: true });
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
    if (this.samples.length) this.samples.push([NaN]);  // a gap of the curves
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
    $('listen-text').textContent = on ? 'Silence' : 'Listen';
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
  move(x, y) { this.slide([x * this.surface.size[0], y * this.surface.size[1]]); }

  /** The probe presses on a spot of the scene, or leaves it. */
  probe(found) {
    const { spot, material, ratio } = found ? this.compare?.at(found) ?? { spot: found, material: this.scene.materials[found.mesh.material] } : {};
    if (!material?.relief) {
      this.lift();
      this.marks?.hide();
      $('force-total').value = spot ? 'no relief here' : '0 N';
      return;
    }
    this.follow(material);
    const place = reliefSpot(material, this.surface, spot, ratio);
    if (!place) return;
    if (this.last?.point && Math.hypot(...place.at.map((p, i) => p - this.last.at[i])) > JUMP * this.last.point.distanceTo(spot.point) + JUMP_MM) this.lift();
    const { force, height } = this.slide(place.at, spot.point);
    const [fx, fy, fz] = force, [x, y] = place.axes, { mean } = this.surface;
    const inScene = x.clone().multiplyScalar(fx).addScaledVector(y, fy).addScaledVector(spot.normal, fz);
    this.strongest = Math.max(this.strongest ?? 0, inScene.length());
    const metres = (depth) => spot.point.clone().addScaledVector(spot.normal, depth).divideScalar(1000).toArray();
    this.marks.show({ probe: metres(-this.depth), proxy: metres(height - mean), force: inScene.toArray(), contact: inScene.lengthSq() > 0 }, this.strongest, false);
  }

  /** @param at mm in the relief, repeats counted on, @param point where that is on the surface, if it is on one */
  slide(at, point) {
    const now = performance.now() / 1000, { size } = this.surface;
    this.position = at.map((p, i) => (p / size[i] % 1 + 1) % 1);
    const seconds = this.last ? Math.max(now - this.last.time, 1e-3) : 0;
    const fresh = !this.last || seconds > 0.5;
    const v = fresh ? [0, 0] : at.map((p, i) => (p - this.last.at[i]) / seconds);
    if (fresh) this.sound.lift();
    this.sound.play(this.surface, at, now, this.depth);
    const result = forceAt(this.surface, ...at, this.depth, ...v);
    this.last = { at, time: now, point };
    this.start ??= now;
    this.samples.push([now - this.start, this.index, result.normal, result.friction, ...at, result.height]);
    if (this.samples.length > KEPT) this.samples.shift();
    $('force-total').value = `${result.total.toFixed(3)} N`;
    $('force-normal').textContent = `${result.normal.toFixed(3)} N`;
    $('force-side').textContent = `${result.force[0].toFixed(3)}, ${result.force[1].toFixed(3)} N`;
    $('force-height').textContent = `${result.height.toFixed(4)} mm`;
    $('force-speed').textContent = `${Math.hypot(...v).toFixed(1)} mm/s`;
    this.show();
    this.plotSoon();
    return result;
  }

  plotSoon() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      let time = 0;
      const times = this.samples.map(([t]) => time = Number.isNaN(t) ? time + 1e-3 : t);
      const columns = this.materials.flatMap((_, i) => [2, 3].map((k) => this.samples.map((s) => s[1] === i ? s[k] : null)));
      this.plot.setData([times, ...columns]);
    });
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
    const rows = (this.samples ?? []).filter(([t]) => !Number.isNaN(t)).map(([t, material, ...rest]) => [t, ...rest, `"${this.materials[material].name.replaceAll('"', '""')}"`]);
    return ['seconds,normal_n,friction_n,x_mm,y_mm,height_mm,material', ...rows.map((row) => row.join(','))].join('\n') + '\n';
  }
}
