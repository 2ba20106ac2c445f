// SPDX-License-Identifier: MIT
// A card per material: photo with its lattice, the primitive, the relief, how rough it is over lengths, constants.
import uPlot from 'uplot';
import { curve, number, tick } from './colour.mjs';
import { element } from './dom.mjs';
import { surfaceOf } from './force.mjs';
import { drawLattice, drawPrimitive } from './lattice_picture.mjs';
import { axis, legend, logSplits } from './plot_look.mjs';
import { drawRelief } from './relief_picture.mjs';

/** Root mean square difference of heights over lags of 2^k samples, along x and y: straight in log-log when fractal. */
export function structureFunction({ width, height, mm }, pitch) {
  const lags = [], rms = [];
  for (let lag = 1; lag <= Math.min(width, height) / 4; lag *= 2) {
    let sum = 0, count = 0;
    const step = Math.max(1, Math.floor(Math.max(width, height) / 256));
    for (let y = 0; y + lag < height; y += step)
      for (let x = 0; x + lag < width; x += step) {
        const h = mm[y * width + x];
        sum += (mm[y * width + x + lag] - h) ** 2 + (mm[(y + lag) * width + x] - h) ** 2;
        count += 2;
      }
    lags.push(lag * pitch);
    rms.push(Math.sqrt(sum / count));
  }
  const seen = rms.map((value) => value > 1e-3 * Math.max(...rms));  // At a period the surface meets itself: no height on a logarithmic axis.
  return [lags.filter((_, i) => seen[i]), rms.filter((_, i) => seen[i])];
}

/** @param size [width, height] whose shape it gets */
function tile(draw, caption, size = [1, 1]) {
  const scale = 184 / Math.max(...size), [width, height] = size.map((mm) => Math.max(1, Math.round(scale * mm)));
  const canvas = element('canvas', { class: 'tile', width, height, role: 'img', 'aria-label': caption });
  draw(canvas);
  return element('figure', {}, canvas, element('figcaption', {}, caption));
}

const plots = [];

/** After a change of colours. */
export function repaintCards() { for (const plot of plots) plot.redraw(); }

const LOGARITHMIC = { splits: (_, __, low, high) => logSplits(low, high), filter: (_, splits) => splits, values: (_, ticks) => ticks.map(tick) };

/** @param functions [{name, data: [lags, rms]}], a curve each */
function roughnessPlot(host, functions, width, height) {
  const plot = new uPlot({
    width, height, legend: functions.length > 1 ? legend : { show: false }, cursor: { show: false }, scales: { x: { time: false, distr: 3 }, y: { distr: 3 } },
    series: [{}, ...functions.map(({ name }, i) => ({ ...curve(i), label: name, spanGaps: true, points: { show: true, size: 6 } }))],
    axes: [axis('lag [mm]', { ...LOGARITHMIC, size: 30 }), axis('rms [mm]', { ...LOGARITHMIC, size: 52 })],
  }, uPlot.join(functions.map(({ data }) => data)), host);
  plots.push(plot);
  return plot;
}

async function imageOf(bytes) {
  const image = new Image();
  image.src = `data:image/png;base64,${bytes}`;
  await image.decode();
  return image;
}

/** In millimetres; what is below a thousandth of the length is no part of it. */
const vectorText = (v) => `(${v.map((c) => number(Math.abs(c) < 1e-3 * Math.hypot(...v) ? 0 : c)).join(', ')}) mm`;

function constants(material, about) {
  const tag = material?.haptic, rows = [];
  const add = (name, value) => { if (value !== undefined && value !== null && value !== '' && value !== false) rows.push([name, value]); };
  add('stiffness', tag && `${number(tag.stiffness ?? 500)} N/m`);
  add('damping', tag && `${number(tag.damping ?? 0)} N·s/m`);
  add('friction', tag && `${number(tag.staticFriction ?? tag.dynamicFriction ?? 0)} static, ${number(tag.dynamicFriction ?? tag.staticFriction ?? 0)} dynamic`);
  add('backing', tag?.backing && `${number(tag.backing.stiffness)} N/m from ${number(1000 * tag.backing.depth)} mm on`);
  for (const { quantity, scale, offset = 0 } of Object.values(tag?.maps?.channels ?? {}))
    add(`map of ${quantity.replaceAll('_', ' ')}`, `${number(Math.min(offset, offset + scale))} to ${number(Math.max(offset, offset + scale))}`);
  const { forceModel: force, frictionModel: hold } = tag ?? {};
  add('force model', force && [force.name ?? 'heightfield', force.form, force.sign === 'literal' && 'uphill', !['heightfield', 'textured-normal'].includes(force.name ?? 'heightfield') && `${number(force.amplitude ?? 0.01)} N per grey level`, force.level && `level ${force.level}`].filter(Boolean).join(', '));
  add('friction model', hold && [hold.name ?? 'coulomb', hold.stiffness > 0 && `${number(hold.stiffness)} N/m`].filter(Boolean).join(', '));
  add('relief', tag?.height && `rms ${number(1000 * tag.height.rms)} mm, range ${number(1000 * tag.height.scale)} mm`);
  const slope = about?.height?.slope;
  add('slope', slope && `at most ${number(slope.steepest.after)}${slope.steeper_share.before > 0 ? `, limited: ${number(100 * slope.steeper_share.before)} % was steeper than ${number(slope.max_slope)}` : ''}`);
  add('fractal dimension', about?.roughness?.fractal_dimension === undefined ? tag?.roughness && (tag.roughness.fractalDimension === undefined ? 'none: no power law' : number(tag.roughness.fractalDimension)) : about.roughness.fractal_dimension === null ? 'none: no power law' : number(about.roughness.fractal_dimension));
  add('class', about?.class?.name?.replaceAll('_', ' '));
  add('lattice', about && (about.lattice ? about.period_mm.map((v) => vectorText(v)).join(' and ') : 'none found'));
  add('height from', about?.height && `${about.height.method}: ${about.height.reason}`);
  const over = about?.roughness?.overlay;
  add('roughness over it', over && `H ${number(over.hurst)}, rms ${number(over.rms_mm)} mm, waves of ${over.wavelength_range_mm.map(number).join(' to ')} mm`);
  const steps = about?.plan?.filter((step) => step.run) ?? [];
  add('made in steps', steps.length > 0 && steps.map((step) => step.step.replaceAll('_', ' ')).join(', '));
  add('picture', about?.picture && `${about.picture.file.split(/[\\/]/).pop()}, ${about.picture.size_mm.map(number).join(' x ')} mm${about.picture.tiles ? ', tiles' : ', does not tile'}`);
  add('made by', tag?.provenance?.tool);
  return element('dl', {}, ...rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));
}

