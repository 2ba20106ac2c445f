// SPDX-License-Identifier: MIT
// Curves as SVG, drawn by gnuplot.
import { execFileSync } from 'node:child_process';
import { basename } from 'node:path';
import { readCsv } from './csv.mjs';

const COLOURS = ['#0a5fb4', '#c1440e', '#2f7d32', '#7b3fa0', '#8a6d00', '#00707a'];
const quote = (text) => `'${text.replaceAll("'", "''").replaceAll('\n', ' ')}'`;

/**
 * @param series [{title, points: [[x, y]], quiet}]; quiet ones are grey and unnamed
 */
function draw(file, { x, y, log, series }) {
  const loud = series.filter((s) => !s.quiet), all = [...series.filter((s) => s.quiet), ...loud];
  const style = (s) => s.quiet ? "lc rgb '#b5bcc4' lw 1 pt 7 ps 0.3 notitle" : `lc rgb '${COLOURS[loud.indexOf(s) % COLOURS.length]}' lw 2 pt ${5 + 2 * (loud.indexOf(s) % 5)} ps 0.6 title ${quote(s.title)}`;
  const script = `set terminal svg size 760,420 enhanced background '#ffffff' font 'sans-serif,13'
set output ${quote(file)}
set termoption noenhanced
set key outside right top width -2
set grid lc rgb '#d8dde2'
set xlabel ${quote(x)}
set ylabel ${quote(y)}
${log ? 'set logscale xy\nset format "%.0e"' : ''}
plot ${all.map((s) => `'-' with ${log ? 'linespoints' : 'lines'} ${style(s)}`).join(', ')}
${all.map((s) => `${s.points.map((p) => p.join(' ')).join('\n')}\ne`).join('\n')}
`;
  execFileSync('gnuplot', { input: script, stdio: ['pipe', 'inherit', 'inherit'] });
}

/** The curves of a method in front of those of all others: `input` and `error_name` are those of its first row. */
export function drawEvaluation(csv, file, method) {
  const rows = readCsv(csv).filter((r) => (r.repeat ?? '0') === '0' && Number(r.error) > 0 && Number(r.seconds) > 0);
  const first = rows.find((r) => r.method === method);
  if (!first) throw new Error(`${csv}: holds no method ${method}`);
  const curves = new Map();
  for (const row of rows) {
    if (row.error_name !== first.error_name || row.input !== first.input) continue;
    const name = row.solver ? `${row.method} (${row.solver})` : row.method;
    if (!curves.has(name)) curves.set(name, { title: name, quiet: row.method !== method, points: [] });
    curves.get(name).points.push([row.seconds, row.error]);
  }
  draw(file, { x: 'run time [s]', y: first.error_name, log: true, series: [...curves.values()] });
  return { error: first.error_name, input: basename(first.input) };
}

const size = (row, name) => Math.hypot(...['x', 'y', 'z'].map((c) => Number(row[`${name}_${c}`])));
const STROKES = {
  force: { y: 'force on the hand [N]', series: { force: (r) => size(r, 'force') } },
  depth: { y: 'probe to proxy [mm]', series: { depth: (r) => 1000 * Math.hypot(...['x', 'y', 'z'].map((c) => r[`probe_${c}`] - r[`proxy_${c}`])) } },
  travel: {
    y: 'way from the start [mm]', series: Object.fromEntries(['probe', 'proxy'].map((what) => [what, (r, start) => 1000 * Math.hypot(...['x', 'y', 'z'].map((c) => r[`${what}_${c}`] - start[`${what}_${c}`]))])),
  },
};

/** A recording of the player over its time. @param what force, depth or travel */
export function drawStroke(csv, file, what) {
  const rows = readCsv(csv), { y, series } = STROKES[what];
  draw(file, { x: 'time [s]', y, log: false, series: Object.entries(series).map(([title, of]) => ({ title, points: rows.map((r) => [r.t, of(r, rows[0])]) })) });
}
