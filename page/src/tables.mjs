// SPDX-License-Identifier: MIT
// Plan, distortion, times and downloads.
import { number } from './colour.mjs';
import { count, csvOf, download, element, table } from './dom.mjs';

const $ = (id) => document.getElementById(id);

const DISTORTION = [
  { title: 'part', of: (r) => r.part },
  { title: 'material', of: (r) => r.material ?? '' },
  { title: 'unwrap', of: (r) => r.unwrap ?? '', text: (r) => r.unwrap ?? '' },
  ...[['charts', (d) => d.charts], ['triangles', (d) => d.triangles], ['flipped', (d) => d.flipped], ['overlapping', (d) => d.overlapping_triangles],
    ['stretch L2', (d) => d.stretch_l2], ['L∞', (d) => d.stretch_linf], ['sym. Dirichlet', (d) => d.symmetric_dirichlet.mean], ['p99', (d) => d.percentiles.symmetric_dirichlet.p99],
    ['angle °', (d) => d.angle_error_deg.mean], ['p99 °', (d) => d.percentiles.angle_error_deg.p99], ['area min', (d) => d.area_ratio.min], ['area max', (d) => d.area_ratio.max]]
    .map(([title, of]) => ({ title, numeric: true, of: (r) => number(of(r.distortion)), text: (r) => of(r.distortion) })),
];

function distortionRows({ scene, report }) {
  if (report) return report.parts;
  return scene.parts.filter((p) => p.distortion).map((p) => ({ part: p.name, distortion: p.distortion }));
}

function fillDistortion(data, onPart) {
  const rows = distortionRows(data), host = $('distortion-table');
  if (!rows.length) return host.append(data.report ? 'No surface has grain.' : 'No part has texture coordinates, so there is no distortion to measure.');
  host.append(element('p', { class: 'note' }, 'Of the full mesh, uv scaled to the surface\'s area. 4 is the least symmetric Dirichlet energy, 1 no stretch. A click on a row selects the part.'), table(DISTORTION, rows, (row) => onPart(row.part)));
}

function planRows(plan) {
  const rows = new Map();
  for (const { part, material, stage, run, reason } of plan) {
    const key = JSON.stringify([part, material]);
    if (!rows.has(key)) rows.set(key, { part, material, stages: {} });
    rows.get(key).stages[stage] = { run, reason };
  }
  return [...rows.values()];
}

function leftOut(rows) {
  const reasons = new Map();
  for (const row of rows)
    for (const [stage, { run, reason }] of Object.entries(row.stages)) {
      if (run) continue;
      if (!reasons.has(reason)) reasons.set(reason, { reason, parts: new Set(), stages: new Set() });
      reasons.get(reason).parts.add(row.part);
      reasons.get(reason).stages.add(stage);
    }
  return [...reasons.values()];
}

/** Open parts that were turned towards those who see them, or have no side. */
function sidesList({ seen_from: from, eye_mm: eye, parts }) {
  const seen = { inside: 'the given point', view: 'the view volume', room: 'the room', around: 'all around' }[from] ?? from;
  const doubleSided = (part) => part.ambiguous - (part.left_ambiguous ?? 0);
  const line = (part) => `${part.part}: ${[part.turned_triangles && `${count(part.turned_triangles, 'triangle')} turned over`,
    doubleSided(part) && `${count(doubleSided(part), 'piece')} double sided`].filter(Boolean).join(', ')} (${part.reasons.join(', ').replaceAll('_', ' ')})`;
  const changed = parts.filter((part) => part.turned_triangles || doubleSided(part));
  return element('div', { id: 'sides' }, element('h3', {}, 'Sides of open parts'),
    element('p', { class: 'note' }, `${count(parts.length, 'part')} with a border, looked at from ${seen}${eye ? ` (${eye.map(number).join(', ')} mm)` : ''}; ${changed.length || 'none'} changed.`),
    element('ul', {}, ...changed.map((part) => element('li', {}, line(part)))));
}

