// SPDX-License-Identifier: MIT
// Curves as SVG, drawn by gnuplot.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { readCsv } from './csv.mjs';

const COLOURS = ['#0a5fb4', '#c1440e', '#2f7d32', '#7b3fa0', '#8a6d00', '#00707a', '#b0306a'];
const quote = (text) => `'${text.replaceAll("'", "''").replaceAll('\n', ' ')}'`;

/** The name of an axis in lines that fit beside it. */
const lines = (text) => text.match(/.{1,38}(?: |$)/g).map((line) => quote(line.trim())).join('."\\n".');

/**
 * @param series [{title, points: [[x, y]], quiet}]; quiet ones are grey and unnamed
 */
export function draw(file, { x, y, log, series }) {
  const loud = series.filter((s) => !s.quiet), all = [...series.filter((s) => s.quiet), ...loud];
  const points = (type, size) => log ? `pt ${type} ps ${size}` : '';
  const style = (s, at = loud.indexOf(s)) => s.quiet ? `lc rgb '#b5bcc4' lw 1 ${points(7, 0.3)} notitle`
    : `lc rgb '${COLOURS[at % COLOURS.length]}' lw 2 ${points(5 + 2 * (at % 5), 0.6)} title ${quote(s.title)}`;
  const script = `set terminal svg size 820,${400 + 20 * loud.length} enhanced background '#ffffff' font 'sans-serif,13'
set output ${quote(file)}
set termoption noenhanced
set key below left maxcols 1
set bmargin ${4 + 0.9 * loud.length}
set grid lc rgb '#d8dde2'
set xlabel ${quote(x)}
set ylabel ${lines(y)}
${log ? 'set logscale xy\nset format "%g"\nset mxtics 10' : ''}
plot ${all.map((s) => `'-' with ${log ? 'linespoints' : 'lines'} ${style(s)}`).join(', ')}
${all.map((s) => `${s.points.map((p) => p.join(' ')).join('\n')}\ne`).join('\n')}
`;
  execFileSync('gnuplot', { input: script, stdio: ['pipe', 'inherit', 'inherit'] });
}

/** The kind of error of a method's curves: one that goes over several samples, and of these the one that most methods have. */
function errorToShow(runs, method) {
  const weight = (error) => {
    const same = runs.filter((r) => r.error_name === error);
    return [same.some((r) => r.method === method && r.trace.length > 2) ? 1 : 0, new Set(same.map((r) => r.method)).size];
  };
  const names = [...new Set(runs.filter((r) => r.method === method && r.trace.length).map((r) => r.error_name))];
  return names.map((name) => ({ name, weight: weight(name) })).sort((a, b) => b.weight[0] - a.weight[0] || b.weight[1] - a.weight[1])[0]?.name;
}

const nameOf = (run) => run.solver ? `${run.method} (${run.solver})` : run.method;

/**
 * The curves of a method in front of all others, from the JSON of `papilla evaluate`.
 * @param variant part of the solver's name, to show only these in front
 */
export function drawEvaluation(json, file, method, variant = '') {
  const { runs } = JSON.parse(readFileSync(json, 'utf8')), error = errorToShow(runs, method);
  if (!error) throw new Error(`${json}: holds no method ${method}`);
  const input = runs.find((r) => r.method === method && r.error_name === error).input;
  const series = runs.filter((r) => r.error_name === error && r.input === input).map((r) => ({
    title: nameOf(r), quiet: r.method !== method || !r.solver.includes(variant),
    points: r.trace.filter((s) => s.seconds > 0 && s.error > 0).map((s) => [s.seconds, s.error]) })).filter((s) => s.points.length);
  draw(file, { x: 'run time [s]', y: error, log: true, series });
  const shown = series.filter((s) => !s.quiet);
  if (!shown.length) throw new Error(`${json}: ${method} ${variant} has nothing to draw`);
  return { error, input: basename(input), others: series.some((s) => s.quiet), dots: shown.every((s) => s.points.length === 1) };
}

const size = (row, name) => Math.hypot(...['x', 'y', 'z'].map((c) => Number(row[`${name}_${c}`])));
const STROKES = {
  force: { y: 'force on the hand [N]', series: { force: (r) => size(r, 'force') } },
  depth: { y: 'probe to proxy [mm]', series: { depth: (r) => 1000 * Math.hypot(...['x', 'y', 'z'].map((c) => r[`probe_${c}`] - r[`proxy_${c}`])) } },
  travel: {
    y: 'way from the start [mm]', series: Object.fromEntries(['probe', 'proxy'].map((what) => [what, (r, start) => 1000 * Math.hypot(...['x', 'y', 'z'].map((c) => r[`${what}_${c}`] - start[`${what}_${c}`]))])),
  },
};

/** Recordings of the player over their time. @param what force, depth or travel */
export function drawStroke(csvs, file, what) {
  const { y, series } = STROKES[what];
  const curves = csvs.flatMap((csv) => {
    const rows = readCsv(csv), name = csvs.length > 1 ? `${basename(csv, '.csv')}: ` : '';
    return Object.entries(series).map(([title, of]) => ({ title: name + title, points: rows.map((r) => [r.t, of(r, rows[0])]) }));
  });
  draw(file, { x: 'time [s]', y, log: false, series: curves });
}
