// SPDX-License-Identifier: MIT
// The figures of the sources, made again by the programs, and the page that compares:
//   node sources.mjs BIN DATA DOCS [FIGURE ...]
// Reads docs/make/sources/page.md, where a line <!-- figures SOURCE --> stands for all figures of a source and
// <!-- section PAGE, HEADING --> for the tables of a page of evidence, and <!-- roughness --> for forces of that experiment; writes DOCS/sources.md and DOCS/pictures/sources.
// With FIGUREs like `schulze 6.4` only these are drawn.
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { draw } from './curve.mjs';
import { headings } from './markdown.mjs';
import { figures as cho } from './sources/cho.mjs';
import { roughnessTable } from './sources/roughness.mjs';
import { figures as schulze } from './sources/schulze.mjs';
import { figures as factory } from './sources/texture_factory.mjs';

const [bin, data, docs, ...only] = process.argv.slice(2);
const make = dirname(fileURLToPath(import.meta.url));
const SOURCES = { schulze, cho, factory };
const GAP = 6;
const pictureOf = (source, figure) => join('pictures', 'sources', `${source}-${figure.number}${endingOf(figure)}`);
const endingOf = (figure) => figure.graph || (figure.panels.length === 1 && figure.panels[0].picture.endsWith('.svg')) ? '.svg' : '.jpg';
const named = (text, i) => text.replaceAll('{}', `panel-${i + 1}`);

/** Runs every command once, in the folder of the figure; {} is a name for each panel. */
function run(figure, folder) {
  const env = { ...process.env, PATH: `${resolve(bin)}:${process.env.PATH}`, DATA: resolve(data), MAKE: make }, done = new Set();
  figure.panels.forEach((panel, i) => panel.commands.map((c) => named(c, i)).filter((c) => !done.has(c)).forEach((command) => {
    done.add(command);
    execFileSync('bash', ['-c', command], { cwd: folder, env, stdio: ['ignore', 'ignore', 'inherit'] });
  }));
}

function drawGraph(figure, folder, file) {
  const series = figure.panels.map((panel, i) => {
    const text = execFileSync('oiiotool', ['--dumpdata', join(folder, named(panel.picture, i))], { encoding: 'utf8', maxBuffer: 1 << 26 });
    const grey = [...text.matchAll(/\(([-\d.e]+)\)$/gm)].map((m) => Number(m[1]));
    return { title: panel.label, points: grey.map((g, x) => [x / (grey.length - 1), g + 1.1 * i]) };
  });
  draw(file, { x: 't', y: 'X(t), each in its own height', log: false, series });
}

function channelsOf(file) {
  const found = /, (\d+) channel/.exec(execFileSync('oiiotool', ['--info', file], { encoding: 'utf8' }));
  return Number(found[1]) < 3 ? '0,0,0' : '0,1,2';
}

/** Panels in rows; the widths of columns differ where a figure says so. */
function drawPanels(figure, folder, file) {
  const { columns, tile, narrow = tile } = figure, rows = Math.ceil(figure.panels.length / columns);
  const files = figure.panels.map((panel, i) => join(folder, named(panel.picture, i)));
  const heights = files.map((f, i) => heightOf(f, widthOf(i)));
  const rowHeights = Array.from({ length: rows }, (_, r) => Math.max(...heights.slice(r * columns, (r + 1) * columns)));
  function widthOf(i) { return i % columns ? narrow : tile; }
  const left = (i) => i % columns ? tile + GAP + (i % columns - 1) * (narrow + GAP) : 0;
  const top = (i) => rowHeights.slice(0, Math.floor(i / columns)).reduce((sum, h) => sum + h + GAP, 0);
  const width = left(columns - 1) + widthOf(columns - 1), height = rowHeights.reduce((sum, h) => sum + h, 0) + (rows - 1) * GAP;
  const paste = files.flatMap((f, i) => [f, '--ch', channelsOf(f), '--resize', `${widthOf(i)}x${heights[i]}`, '--swap', '--paste', `+${left(i)}+${top(i)}`]);
  execFileSync('oiiotool', ['--pattern', 'constant:color=1,1,1', `${width}x${height}`, '3', ...paste, '--compression', 'jpeg:85', '-d', 'uint8', '-o', file], { stdio: 'inherit' });
}

function heightOf(file, width) {
  const [, w, h] = /(\d+) x +(\d+)/.exec(execFileSync('oiiotool', ['--info', file], { encoding: 'utf8' })).map(Number);
  return Math.round(h * width / w);
}

function makeFigure(source, figure) {
  const folder = mkdtempSync(join(tmpdir(), 'papilla-sources-')), file = join(docs, pictureOf(source, figure));
  run(figure, folder);
  if (figure.graph) drawGraph(figure, folder, file);
  else if (file.endsWith('.svg')) copyFileSync(join(folder, named(figure.panels[0].picture, 0)), file);
  else drawPanels(figure, folder, file);
  rmSync(folder, { recursive: true });
}

const NAMES = { schulze: 'Abb.', cho: 'Fig.', factory: 'Abb.' };

/** A figure on the page: what it is, the picture, what differs, the commands. */
function figureText(source, figure) {
  const commands = [...new Set(figure.panels.flatMap((panel, i) => panel.commands.map((c) => named(c, i))))];
  const labels = figure.panels.map((p) => p.label);
  const said = labels.some(Boolean) && labels.length > 1 ? `From the upper left: ${labels.map((l) => l || '–').join('; ')}. ` : '';
  return `### ${NAMES[source]} ${figure.number}: ${figure.title}

![${figure.title}](${pictureOf(source, figure)})

${said}${figure.differs ? `Differs: ${figure.differs}.` : 'Our own formulas for what is shown there.'}

<details><summary>commands</summary>

${commands.map((c) => `    ${c}`).join('\n')}

</details>
`;
}

/** A section of a page of evidence, without its heading. */
function section(page, heading) {
  const text = readFileSync(join(docs, 'evidence', page), 'utf8'), heads = headings(text), at = heads.findIndex((h) => h.text === heading);
  if (at < 0) throw new Error(`${page}: has no section '${heading}'`);
  return text.split('\n').slice(heads[at].line + 1, heads[at + 1]?.line).join('\n').trim();
}

mkdirSync(join(docs, 'pictures', 'sources'), { recursive: true });
for (const [source, figures] of Object.entries(SOURCES))
  for (const figure of figures)
    if (!only.length || only.includes(`${source} ${figure.number}`)) {
      makeFigure(source, figure);
      console.log(`${source} ${figure.number}`);
    }
const page = readFileSync(join(make, 'sources', 'page.md'), 'utf8')
  .replace(/^<!-- figures (\w+) -->$/gm, (_, source) => SOURCES[source].map((figure) => figureText(source, figure)).join('\n').trim())
  .replace(/^<!-- section ([^,]+), (.*) -->$/gm, (_, file, heading) => section(file, heading))
  .replace(/^<!-- roughness -->$/m, () => roughnessTable(bin));
writeFileSync(join(docs, 'sources.md'), page);
