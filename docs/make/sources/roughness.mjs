// SPDX-License-Identifier: MIT
// What the hand gets of the surfaces of the roughness experiment: how much the force of a stroke changes from tick to tick, by dimension
// and force model.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { readCsv } from '../csv.mjs';

const AXES = ['force_x', 'force_y', 'force_z'];
const SETTLED = 0.2;

/** Root mean square of the change of force from tick to tick, mN, once the hand is in contact. */
function change(csv) {
  const ticks = readCsv(csv).filter((row) => Number(row.t) > SETTLED), steps = ticks.slice(1);
  const squares = steps.map((row, i) => AXES.reduce((sum, axis) => sum + (row[axis] - ticks[i][axis]) ** 2, 0));
  return 1000 * Math.sqrt(squares.reduce((a, b) => a + b) / steps.length);
}

/** A table: a row for each force model, a column for each dimension. */
export function roughnessTable(bin) {
  const folder = mkdtempSync(join(tmpdir(), 'papilla-roughness-'));
  execFileSync(join(bin, 'papilla'), ['study', 'new', '-o', folder, '--experiments', 'roughness', '--participants', '1', '--quiet']);
  const { stimuli } = JSON.parse(readFileSync(join(folder, 'STUDY.json'), 'utf8'));
  const found = {};
  for (const { file, model, dimension } of stimuli) {
    const stroke = join(folder, 'stroke.csv');
    execFileSync(join(bin, 'papilla-player'), [join(folder, file), '--seconds', '1', '--motion', 'slide', '--record', stroke, '--quiet']);
    (found[model] ??= {})[dimension] = change(stroke);
  }
  rmSync(folder, { recursive: true });
  const dimensions = [...new Set(stimuli.map((s) => s.dimension))].sort();
  const line = (cells) => `| ${cells.join(' | ')} |`;
  return [line(['force model', ...dimensions.map((d) => `D = ${d}`)]), line(['---', ...dimensions.map(() => '---')]),
    ...Object.entries(found).map(([model, by]) => line([model, ...dimensions.map((d) => by[d].toPrecision(3))]))].join('\n');
}