/** Materials that feel the same, with what the report says of their grain. */
function groups(scene, report) {
  const bySame = new Map();
  for (const material of scene.materials) {
    const key = material.haptic ? JSON.stringify([material.haptic, material.height]) : 'none';
    if (!bySame.has(key)) bySame.set(key, []);
    bySame.get(key).push(material);
  }
  return [...bySame.entries()].map(([key, materials]) => ({
    felt: key !== 'none', materials,
    about: report?.materials?.find((entry) => entry.height && materials[0].relief && materials.some((m) => m.name.startsWith(entry.name))),
  }));
}

/** @param compared takes what is drawn of all in one plot */
async function card({ felt, materials, about }, compared) {
  const [material] = materials;
  const title = about?.name ?? (felt ? material.name.replace(/ #[0-9A-Fa-f]{6,8}$/, '') || `material ${material.index}` : 'without touch');
  const node = element('article', { class: 'card' }, element('h3', {}, title));
  const pictures = element('div', { class: 'pictures' });
  const size = material.relief ? surfaceOf(material).size : null;
  if (about?.photo) {
    const image = await imageOf(about.photo);
    const vectors = about.lattice ? about.period_mm : null, shows = about.picture.shows_mm;  // The relief may be a tile of it.
    pictures.append(tile((c) => drawLattice(c, image, null, shows), 'photo', shows));
    if (vectors) pictures.append(tile((c) => drawLattice(c, image, vectors, shows), 'lattice', shows), tile((c) => drawPrimitive(c, image, vectors, shows), 'primitive'));
  }
  if (material.relief) pictures.append(tile((c) => drawRelief(c, material.relief, size), 'relief', size));
  node.append(pictures);
  if (felt) node.append(constants(material, about));
  if (material.relief) {
    const host = element('div', { role: 'img', 'aria-label': 'Root mean square difference of heights over distance, logarithmic' });
    node.append(host);
    const data = structureFunction(material.relief, size[0] / material.relief.width);
    roughnessPlot(host, [{ name: title, data }], 300, 180);
    compared.push({ name: title, data });
  }
  for (const warning of new Set(materials.flatMap((m) => m.warnings))) node.append(element('p', { class: 'note' }, `⚠ ${warning}`));
  node.append(element('p', { class: 'note' }, `${materials.length} of the file's materials: ${materials.slice(0, 12).map((m) => m.name || `#${m.index}`).join(', ')}${materials.length > 12 ? ', …' : ''}`));
  return node;
}

/** What the textured view is lit by; missing where the browser can't draw in 3D. */
function environmentCard(three) {
  const canvas = element('canvas', { class: 'tile', id: 'environment', width: 184, height: 184, role: 'img', 'aria-label': 'A mirror ball in the light of the textured view' });
  canvas.getContext('2d').putImageData(three.environmentPicture(184), 0, 0);
  return element('article', { class: 'card' }, element('h3', {}, 'environment'),
    element('div', { class: 'pictures' }, element('figure', {}, canvas, element('figcaption', {}, 'mirror ball'))),
    element('p', { class: 'note' }, three.data.environment === null
      ? "What lights and is mirrored in the textured view: a white studio of the page itself, with a lamp at the camera's upper left. It is no part of the file."
      : 'What lights and is mirrored in the textured view: the picture that was given as environment. Materials with one of their own mirror that.'));
}

/** The roughness of all materials in one plot. */
function comparison(compared) {
  const host = element('div', { class: 'curves', role: 'img', 'aria-label': `Root mean square difference of heights over distance of ${compared.map(({ name }) => name).join(', ')}` });
  const node = element('article', { class: 'card wide' }, element('h3', {}, 'Roughness over length, all materials'), host);
  const plot = roughnessPlot(host, compared, 600, 260);
  new ResizeObserver(() => host.clientWidth && plot.setSize({ width: Math.min(host.clientWidth, 900), height: 260 })).observe(host);
  return node;
}

/** @param three the scene in 3D, or nothing */
export async function fillCards(host, scene, report, three) {
  const compared = [];
  if (!scene.materials.length) host.append('The file has no materials.');
  for (const group of groups(scene, report).sort((a, b) => Boolean(b.about) - Boolean(a.about) || b.felt - a.felt)) host.append(await card(group, compared));
  if (compared.length > 1) host.append(comparison(compared));
  if (three) host.append(environmentCard(three));
}