/** What repair did to the surfaces before they were unwrapped. */
function repairList({ operations, lost_mm: lost, added_mm: added, sampled, tolerance_mm: tolerance, refused }) {
  const done = Object.entries(operations).filter(([, times]) => times).map(([name, times]) => `${times} ${name.replaceAll('_', ' ')}`);
  if (refused.triangles) done.push(`not done: pieces of ${count(refused.triangles, 'triangle')} would have moved by ${number(refused.deviation_mm)} mm`);
  return element('div', { id: 'repair' }, element('h3', {}, 'Repair'),
    element('p', { class: 'note' }, `Surface lost within ${number(lost)} mm, added within ${number(added)} mm, ${sampled ? 'by samples of the large pieces' : 'measured both ways'}; ${number(tolerance)} mm allowed.`),
    element('ul', {}, ...done.map((line) => element('li', {}, line))));
}

function fillPlan({ scene, report }) {
  const host = $('plan-table');
  const lost = [...(report?.losses ?? scene.losses), ...(report?.warnings ?? scene.warnings)];
  if (lost.length) host.append(element('ul', {}, ...lost.map((line) => element('li', {}, line))));
  if (report?.sides?.parts.length) host.append(sidesList(report.sides));
  if (report?.repair && (report.repair.refused.triangles || Object.values(report.repair.operations).some(Boolean))) host.append(repairList(report.repair));
  if (!report?.plan) return host.append(element('p', {}, 'The file alone does not tell how it was made; bake --report writes a page with the plan.'));
  const rows = planRows(report.plan), stages = [...new Set(report.plan.map((step) => step.stage))];
  host.append(element('h3', {}, 'Left out, and why'), table([
    { title: 'reason', of: (r) => r.reason }, { title: 'stages', of: (r) => [...r.stages].join(', ') },
    { title: 'parts', numeric: true, of: (r) => r.parts.size }, { title: 'which', of: (r) => [...r.parts].slice(0, 12).join(', ') + (r.parts.size > 12 ? ', …' : '') }], leftOut(rows)));
  const mark = ({ run, reason }) => element('span', { title: reason, role: 'img', 'aria-label': run ? 'done' : 'left out' }, run ? '✓' : '–');
  host.append(element('h3', {}, 'Part by part'), element('p', { class: 'note' }, '✓ done, – left out; the tooltip says why.'), table([{ title: 'part', of: (r) => r.part }, { title: 'material', of: (r) => r.material ?? '' },
    ...stages.map((stage) => ({ title: stage.replaceAll('_', ' '), of: (r) => r.stages[stage] ? mark(r.stages[stage]) : '' }))], rows));
}

const VERDICTS = { told_apart: 'told apart', alike: 'nobody tells apart', unknown: 'not known' };
const ORDER = ['alike', 'unknown', 'told_apart'];

/** A Weber difference, marked where it is more than its fraction. */
function differenceCell(value, fraction) {
  if (value === null) return '–';
  const text = value === 'infinite' ? '∞' : number(value);
  return value === 'infinite' || value > fraction ? element('b', {}, text) : text;
}

function reliefRows(materials) {
  const felt = materials.filter(({ relief }) => relief);
  if (!felt.length) return [];
  const share = (name) => ({ title: `${name} %`, numeric: true, of: ({ relief }) => number(100 * relief.receptors.find((r) => r.name === name).variance_share) });
  const finest = ({ may_be_left_out: none, finest_felt_mm: mm }) => none ? 'all of it' : mm === null ? 'nothing' : `below ${number(mm)} mm`;
  const saving = ({ size, needed_size: needed, bytes, needed_bytes: left }) => left < bytes ? `${needed.join(' x ')} for ${size.join(' x ')}: ${number((bytes - left) / 1e3)} of ${number(bytes / 1e3)} kB` : 'nothing';
  return [element('h3', {}, 'Reliefs under the stroke'), table([{ title: 'material', of: (m) => m.name },
    { title: 'Hz', of: ({ relief }) => relief.frequencies_hz.map(number).join(' to ') }, ...felt[0].relief.receptors.map(({ name }) => share(name)),
    { title: 'times threshold', numeric: true, of: ({ relief }) => number(relief.times_threshold) },
    { title: 'not felt', of: ({ relief }) => finest(relief) }, { title: 'leaving it out saves', of: ({ relief }) => saving(relief) }], felt)];
}

