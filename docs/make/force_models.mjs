// SPDX-License-Identifier: MIT
// Curves of the force models from their evidence: node force_models.mjs docs/evidence/forces.md OUT.svg
import { readFileSync } from 'node:fs';
import { draw } from './curve.mjs';

const [page, out] = process.argv.slice(2);
const section = readFileSync(page, 'utf8').split('## Two waves of a sinusoidal relief')[1];
const [head, , ...rows] = section.split('\n').filter((line) => line.startsWith('|')).map((line) => line.split('|').slice(1, -1).map((cell) => cell.trim()));
const of = (column) => rows.map((row) => [row[0], row[column]]);
const series = head.flatMap((title, column) => column === 0 ? [] : [{ title, quiet: title === 'closed form', points: of(column) }]);
draw(out, { x: head[0], y: 'force on the hand [N]', log: false, series });
