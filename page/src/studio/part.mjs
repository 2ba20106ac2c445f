// SPDX-License-Identifier: MIT
// What is selected: its material, and how the grain lies on it.
import { number } from '../colour.mjs';
import { element } from '../dom.mjs';
import { later } from './later.mjs';
import { T } from './texts.mjs';

const METHODS = ['auto', 'new', 'keep', 'best', 'natural', 'planar', 'triplanar', 'maillot', 'levy', 'lscm', 'arap', 'mvc', 'tutte', 'intermediate'];

/** A row of label and controls. */
const row = (text, ...controls) => element('div', { class: 'field' }, element('span', {}, text), ...controls);

function input(name, attributes, value) {
  const node = element('input', { 'aria-label': name, ...attributes });
  if (value !== undefined && value !== null) node.value = value;
  return node;
}

export class PartPanel {
  /** @param vary(values) changes the selected parts' material @param set(material, values) changes it for all @param turn a GrainTurn @param isRecipe(text) @param editRecipe(material) */
  constructor(host, { vary, set, assign, remove, turn, isRecipe, editRecipe }) { Object.assign(this, { host, vary, set, assign, remove, turn, isRecipe, editRecipe }); }

  /** @param surfaces of the state, those selected @param made their data, where it is there @param document the state's */
  show(surfaces, made, document, library) {
    if (this.host.contains(globalThis.document.activeElement) && this.keeps(surfaces)) return this.numbers(made);
    this.last = surfaces.map((s) => `${s.part}/${s.slot}`).join();
    this.turn.hide();
    if (!surfaces.length) return this.host.replaceChildren(element('p', { class: 'note' }, T.selectFirst));
    const names = new Set(surfaces.map((s) => s.material)), [first] = surfaces;
    const select = element('select', { 'aria-label': T.material }, ...[null, ...Object.keys(document.materials ?? {})].map((name) => element('option', { value: name ?? '' }, name ?? T.noMaterial)));
    if (names.size > 1) select.prepend(element('option', { value: '\0' }, T.several));
    select.value = names.size > 1 ? '\0' : first.material ?? '';
    select.addEventListener('change', () => select.value !== '\0' && this.assign(select.value || null));
    const rows = [row(T.material, select)];
    if (names.size === 1 && first.material !== null) rows.push(...this.lay(first, made[0], document, library), ...this.constants(first.material, document, library));
    this.readings = element('dl', {});
    this.host.replaceChildren(...rows, this.readings);
    return this.numbers(made);
  }

  keeps(surfaces) { return this.last === surfaces.map((s) => `${s.part}/${s.slot}`).join(); }

  lay(surface, data, document, library) {
    const own = document.materials[surface.material] ?? {}, base = library.find((m) => `library:${m.name}` === own.material);
    const size = own.size_mm ?? base?.height?.size_mm ?? [40, 40], grain = own.unwrap?.grain ?? 'up';
    if (!own.texture && !base?.height && !own.height?.images) return [element('p', { class: 'note' }, T.noGrain)];
    const isOwn = Array.isArray(grain);
    const sizes = size.map((mm, k) => input([T.width, T.height][k], { type: 'number', min: '0.1', max: '10000', step: 'any', id: `size-${k}` }, mm));
    for (const node of sizes) later(node, () => sizes.every((s) => s.valueAsNumber > 0) && this.vary({ '/size_mm': sizes.map((s) => s.valueAsNumber) }));
    const along = element('select', { 'aria-label': T.direction, id: 'grain' }, ...Object.entries(T.directions).map(([value, text]) => element('option', { value }, text)));
    along.value = isOwn ? 'own' : typeof grain === 'string' ? grain : 'up';
    along.addEventListener('change', () => along.value === 'own' ? this.turn.write() : this.vary({ '/unwrap/grain': along.value }));
    const phases = (own.phase_mm ?? [0, 0]).map((mm, k) => input(`${T.phase}, ${'uv'[k]}`, { type: 'number', min: '-100000', max: '100000', step: 'any', id: `phase-${k}` }, mm));
    for (const node of phases) later(node, () => phases.every((p) => Number.isFinite(p.valueAsNumber)) && this.vary({ '/phase_mm': phases.map((p) => p.valueAsNumber) }));
    const method = typeof own.unwrap === 'object' ? own.unwrap.method ?? 'new' : own.unwrap ?? 'auto';
    const mapping = element('select', { 'aria-label': T.mapping, id: 'mapping' }, ...METHODS.map((name) => element('option', { value: name }, name)));
    mapping.value = method;
    mapping.addEventListener('change', () => this.vary(typeof own.unwrap === 'object' && mapping.value !== 'keep' ? { '/unwrap/method': mapping.value } : { '/unwrap': mapping.value }));
    return [element('h2', {}, T.forPart), row(T.size, ...sizes), row(T.phase, ...phases), row(T.direction, along), row(T.angle, this.turn.controls(surface, data, grain)), row(T.mapping, mapping)];
  }

  constants(name, document, library) {
    const own = document.materials[name] ?? {}, base = library.find((m) => `library:${m.name}` === own.material);
    const field = (text, pointer, value, more = {}) => {
      const node = input(text, { type: 'number', step: 'any', min: '0', ...more }, value);
      return row(text, later(node, () => this.set(name, { [pointer]: Number.isFinite(node.valueAsNumber) ? node.valueAsNumber : null }, text)));
    };
    const colour = input(T.colour, { type: 'color' }, own.color ?? base?.appearance?.color ?? '#808080');
    colour.addEventListener('change', () => this.set(name, { '/color': colour.value }, T.colour));
    const remove = element('button', { type: 'button' }, T.removeMaterial);
    remove.addEventListener('click', () => this.remove(name));
    const edit = element('button', { type: 'button', id: 'part-recipe' }, T.recipe.edit);
    edit.addEventListener('click', () => this.editRecipe(name));
    return [
      element('h2', {}, `${T.forMaterial}: ${name}`), ...(this.isRecipe(own.texture ?? base?.height?.recipe) ? [edit] : []), field(T.depth, '/height/depth_mm', own.height?.depth_mm ?? base?.height?.depth_mm),
      field(T.stiffness, '/stiffness', own.stiffness ?? base?.stiffness), field(T.damping, '/damping', own.damping ?? base?.damping),
      field(T.friction, '/staticFriction', own.staticFriction ?? base?.static_friction), field(T.sliding, '/dynamicFriction', own.dynamicFriction ?? base?.dynamic_friction),
      row(T.colour, colour), field(T.shine, '/roughness', own.roughness ?? base?.appearance?.roughness, { max: '1' }), field(T.metal, '/metallic', own.metallic ?? base?.appearance?.metallic, { max: '1' }), remove,
    ];
  }

  numbers(made) {
    const [data] = made, rows = [];
    const add = (name, value) => value !== undefined && value !== '' && rows.push(element('dt', {}, name), element('dd', {}, value));
    if (data?.report) {
      add(T.method, `${data.report.method}${data.report.reason ? `: ${data.report.reason}` : ''}`);
      add(T.charts, String(data.report.charts));
      add(T.seamLength, `${number(data.report.seam_mm)} mm`);
      add(T.distortion, number(data.report.distortion?.stretch_l2 ?? NaN));
      add(T.notes, data.report.notes.join('; '));
    }
    if (data) add(T.took, `${number(data.seconds)} s`);
    add(T.warning, (data?.warnings ?? []).join('; '));
    this.readings?.replaceChildren(...rows);
  }
}