/** Weber differences of all pairs of materials, and what of their reliefs is felt. */
function fillApart({ report }) {
  const host = $('apart-table');
  if (!report?.touch) return host.append('bake --report compares the materials of a scene.');
  const { speed_m_per_s: speed, weber, receptors, materials, pairs } = report.touch;
  if (!pairs.length) host.append(element('p', {}, 'Fewer than two materials.'));
  else {
    const alike = pairs.filter(({ verdict }) => verdict === 'alike').length;
    host.append(element('p', { class: 'note' }, `${alike} of ${count(pairs.length, 'pair')} nobody tells apart. Weber differences |a − b| / (min(a, b) + noise); bold: more than the fraction that is felt, ${weber.map((w) => `${w.quantity} ${w.fraction}`).join(', ')}.`),
      table([{ title: 'material', of: (p) => p.a }, { title: 'and', of: (p) => p.b },
        ...weber.map((w) => ({ title: w.quantity, numeric: true, of: (p) => differenceCell(p[w.quantity], w.fraction) })),
        { title: 'verdict', of: (p) => VERDICTS[p.verdict] }, { title: 'why', of: (p) => p.reason }],
      [...pairs].sort((p, q) => ORDER.indexOf(p.verdict) - ORDER.indexOf(q.verdict))));
  }
  host.append(...reliefRows(materials));
  host.append(element('p', { class: 'note' }, `A stroke of ${speed} m/s. Receptors: ${receptors.map((r) => `${r.name} ${r.low_hz} to ${r.high_hz} Hz (${r.senses})`).join(', ')}. Sources: ${weber.map((w) => w.source).join('; ')}.`));
}

function fillTimings({ report }) {
  const host = $('timings-table');
  if (!report?.seconds) return host.append('Nothing was computed for this page but the page.');
  const rows = Object.entries(report.seconds).sort((a, b) => b[1] - a[1]), longest = Math.max(...rows.map(([, s]) => s), 1e-9);
  host.append(table([{ title: 'stage', of: ([name]) => name.replaceAll('_', ' ') }, { title: 'seconds', numeric: true, of: ([, s]) => number(s) },
    { title: 'share of the longest', of: ([, s]) => element('span', { class: 'bar-mark', style: `width:${Math.max(1, 300 * s / longest)}px` }) }], rows));
  host.append(element('p', { class: 'note' }, 'Stages that run in parallel count the time of all their threads, so they can add up to more than the total.'));
}

function fillDownloads(data, touch) {
  const { scene, report } = data, rows = distortionRows(data);
  const facts = { file: scene.file, triangles: scene.triangles, triangles_shown: scene.triangles_shown, parts: scene.parts.map(({ name, triangles, distortion }) => ({ name, triangles, distortion })),
    materials: scene.materials.map(({ name, haptic, warnings }) => ({ name, haptic, warnings })), losses: scene.losses, warnings: scene.warnings };
  const offer = (name, type, text) => {
    const button = element('button', { type: 'button', 'data-file': name }, `↓ ${name}`);
    button.addEventListener('click', () => download(name, text(), type));
    $('downloads').append(button);
  };
  offer('scene.json', 'application/json', () => JSON.stringify(facts, null, 2));
  if (report) offer('report.json', 'application/json', () => JSON.stringify({ ...report, materials: report.materials.map((entry) => ({ ...entry, photo: undefined })) }, null, 2));
  if (rows.length) offer('distortion.csv', 'text/csv', () => csvOf(DISTORTION, rows));
  if (report?.plan) offer('plan.csv', 'text/csv', () => csvOf(['part', 'material', 'stage', 'run', 'reason'].map((key) => ({ title: key, of: (r) => r[key] ?? '' })), report.plan));
  if (touch.samples) offer('force.csv', 'text/csv', () => touch.csv());
}

export function fillTables(data, touch, onPart) {
  fillDistortion(data, onPart);
  fillPlan(data);
  fillApart(data);
  fillTimings(data);
  fillDownloads(data, touch);
}
