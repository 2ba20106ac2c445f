// SPDX-License-Identifier: MIT
// A player that is followed: numbers and the force curve; the marks in the scene are LiveMarks.
import uPlot from 'uplot';
import { number } from './colour.mjs';
import { LiveMarks } from './live_marks.mjs';
import { axis, legend } from './plot_look.mjs';

const $ = (id) => document.getElementById(id);
const SHOWN_S = 10, PLOT_HEIGHT = 190;

const length = (v) => Math.hypot(...v);
const triple = (v, unit) => v ? `${v.map((c) => c.toFixed(2)).join(', ')} ${unit}` : 'no number';
const millimetres = (v) => v?.map((c) => 1000 * c);

export class Live {
  /** @param three may be missing where the browser can't draw in 3D */
  constructor(title, three) {
    this.title = title;
    this.marks = three && new LiveMarks(three);
    this.clear();
    this.makePlot();
    this.say('Connecting.');
    const events = new EventSource(`live${location.search}`);  // with the token of the page's address
    events.addEventListener('state', (e) => this.enter(JSON.parse(e.data)));
    events.addEventListener('sample', (e) => this.take(JSON.parse(e.data)));
    events.addEventListener('error', () => this.say('papilla view has ended. When it starts again it gives a new address.', 'lost'));
  }

  say(text, state = 'connecting') {
    $('live-state').textContent = text;
    $('live').dataset.state = state;
  }

  clear() { this.samples = [[], [], []]; this.count = 0; }

  enter({ state, file, device, rate_hz: rate }) {
    if (state === 'waiting') return this.say('No player yet: start papilla-player FILE --live.', state);
    if (state === 'ended') {
      this.marks?.fade();
      return this.say('The player has ended. The last position stays; a new player is followed as soon as it starts.', state);
    }
    this.clear();
    const name = file.split('/').pop();
    const other = name === this.title ? '' : ` It plays another file than this page shows: ${name}.`;
    this.say(`Playing on ${device} at ${number(rate)} Hz.${other}`, state);
  }

  take({ t, probe, proxy, force, contact }) {
    $('live-force').value = force ? `${length(force).toFixed(3)} N` : 'no number';
    $('live-vector').textContent = triple(force, 'N');
    $('live-contact').textContent = contact ? 'yes' : 'no';
    $('live-probe').textContent = triple(millimetres(probe), 'mm');
    $('live-proxy').textContent = triple(millimetres(proxy), 'mm');
    $('live-depth').textContent = probe && proxy ? `${(1000 * length(probe.map((c, i) => c - proxy[i]))).toFixed(3)} mm` : '–';
    $('live-time').textContent = `${t.toFixed(2)} s`;
    $('live').dataset.count = ++this.count;
    if (!probe || !proxy || !force) return;
    const [times, total, up] = this.samples;
    times.push(t);
    total.push(length(force));
    up.push(contact ? 0 : null);
    while (times[times.length - 1] - times[0] > SHOWN_S) for (const column of this.samples) column.shift();
    this.marks?.show({ probe, proxy, force, contact }, Math.max(...total), $('live-camera').checked);
    this.drawSoon();
  }

  drawSoon() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.plot.setData(this.samples); });
  }

  makePlot() {
    this.plot = new uPlot({
      width: Math.max($('live-plot').clientWidth, 200), height: PLOT_HEIGHT, legend, scales: { x: { time: false }, y: { range: (_, low, high) => [0, Math.max(high ?? 0, 0.1) * 1.05] } },
      series: [{ label: 'seconds' }, { label: 'force [N]', stroke: '#1b7fd6', width: 2 }, { label: 'in contact', stroke: '#d9730d', width: 6 }],
      axes: [axis('seconds'), axis('newtons')],
    }, this.samples, $('live-plot'));
    new ResizeObserver(() => $('live-plot').clientWidth && this.plot.setSize({ width: $('live-plot').clientWidth, height: PLOT_HEIGHT })).observe($('live-plot'));
  }

  /** After a change of colours. */
  repaint() { this.plot.redraw(); }
}
