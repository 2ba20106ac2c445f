// SPDX-License-Identifier: MIT
// The scale of a view with its numbers and their unit.
import { number, viridis } from './colour.mjs';
import { element } from './dom.mjs';
import { legendText, valueAt } from './views.mjs';

const $ = (id) => document.getElementById(id);
const TICKS = [0, 0.25, 0.5, 0.75, 1];

export function showLegend(view, range, checker) {
  const plain = view.kind < 2;
  $('legend-box').hidden = view.id === 'textured';
  $('legend').hidden = $('legend-ticks').hidden = plain;
  $('legend-title').textContent = plain ? view.name : `${view.what}${view.unit ? ` [${view.unit}]` : ''}`;
  $('legend-text').textContent = legendText(view, checker);
  $('legend-ticks').replaceChildren(...TICKS.map((t) => element('li', { 'data-at': t }, number(valueAt(view, range, t)))));
  [...$('legend-ticks').children].forEach((node, i) => { node.style.left = `${100 * TICKS[i]}%`; });
  const context = $('legend').getContext('2d');
  for (let x = 0; x < 256; ++x) {
    const [r, g, b] = viridis(x / 255);
    context.fillStyle = (x + 12.8) % 25.6 < 1 ? '#000' : `rgb(${r} ${g} ${b})`;
    context.fillRect(x, 0, 1, 12);
  }
}
